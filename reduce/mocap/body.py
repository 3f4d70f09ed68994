"""What is known about the body that carries the markers: shape, centre of mass, axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field, field_validator

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.inputs.toml_input import InputTable, Listed, read_model
from .file import Markers
from .motion import Prior
from .rigid import Poses, kabsch

# limit: length from which on three numbers are a direction [-]: round-off of six digits
_SHORTEST_DIRECTION = 1e-6

Place = Annotated[tuple[float, float, float], Listed]


class BodyFile(InputTable):
    """Where the markers sit on the striker: a TOML file.

    `markers` are their places from the centre of mass [m], in axes fixed to the striker, `axis` the
    direction of the rod in them, `centre_std_m` how well the centre of mass is known.
    """

    markers: dict[str, Place] = Field(min_length=3)
    axis: Place = (0.0, 0.0, 1.0)
    centre_std_m: float = Field(5e-4, gt=0.0)

    @field_validator("axis")
    @classmethod
    def _has_length(cls, given: Place) -> Place:
        if not np.linalg.norm(given) > _SHORTEST_DIRECTION:
            raise ValueError("a direction")
        return given


@dataclass(frozen=True)
class Body:
    """The striker in the axes of the markers' mean shape.

    - `shape`: `"rod"`, `"sphere"` or `"body"`, which touches with its lowest marker.
    - `axis`: (3,) unit vector of the rod, either way; zero for the others.
    - `length`: between the centres of a rod's two tip spheres [m].
    - `tip_radius`: of the rod's tip or the sphere [m].
    - `inertia_over_mass`: about the centre, across the axis, over the mass [m²].
    - `centre`: centre of mass seen from the markers' centroid, and its uncertainty.
    - `markers`: (m, 3) mean shape about its centroid [m].
    """

    shape: str
    axis: Array
    length: float
    tip_radius: float
    inertia_over_mass: float
    centre: Prior
    markers: Array

    def upward(self, turn: Array, up: Array) -> Array:
        """Return the rod's axis, upper end, in frames with rotations (n, 3, 3), as (n, 3)."""
        axis = turn @ self.axis
        sign = np.sign(axis @ up)
        return np.asarray(axis * np.where(sign == 0.0, 1.0, sign)[:, None])

    def tip(self, axis: Array, up: Array) -> Array:
        """Return the lowest point seen from the centre of mass for axes (n, 3), as (n, 3) [m]."""
        return np.asarray(-0.5 * self.length * axis - self.tip_radius * up)

    def lowest(self, turn: Array, up: Array) -> Array:
        """Return the lowest marker seen from the centre of mass, (3,) [m]."""
        arms = (self.markers - self.centre.value) @ turn.T
        return np.asarray(arms[int(np.argmin(arms @ up))])


def make_body(
    poses: Poses, markers: Markers, *, shape: str, tip_radius: float, length: float,
    radius: float | None, file: Path | None, axis: Sequence[str],
) -> tuple[Body, tuple[str, ...]]:  # fmt: skip
    """Return the body and remarks about it; lengths [m].

    Without a `BodyFile` spin shows the centre of mass, and `axis` names two markers on a line along
    the rod. A rod without an axis, and a file that does not fit the markers, are refused.
    """
    across = radius if radius is not None else tip_radius
    given, way = None, np.zeros(3)
    remarks: tuple[str, ...] = ("centre of mass found from the flights (no body file)",)
    if file is not None:
        given, way, remarks = _from_file(file, poses, markers)
    if axis:
        one, two = (markers.names.index(markers.only((n,)).names[0]) for n in axis)
        way = poses.shape[one] - poses.shape[two]
        way = way / np.linalg.norm(way)
    if shape != "rod":
        way = np.zeros(3)
    elif not way.any():
        raise InputError(
            "the axis of the rod is not known", key="axis",
            allowed="two markers along it as A:B, or a body file",
        )  # fmt: skip
    centre = given or centre_of(poses, way, tip_radius, across)
    inertia = length**2 / 12.0 + across**2 / 4.0 if shape == "rod" else 0.4 * tip_radius**2
    if shape == "body":
        inertia = float("inf")
    return Body(shape, way, length, tip_radius, inertia, centre, poses.shape), remarks


def centre_of(poses: Poses, axis: Array, tip_radius: float, radius: float) -> Prior:
    """Return what the markers alone tell of the centre of mass: it lies near a rod's axis.

    `axis` is zero for a body without one, `radius` that of the rod. A rod's markers sit on it, so
    that their centroid lies no farther beside its axis than they spread, or than its radius.
    """
    along = max(poses.extent, tip_radius)
    if not axis.any():
        return Prior(np.zeros(3), along)
    beside = poses.shape - np.outer(poses.shape @ axis, axis)
    spread = float(np.linalg.norm(beside, axis=1).max())
    return Prior(np.zeros(3), along, axis, max(radius, spread))


def _from_file(path: Path, poses: Poses, markers: Markers) -> tuple[Prior, Array, tuple[str, ...]]:
    given = read_model(path, BodyFile)
    common = [n for n in markers.names if n in given.markers]
    if len(common) < 3:
        raise InputError(
            f"{len(common)} of the recording's markers are in it", source=str(path),
            key="markers", allowed=f"three or more of {', '.join(markers.names[:20])}",
        )  # fmt: skip
    body = np.array([given.markers[n] for n in common])
    shape = poses.shape[[markers.names.index(n) for n in common]]
    origin, turn = kabsch(body, shape)
    off = float(np.sqrt(np.mean(np.sum((shape - origin - body @ turn.T) ** 2, axis=1))))
    if off > 0.1 * poses.extent:
        raise InputError(
            f"the markers seen lie {off * 1e3:.3g} mm from it", source=str(path), key="markers",
            allowed="the places of the same markers, in metres",
        )  # fmt: skip
    way = turn @ np.asarray(given.axis, dtype=np.float64)
    remark = f"body file: the markers seen differ from it by {off * 1e3:.2g} mm"
    std = float(np.hypot(given.centre_std_m, off / np.sqrt(len(common))))
    return Prior(origin, std), way / np.linalg.norm(way), (remark,)
