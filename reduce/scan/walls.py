"""Sections through a crater: where its walls reach the surface, and the height of its rim."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...core.arrays import Array
from ..measured import Measured
from ..rules import RULES
from .level import Levelled, filled

_BAND = np.linspace(-0.08, 0.08, 7)
"""Lines that are averaged into a section, from its middle, in halves of the crater's width."""


@dataclass(frozen=True)
class Section:
    """Heights along a line through the deepest point: `s` from it, `z` above the level [m]."""

    s: Array
    z: Array


def section(found: Levelled, place: Array, direction: float, half_width: float) -> Section:
    """Return the heights along a line through `place`, averaged over a narrow band."""
    axis = np.array([math.cos(direction), math.sin(direction)])
    normal = np.array([-axis[1], axis[0]])
    size = float(np.hypot(*(np.array(found.z.shape) * found.step)))
    s = np.arange(-size, size, float(found.step.min()))
    points = place + s[:, None, None] * axis + (_BAND * half_width)[None, :, None] * normal
    at = (points / found.step).transpose(2, 0, 1)
    z = ndimage.map_coordinates(filled(found.z), at, order=1, mode="constant", cval=np.nan)
    mean = z.mean(axis=1)
    inside = np.isfinite(mean)
    return Section(s[inside], mean[inside])


def section_covariance(found: Levelled, half_width: float) -> Array:
    """Return the autocovariance of a section's heights on undisturbed surface by lag [m²]."""
    lags = max(int(0.6 * half_width / float(found.step.min())), 4)
    band = np.maximum((0.16 * half_width / found.step).astype(int), 1)
    sums, counts = np.zeros(lags), np.zeros(lags)
    for axis in (0, 1):
        mean = ndimage.uniform_filter1d(filled(found.z), int(band[1 - axis]), axis=1 - axis)
        field = np.moveaxis(np.where(found.clear, mean, 0.0), axis, 0)
        seen = np.moveaxis(found.clear, axis, 0)
        for lag in range(min(lags, field.shape[0] - 1)):
            both = seen[lag:] & seen[: seen.shape[0] - lag]
            products = field[lag:] * field[: field.shape[0] - lag]
            sums[lag] += float(np.sum(products[both]))
            counts[lag] += float(both.sum())
    return np.asarray(sums / np.maximum(counts, 1.0))


def opening(line: Section, depth: float, covariance: Array) -> Measured:
    """Return the distance between the two walls where they reach the surface; nan if one is cut."""
    left, right = (_wall_end(side * line.s, line.z, depth, covariance) for side in (-1.0, 1.0))
    if left is None or right is None:
        return Measured(math.nan, math.nan)
    return Measured(left.value + right.value, math.hypot(left.std, right.std))


def without_band(length: Measured, width: Measured, half_width: float) -> tuple[Measured, Measured]:
    """Return both without what averaging over a band takes off where a wall is curved.

    The outline of radius `half_width` lies t²/(2 half_width) further in at t beside the middle: at
    the ends of a scar always, at its sides as far as they are not straight over the band.
    """
    short = half_width * float(np.mean(_BAND**2))
    straight = (length.value - width.value) / (2.0 * _BAND[-1] * half_width)
    bent = min(max(1.0 - straight, 0.0), 1.0)
    wider = Measured(width.value + bent * short, width.std)
    return Measured(length.value + short, length.std), wider


def _wall_end(outward: Array, z: Array, depth: float, covariance: Array) -> Measured | None:
    """Return where the wall on one side, a parabola near its upper end, reaches height 0."""
    order = np.argsort(outward)
    order = order[outward[order] >= 0.0]
    out, height = outward[order], z[order]
    if not out.size:
        return None
    smooth = ndimage.uniform_filter1d(height, max(out.size // 60, 1))
    first, last = RULES.wall
    over = np.flatnonzero(smooth > -first * depth)
    deep = np.flatnonzero(smooth[: over[0]] < -last * depth) if over.size else over
    if not over.size or not deep.size or over[0] - deep[-1] < 5:
        return None
    wall = slice(int(deep[-1]) + 1, int(over[0]))
    middle, scale = float(out[wall].mean()), float(np.ptp(out[wall]))
    u = (out[wall] - middle) / scale
    solver = np.linalg.pinv(np.stack([np.ones_like(u), u, u * u], axis=1))
    c = solver @ height[wall]
    roots = np.roots(c[::-1])
    roots = roots[np.isreal(roots)].real
    roots = roots[(roots > 0.3) & (roots < 2.0)]
    if roots.size == 0:
        return None
    end = float(roots.min())
    slope = float(c[1] + 2.0 * c[2] * end)
    lag = np.abs(np.subtract.outer(np.arange(u.size), np.arange(u.size)))
    noise = np.where(lag < covariance.size, covariance[lag.clip(0, covariance.size - 1)], 0.0)
    weights = np.array([1.0, end, end * end]) @ solver
    std = math.sqrt(max(float(weights @ noise @ weights), 0.0)) / abs(slope) * scale
    step = scale / (u.size - 1)
    return Measured(middle + end * scale, math.hypot(std, RULES.wall_end * step))


def without_blur(height: Measured, curvature: float, blur: Measured) -> Measured:
    """Return a depth, or a height, without what a lateral blur took off where it bends so."""
    lift = 0.5 * curvature * blur.value**2
    return Measured(height.value + lift, math.hypot(height.std, curvature * blur.value * blur.std))


def pile_up(found: Levelled, half_width: float, blur: Measured) -> Measured:
    """Return the largest mean height along lines of equal distance from the crater's edge.

    Between rings it is the parabola's whose means over three of them are theirs, and its bend says
    what the blur took off.
    """
    away = ndimage.distance_transform_edt(~found.crater, sampling=found.step)
    width = max(0.04 * half_width, float(found.step.max()))
    near = (away > 0.0) & (away <= 1.2 * half_width) & np.isfinite(found.z)
    ring, z = np.ceil(away[near] / width).astype(int), found.z[near]
    counts = np.bincount(ring)
    means = np.bincount(ring, z) / np.maximum(counts, 1)
    means[counts < 2 * RULES.sectors] = -np.inf
    k = int(np.argmax(means))
    if not means[k] > 0.0:
        return Measured(0.0, 0.0)
    top, bend, beside = means[k], 0.0, means[[max(k - 1, 0), min(k + 1, len(means) - 1)]]
    if np.all((beside < top) & np.isfinite(beside)):
        bend = 2.0 * top - beside.sum()
        top += np.diff(beside)[0] ** 2 / (8.0 * bend) + bend / 24.0
    middle = np.argwhere(found.crater).mean(0)[:, None]
    turn = np.arctan2(*(np.argwhere(near)[ring == k].T - middle)) / (2.0 * np.pi) + 0.5
    sector = (turn * RULES.sectors).astype(int).clip(0, RULES.sectors - 1)
    counts = np.bincount(sector)
    around = np.bincount(sector, z[ring == k])[counts > 0] / counts[counts > 0]
    # the edge is known to whole points, which blurs the rim by step²/12, more or less
    pixels = float(bend * np.prod(found.step)) / (24.0 * width**2)
    noise = float(np.std(around, ddof=1)) / math.sqrt(len(around))
    read = Measured(float(top) + pixels, math.hypot(noise, pixels))
    return without_blur(read, float(bend) / width**2, blur)
