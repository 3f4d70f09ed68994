"""Options of the reduction of a video."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from ..bounces.options import BallOptions
from ..images.options import PictureOptions

# limit: frames of a clip [-]: none is as long
_MOST_FRAMES = 10**9


class VideoOptions(PictureOptions, BallOptions):
    """Options of the reduction of a video."""

    frame_rate_hz: float = Field(ge=1e-3, le=1e10, description="the camera's own frames per second")
    shape: Literal["rod", "sphere"] = Field("rod", description="of the striker")
    line_time_s: float = Field(
        0.0, ge=0.0, description="from one row to the next, of a shutter that rolls down"
    )
    striker_is: Literal["bright", "dark"] = Field("bright", description="against its ground")
    background: Literal["none", "median"] = Field(
        "none", description="median: subtract the median of all frames"
    )
    down: Literal["down", "left", "up", "right"] = Field(
        "down", description="where gravity points in the picture"
    )
    first_frame: int = Field(
        0, ge=0, le=_MOST_FRAMES, description="number of the first frame to use"
    )
    last_frame: int | None = Field(
        None, ge=0, le=_MOST_FRAMES, description="number of the last one"
    )


Options = VideoOptions
"""By this name a kind is found."""
