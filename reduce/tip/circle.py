"""A robust circle through edge points along rays, and how well its radius is known."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import least_squares

from ...core.arrays import Array, Mask
from ...core.errors import InputError
from ..rules import RULES
from ..shared.regression import correlation_factor, robust_std, unit_covariance
from .edge import Edge, find_edges


def fit_circle(
    grey: Array, start: tuple[float, float, float, float], reach: float, source: str
) -> tuple[float, float, float, Edge, Mask]:
    """Alternate between edge points on rays and the circle through them."""
    x, y, radius, lean = start
    for _ in range(3):
        half = math.asin(min(RULES.cap * reach / radius, 1.0)) if math.isfinite(reach) else math.pi
        count = max(int(2.0 * half * radius), 24)
        angle = np.linspace(-half, half, count, endpoint=math.isfinite(reach)) + lean
        dx, dy = np.sin(angle), np.cos(angle)
        edge = find_edges(grey, x + radius * dx, y + radius * dy, dx, dy)
        if edge.good.sum() < 20:
            raise InputError(
                f"the edge of the tip is found at only {edge.good.sum()} points", source=source,
                allowed="20 or more: a sharper or larger picture",
            )  # fmt: skip
        points = np.stack([edge.x, edge.y], axis=1)
        (x, y, radius), used = _fit(points, edge.good, (x, y, radius))
    return x, y, radius, edge, used


def _fit(
    points: Array, good: Mask, start: tuple[float, float, float]
) -> tuple[tuple[float, float, float], Mask]:
    """Robust circle through points: soft-L1 for the bulk, then least squares on what is near."""
    bulk = _least(points[good], start, loss="soft_l1")
    off = _off(points, bulk)
    limit = RULES.no_chance * max(robust_std(off[good]), 0.02)
    used = good & (np.abs(off) < limit)
    x, y, radius = _least(points[used], tuple(bulk), loss="linear")
    return (float(x), float(y), float(radius)), used


def _least(points: Array, start: tuple[float, ...] | Array, *, loss: str) -> Array:
    spread = max(robust_std(_off(points, np.asarray(start))), 0.05)
    return np.asarray(
        least_squares(
            lambda p: _off(points, p) / spread, np.asarray(start), loss=loss, x_scale="jac",
            xtol=1e-12, ftol=1e-12, gtol=1e-12,
        ).x
    )  # fmt: skip


def _off(points: Array, circle: Array) -> Array:
    return np.asarray(np.hypot(points[:, 0] - circle[0], points[:, 1] - circle[1]) - circle[2])


def radius_std(points: Array, used: Mask, circle: tuple[float, float, float]) -> float:
    """Return the larger of the error by the points' scatter and by leaving out sectors."""
    chosen = points[used]
    x, y, radius = circle
    reach = np.hypot(chosen[:, 0] - x, chosen[:, 1] - y)
    jacobian = np.stack(
        [-(chosen[:, 0] - x) / reach, -(chosen[:, 1] - y) / reach, -np.ones_like(reach)], axis=1
    )
    off = reach - radius
    variance = float(off @ off) / max(off.size - 3, 1) * correlation_factor(off)
    scatter = variance * float(unit_covariance(jacobian)[2, 2])
    parts = np.array_split(np.arange(len(chosen)), RULES.sectors)
    left = np.array([
        _least(np.delete(chosen, part, axis=0), circle, loss="linear")[2] for part in parts
    ])  # fmt: skip
    sectors = (RULES.sectors - 1) / RULES.sectors * float(np.sum((left - left.mean()) ** 2))
    return math.sqrt(max(scatter, sectors))
