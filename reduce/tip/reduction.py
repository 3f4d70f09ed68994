"""Radius of a tip from a photograph: sub-pixel edge along rays, robust circle, uncertainty.

Along each ray from the middle of the circle the grey values are a blurred step between the local
levels of body and ground, so that uneven light does not move the edge. Blur moves the edge of a
disc inwards by σ²/(2R), which is put back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import binary_fill_holes, map_coordinates
from scipy.optimize import least_squares
from scipy.special import ndtr

from ...core.arrays import Array, Indices, Mask
from ...core.errors import InputError
from ..images.picture_file import Frame
from ..images.silhouette import body_mask
from ..measured import Measured
from ..rules import RULES
from ..shared.regression import correlation_factor, robust_regression, robust_std, unit_covariance

# limit: rounds of the edge and the circle at most [-]
_TIP_ROUNDS = 12

Side = tuple[float, float]
"""One side of a rod, column = a + b row."""


@dataclass(frozen=True)
class TipReduction:
    """The fitted circle, in pixels unless said otherwise.

    - `x`, `y`, `radius`: middle (column, row) and radius of the circle.
    - `edge`: (n, 2) columns and rows of the edge points.
    - `used`: (n,) points within the final fit.
    - `residual`: (n,) distance of the points outside the circle.
    - `blur`: standard deviation of the blur.
    - `arc`: angle that the used points span [rad].
    - `sides`: left and right side of a rod as column = a + b row, or None.
    - `width`: of the rod, nan for a ball.
    - `scale`: size of a pixel [m], nan where it is not known.
    """

    x: float
    y: float
    radius: Measured
    edge: Array
    used: Mask
    residual: Array
    blur: float
    arc: float
    sides: tuple[Side, Side] | None
    width: Measured
    scale: Measured
    notes: tuple[str, ...]

    @property
    def roundness(self) -> float:
        """Root mean square distance of the used edge from the circle [pixel]."""
        return float(np.sqrt(np.mean(self.residual[self.used] ** 2)))

    @property
    def tip_radius(self) -> Measured:
        """Radius [m], with the error of the scale; nan without a scale."""
        return self.radius.times(self.scale)


def reduce_tip(
    picture: Frame, *, shape: str = "rod", striker_is: str = "dark", scale: Measured | None = None,
    diameter: Measured | None = None, source: str = "",
) -> TipReduction:  # fmt: skip
    """Fit a circle to the tip of a body in grey values (rows, columns), the tip pointing down.

    A rod enters from above, a sphere is wholly in view. The size of a pixel [m] is `scale`, or
    follows from the rod's diameter [m]. No body, or too little of its edge, is refused.
    """
    grey = picture.astype(np.float64)
    if striker_is == "dark":
        grey = 255.0 - grey
    mask = _mask(grey, source)
    sides, width = None, Measured(math.nan, math.nan)
    if shape == "rod":
        sides, width, start, reach = _rod(grey, mask, source)
    else:
        start, reach = _ball(mask, source), math.inf
    x, y, radius, edge, used = fit_circle(grey, start, reach, source)
    points = np.stack([edge.x, edge.y], axis=1)
    off = np.hypot(points[:, 0] - x, points[:, 1] - y) - radius
    blur = float(np.median(edge.blur[used]))
    std = radius_std(points, used, (x, y, radius))
    arc = float(np.ptp(np.arctan2(points[used, 0] - x, points[used, 1] - y)))
    true = Measured(radius + 0.5 * blur**2 / radius, std)
    size = scale
    if size is None and diameter is not None and math.isfinite(width.value):
        size = diameter.over(width)
    found = TipReduction(
        x, y, true, points, used, off, blur, arc, sides, width,
        size or Measured(math.nan, math.nan), (),
    )  # fmt: skip
    return _with_notes(found)


def _mask(grey: Array, source: str) -> Mask:
    from skimage.filters import threshold_otsu

    if np.ptp(grey) < 10.0:
        raise InputError("the picture has no contrast", source=source, allowed="a tip in view")
    mask = np.asarray(binary_fill_holes(body_mask(grey, float(threshold_otsu(grey)))))
    if mask.sum() < 200:
        raise InputError(
            f"the largest body has {mask.sum()} pixels", source=source,
            allowed="200 or more (see --striker-is, --crop, --channel)",
        )  # fmt: skip
    return mask


def _ball(mask: Mask, source: str) -> tuple[float, float, float, float]:
    if mask[0].any() or mask[-1].any() or mask[:, [0, -1]].any():
        raise InputError(
            "the body touches the edge of the picture", source=source, allowed="a ball wholly in it"
        )
    rows, columns = np.nonzero(mask)
    return float(columns.mean()), float(rows.mean()), math.sqrt(mask.sum() / math.pi), 0.0


def _rod(
    grey: Array, mask: Mask, source: str
) -> tuple[tuple[Side, Side], Measured, tuple[float, float, float, float], float]:
    """Return sides, width, a first circle, and how far from the axis the cap is read."""
    rows = np.flatnonzero(mask.any(axis=1))
    if rows[0] > 1 or rows[-1] >= mask.shape[0] - 2 or rows.size < 30:
        raise InputError(
            "the body does not enter from above and end in the picture", source=source,
            allowed="a rod whose tip points down (see --tip-points)",
        )  # fmt: skip
    widths = mask[rows].sum(axis=1)
    full = float(np.median(widths[: max(rows.size // 4, 5)]))
    # where the body is as wide as at the top it has straight sides
    straight = rows[: max(int(np.argmax(widths < full - 2.0)), 0)]
    if straight.size < 12:
        raise InputError(
            f"only {straight.size} rows show the sides of the rod", source=source,
            allowed="12 or more above the tip",
        )  # fmt: skip
    left, right = (_side(grey, mask, straight, way) for way in (-1, 1))
    lean = math.atan(0.5 * (left[1] + right[1]))
    middle = float(straight.mean())
    span = (right[0] + right[1] * middle) - (left[0] + left[1] * middle)
    width = Measured(span * math.cos(lean), math.hypot(left[2], right[2]))
    bottom = float(rows[-1]) + 0.5
    half = 0.5 * width.value
    sides = ((left[0], left[1]), (right[0], right[1]))
    axis = 0.5 * (left[0] + right[0] + (left[1] + right[1]) * bottom)
    radius = _first_radius(mask, half, axis, bottom, lean)
    x, y = axis - radius * math.sin(lean), bottom - radius * math.cos(lean)
    return sides, width, (x, y, radius, lean), half


def _side(grey: Array, mask: Mask, rows: Indices, way: int) -> tuple[float, float, float]:
    """Fit one side of a rod as column = a + b row; a, b and the error in the middle."""
    first = np.argmax(mask[rows], axis=1).astype(np.float64) - 0.5
    if way > 0:
        first = mask.shape[1] - 0.5 - np.argmax(mask[rows, ::-1], axis=1)
    edge = find_edges(grey, first, rows.astype(np.float64), np.full(rows.size, float(way)),
                  np.zeros(rows.size))  # fmt: skip
    middle = float(rows.mean())
    row, column = rows[edge.good] - middle, edge.x[edge.good]
    if row.size < 8:
        return float(np.median(first)), 0.0, 0.5
    fit = robust_regression(np.stack([np.ones_like(row), row], axis=1), column, floor=1e-3)
    a, b = fit.coefficients
    return float(a - b * middle), float(b), float(np.sqrt(fit.covariance[0, 0]))


def _first_radius(mask: Mask, half: float, axis: float, bottom: float, lean: float) -> float:
    columns = np.arange(mask.shape[1])
    ends = mask.shape[0] - 0.5 - np.argmax(mask[::-1], axis=0)
    off = (columns - axis) * math.cos(lean) + (ends - bottom) * math.sin(lean)
    up = (columns - axis) * math.sin(lean) - (ends - bottom) * math.cos(lean)
    inside = mask.any(axis=0) & (np.abs(off) < RULES.cap * half)
    curve = np.polyfit(off[inside], up[inside], 2)[0] if inside.sum() > 5 else 0.0
    return float(np.clip(0.5 / max(curve, 1e-9), 0.9 * half, 50.0 * half))


def _with_notes(found: TipReduction) -> TipReduction:
    notes = [
        f"{int(found.used.sum())} of {found.used.size} edge points over "
        f"{math.degrees(found.arc):.0f} deg; off the circle by {found.roundness:.3f} pixel; "
        f"blur {found.blur:.2f} pixel"
    ]
    if not math.isfinite(found.scale.value):
        notes.append("no length scale: give the size of a pixel or the diameter of the rod")
    radius = found.radius
    apex = np.abs(found.edge[:, 0] - found.x) < 0.15 * found.radius.value * found.arc / 2.0
    apex &= found.used | (np.abs(found.residual) < 10.0)
    if apex.sum() >= 5:
        inside = -float(np.median(found.residual[apex]))
        spread = robust_std(found.residual[found.used & ~apex]) or 1e-3
        if inside > max(4.0 * spread / math.sqrt(apex.sum()), 0.1, 1.5 * spread):
            flat = math.sqrt(2.0 * found.radius.value * inside)
            notes.append(
                f"the apex lies {inside:.2f} pixel inside the circle: a flat of about "
                f"{flat:.1f} pixel radius?"
            )
            # the curvature of the apex alone, by its sag over the part that is looked at
            reach = 0.15 * radius.value * found.arc / 2.0
            bent = 2.0 * inside * radius.value / reach**2
            radius = radius.widened(radius.value * min(bent, 1.0))
    return replace(found, radius=radius, notes=tuple(notes))


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
