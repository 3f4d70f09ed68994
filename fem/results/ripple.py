"""Curves without the ripple of the mesh, from all steps of the path.

With the approach prescribed, force and radius rise and fall by some tenths of a per cent as the
contact edge crosses one ring of elements after the other. Where the edge stands between two rings
is known at every step, so the part that repeats from ring to ring is told from the curve by least
squares over the neighbouring steps, and left out: a mean over whole rings that follows slope and
curvature of the curve.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...core.arrays import Array
from ..rules import RULES
from .measure import Reading

# steps within the reach, else the raw value stands
_ENOUGH = 2 * RULES.harmonics + RULES.ripple_degree + 4
_NAMES = ("force", "radius", "radius_last_node", "share")


@dataclass
class RippleTrack:
    """All steps of a loading path: what the smooth curves are made from."""

    readings: list[Reading] = field(default_factory=list)

    def smooth(self, wanted: Sequence[Reading]) -> list[Reading]:
        """Return some of the readings without their ripple; F, a and the share have one."""
        path = self.readings
        x = np.log([r.delta for r in path])
        turns = 2.0 * np.pi * np.array([r.place for r in path])
        raw = {name: np.array([getattr(r, name) for r in path]) for name in _NAMES}
        out = []
        for reading in wanted:
            here = int(np.abs(x - np.log(reading.delta)).argmin())
            weights = _weights(x, turns, here)
            if weights is None:
                out.append(reading)
                continue
            force, radius, last, share = (_mean(raw[name], weights, here) for name in _NAMES)
            both = reading.sphere + reading.flat
            out.append(
                replace(
                    reading,
                    force=force,
                    radius=radius,
                    radius_last_node=last,
                    sphere=share * both,
                    flat=(1.0 - share) * both,
                )
            )
        return out


def _mean(values: Array, weights: Array, here: int) -> float:
    """Weighted mean of the logarithms, of the values themselves where one is not above 0."""
    near = values[weights != 0.0]
    weights = weights[weights != 0.0]
    if near.min() <= 0.0:  # the share of a nearly rigid body
        return float(values[here] + weights @ (near - values[here]))
    return float(values[here] * np.exp(weights @ np.log(near / values[here])))


def _weights(x: Array, turns: Array, here: int) -> Array | None:
    """Weights of the steps in the smooth value at step `here`; none: too few steps about it."""
    t = (x - x[here]) / RULES.ripple_reach
    near = np.flatnonzero(np.abs(t) < 1.0)
    if len(near) < _ENOUGH:
        return None
    t = t[near]
    columns = [t**k for k in range(RULES.ripple_degree + 1)]
    for k in range(1, RULES.harmonics + 1):
        columns += [np.cos(k * turns[near]), np.sin(k * turns[near])]
    root = np.sqrt((1.0 - np.abs(t) ** 3) ** 3)
    prior = np.eye(2 * RULES.harmonics, len(columns), RULES.ripple_degree + 1) * np.sqrt(
        RULES.ripple_prior
    )
    rows = np.vstack([np.stack(columns, axis=1) * root[:, None], prior])
    weights = np.zeros(len(x))
    weights[near] = np.linalg.pinv(rows)[0, : len(near)] * root
    return weights
