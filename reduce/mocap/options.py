"""Options of the reduction of motion capture."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from pydantic import Field, ValidationInfo, field_validator, model_validator

from ...core.arrays import Array
from ...core.inputs.csv_table import number
from ...core.inputs.toml_input import InputTable
from ..bounces.options import GRAVITY


def _markers(text: str) -> tuple[str, ...]:
    return tuple(n.strip() for n in text.split(":") if n.strip())


class MocapOptions(InputTable):
    """Options of the reduction of motion capture."""

    shape: Literal["rod", "sphere", "body"] = Field(
        "rod", description="of the striker; a body touches with its lowest marker"
    )
    tip_radius_m: float | None = Field(None, gt=0.0, le=1.0, description="of the tip or the sphere")
    length_m: float | None = Field(
        None, gt=0.0, description="of a rod between the centres of its tip spheres"
    )
    radius_m: float | None = Field(None, gt=0.0, description="of the rod; default: the tip's")
    axis: str = Field("", description="two markers on a line along the rod, as A:B")
    body: str = Field(
        "", description="TOML file with the places of the markers from the centre of mass"
    )
    markers: str = Field("", description="markers on the striker, as A,B,C; default: all")
    select: str = Field("", description="COLUMN=VALUE: only these rows of a table")
    up: Literal["z", "-z", "y", "-y", "x", "-x"] = Field("z", description="out of the flat")
    unit: Literal["file", "m", "cm", "mm"] = Field("file", description="file: what it says")
    frame_rate_hz: float | None = Field(
        None, ge=1e-3, le=1e10, description="frames per second; default: what the file says"
    )
    spin_before_rad_s: str = Field(
        "", description="of a ball followed as one point, measured otherwise, as X,Y,Z"
    )
    first_frame: int = Field(0, ge=0, description="number of the first frame to use")
    last_frame: int | None = Field(None, ge=0, description="number of the last one")
    gravity_m_s2: float = Field(GRAVITY, ge=0.01, le=1e4, description="acceleration of the fall")
    length_scale_std: float = Field(
        0.0, ge=0.0, description="relative standard deviation of the tracker's lengths"
    )

    @model_validator(mode="after")
    def _sizes(self) -> MocapOptions:
        if self.shape != "body" and self.tip_radius_m is None:
            raise ValueError("tip_radius_m is needed: the radius of the tip or of the sphere")
        if self.shape == "rod" and self.length_m is None:
            raise ValueError("length_m is needed for a rod")
        return self

    @field_validator("last_frame")
    @classmethod
    def _order(cls, given: int | None, info: ValidationInfo) -> int | None:
        first = info.data.get("first_frame", 0)
        if given is not None and given < first:
            raise ValueError(f"first_frame, {first}, or more")
        return given

    @field_validator("axis")
    @classmethod
    def _two_markers(cls, given: str) -> str:
        if given and len(_markers(given)) != 2:
            raise ValueError("two markers, as A:B")
        return given

    @field_validator("spin_before_rad_s")
    @classmethod
    def _spin(cls, given: str) -> str:
        if given and [math.isfinite(number(v)) for v in given.split(",")] != [True] * 3:
            raise ValueError("three numbers, as X,Y,Z")
        return given

    @property
    def spin(self) -> Array | None:
        """Spin before the first bounce (3,) [rad/s], if it was given."""
        if not self.spin_before_rad_s:
            return None
        return np.array([float(v) for v in self.spin_before_rad_s.split(",")])

    @property
    def two_ends(self) -> tuple[str, ...]:
        """The two markers along the rod."""
        return _markers(self.axis)


Options = MocapOptions
"""By this name a kind is found."""
