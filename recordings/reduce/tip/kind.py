"""The photograph of a tip, read, fitted and drawn."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import Field, field_validator, model_validator

from ....core.errors import InputError
from ....core.toml_input import InputTable
from ..clip import DOWN, crop_window, cropped, read_picture
from ..measured import Measured
from ..reduced import Reduced
from .picture import draw_tip
from .reduction import TipReduction, reduce_tip


class Options(InputTable):
    """Options of the reduction of a photograph."""

    shape: Literal["rod", "sphere"] = Field("rod", description="a rod, or a ball wholly in view")
    pixel_m: float | None = Field(None, gt=0.0, description="size of a pixel")
    pixel_m_std: float = Field(0.0, ge=0.0, description="its standard deviation")
    diameter_m: float | None = Field(
        None, gt=0.0, description="of the rod, from which the size of a pixel follows"
    )
    diameter_m_std: float = Field(0.0, ge=0.0, description="its standard deviation")
    striker_is: Literal["dark", "bright"] = Field("dark", description="against its ground")
    channel: Literal["grey", "red", "green", "blue"] = Field("grey", description="colour to use")
    tip_points: Literal["down", "left", "up", "right"] = Field(
        "down", description="where the tip points in the picture"
    )
    crop: str = Field("", description="rows and columns to keep, TOP:BOTTOM,LEFT:RIGHT")

    @field_validator("crop")
    @classmethod
    def _four_numbers(cls, given: str) -> str:
        crop_window(given)
        return given

    @model_validator(mode="after")
    def _one_scale(self) -> Options:
        if self.pixel_m is not None and self.diameter_m is not None:
            raise ValueError("pixel_m or diameter_m, not both")
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
    window = crop_window(options.crop)
    if window is not None:
        picture = cropped(picture, window)
    found = reduce_tip(
        picture, shape=options.shape, striker_is=options.striker_is,
        scale=_measured(options.pixel_m, options.pixel_m_std),
        diameter=_measured(options.diameter_m, options.diameter_m_std), source=str(path),
    )  # fmt: skip
    measured = math.isfinite(found.tip_radius.value)
    return Reduced(
        source=path, values=_values(found), trials=(), notes=found.notes,
        draw=lambda to: draw_tip(found, picture, to),
        striker={"tip_radius_m": found.tip_radius} if measured else {},
    )  # fmt: skip


def _measured(value: float | None, std: float) -> Measured | None:
    return None if value is None else Measured(value, std)


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
