"""Marker tracks, read, fitted and drawn."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import Field, model_validator

from ....core.toml_input import InputTable, read_model
from ...csv_table import number
from ..measured import Array, Measured
from ..reduced import Reduced
from .body import BodyFile, make_body
from .file import Markers, read_markers
from .picture import draw_mocap, draw_point
from .point import reduce_point
from .reduction import GRAVITY, MocapReduction, Scene, reduce_mocap
from .rigid import rigid_poses


def _three_numbers(text: str) -> bool:
    return len(text.split(",")) == 3 and all(math.isfinite(number(v)) for v in text.split(","))


class Options(InputTable):
    """Options of the reduction of motion capture."""

    shape: Literal["rod", "sphere", "body"] = Field(
        "rod", description="of the striker; a body touches with its lowest marker"
    )
    tip_radius_m: float | None = Field(None, gt=0.0, description="of the tip or the sphere")
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
        None, gt=0.0, description="frames per second; default: what the file says"
    )
    spin_before_rad_s: str = Field(
        "", description="of a ball followed as one point, measured otherwise, as X,Y,Z"
    )
    first_frame: int = Field(0, ge=0, description="number of the first frame to use")
    last_frame: int | None = Field(None, ge=0, description="number of the last one")
    gravity_m_s2: float = Field(GRAVITY, gt=0.0, description="acceleration of the fall")
    length_scale_std: float = Field(
        0.0, ge=0.0, description="relative standard deviation of the tracker's lengths"
    )

    @model_validator(mode="after")
    def _sizes(self) -> Options:
        if self.shape != "body" and self.tip_radius_m is None:
            raise ValueError("tip_radius_m is needed, the radius of the tip or of the sphere")
        if self.shape == "rod" and self.length_m is None:
            raise ValueError("length_m is needed for a rod")
        if self.axis and len(self.two_ends) != 2:
            raise ValueError("axis takes two markers, as A:B")
        if self.spin_before_rad_s and not _three_numbers(self.spin_before_rad_s):
            raise ValueError("spin_before_rad_s takes three numbers, as X,Y,Z")
        if self.last_frame is not None and self.last_frame < self.first_frame:
            raise ValueError("last_frame is first_frame or more")
        return self

    @property
    def spin(self) -> Array | None:
        """Spin before the first bounce (3,) [rad/s], if it was given."""
        if not self.spin_before_rad_s:
            return None
        return np.array([float(v) for v in self.spin_before_rad_s.split(",")])

    @property
    def two_ends(self) -> tuple[str, ...]:
        """The two markers along the rod."""
        return tuple(n.strip() for n in self.axis.split(":") if n.strip())


def reduce(path: Path, options: Options) -> Reduced:
    """Fit a rigid body to the markers and read its motion before and after each impact.

    Raises
    ------
    InputError
        The file cannot be read, or shows no body or no impact.
    """
    places = read_model(Path(options.body), BodyFile).markers if options.body else {}
    markers = read_markers(
        path, unit=None if options.unit == "file" else options.unit, rate=options.frame_rate_hz,
        select=options.select, points=places,
    )  # fmt: skip
    markers = markers.part(options.first_frame, options.last_frame)
    if options.markers:
        markers = markers.only(tuple(n.strip() for n in options.markers.split(",")))
    up = np.zeros(3)
    up["xyz".index(options.up[-1])] = -1.0 if options.up.startswith("-") else 1.0
    scene = Scene(up, options.gravity_m_s2, options.length_scale_std)
    if options.shape == "sphere" and len(markers.names) == 1:
        return _point(path, markers, scene, options)
    poses = rigid_poses(markers)
    ends = options.two_ends
    body, remarks = make_body(
        poses, markers, shape=options.shape, tip_radius=options.tip_radius_m or 0.0,
        length=(options.length_m or 0.0) if options.shape == "rod" else 0.0,
        radius=options.radius_m, file=Path(options.body) if options.body else None,
        axis=(ends[0], ends[1]) if options.axis else None,
    )  # fmt: skip
    found = reduce_mocap(poses, body, scene, source=str(path))
    missing = f"{100.0 * markers.missing:.2g} % of the marker positions are missing"
    noise = {"frame_rate_hz": found.rate, "tip_height_m": found.flights.sigma}
    return Reduced(
        source=path, values=_values(found), trials=found.trials(),
        notes=(missing, *remarks, *found.notes), noise=noise,
        draw=lambda picture: draw_mocap(found, picture),
    )  # fmt: skip


def _point(path: Path, markers: Markers, scene: Scene, options: Options) -> Reduced:
    found = reduce_point(markers, scene, spin=options.spin)
    values = {"position_noise_m": Measured(found.noise, math.nan)}
    for k, bounce in enumerate(found.bounces, start=1):
        label = f"bounce{k}_" if len(found.bounces) > 1 else ""
        values |= {f"{label}{name}": value for name, value in bounce.measured.items()}
    return Reduced(
        source=path, values=values, trials=found.trials(), notes=found.notes,
        draw=lambda picture: draw_point(found, picture), noise={"frame_rate_hz": markers.rate},
    )  # fmt: skip


def _values(found: MocapReduction) -> dict[str, Measured]:
    values = {
        "marker_noise_m": Measured(found.flights.sigma, math.nan),
        "fall_acceleration_m_s2": found.fall,
    }
    for k, hit in enumerate(found.hits, start=1):
        label = f"bounce{k}_" if len(found.hits) > 1 else ""
        values |= {f"{label}{name}": value for name, value in hit.measured.items()}
    return values
