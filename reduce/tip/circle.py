"""The edge of a tip to parts of a pixel, and the robust circle through it.

Along rays the grey values are a blurred step between the local levels of body and ground.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import map_coordinates
from scipy.optimize import least_squares
from scipy.special import ndtr

from ...core.arrays import Array, Mask
from ...core.errors import InputError
from ..rules import RULES
from ..shared.regression import correlation_factor, robust_std, unit_covariance

# limit: rounds of the edge and the circle at most [-]
_TIP_ROUNDS = 12


@dataclass(frozen=True)
class Edge:
    """Edge points in order along the body: column, row, blur [pixel] and whether they settled."""

    x: Array
    y: Array
    blur: Array
    good: Mask


def find_edges(grey: Array, x: Array, y: Array, dx: Array, dy: Array) -> Edge:
    """Find the edge near points (x, y) along outward directions (dx, dy), all (n,)."""
    reach = 9.0
    for _ in range(2):
        t = np.arange(-reach, reach + 0.5 * RULES.edge_step, RULES.edge_step)
        places = [y[:, None] + t * dy[:, None], x[:, None] + t * dx[:, None]]
        values = map_coordinates(grey, places, order=1, mode="nearest")
        p, settled = _steps(values, t)
        blur = float(np.median(p[settled, 3])) if settled.any() else 2.0
        reach = float(np.clip(5.0 * blur + 2.0, 5.0, 15.0))
    inside = (places[0] > 0.0) & (places[0] < grey.shape[0] - 1.0)
    inside &= (places[1] > 0.0) & (places[1] < grey.shape[1] - 1.0)
    good = settled & inside.all(axis=1)
    if good.any():
        contrast = float(np.median(p[good, 2]))
        good &= (p[:, 2] > 0.3 * contrast) & (p[:, 3] < 3.0 * blur)
    return Edge(x + p[:, 0] * dx, y + p[:, 0] * dy, p[:, 3], good)


def _steps(values: Array, t: Array) -> tuple[Array, Mask]:
    """Fit place, ground, contrast, blur of falling steps (n, s) by Gauss-Newton, all at once."""
    low, high = values[:, -4:].mean(axis=1), values[:, :4].mean(axis=1)
    bright = np.clip((values - low[:, None]) / np.maximum(high - low, 1.0)[:, None], 0.0, 1.0)
    p = np.stack(
        [t[0] + bright.sum(axis=1) * RULES.edge_step, low, high - low, np.full(len(low), 1.5)],
        axis=1,
    )
    for _ in range(_TIP_ROUNDS):
        z = (p[:, :1] - t) / p[:, 3:]
        step = ndtr(z)
        slope = p[:, 2:3] * np.exp(-0.5 * z**2) / (math.sqrt(2.0 * math.pi) * p[:, 3:])
        jacobian = np.stack([slope, np.ones_like(z), step, -slope * z], axis=2)
        residual = values - p[:, 1:2] - p[:, 2:3] * step
        normal = np.swapaxes(jacobian, 1, 2) @ jacobian + 1e-9 * np.eye(4)
        change = np.linalg.solve(normal, (np.swapaxes(jacobian, 1, 2) @ residual[:, :, None]))
        change = np.clip(change[:, :, 0], [-1.0, -50.0, -50.0, -0.5], [1.0, 50.0, 50.0, 0.5])
        p = p + change
        p[:, 3] = np.clip(p[:, 3], 0.3, 0.3 * (t[-1] - t[0]))
        p[:, 0] = np.clip(p[:, 0], t[0], t[-1])
    settled = np.abs(change[:, 0]) < 0.02
    return p, settled & (p[:, 2] > 5.0) & (np.abs(p[:, 0]) < 0.8 * t[-1])


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
