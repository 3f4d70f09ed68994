"""The undisturbed surface of a scan: spikes out, crater found, the rest levelled.

The undisturbed surface is a plane (or paraboloid) fitted robustly without the crater and its rim;
crater and fit are found in turns.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...core.arrays import Array, Mask
from ...core.errors import InputError
from ..rules import RULES
from ..shared.regression import MAD_TO_STD, robust_regression, robust_std
from .file import Scan

# limit: depth and area of another crater at least, in those of the deepest [-]; less is roughness
_LIKE = 0.2

LEVELS = {"plane": 1, "paraboloid": 2}
"""Shape of the undisturbed surface, and its polynomial degree."""


@dataclass(frozen=True)
class Levelled:
    """A scan above its undisturbed surface.

    - `z`: (nx, ny) heights above it, NaN where nothing was seen [m].
    - `crater`, `clear`: (nx, ny) the crater; the surface that it was levelled on.
    - `step`, `terms`: (2,) distance of the points [m]; (nx, ny, p) polynomial terms of the level.
    - `outliers`, `others`: number of spikes taken out; of craters beside this one.
    """

    z: Array
    crater: Mask
    clear: Mask
    step: Array
    terms: Array
    outliers: int
    others: int = 0

    @property
    def leaves(self) -> bool:
        """Whether the crater goes on beyond an edge of the scan."""
        return bool(self.crater[1:-1, 1:-1].sum() < self.crater.sum())

    @property
    def roughness(self) -> float:
        """Robust standard deviation of the undisturbed surface about its level [m]."""
        return robust_std(self.z[self.clear])


def levelled(scan: Scan, *, level: str = "plane") -> Levelled:
    """Return the scan above its undisturbed surface.

    Refuses what has no crater that stands out of the roughness, or no surface left around it.
    """
    z, outliers = _without_spikes(scan.z)
    terms = _terms(z.shape, LEVELS[level])
    seen = np.isfinite(z)
    clear, crater = seen, np.zeros_like(seen)
    blur = max(1.0, 0.004 * max(z.shape))
    whole = filled(z)
    for _ in range(8):
        smooth = ndimage.gaussian_filter(whole - _surface(terms, z, clear, 20_000), blur)
        found, *others = _craters_of(smooth, clear, scan)
        same = np.array_equal(found, crater)
        crater = found
        clear = seen & _outside((crater, *others), scan)
        if same:
            break
    return Levelled(
        z - _surface(terms, z, clear, 200_000), crater, clear, scan.step, terms, outliers,
        len(others),
    )  # fmt: skip


def filled(z: Array) -> Array:
    """Return the heights with every gap closed by its nearest neighbour."""
    hole = ~np.isfinite(z)
    if not hole.any():
        return z
    place = ndimage.distance_transform_edt(hole, return_distances=False, return_indices=True)
    return np.asarray(z[tuple(place)])


def _without_spikes(z: Array) -> tuple[Array, int]:
    """Heights without points far from those around, by the roughness and by how these differ."""
    whole = filled(z)
    off = z - ndimage.median_filter(whole, size=5, mode="nearest")
    spike = np.abs(off) > RULES.foreign * max(robust_std(off[np.isfinite(off)]), 1e-15)
    # the points of a narrow rim are as far off as a spike, but those around them differ as much
    windows = np.lib.stride_tricks.sliding_window_view(np.pad(whole, 2, mode="edge"), (5, 5))
    around = windows[spike].reshape(-1, 25)
    away = np.abs(around - np.median(around, axis=1, keepdims=True))
    spike[spike] = np.abs(off[spike]) > RULES.foreign * MAD_TO_STD * np.median(away, axis=1)
    return np.where(spike, np.nan, z), int(spike.sum())


def _terms(shape: tuple[int, ...], degree: int) -> Array:
    x, y = np.meshgrid(*(np.linspace(-1.0, 1.0, n) for n in shape), indexing="ij")
    terms = [np.ones_like(x), x, y]
    if degree == 2:
        terms += [x * x, x * y, y * y]
    return np.stack(terms, axis=-1)


def _surface(terms: Array, z: Array, clear: Mask, most: int) -> Array:
    """Return the robust polynomial through at most `most` of the clear points, (nx, ny)."""
    chosen = np.flatnonzero(clear.ravel())
    thin = chosen[:: max(1, chosen.size // most)]
    fit = robust_regression(terms.reshape(-1, terms.shape[-1])[thin], z.ravel()[thin])
    return np.asarray(terms @ fit.coefficients)


def _craters_of(smooth: Array, clear: Mask, scan: Scan) -> list[Mask]:
    """Return connected regions below the surface: that of the deepest place, others like it."""
    noise = robust_std(smooth[clear])
    lowest = np.unravel_index(int(np.argmin(smooth)), smooth.shape)
    depth = -float(smooth[lowest])
    least = 5.0 * max(noise, 1e-15)
    if not depth > least:
        raise InputError(
            f"no crater: the lowest place lies {depth:.3g} m under the surface, whose roughness "
            f"is {noise:.3g} m", source=scan.source,
            allowed="a crater deeper than five times that; --level paraboloid on a curved surface",
        )  # fmt: skip
    regions, count = ndimage.label(smooth < -max(0.03 * depth, min(2.0 * noise, 0.2 * depth)))
    every = np.arange(count + 1)
    area = np.bincount(regions.ravel(), minlength=count + 1)
    deep = ndimage.minimum(smooth, regions, every) < -max(_LIKE * depth, least)
    deep &= area > _LIKE * area[regions[lowest]]
    others = [n for n in every[1:] if deep[n] and n != regions[lowest]]
    return [regions == n for n in (regions[lowest], *others)]


def _outside(craters: Sequence[Mask], scan: Scan) -> Mask:
    """Points seen that lie clear of the craters, by the radius of the widest."""
    radius = math.sqrt(max(float(crater.sum()) for crater in craters) / math.pi)
    away = ndimage.distance_transform_edt(~np.any(craters, axis=0))
    outside = np.asarray((away > (RULES.clearance - 1.0) * max(radius, 2.0)) & np.isfinite(scan.z))
    if outside.sum() < RULES.level_points * outside.size:
        raise InputError(
            "the crater leaves no undisturbed surface to level on", source=scan.source,
            allowed="a scan some 4 crater widths wide",
        )  # fmt: skip
    return outside
