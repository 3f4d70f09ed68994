"""Options of the reduction of a scan."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from ...core.inputs.toml_input import InputTable


class ScanOptions(InputTable):
    """Options of the reduction of a scan."""

    shows: Literal["crater", "ball"] = Field(
        "crater", description="a crater, or the top of a ball or tip"
    )
    level: Literal["plane", "paraboloid"] = Field(
        "plane", description="shape of the undisturbed surface"
    )
    unit: Literal["file", "m", "mm", "um", "nm"] = Field(
        "file", description="of the lengths along the surface; file: what it says"
    )
    height_unit: Literal["same", "m", "mm", "um", "nm"] = Field(
        "same", description="of the heights; same: as along the surface"
    )
    step_m: float | None = Field(
        None, gt=0.0, description="distance of the points, for files that are silent or wrong"
    )
    height_scale: float = Field(1.0, gt=0.0, description="true over shown height")
    height_scale_std: float = Field(0.0, ge=0.0, description="its standard deviation")
    blur_m: float = Field(
        0.0, ge=0.0, description="standard deviation of the instrument's lateral blur"
    )
    blur_m_std: float = Field(0.0, ge=0.0, description="its standard deviation")
    reach_m: float | None = Field(
        None, gt=0.0, description="of a ball: distance from the top that is used; default: all"
    )


Options = ScanOptions
"""By this name a kind is found."""
