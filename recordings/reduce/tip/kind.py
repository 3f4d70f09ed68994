"""The photograph of a tip, read, fitted and drawn."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import Field, model_validator

from ....core.errors import InputError
from ..images.options import PictureOptions
from ..images.picture_file import DOWN, crop_window, cropped, read_picture
from ..measured import Measured
from ..reduced import Reduced
from .picture import draw_tip
from .reduction import TipReduction, reduce_tip


class Options(PictureOptions):
    """Options of the reduction of a photograph."""

    shape: Literal["rod", "sphere"] = Field("rod", description="a rod, or a ball wholly in view")
    striker_is: Literal["dark", "bright"] = Field("dark", description="against its ground")
    tip_points: Literal["down", "left", "up", "right"] = Field(
        "down", description="where the tip points in the picture"
    )

    @model_validator(mode="after")
    def _diameter_of_a_rod(self) -> Options:
        if self.diameter_m is not None and self.shape == "sphere":
            raise ValueError("diameter_m is a rod's; give pixel_m for a ball")
        return self


def reduce(path: Path, options: Options) -> Reduced:
    """Fit a circle to the tip and return its radius.

    Raises
    ------
    InputError
        The picture cannot be read, or shows no tip.
    """
    if path.is_dir():
        raise InputError("a folder", source=str(path), allowed="one picture")
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
