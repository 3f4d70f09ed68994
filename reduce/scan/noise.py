"""How far roughness that hangs together moves what is read from a scan.

Every height that is read is a weighted sum of points. Its variance is the sum, over the distances
between two points, of the autocorrelation of the weights times the autocovariance of the
undisturbed surface; so waviness counts as what it is, and so does the error of the level.
"""

from __future__ import annotations

import numpy as np

from ...core.arrays import Array, Indices, Mask
from ..rules import RULES


def autocovariance(z: Array, clear: Mask, reach: Indices) -> Array:
    """Return the autocovariance by lag up to `reach` points, (2 rx + 1, 2 ry + 1) [m²].

    Of the points (nx, ny) of heights above the level [m] that are clear.
    """
    weights = clear.astype(np.float64)
    sums = _correlation(np.where(clear, z, 0.0), reach)
    pairs = np.rint(_correlation(weights, reach))
    return np.where(pairs >= RULES.lag_pairs, sums / np.maximum(pairs, 1.0), 0.0)


def variance(weights: Array, covariance: Array) -> float:
    """Return the variance of the heights' sum with weights (nx, ny) [m²].

    Beyond its reach the autocovariance of the surface is taken as 0.
    """
    reach = (np.array(covariance.shape) - 1) // 2
    # lags near 0 can come out a little negative in sum where the surface is almost white
    floor = float(covariance[tuple(reach)]) * float(np.sum(weights**2)) * 0.1
    return max(float(np.sum(_correlation(weights, reach) * covariance)), floor)


def _correlation(field: Array, reach: Indices) -> Array:
    """Return the sums of products of points `lag` apart, lags from -reach to reach."""
    size = [int(n + r) for n, r in zip(field.shape, reach, strict=True)]
    full = np.fft.irfft2(np.abs(np.fft.rfft2(field, size)) ** 2, size)
    i, j = (np.arange(-r, r + 1) for r in reach)
    return np.asarray(full[np.ix_(i, j)])
