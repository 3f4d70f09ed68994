"""A scan of the top of a ball or a rounded tip: its radius."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from ...core.arrays import Array
from ...core.errors import InputError
from ..measured import Measured
from ..rules import RULES
from ..shared.regression import robust_std
from .file import Scan

# limit: points of a scan of a ball at least [-]
_BALL_FEWEST = 200

# limit: points of a scan of a ball that are fitted [-]: memory; more move no radius
_BALL_POINTS = 20_000


@dataclass(frozen=True)
class ScannedBall:
    """A sphere fitted to a scan; lengths in metres.

    Its radius, (2,) place of its top, the distance from there within which points were used, their
    robust standard deviation about it, and each with how far it lies above, (n,).
    """

    radius: Measured
    top: Array
    reach: float
    rest: float
    x: Array
    y: Array
    off: Array
    notes: tuple[str, ...]


def reduce_ball(scan: Scan, *, reach: float | None = None) -> ScannedBall:
    """Fit a sphere to the points within `reach` of the top; default: as far as the scan goes.

    The standard deviation is what leaving out eighths of the points around the top in turn gives: a
    tip that is not round says so. Refuses a scan without a rounded top, or with too few points of
    it.
    """
    i, j = np.nonzero(np.isfinite(scan.z))
    x, y, z = i * scan.step[0], j * scan.step[1], scan.z[i, j]
    top = _paraboloid_top(x, y, z, scan)
    extent = (np.array(scan.z.shape) - 1) * scan.step
    limit = reach or float(min(np.min(top), np.min(extent - top)))
    near = np.flatnonzero(np.hypot(x - top[0], y - top[1]) <= limit)
    if near.size < _BALL_FEWEST:
        raise InputError(
            f"{near.size} points within {limit:.3g} m of the top", source=scan.source,
            key="reach_m", allowed=f"{_BALL_FEWEST} or more points",
        )  # fmt: skip
    near = near[:: max(1, near.size // _BALL_POINTS)]
    x, y, z = x[near], y[near], z[near]
    fit, off = _sphere(x, y, z, top, limit)
    turn = (np.arctan2(y - top[1], x - top[0]) + np.pi) / (2 * np.pi)
    sector = (turn * RULES.sectors).astype(int)
    kept = (sector % RULES.sectors != left_out for left_out in range(RULES.sectors))
    parts = [1.0 / _sphere(x[k], y[k], z[k], top, limit)[0][3] for k in kept]
    scatter = np.sum((parts - np.mean(parts)) ** 2)
    std = float(np.sqrt((RULES.sectors - 1) / RULES.sectors * scatter))
    missing = 100.0 * float(np.mean(~np.isfinite(scan.z)))
    notes = (f"{missing:.2g} % not seen",) if missing else ()
    return ScannedBall(
        Measured(1.0 / float(fit[3]), std), fit[:2] * limit + top, limit, robust_std(off), x, y,
        off, notes,
    )  # fmt: skip


def _paraboloid_top(x: Array, y: Array, z: Array, scan: Scan) -> Array:
    thin = slice(None, None, max(1, x.size // _BALL_POINTS))
    size = float(np.hypot(np.ptp(x), np.ptp(y)))
    u, v = x[thin] / size, y[thin] / size
    design = np.stack([np.ones_like(u), u, v, u * u, u * v, v * v], axis=1)
    c = np.linalg.lstsq(design, z[thin], rcond=None)[0]
    hessian = np.array([[2 * c[3], c[4]], [c[4], 2 * c[5]]])
    bent = np.linalg.eigvalsh(hessian)
    if bent[1] >= 0.0:
        raise InputError(
            "the scan shows no rounded top", source=scan.source, allowed="a ball seen from above"
        )
    top = -np.linalg.solve(hessian, c[1:3]) * size
    inside = (top > 0.0) & (top < (np.array(scan.z.shape) - 1) * scan.step)
    if not inside.all():
        raise InputError(
            "the top of the ball is not in the scan", source=scan.source,
            allowed="a scan around the highest point",
        )  # fmt: skip
    return np.asarray(top)


def _sphere(x: Array, y: Array, z: Array, top: Array, limit: float) -> tuple[Array, Array]:
    """Return place of the top [limit], its height and the curvature [1/m], and what is left."""
    u, v = (x - top[0]) / limit, (y - top[1]) / limit
    first = -np.polyfit(u**2 + v**2, z, 1)[0] * 2.0 / limit**2
    scale = max(robust_std(z - np.polyval(np.polyfit(u**2 + v**2, z, 1), u**2 + v**2)), 1e-12)

    def off(p: Array) -> Array:
        r2 = ((u - p[0]) ** 2 + (v - p[1]) ** 2) * limit**2
        k = p[3] * first
        sag = k * r2 / (1.0 + np.sqrt(np.maximum(1.0 - k * k * r2, 1e-6)))
        return np.asarray((z - p[2] * scale - z.max() + sag) / scale)

    fit = least_squares(off, [0.0, 0.0, 0.0, 1.0], loss="soft_l1")
    return np.array([fit.x[0], fit.x[1], fit.x[2] * scale, fit.x[3] * first]), off(fit.x) * scale
