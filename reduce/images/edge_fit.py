"""Fits of a body's blurred edge to grey values: the sub-pixel position of a rod's tip or a ball.

The picture of a bright body is I = dark + bright Φ(d/σ), with d the distance into the body and σ
the blur. Blurring a disc of radius R moves its half-level edge inwards by σ²/(2R) (the curvature
flow of the heat equation), which the models take along; light that changes along the body is a
parameter, because it would pull the edge as well.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from ...core.arrays import Array, Mask
from ..rules import RULES
from ..shared.regression import robust_std

# limit: rounds of the fit of an edge at most [-]
_EDGE_ROUNDS = 10

_POSE = (0, 1, 2, 3, 4, 5, 6)
_FREE = {"pose": _POSE, "shape": (*_POSE, 7, 8), "mirror": (*_POSE, 9, 10)}
"""Places of the parameters of a rod's picture that a fit moves."""

Picture = Callable[[Array], tuple[Array, Array, Mask]]
"""Parameters to model grey values, their derivatives (p, ...) and the pixels that count."""


@dataclass(frozen=True)
class RodShape:
    """What all frames share, in pixels: half the width, curvature of the tip, blur, the flat.

    The flat, at row `flat`, reflects the rod with the part `mirror` of its light.
    """

    half_width: float
    curvature: float
    blur: float
    mirror: float = 0.0
    flat: float = 0.0

    @property
    def tip_radius(self) -> float:
        """Radius of the tip [pixel]."""
        return 1.0 / self.curvature

    @property
    def cap_height(self) -> float:
        """Distance from the tip to where the sides begin [pixel]."""
        reach = min(self.half_width * self.curvature, 1.0)
        return (1.0 - float(np.sqrt(1.0 - reach**2))) / self.curvature


@dataclass(frozen=True)
class RodPose:
    """Tip of the rod on its axis (column, row), lean to the right [rad], and its shape."""

    x: float
    y: float
    lean: float
    shape: RodShape


@dataclass(frozen=True)
class BallEdge:
    """Centre of a ball (column, row), its radius [pixel], and its grey value."""

    x: float
    y: float
    radius: float
    bright: float


def fit_rod(
    frame: Array, shape: RodShape, pose: tuple[float, float, float], *, levels: tuple[float, float],
    free: str = "pose",
) -> RodPose | None:  # fmt: skip
    """Fit pose, or pose and shape, to the grey values around the tip.

    - `frame`: (rows, columns), grey values, the rod bright.
    - `shape`, `pose`: start; `pose` is column and row of the tip on the axis, and lean.
    - `levels`: grey values of background and rod.
    - `free`: `"pose"`; `"shape"` for half-width and curvature, `"mirror"` for the reflection as
      well.

    Returned: None where the tip is not wholly in the frame or the fit does not settle.
    """
    window = _rod_window(frame.shape, shape, pose)
    if window is None:
        return None
    rows, columns = np.mgrid[window].astype(np.float64)
    contrast = levels[1] - levels[0]
    half, inf = shape.half_width, np.inf
    start = np.array([
        *pose, levels[0], contrast, shape.blur, 0.0, half, shape.curvature, shape.mirror, shape.flat
    ])  # fmt: skip
    limits = np.array(
        [2.0, 2.0, 0.05, inf, inf, 0.5, inf, 0.1 * half, 0.3 * shape.curvature, 0.2, 1.0]
    )
    low = np.array([*[-inf] * 5, 0.25, -inf, 1.0, 1e-5 / half, 0.0, -inf])
    high = np.array([*[inf] * 7, 2.0 * half, 1.0 / half, 1.0, inf])
    p = _settle(
        lambda p: _mirrored_rod(rows, columns, p), frame[window], start,
        free=_FREE[free], limits=limits, low=low, high=high,
    )  # fmt: skip
    if p is None or not (0.3 * contrast < p[4] < 2.0 * contrast and p[5] < 0.5 * p[7] > 1.0):
        return None
    found = RodShape(*(float(p[k]) for k in (7, 8, 5, 9, 10)))
    return RodPose(float(p[0]), float(p[1]), float(p[2]), found)


def fit_ball(
    frame: Array, start: tuple[float, float, float], *, levels: tuple[float, float]
) -> BallEdge | None:
    """Fit centre and radius of a bright disc whose light may fall off linearly.

    In grey values (rows, columns), from column, row and radius [pixel]; `levels` are the grey
    values of background and ball.
    """
    x, y, radius = start
    reach = int(radius + 8.0)
    top, left = max(int(y) - reach, 0), max(int(x) - reach, 0)
    window = (
        slice(top, min(int(y) + reach + 2, frame.shape[0])),
        slice(left, min(int(x) + reach + 2, frame.shape[1])),
    )
    rows, columns = np.mgrid[window].astype(np.float64)
    contrast = levels[1] - levels[0]
    p0 = np.array([x, y, radius, levels[0], contrast, 1.0, 0.0, 0.0])
    limits = np.array([2.0, 2.0, 1.0, np.inf, np.inf, 0.5, np.inf, np.inf])
    low = np.array([-np.inf, -np.inf, 1.5, -np.inf, -np.inf, 0.25, -np.inf, -np.inf])
    p = _settle(
        lambda p: _ball_picture(rows, columns, p), frame[window], p0,
        free=tuple(range(8)), limits=limits, low=low, high=np.full(8, np.inf),
    )  # fmt: skip
    if p is None or not (0.3 * contrast < p[4] < 2.0 * contrast and p[5] < 0.3 * p[2]):
        return None
    return BallEdge(float(p[0]), float(p[1]), float(p[2]), levels[1])


def _settle(
    picture: Picture, values: Array, start: Array, *, free: tuple[int, ...], limits: Array,
    low: Array, high: Array,
) -> Array | None:  # fmt: skip
    """Weighted Gauss-Newton with Huber weights; the parameters (p,), or None."""
    p, moved = start.copy(), list(free)
    for _ in range(_EDGE_ROUNDS):
        model, jacobian, zone = picture(p)
        residual = (values - model)[zone]
        if residual.size <= len(moved) + 4:
            return None
        # quantisation alone leaves 0.3 grey levels
        spread = max(robust_std(residual), 0.3)
        weight = np.minimum(1.0, RULES.doubtful * spread / np.maximum(np.abs(residual), 1e-12))
        active = jacobian[moved][:, zone]
        try:
            move = np.linalg.inv((active * weight) @ active.T) @ (active @ (weight * residual))
        except np.linalg.LinAlgError:
            return None
        if not np.all(np.isfinite(move)):
            return None
        p[moved] += np.clip(move, -limits[moved], limits[moved])
        p = np.clip(p, low, high)
        if np.abs(move[:2]).max() < RULES.edge_settled:
            break
    return None if np.abs(move[:2]).max() > RULES.edge_last else p


def _mirrored_rod(rows: Array, columns: Array, p: Array) -> tuple[Array, Array, Mask]:
    """A rod above a flat that reflects it; `p` ends in the share of light and the flat's row."""
    model, jacobian, zone = _rod_picture(rows, columns, p[:9])
    share, flat = p[9:]
    again, slopes, _ = _rod_picture(2.0 * flat - rows, columns, p[:9])
    again, slopes[3] = again - p[3], 0.0
    mirror = np.stack([again, -2.0 * share * slopes[1]])
    return model + share * again, np.concatenate([jacobian + share * slopes, mirror]), zone


def _rod_picture(rows: Array, columns: Array, p: Array) -> tuple[Array, Array, Mask]:
    x, y, lean, dark, contrast, blur, fall, half, curvature = p
    sin, cos = np.sin(lean), np.cos(lean)
    radius = 1.0 / curvature
    across = (columns - x) * cos + (rows - y) * sin
    up = (columns - x) * sin - (rows - y) * cos
    below = np.minimum(up - radius, 0.0)
    reach = np.hypot(across, below)
    cap = radius - 0.5 * blur**2 * curvature - reach
    side = half - np.abs(across)
    on_cap = (cap < side) & (up < radius)
    safe = np.maximum(reach, 1e-9)
    d_across = np.where(on_cap, -across / safe, -np.sign(across))
    d_up = np.where(on_cap, -below / safe, 0.0)
    z = np.where(on_cap, cap, side) / blur
    step = ndtr(z)
    light = contrast + fall * up
    edge = light * np.exp(-0.5 * z**2) / (np.sqrt(2.0 * np.pi) * blur)
    # moving the rod is moving each pixel the other way in the rod's own axes
    jacobian = np.stack([
        edge * (-cos * d_across - sin * d_up),
        edge * (-sin * d_across + cos * d_up),
        edge * (-up * d_across + across * d_up),
        np.ones_like(z),
        step,
        -edge * z,
        up * step,
        edge * ~on_cap,
        edge * on_cap * -(radius**2) * (1.0 + below / safe),
    ])  # fmt: skip
    cap_height = radius - np.sqrt(max(radius**2 - half**2, 0.0))
    zone = (np.abs(across) < half + 4.0 * blur + 2.0) & (up > -(4.0 * blur + 2.0))
    zone &= (np.abs(across) < RULES.cap * half) | (up > cap_height + 4.0 * blur + 1.0)
    return dark + light * step, jacobian, zone


def _ball_picture(rows: Array, columns: Array, p: Array) -> tuple[Array, Array, Mask]:
    x, y, radius, dark, contrast, blur, fall_x, fall_y = p
    dx, dy = columns - x, rows - y
    reach = np.maximum(np.hypot(dx, dy), 1e-9)
    z = (radius - 0.5 * blur**2 / radius - reach) / blur
    step = ndtr(z)
    light = contrast + fall_x * dx + fall_y * dy
    edge = light * np.exp(-0.5 * z**2) / (np.sqrt(2.0 * np.pi) * blur)
    jacobian = np.stack([
        edge * dx / reach, edge * dy / reach, edge, np.ones_like(z), step, -edge * z,
        dx * step, dy * step,
    ])  # fmt: skip
    return dark + light * step, jacobian, reach < radius + 4.0 * blur + 2.0


def _rod_window(
    size: tuple[int, ...], shape: RodShape, pose: tuple[float, float, float]
) -> tuple[slice, slice] | None:
    x, y, lean = pose
    side = shape.half_width + 5.0 * shape.blur + 3.0
    height = shape.cap_height + 2.5 * shape.half_width
    lean_shift = abs(height * np.sin(lean))
    top, bottom = max(int(y - height), 0), int(y + 5.0 * shape.blur + 4.0) + 1
    left, right = max(int(x - side - lean_shift), 0), int(x + side + lean_shift) + 1
    enough = y - top > shape.cap_height + 4.0 * shape.blur + 4.0
    if not enough or bottom > size[0] or x < 0 or x > size[1]:
        return None
    return slice(top, bottom), slice(left, min(right, size[1]))
