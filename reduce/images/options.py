"""Options that every reduction of pictures has."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, field_validator, model_validator

from ...core.inputs.toml_input import InputTable
from ..measured import Measured
from .picture_file import crop_window


class PictureOptions(InputTable):
    """How a picture is read, and how large its pixels are."""

    pixel_m: float | None = Field(None, gt=0.0, le=0.01, description="size of a pixel")
    pixel_m_std: float = Field(0.0, ge=0.0, description="its standard deviation")
    diameter_m: float | None = Field(
        None, gt=0.0, le=1.0, description="of the striker, from which the size of a pixel follows"
    )
    diameter_m_std: float = Field(0.0, ge=0.0, description="its standard deviation")
    channel: Literal["grey", "red", "green", "blue"] = Field("grey", description="colour to use")
    crop: str = Field("", description="rows and columns to keep, TOP:BOTTOM,LEFT:RIGHT")

    @field_validator("crop")
    @classmethod
    def _four_numbers(cls, given: str) -> str:
        crop_window(given)
        return given

    @model_validator(mode="after")
    def _one_scale(self) -> PictureOptions:
        if self.pixel_m is not None and self.diameter_m is not None:
            raise ValueError("pixel_m or diameter_m, not both")
        return self

    @property
    def pixel(self) -> Measured | None:
        """Size of a pixel [m], if it is given."""
        return None if self.pixel_m is None else Measured(self.pixel_m, self.pixel_m_std)

    @property
    def diameter(self) -> Measured | None:
        """Diameter of the striker [m], if it is given."""
        return None if self.diameter_m is None else Measured(self.diameter_m, self.diameter_m_std)
