"""Robust linear regression with an honest covariance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array, Mask
from ..rules import RULES

# limit: rounds of a fit at most [-]; it ends by itself
FIT_ROUNDS = 20

# limit: singular value of a design, of the largest, below which it holds round-off alone [-]:
# root of the last digit of a double, twice
_UNSEEN = 3e-8

MAD_TO_STD = 1.4826


@dataclass(frozen=True)
class Regression:
    """Coefficients (p,), covariance (p, p), residual std, and which of the n points were used."""

    coefficients: Array
    covariance: Array
    sigma: float
    used: Mask

    def prediction_std(self, design: Array) -> Array:
        """Return that of the values fitted to a design (m, p), without the noise of a point."""
        return np.asarray(np.sqrt(np.einsum("ij,jk,ik->i", design, self.covariance, design)))


def robust_regression(design: Array, observed: Array, *, floor: float = 0.0) -> Regression:
    """Fit `observed = design @ coefficients` with outliers left out.

    A soft-L1 fit finds the bulk, points beyond four robust standard deviations are left out, and
    ordinary least squares on the rest gives coefficients and covariance. Neighbouring residuals
    that hang together (lag-one correlation r of the points in their order) carry less information:
    the covariance is multiplied by (1 + r)/(1 - r) for r > 0.

    `design`, `observed`: (n, p) and (n,), n > p, in the order of time; `floor`: smallest residual
    standard deviation that is believed, in the unit of `observed`.
    """
    n, p = design.shape
    scale = np.linalg.norm(design, axis=0)
    scale[scale == 0.0] = 1.0
    scaled = design / scale
    start = np.linalg.lstsq(scaled, observed, rcond=None)[0]
    spread = max(robust_std(observed - scaled @ start), floor, _tiny(observed))
    bulk = _soft_l1(scaled, observed, start, spread)
    residual = observed - scaled @ bulk
    limit = RULES.no_chance * max(robust_std(residual, lost=p), floor, _tiny(observed))
    used = np.abs(residual) <= limit
    if used.sum() <= p:
        used = np.ones(n, dtype=np.bool_)
    coefficients = np.linalg.lstsq(scaled[used], observed[used], rcond=None)[0]
    residual = observed[used] - scaled[used] @ coefficients
    freedom = max(int(used.sum()) - p, 1)
    sigma = max(float(np.sqrt(residual @ residual / freedom)), floor)
    covariance = sigma**2 * unit_covariance(scaled[used]) * correlation_factor(residual)
    return Regression(coefficients / scale, covariance / np.outer(scale, scale), sigma, used)


def unit_covariance(design: Array) -> Array:
    """Return (AᵀA)⁺ for a design A (n, p): the covariance of coefficients if points have std 1.

    From the singular values of A itself, for no variance is negative then. Directions in which the
    points are a thirty-millionth as telling as in the best one count as not seen, with zeros.
    """
    _, size, ways = np.linalg.svd(design, full_matrices=False)
    seen = size > _UNSEEN * size[0]
    ways = ways[seen] / size[seen, None]
    return np.asarray(ways.T @ ways)


def _soft_l1(design: Array, observed: Array, start: Array, spread: float) -> Array:
    """Minimise the sum of sqrt(1 + z²) over residuals z in units of `spread`, by reweighting."""
    c: Array = start
    for _ in range(FIT_ROUNDS):
        weight = (1.0 + ((observed - design @ c) / spread) ** 2) ** -0.25
        there = np.linalg.lstsq(design * weight[:, None], observed * weight, rcond=None)[0]
        moved = float(np.abs(design @ (there - c)).max())
        c = np.asarray(there, dtype=np.float64)
        if moved < 1e-3 * spread:
            break
    return np.asarray(c)


def robust_std(values: Array, *, lost: int = 0) -> float:
    """Return the standard deviation of the bulk from the median absolute deviation.

    `lost` is the number of degrees of freedom that a fit has taken.
    """
    n = values.size
    if n == 0:
        return 0.0
    deviation = float(np.median(np.abs(values - np.median(values))))
    return MAD_TO_STD * deviation * float(np.sqrt(n / max(n - lost, 1)))


def _tiny(observed: Array) -> float:
    return float(1e-12 * (np.ptp(observed) + np.abs(observed).max()) + 1e-300)


def correlation_factor(residual: Array) -> float:
    """Return by how much neighbours that hang together widen the variance of a mean."""
    total = float(residual @ residual)
    if residual.size < 8 or total == 0.0:
        return 1.0
    # white residuals of a fit have a lag-one correlation of about -1/n
    lag_one = float(residual[1:] @ residual[:-1]) / total + 1.0 / residual.size
    lag_one = min(max(lag_one, 0.0), 0.95)
    return (1.0 + lag_one) / (1.0 - lag_one)


def long_run_factor(residual: Array, *, lost: float = 0.0) -> float:
    """Return by how much residuals that hang together, or swing, widen the variance of a mean.

    The long-run variance over the plain one, with Bartlett's weights over lags up to the root of
    the number of samples (W. Newey, K. West, Econometrica 55 (1987)); never below 1. `lost` is the
    number of degrees of freedom that the fit has taken from these residuals.
    """
    n = residual.size
    total = float(residual @ residual)
    if n < 8 or total == 0.0:
        return 1.0
    lags = max(2, round(n**0.5))
    factor = 1.0
    for k in range(1, lags + 1):
        lagged = float(residual[k:] @ residual[:-k]) / total + (1.0 + lost) / n
        factor += 2.0 * (1.0 - k / (lags + 1.0)) * lagged
    return max(factor, 1.0)
