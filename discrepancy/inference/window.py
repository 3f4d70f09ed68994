"""A fit made again on a grid about its most probable place."""

from __future__ import annotations

import numpy as np

from ...core.arrays import Array
from ..comparison.forward import Simulator
from ..rules import RULES
from .fit import Fit, expand, tried_steps
from .grid import Grid


def sharpened(simulator: Simulator, fitted: Fit, *, rounds: int = 8) -> Fit:
    """Fit again on a grid about the most probable place, if the data know it better than a grid.

    A grid over the whole prior has few nodes; where the data pin a parameter down to a part of
    their distance, neither the simulation between them nor the interval can be trusted. The window
    follows the most probable place, and shrinks to a few standard deviations about it.

    `fitted`: a fit with mechanisms; `rounds`: largest number of windows, at least 1.
    """
    grid, z, place = fitted.grid, fitted.z, fitted.place
    spread = _spread(fitted)
    share = np.array([1.0 / len(f) for f in grid.fine])
    node = np.array([min(1.0 / (len(c) - 1), RULES.node_apart) for c in grid.coarse])
    jumps = any(m.jumps for m in fitted.mechanisms)
    if np.all(spread > np.maximum(RULES.resolved * share, node)) and not jumps:
        return fitted
    half = np.maximum(RULES.window * spread, 2.5 * share)
    best = None
    for _ in range(max(rounds, 1)):
        low, high = np.maximum(place - half, 0.0), np.minimum(place + half, 1.0)
        window = tuple(zip(low.tolist(), high.tolist(), strict=True))
        local = Grid(grid.axes, window)
        found = expand(simulator, fitted.mechanisms, local, z, place, None)
        # where outcomes bend or jump, a step may fall off the branch that the data are on
        if best is None or found.log_evidence > best.log_evidence:
            best = found
        wide = high - low
        outward = (
            ((found.place < low + 0.1 * wide) & (low > 0.0))
            | ((found.place > high - 0.1 * wide) & (high < 1.0))
        )  # fmt: skip
        z, place, settled = tried_steps(simulator, found, z, place)
        narrow = RULES.window * _spread(found)
        if not outward.any() and np.all(narrow > 0.3 * half) and settled:
            break
        half = np.where(outward, 1.6 * half, np.clip(narrow, 0.1 * half, half))
    assert best is not None
    return best


def _spread(fitted: Fit) -> Array:
    """Posterior standard deviation of each parameter, as a share of its prior's range."""
    places, weight = fitted.grid.places(), fitted.weight
    away = places - weight @ places
    return np.asarray(np.sqrt(weight @ away**2))
