"""Marker tracks of motion capture: C3D files, and tables with three columns a marker."""

from __future__ import annotations

import importlib.util
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from ...core.arrays import Array
from ...core.errors import InputError, missing_extra, reading
from ...core.inputs.csv_table import shown
from ...core.processes.confined import confined
from ..shared.units import LENGTH, metres
from ..table.cells import UNSEEN
from ..table.file import Columns, read_columns
from .exports import read_export

# limit: frames of a recording at least [-]; two flights of a parabola each
_MOCAP_FRAMES = 10

# limit: distance of a marker from the origin [m]; a stadium: millimetres taken for metres
_FARTHEST_MARKER = 1e3

UNITS = ("m", "cm", "mm")
"""Units of length that a file may be in."""

_COORDINATE = re.compile(
    r"(?P<marker>.+?)[ _.:]?(?P<axis>[xyzXYZ])(?:[ _]?[\[(]?(?P<unit>mm|cm|m)[\])]?)?"
)
_TIME = re.compile(
    r"(?:t|time|zeit|temps|tiempo|tempo)(?:[ _]?[\[(]?(?P<unit>s|ms)[\])]?)?", re.IGNORECASE
)
_FRAME = re.compile(r"frame", re.IGNORECASE)
_TURN = ("qw", "qx", "qy", "qz")


@dataclass(frozen=True)
class Markers:
    """Positions (n, m, 3) of markers at increasing times (n,) [m, s]; NaN where not seen."""

    time: Array
    names: tuple[str, ...]
    position: Array
    source: str

    @property
    def rate(self) -> float:
        """Frames per second, from the usual gap between frames [1/s]."""
        return float(1.0 / np.median(np.diff(self.time)))

    @property
    def missing(self) -> float:
        """Part of the marker positions that were not seen."""
        return float(np.mean(~np.isfinite(self.position).all(axis=2)))

    def only(self, names: tuple[str, ...]) -> Markers:
        """Return the named markers, in that order; refuse a name that is none of theirs."""
        for name in names:
            if name not in self.names:
                raise InputError(
                    f"no marker {name!r}", source=self.source, key="markers",
                    allowed=", ".join(self.names[:20]),
                )  # fmt: skip
        index = [self.names.index(n) for n in names]
        return replace(self, names=names, position=self.position[:, index])

    def part(self, first: int, last: int | None) -> Markers:
        """Return frames `first` to `last`, both included."""
        stop = None if last is None else last + 1
        if self.time[first:stop].size < _MOCAP_FRAMES:
            raise InputError(
                f"{self.time[first:stop].size} frames in the range", source=self.source,
                allowed=f"{_MOCAP_FRAMES} frames or more",
            )  # fmt: skip
        return replace(self, time=self.time[first:stop], position=self.position[first:stop])


def read_markers(
    path: Path, *, unit: str | None, rate: float | None, select: str = "",
    points: Mapping[str, Sequence[float]] | None = None,
) -> Markers:  # fmt: skip
    """Read marker tracks from a C3D file, a tracker's export, or a table.

    A table has names above its numbers, a column `time_s` (or `frame`, with `rate` [1/s]), and
    three columns for each marker that end in x, y, z, with or without a unit: `A_x_mm`, `A.X`,
    `A:z`. An empty cell, or a marker at exactly (0, 0, 0), was not seen. A table of poses has
    columns x, y, z of a place on the body and qw, qx, qy, qz of its rotation (scalar first)
    instead; `points`, places on the body [m] by name, then stand for markers. `unit` and `rate`
    count before those of the file, and `select`, `COLUMN=VALUE`, picks rows. A file that does not
    say its unit or its time is refused.
    """
    if path.suffix.lower() == ".c3d":
        markers = _c3d(path, unit, rate)
    elif (export := read_export(path)) is not None:
        factor = metres(unit or export.unit, source=str(path), allowed=LENGTH)
        time = export.time if rate is None else np.arange(export.time.size) / rate
        markers = Markers(time, export.names, export.position * factor, str(path))
    else:
        markers = _table(path, unit, rate, select, points or {})
    if markers.time.size < _MOCAP_FRAMES:
        raise InputError(
            f"{markers.time.size} frames", source=str(path), allowed=f"{_MOCAP_FRAMES} or more"
        )
    farthest = float(np.nanmax(np.abs(markers.position), initial=0.0))
    if farthest > _FARTHEST_MARKER:
        raise InputError(
            f"a marker {farthest:.3g} m from the origin", source=str(path), key="unit",
            allowed=f"up to {_FARTHEST_MARKER:g} m",
        )  # fmt: skip
    if not np.all(np.diff(markers.time) > 0.0):
        row = int(np.argmin(np.diff(markers.time) > 0.0)) + 1
        raise InputError(
            f"the time does not increase after frame {row}", source=str(path),
            allowed="increasing times",
        )  # fmt: skip
    unseen = np.all(markers.position == 0.0, axis=2)
    return replace(markers, position=np.where(unseen[:, :, None], np.nan, markers.position))


def _c3d(path: Path, unit: str | None, rate: float | None) -> Markers:
    if importlib.util.find_spec("ezc3d") is None:
        raise missing_extra("reading C3D files", "mocap")
    points, residuals, labels, stated, rates = confined(_c3d_content, path, source=str(path))
    labels += [f"M{k + 1}" for k in range(len(labels), points.shape[1])]
    factor = metres(unit or (stated[0] if stated else ""), source=str(path), allowed=UNITS)
    hertz = rate or (rates[0] if rates else 0.0)
    if not 0.0 < hertz < math.inf:
        raise InputError(
            "the file does not say its frame rate", source=str(path), key="frame_rate_hz",
            allowed="frames per second",
        )  # fmt: skip
    position = points.T * factor
    position[(residuals.T < 0.0)] = np.nan
    return Markers(np.arange(position.shape[0]) / hertz, tuple(labels), position, str(path))


def _c3d_content(path: Path) -> tuple[Array, Array, list[str], list[str], list[float]]:
    import ezc3d

    with reading(path, "a C3D file", "cannot be read as C3D"):
        content = ezc3d.c3d(str(path))
        points = np.asarray(content["data"]["points"], dtype=np.float64)[:3]
        residuals = np.asarray(content["data"]["meta_points"]["residuals"])[0]
        labels = [str(n) for n in _parameter(content, "LABELS")][: points.shape[1]]
        stated = [str(u).strip().lower() for u in _parameter(content, "UNITS")]
        rates = [float(r) for r in _parameter(content, "RATE")]
    return points, residuals, labels, stated, rates


def _parameter(content: Any, name: str) -> list[Any]:
    group = content["parameters"]["POINT"]
    return list(group[name]["value"]) if name in group else []


def _table(
    path: Path, unit: str | None, rate: float | None, select: str,
    points: Mapping[str, Sequence[float]],
) -> Markers:  # fmt: skip
    table = read_columns(path)
    if select:
        table = table.select(select)
    unnamed = [k for k, name in enumerate(table.names) if not name]
    if any(row[k] for row in table.cells for k in unnamed):
        raise InputError(
            f"{len(table.names)} cells under {len(table.names) - len(unnamed)} columns",
            source=table.source, allowed="as many cells as names",
        )  # fmt: skip
    time = _times(table, rate)
    if set(_TURN) <= set(table.names):
        return _poses(table, time, unit, points)
    groups = _groups(table)
    if not groups:
        raise InputError(
            "no marker", source=table.source,
            allowed="columns NAME_x, NAME_y, NAME_z for each marker",
        )  # fmt: skip
    tracks = []
    for name, columns in groups.items():
        if set(columns) != set("xyz"):
            lacking = ", ".join(sorted(set("xyz") - set(columns)))
            raise InputError(
                f"marker {name!r} has no {lacking}", source=table.source, allowed="x, y and z"
            )
        factor = [LENGTH.get(unit or columns[a][1] or "", math.nan) for a in "xyz"]
        if np.isnan(factor).any():
            raise InputError(
                f"the unit of marker {name!r} is not stated", source=table.source,
                allowed="columns that end in _m or _mm, or the option unit",
            )  # fmt: skip
        tracks.append(_numbers(table, [columns[a][0] for a in "xyz"]) * factor)
    return Markers(time, tuple(groups), np.stack(tracks, axis=1), table.source)


def _numbers(table: Columns, names: Sequence[str]) -> Array:
    """Return columns as numbers, (n, m); NaN where nothing was seen."""
    places = [table.names.index(name) for name in names]
    values = table.values[:, places]
    for row, k in np.argwhere(np.isnan(values)):
        cell = table.cells[row][places[k]]
        if cell.lower() not in UNSEEN:
            where = f"column {names[k]}, row {row + 1} of the numbers"
            raise InputError(
                shown(cell), source=table.source, key=where,
                allowed="a number, or an empty cell where nothing was seen",
            )  # fmt: skip
    return values


def _poses(
    table: Columns, time: Array, unit: str | None, points: Mapping[str, Sequence[float]]
) -> Markers:
    """Return the tracks of places on a body whose pose a table gives."""
    place = {c[0]: c for c in table.names if re.fullmatch(r"[xyz](_(m|cm|mm))?", c)}
    if set(place) != set("xyz"):
        raise InputError(
            "a pose has no place", source=table.source,
            allowed="columns x_m, y_m, z_m beside qw to qz",
        )  # fmt: skip
    if len(points) < 3:
        raise InputError(
            "places on the body are needed for poses", source=table.source,
            allowed="a body file, 3 markers",
        )  # fmt: skip
    factor = metres(unit or place["x"].partition("_")[2], source=table.source, allowed=UNITS)
    origin = _numbers(table, [place[a] for a in "xyz"]) * factor
    turn = _numbers(table, _TURN)
    known = np.isfinite(turn).all(axis=1) & (np.linalg.norm(turn, axis=1) > 0.5)
    position = np.full((time.size, len(points), 3), np.nan)
    rotation = Rotation.from_quat(turn[known], scalar_first=True).as_matrix()
    body = np.array(list(points.values()), dtype=np.float64)
    position[known] = origin[known, None] + np.einsum("kij,mj->kmi", rotation, body)
    return Markers(time, tuple(points), position, table.source)


def _times(table: Columns, rate: float | None) -> Array:
    if rate is not None:
        frames = [_numbers(table, [n])[:, 0] for n in table.names if _FRAME.fullmatch(n)]
        return np.asarray((frames[0] if frames else np.arange(len(table.values))) / rate)
    for name in table.names:
        found = _TIME.fullmatch(name)
        if found is not None:
            time = _numbers(table, [name])[:, 0]
            if np.isnan(time).any():
                raise InputError(
                    "a time is missing", source=table.source, key=f"column {name}",
                    allowed="a number in every row",
                )  # fmt: skip
            return time * (1e-3 if found["unit"] == "ms" else 1.0)
    raise InputError(
        f"no column of time among {', '.join(table.names[:12])}", source=table.source,
        allowed="time_s, or the option frame_rate_hz",
    )  # fmt: skip


def _groups(table: Columns) -> dict[str, dict[str, tuple[str, str | None]]]:
    """Return, for each marker, the column and the stated unit of x, y, z."""
    groups: dict[str, dict[str, tuple[str, str | None]]] = {}
    for column in table.names:
        found = _COORDINATE.fullmatch(column)
        if found is not None and not _TIME.fullmatch(column):
            axes = groups.setdefault(found["marker"], {})
            axes[found["axis"].lower()] = (column, found["unit"])
    return groups
