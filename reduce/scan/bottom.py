"""The deepest point of a crater: minimum of a smooth surface fitted to the floor.

The lowest single point of a noisy scan is biased deep. A bivariate quartic over a disc reads the
same floor without that bias; a smaller disc tells whether the quartic was up to its shape.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval2d
from scipy import ndimage

from ...core.arrays import Array, Indices, Mask
from ...core.errors import InputError
from ..measured import Measured
from ..rules import RULES
from ..shared.regression import robust_std
from .level import Levelled, filled
from .noise import autocovariance, variance

# limit: points of the smaller one at least [-]; three for each of fifteen coefficients
_BOTTOM_POINTS = 45

_POWERS = [(i, k - i) for k in range(5) for i in range(k + 1)]


@dataclass(frozen=True)
class Bottom:
    """The deepest point: depth [m], place (2,) [m], Laplacian of the floor [1/m]."""

    depth: Measured
    place: Array
    laplacian: float


@dataclass(frozen=True)
class _Floor:
    """A fitted disc: height and place of its minimum, Laplacian, weights of the points."""

    low: float
    place: Array
    laplacian: float
    weights: Array


def find_bottom(found: Levelled, half_width: float, *, source: str) -> Bottom:
    """Return the deepest point with the standard deviation that the surface's roughness gives.

    `half_width` is half the width of the crater [m]. Refuses a floor of too few points.
    """
    smooth = ndimage.gaussian_filter(filled(found.z), 0.2 * half_width / found.step)
    start = np.unravel_index(int(np.argmin(np.where(found.crater, smooth, np.inf))), smooth.shape)
    large, small = (
        _floor(found, np.array(start), part * half_width, source)
        for part in (RULES.bottom_large, RULES.bottom_small)
    )
    reach = np.minimum(
        np.ceil(2.0 * RULES.bottom_large * half_width / found.step), np.array(found.z.shape) // 2
    ).astype(int)
    covariance = autocovariance(found.z, found.clear, reach)
    noise = variance(large.weights + _level_weights(found, large.place), covariance)
    # the two discs differ by noise; what they differ beyond it is the error of the quartic
    apart = (large.low - small.low) ** 2
    model = max(apart - variance(large.weights - small.weights, covariance), 0.0)
    return Bottom(Measured(-large.low, math.sqrt(noise + model)), large.place, large.laplacian)


def _floor(found: Levelled, start: Array, radius: float, source: str) -> _Floor:
    offsets, u = _disc(found.step, radius)
    for _ in range(8):
        index = start + offsets
        ok = np.all((index >= 0) & (index < found.z.shape), axis=1)
        ok[ok] = np.isfinite(found.z[tuple(index[ok].T)])
        if ok.sum() < _BOTTOM_POINTS:
            raise InputError(
                f"{int(ok.sum())} points on the floor of the crater", source=source,
                allowed=f"{_BOTTOM_POINTS} or more: a finer scan",
            )  # fmt: skip
        z = found.z[tuple(index[ok].T)]
        c, used = _clipped_fit(_design(u[ok]), z)
        at = _lowest(c, u)
        fitted = _as_floor(found, c, at, start, radius, index[ok][used], u[ok][used])
        shift = np.rint(at * radius / found.step).astype(int)
        if not np.any(shift):
            break
        start = start + shift
    return fitted


def _as_floor(
    found: Levelled, c: Array, at: Array, start: Array, radius: float, index: Array, u: Array
) -> _Floor:
    weights = np.zeros_like(found.z)
    weights[tuple(index.T)] = _design(at[None, :])[0] @ np.linalg.pinv(_design(u))
    step = 1e-3
    around = _design(at + step * np.array([[1, 0], [-1, 0], [0, 1], [0, -1], [0, 0]])) @ c
    laplacian = float(around[:4].sum() - 4.0 * around[4]) / (step * radius) ** 2
    return _Floor(float(around[4]), start * found.step + at * radius, laplacian, weights)


def _disc(step: Array, radius: float) -> tuple[Indices, Array]:
    """Offsets (m, 2) of the points within `radius`, whole and in units of the radius."""
    reach = (radius / step).astype(int)
    i, j = np.mgrid[-reach[0] : reach[0] + 1, -reach[1] : reach[1] + 1]
    offsets = np.stack([i.ravel(), j.ravel()], axis=1)
    u = offsets * step / radius
    inside = np.sum(u**2, axis=1) <= 1.0
    return offsets[inside], u[inside]


def _design(u: Array) -> Array:
    return np.stack([u[:, 0] ** i * u[:, 1] ** j for i, j in _POWERS], axis=1)


def _clipped_fit(design: Array, z: Array) -> tuple[Array, Mask]:
    used = np.ones(z.size, dtype=np.bool_)
    for _ in range(3):
        c = np.linalg.lstsq(design[used], z[used], rcond=None)[0]
        off = np.abs(z - design @ c)
        new = off <= RULES.no_chance * max(robust_std(off * np.sign(z - design @ c)), 1e-15)
        if new.sum() < _BOTTOM_POINTS or np.array_equal(new, used):
            break
        used = new
    return np.asarray(np.linalg.lstsq(design[used], z[used], rcond=None)[0]), used


def _lowest(c: Array, u: Array) -> Array:
    """Place of the minimum in the inner part of the disc: best grid point, then Newton."""
    inner = u[np.sum(u**2, axis=1) <= 0.4]
    at = np.asarray(inner[int(np.argmin(_design(inner) @ c))])
    for _ in range(4):
        slope, hessian = _derivatives(c, at)
        if np.linalg.eigvalsh(hessian)[0] <= 0.0:
            break
        move = np.linalg.solve(hessian, slope)
        if np.linalg.norm(move) > 0.2:
            break
        at = at - move
    return at


def _derivatives(c: Array, at: Array) -> tuple[Array, Array]:
    """Return slope (2,) and second derivatives (2, 2) of the quartic at a place."""
    table = np.zeros((5, 5))
    table[tuple(np.transpose(_POWERS))] = c

    def at_place(x: int, y: int) -> float:
        return float(polyval2d(at[0], at[1], polyder(polyder(table, x, axis=0), y, axis=1)))

    mixed = at_place(1, 1)
    slope = np.array([at_place(1, 0), at_place(0, 1)])
    return slope, np.array([[at_place(2, 0), mixed], [mixed, at_place(0, 2)]])


def _level_weights(found: Levelled, place: Array) -> Array:
    """Weights with which the clear points enter the height at a place through the level."""
    shape = np.array(found.z.shape)
    index = np.clip(np.rint(place / found.step).astype(int), 0, shape - 1)
    terms = found.terms[found.clear]
    weights = np.zeros_like(found.z)
    solved = np.linalg.solve(terms.T @ terms, found.terms[tuple(index)])
    weights[found.clear] = -(terms @ solved)
    return weights
