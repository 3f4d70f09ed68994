"""Smoothing of curves over depth, which separates the ripple of the mesh from its bias."""

from __future__ import annotations

import numpy as np

from ...core.arrays import Array, Mask

_WINDOW = 0.45  # half width of the local fit in ln Delta: several surface elements


def smoothed(delta: Array, values: Array) -> Array:
    """Local quadratic in ln Delta over +-0.45, shape (n,); a positive quantity is best given as ln.

    `delta`, `values`: shape (n,).
    """
    x = np.log(delta)
    out = np.empty_like(values)
    for k in range(len(x)):
        near = np.abs(x - x[k]) < _WINDOW
        out[k] = np.polyval(np.polyfit(x[near], values[near], 2), x[k])
    return out


def inner(delta: Array) -> Mask:
    """Points at least half a window from the ends, where the local fit is one-sided and noisy."""
    x = np.log(delta)
    return np.asarray((x - x[0] > 0.5 * _WINDOW) & (x[-1] - x > 0.5 * _WINDOW))
