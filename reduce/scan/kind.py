"""A scan of a crater or a tip, read, levelled, measured and drawn."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ..measured import Measured
from ..reduced import Reduced
from .ball import reduce_ball
from .crater import Crater, reduce_scan
from .file import Scan, read_scan
from .options import ScanOptions
from .picture import draw_ball, draw_crater


def reduce(path: Path, options: ScanOptions) -> Reduced:
    """Measure the deepest crater of a scan, or the radius of a ball."""
    scan = read_scan(
        path, unit=None if options.unit == "file" else options.unit,
        height_unit=None if options.height_unit == "same" else options.height_unit,
        step=options.step_m,
    )  # fmt: skip
    scale = Measured(options.height_scale, options.height_scale_std)
    if options.shows == "ball":
        return _ball(path, scan, options)
    found = reduce_scan(
        scan, level=options.level, height_scale=scale,
        blur=Measured(options.blur_m, options.blur_m_std),
    )  # fmt: skip
    return Reduced(
        source=path, values=_values(found), trials=found.trials(), notes=found.notes,
        draw=lambda to: draw_crater(found, to),
    )  # fmt: skip


def _ball(path: Path, scan: Scan, options: ScanOptions) -> Reduced:
    found = reduce_ball(scan, reach=options.reach_m)
    # a radius is a length squared over a height
    radius = found.radius.over(Measured(options.height_scale, options.height_scale_std))
    values = {
        "tip_radius_m": radius,
        "roughness_m": Measured(found.rest, math.nan),
        "reach_m": Measured(found.reach, math.nan),
    }
    return Reduced(
        source=path, values=values, trials=(), notes=found.notes,
        draw=lambda to: draw_ball(found, to), striker={"tip_radius_m": radius},
    )  # fmt: skip


def _values(found: Crater) -> dict[str, Measured]:
    values = {
        "permanent_depth_m": found.depth,
        "pile_up_m": found.pile_up,
        "crater_volume_m3": found.volume,
    }
    if found.is_scar:
        return values | {
            "scar_length_m": found.length,
            "scar_width_m": found.width,
            "scar_excess_m": found.sliding,
            "scar_direction_deg": Measured(np.degrees(found.direction) % 180.0, math.nan),
        }
    across = Measured(
        0.5 * (found.length.value + found.width.value),
        0.5 * math.hypot(found.length.std, found.width.std),
    )
    return values | {"crater_diameter_m": across, "contact_radius_m": across.scaled(0.5)}
