"""Crater scans: permanent depth, pile-up, size, volume and sliding length with uncertainties."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...core.arrays import Array
from ...core.errors import InputError
from ..gates import Refused
from ..measured import UNITY, ZERO, Measured, Trial
from ..rules import RULES
from .bottom import find_bottom
from .file import Scan
from .level import Levelled, filled, levelled
from .walls import (
    Section,
    opening,
    pile_up,
    section,
    section_covariance,
    without_band,
    without_blur,
)

# limit: area within the outline of a crater at most, in that below the surface [-]; a ring around
# a hill, as of heights that grow downwards, has 1.7
_FILLED = 1.2


@dataclass(frozen=True)
class Crater:
    """A measured crater; lengths in metres.

    - `depth`: deepest point below the undisturbed surface.
    - `pile_up`: height of the rim, mean along the edge at the distance where it is largest.
    - `length`, `width`: between the walls at the level of the surface: along the scar, and across
      it at the deepest point; nan where a wall leaves the scan.
    - `sliding`: `length - width`.
    - `volume`: of the part below the surface [m³]; nan where that leaves the scan.
    - `deepest`: (2,) place of the deepest point.
    - `direction`: angle of the scar in the scan [rad].
    - `surface`: the levelled scan.
    - `along`, `across`: sections through the deepest point along and across the scar.
    """

    depth: Measured
    pile_up: Measured
    length: Measured
    width: Measured
    sliding: Measured
    volume: Measured
    deepest: Array
    direction: float
    surface: Levelled
    along: Section
    across: Section
    notes: tuple[str, ...]

    @property
    def is_scar(self) -> bool:
        """Whether the crater is longer than wide beyond what its walls are known to."""
        return self.sliding.value > max(3.0 * self.sliding.std, 0.05 * self.width.value)

    def trials(self) -> tuple[Trial, ...]:
        """Return the observables of trials.csv and the profile along the scar."""
        row = {"permanent_depth_m": self.depth}
        if self.is_scar:
            row |= {"scar_length_m": self.length, "scar_width_m": self.width}
        profile = {"x_m": self.along.s - self.along.s[0], "z_m": self.along.z}
        return (Trial(row, profile=profile),)


def reduce_scan(
    scan: Scan, *, level: str = "plane", height_scale: Measured = UNITY, blur: Measured = ZERO
) -> Crater:
    """Measure the deepest crater of a scan, or refuse one that stands out of no roughness.

    `level` is the shape of the undisturbed surface, one of `scan_level.LEVELS`; `height_scale` true
    over shown heights; `blur` the standard deviation of the lateral blur [m]: it lifts a floor of
    Laplacian q by q blur²/2, and lowers the rim, which is taken off.
    """
    shown = levelled(scan, level=level)
    direction, half_width = _shape(shown)
    bottom = find_bottom(shown, half_width, source=scan.source)
    along = section(shown, bottom.place, direction, half_width)
    across = section(shown, bottom.place, direction + 0.5 * math.pi, half_width)
    covariance = section_covariance(shown, half_width)
    length, width = (opening(s, bottom.depth.value, covariance) for s in (along, across))
    _check_whole(shown, length, width, scan.source)
    length, width = without_band(length, width, half_width)
    depth = without_blur(bottom.depth, bottom.laplacian, blur)
    if not depth.std < RULES.own_error * depth.value:
        raise Refused(
            f"a crater {1e6 * depth.value:.3g} um deep +- {1e6 * depth.std:.3g} um",
            source=scan.source, allowed="a depth that the roughness lets see, a finer scan",
        )  # fmt: skip
    rim, cell = pile_up(shown, half_width, blur), float(np.prod(scan.step))
    volume = Measured(
        math.nan if shown.leaves else -float(np.sum(filled(shown.z)[shown.crater])) * cell,
        bottom.depth.std * float(shown.crater.sum()) * cell,
    )
    return Crater(
        depth=depth.times(height_scale), pile_up=rim.times(height_scale),
        length=length, width=width, sliding=length.minus(width),
        volume=volume.times(height_scale), deepest=bottom.place, direction=direction,
        surface=shown, along=along, across=across,
        notes=_notes(scan, shown, width, height_scale),
    )  # fmt: skip


def _check_whole(found: Levelled, length: Measured, width: Measured, source: str) -> None:
    """Refuse a lowest part that surrounds a hill, or of which no wall leads up within the scan."""
    hill = bool(ndimage.binary_fill_holes(found.crater).sum() > _FILLED * found.crater.sum())
    cut = found.leaves and math.isnan(length.value) and math.isnan(width.value)
    if hill or cut:
        raise Refused(
            "the lowest part surrounds a hill" if hill else "the lowest part leaves the scan",
            source=source, allowed="a crater that is whole in the scan, heights that grow upwards",
        )  # fmt: skip


def _shape(found: Levelled) -> tuple[float, float]:
    """Return the direction of the crater's longer axis [rad] and half its width [m]."""
    cells = np.argwhere(found.crater) * found.step
    if len(cells) < 30:
        raise InputError(
            f"the crater covers {len(cells)} points", allowed="30 or more: a finer scan"
        )
    values, vectors = np.linalg.eigh(np.cov(cells.T))
    area = len(cells) * float(np.prod(found.step))
    ratio = math.sqrt(values[1] / max(values[0], 1e-300))
    return math.atan2(vectors[1, 1], vectors[0, 1]), math.sqrt(area / (math.pi * ratio))


def _notes(scan: Scan, found: Levelled, width: Measured, scale: Measured) -> tuple[str, ...]:
    notes = [f"roughness of the level surface {found.roughness * 1e6:.3g} um"]
    missing = int(np.isnan(scan.z).sum())
    if found.outliers or missing:
        notes.append(
            f"{100 * found.outliers / scan.z.size:.2g} % spikes taken out, "
            f"{100 * missing / scan.z.size:.2g} % not seen"
        )
    if found.others:
        notes.append(f"of {found.others + 1} craters the deepest is read, the others are left out")
    if scale.std == 0.0:
        notes.append("the calibration of the instrument's heights is taken as exact")
    if not math.isfinite(width.value):
        why = "does not reach the surface within the scan" if found.leaves else "has too few points"
        notes.append(f"a wall of the crater {why}: no width, no diameter")
    return tuple(notes)
