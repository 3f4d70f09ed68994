"""The undisturbed surface of a scan: spikes out, crater found, the rest levelled.

The undisturbed surface is a plane (or paraboloid) fitted robustly without the crater and its rim;
crater and fit are found in turns.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...core.arrays import Array, Mask
from ...core.errors import InputError
from ..rules import RULES
from ..shared.regression import robust_regression, robust_std
from .file import Scan

LEVELS = {"plane": 1, "paraboloid": 2}
"""Shape of the undisturbed surface, and its polynomial degree."""


@dataclass(frozen=True)
class Levelled:
    """A scan above its undisturbed surface.

    - `z`: (nx, ny) heights above it, NaN where nothing was seen [m].
    - `crater`, `clear`: (nx, ny) the crater; the surface that it was levelled on.
    - `step`, `terms`: (2,) distance of the points [m]; (nx, ny, p) polynomial terms of the level.
    - `outliers`: number of spikes taken out.
    """

    z: Array
    crater: Mask
    clear: Mask
    step: Array
    terms: Array
    outliers: int

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
        surface = _surface(terms, z, clear, 20_000)
        found = _crater_of(ndimage.gaussian_filter(whole - surface, blur), clear, scan)
        same = np.array_equal(found, crater)
        crater = found
        clear = seen & _outside(crater, scan)
        if same:
            break
    return Levelled(
        z - _surface(terms, z, clear, 200_000), crater, clear, scan.step, terms, outliers
    )


def filled(z: Array) -> Array:
    """Return the heights with every gap closed by its nearest neighbour."""
    hole = ~np.isfinite(z)
    if not hole.any():
        return z
    place = ndimage.distance_transform_edt(hole, return_distances=False, return_indices=True)
    return np.asarray(z[tuple(place)])


def _without_spikes(z: Array) -> tuple[Array, int]:
    off = z - ndimage.median_filter(filled(z), size=5, mode="nearest")
    spike = np.abs(off) > RULES.foreign * max(robust_std(off[np.isfinite(off)]), 1e-15)
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


def _crater_of(smooth: Array, clear: Mask, scan: Scan) -> Mask:
    """Return the connected region below the surface that holds the deepest place."""
    noise = robust_std(smooth[clear])
    lowest = np.unravel_index(int(np.argmin(smooth)), smooth.shape)
    depth = -float(smooth[lowest])
    if not depth > 5.0 * max(noise, 1e-15):
        raise InputError(
            f"no crater: the lowest place lies {depth:.3g} m under the surface, whose roughness "
            f"is {noise:.3g} m", source=scan.source, allowed="a crater deeper than five times that",
        )  # fmt: skip
    regions, _ = ndimage.label(smooth < -max(0.03 * depth, min(2.0 * noise, 0.2 * depth)))
    return np.asarray(regions == regions[lowest])


def _outside(crater: Mask, scan: Scan) -> Mask:
    radius = math.sqrt(float(crater.sum()) / math.pi)
    away = ndimage.distance_transform_edt(~crater)
    outside = np.asarray(away > (RULES.clearance - 1.0) * max(radius, 2.0))
    if (outside & np.isfinite(scan.z)).sum() < RULES.level_points * crater.size:
        raise InputError(
            "the crater leaves no undisturbed surface to level on", source=scan.source,
            allowed="a scan some 4 crater widths wide",
        )  # fmt: skip
    return outside
