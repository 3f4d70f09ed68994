"""Presses of null laws: the depth that carries a load, and what is left of it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...core.arrays import Array
from .laws import NullCurve


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
