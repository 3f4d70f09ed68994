"""Discrepancies of null laws from the baseline, over a rig's conditions, and null noise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array
from .laws import NullCurve, NullReference, curve, draw
from .motion import NullBodies, collide


@dataclass(frozen=True, eq=False)
class NullRig:
    """Conditions in plain numbers.

    `bodies`: strikers before touch, one a condition; `references`: the baseline's curve of each
    condition; `loads`: (conditions,) largest load of each press [N]; nan of an impact.
    """

    bodies: NullBodies
    references: Sequence[NullReference]
    loads: Array


def discrepancies(
    rig: NullRig, count: int, rng: np.random.Generator, size: dict[str, float]
) -> dict[str, Array]:
    """Return observables of `count` null laws, each of shape (count, conditions).

    `rig`: what strikes what; `size`: standard deviations of the levels of force and recovery and of
    their slopes, and the largest rms distances of their shapes.
    """
    n = len(rig.references)
    contacts = list(dict.fromkeys(rig.references))
    curves = []
    for _ in range(count):
        law = draw(rng, size)
        table = {r: curve(r, law) for r in contacts}
        curves += [table[r] for r in rig.references]
    loads = np.tile(rig.loads, count)
    struck = np.isnan(loads)
    seen: dict[str, Array] = {}
    for rows in (struck, ~struck):
        if not rows.any():
            continue
        own = [c for c, here in zip(curves, rows, strict=True) if here]
        if rows is struck:
            fields = NullBodies.__dataclass_fields__
            many = NullBodies(*(np.tile(getattr(rig.bodies, k), count)[rows] for k in fields))
            found = collide(many, own)
        else:
            found = press(loads[rows], own)
        for name, values in found.items():
            seen.setdefault(name, np.full(len(curves), np.nan))[rows] = values
    return {k: v.reshape(count, n) for k, v in seen.items()}


def press(loads: Array, curves: Sequence[NullCurve]) -> dict[str, Array]:
    """Return the observables of n presses, each of shape (n,).

    `loads`: (n,) largest loads [N]; `curves`: the law of each contact, n of them.
    """
    x, crater, radius, back = np.empty((4, len(loads)))
    for i, (load, c) in enumerate(zip(loads, curves, strict=True)):
        rising = np.maximum.accumulate(c.log_force)
        x[i] = np.interp(np.log(load), rising, c.log_depth)
        crater[i], radius[i], back[i] = (
            np.interp(x[i], c.log_depth, table) for table in (c.crater, c.radius, c.recovery)
        )
    return {
        "permanent_depth_m": crater, "dent_diameter_m": 2.0 * radius, "press_depth_m": np.exp(x),
        "recovered_depth_m": back, "peak_depth_m": np.exp(x),
    }  # fmt: skip


def scatter(rng: np.random.Generator, shape: tuple[int, ...]) -> Array:
    """Noise of unit standard deviation with the tails of a logistic distribution."""
    return np.asarray(rng.logistic(0.0, np.sqrt(3.0) / np.pi, shape))
