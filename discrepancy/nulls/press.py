"""Presses of null laws: the depth that carries a load, and what is left of it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .laws import Curve

Array = NDArray[np.float64]


def press(loads: Array, curves: Sequence[Curve]) -> dict[str, Array]:
    """Return the observables of n presses, each of shape (n,).

    Parameters
    ----------
    loads
        (n,) largest loads [N].
    curves
        The law of each contact, n of them.
    """
    names = (
        "permanent_depth_m", "dent_diameter_m", "press_depth_m", "recovered_depth_m", "peak_depth_m"
    )  # fmt: skip
    rows = np.empty((len(loads), len(names)))
    for i, (load, c) in enumerate(zip(loads, curves, strict=True)):
        rising = np.maximum.accumulate(c.log_force)
        x = float(np.interp(np.log(load), rising, c.log_depth))
        crater, radius, back = (
            float(np.interp(x, c.log_depth, table)) for table in (c.crater, c.radius, c.recovery)
        )
        rows[i] = crater, 2.0 * radius, np.exp(x), back, np.exp(x)
    return dict(zip(names, rows.T, strict=True))
