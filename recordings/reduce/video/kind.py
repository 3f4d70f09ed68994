"""A video or a folder of pictures, read, tracked and drawn."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Literal

from pydantic import Field, field_validator, model_validator

from ....core.errors import InputError
from ....core.toml_input import InputTable
from ..clip import read_clip
from ..measured import Measured
from ..reduced import Reduced
from .picture import draw_video
from .reduction import GRAVITY, Optics, VideoReduction, reduce_video

_CROP = re.compile(r"(\d+):(\d+),(\d+):(\d+)")


class Options(InputTable):
    """Options of the reduction of a video."""

    frame_rate_hz: float = Field(gt=0.0, description="the camera's own frames per second")
    shape: Literal["rod", "sphere"] = Field("rod", description="of the striker")
    pixel_m: float | None = Field(None, gt=0.0, description="size of a pixel")
    pixel_m_std: float = Field(0.0, ge=0.0, description="its standard deviation")
    diameter_m: float | None = Field(
        None, gt=0.0, description="of the striker, from which the size of a pixel follows"
    )
    diameter_m_std: float = Field(0.0, ge=0.0, description="its standard deviation")
    gravity_m_s2: float = Field(GRAVITY, gt=0.0, description="acceleration of the fall")
    striker_is: Literal["bright", "dark"] = Field("bright", description="against its ground")
    background: Literal["none", "median"] = Field(
        "none", description="median: subtract the median of all frames"
    )
    channel: Literal["grey", "red", "green", "blue"] = Field("grey", description="colour to use")
    down: Literal["down", "left", "up", "right"] = Field(
        "down", description="where gravity points in the picture"
    )
    first_frame: int = Field(0, ge=0, description="number of the first frame to use")
    last_frame: int | None = Field(None, ge=0, description="number of the last one")
    crop: str = Field("", description="rows and columns to keep, TOP:BOTTOM,LEFT:RIGHT")

    @field_validator("crop")
    @classmethod
    def _four_numbers(cls, given: str) -> str:
        if given and not _CROP.fullmatch(given):
            raise ValueError("TOP:BOTTOM,LEFT:RIGHT, four whole numbers")
        return given

    @model_validator(mode="after")
    def _one_scale(self) -> Options:
        if self.pixel_m is not None and self.diameter_m is not None:
            raise ValueError("pixel_m or diameter_m, not both")
        return self

    @property
    def window(self) -> tuple[int, int, int, int] | None:
        """Rows and columns to keep."""
        found = _CROP.fullmatch(self.crop)
        if found is None:
            return None
        top, bottom, left, right = map(int, found.groups())
        return top, bottom, left, right


def reduce(path: Path, options: Options) -> Reduced:
    """Track the striker and read its speeds before and after each contact.

    Raises
    ------
    InputError
        The clip cannot be read, or shows no striker or no contact.
    """
    last = options.last_frame
    if last is not None and last < options.first_frame:
        raise InputError(f"{last}", key="last_frame", allowed=f"{options.first_frame} or more")
    clip = read_clip(
        path, channel=options.channel, down=options.down, first=options.first_frame, last=last,
        crop=options.window,
    )  # fmt: skip
    optics = Optics(
        rate=options.frame_rate_hz,
        scale=_measured(options.pixel_m, options.pixel_m_std),
        size=_measured(options.diameter_m, options.diameter_m_std),
        gravity=options.gravity_m_s2,
    )
    found = reduce_video(
        clip, optics, shape=options.shape, striker_is=options.striker_is,
        background=options.background,
    )  # fmt: skip
    return Reduced(
        source=path, values=_values(found), trials=found.trials(), notes=found.notes,
        draw=lambda picture: draw_video(found, clip, picture),
        noise={"frame_rate_hz": found.rate},
    )  # fmt: skip


def _measured(value: float | None, std: float) -> Measured | None:
    return None if value is None else Measured(value, std)


def _values(found: VideoReduction) -> dict[str, Measured]:
    values = {"half_width_pixel": found.half_width, "pixel_m": found.scale}
    for number, trial in enumerate(found.trials(), start=1):
        label = f"bounce{number}_" if len(found.bounces) > 1 else ""
        values |= {f"{label}{name}": value for name, value in trial.observables.items()}
    return values
