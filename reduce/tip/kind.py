"""The photograph of a tip, read, fitted and drawn."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ..images.picture_file import DOWN, crop_window, cropped, read_picture
from ..measured import Measured
from ..reduced import Reduced
from .options import TipOptions
from .picture import draw_tip
from .reduction import TipReduction, reduce_tip


def reduce(path: Path, options: TipOptions) -> Reduced:
    """Fit a circle to the tip and return its radius."""
    picture = np.rot90(read_picture(path, channel=options.channel), DOWN[options.tip_points])
    picture = cropped(picture, crop_window(options.crop))
    found = reduce_tip(
        picture, shape=options.shape, striker_is=options.striker_is,
        scale=options.pixel, diameter=options.diameter, source=str(path),
    )  # fmt: skip
    measured = math.isfinite(found.tip_radius.value)
    return Reduced(
        source=path, values=_values(found), trials=(), notes=found.notes,
        draw=lambda to: draw_tip(found, picture, to),
        striker={"tip_radius_m": found.tip_radius} if measured else {},
    )  # fmt: skip


def _values(found: TipReduction) -> dict[str, Measured]:
    values = {
        "tip_radius_pixel": found.radius,
        "roundness_pixel": Measured(found.roundness, math.nan),
        "arc_deg": Measured(math.degrees(found.arc), math.nan),
    }
    if math.isfinite(found.width.value):
        values["width_pixel"] = found.width
    if math.isfinite(found.scale.value):
        values |= {"pixel_m": found.scale, "tip_radius_m": found.tip_radius}
    return values
