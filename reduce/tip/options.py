"""Options of the reduction of a photograph."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from ..images.options import PictureOptions


class TipOptions(PictureOptions):
    """Options of the reduction of a photograph."""

    shape: Literal["rod", "sphere"] = Field("rod", description="a rod, or a ball wholly in view")
    striker_is: Literal["dark", "bright"] = Field("dark", description="against its ground")
    tip_points: Literal["down", "left", "up", "right"] = Field(
        "down", description="where the tip points in the picture"
    )

    @model_validator(mode="after")
    def _diameter_of_a_rod(self) -> TipOptions:
        if self.diameter_m is not None and self.shape == "sphere":
            raise ValueError("diameter_m is a rod's; give pixel_m for a ball")
        return self


Options = TipOptions
"""By this name a kind is found."""
