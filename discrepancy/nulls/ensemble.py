"""Discrepancies of null laws from the baseline, over a rig's conditions, and null noise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array
from .laws import NullReference, curve, draw
from .motion import NullBodies, collide
from .press import press


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


def scatter(rng: np.random.Generator, shape: tuple[int, ...]) -> Array:
    """Noise of unit standard deviation with the tails of a logistic distribution."""
    return np.asarray(rng.logistic(0.0, np.sqrt(3.0) / np.pi, shape))
