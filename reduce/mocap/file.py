"""Marker tracks of motion capture: C3D files, and CSV tables with three columns a marker."""

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
from ...core.errors import InputError, InputErrors, first_line, missing_extra
from ...core.inputs.csv_table import (
    Problems,
    TextTable,
    numbers,
    read_text_table,
    rows_with,
    selection,
)
from ...core.processes.confined import confined
from ..rules import RULES
from ..shared.units import LENGTH, metres
from .exports import read_export

UNITS = ("m", "cm", "mm")
"""Units of length that a file may be in."""

_COORDINATE = re.compile(
    r"(?P<marker>.+?)[ _.:]?(?P<axis>[xyzXYZ])(?:[ _]?[\[(]?(?P<unit>mm|cm|m)[\])]?)?"
)
_TIME = re.compile(r"(?:t|time)(?:[ _]?[\[(]?(?P<unit>s|ms)[\])]?)?", re.IGNORECASE)
_FRAME = re.compile(r"frame", re.IGNORECASE)
_TURN = ("qw", "qx", "qy", "qz")


@dataclass(frozen=True)
class Markers:
    """Positions of markers.

    Parameters
    ----------
    time
        (n,), increasing [s].
    names
        Of the m markers.
    position
        (n, m, 3), NaN where a marker was not seen [m].
    source
        The file.
    """

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
        """Return the named markers, in that order.

        Raises
        ------
        InputError
            There is no such marker.
        """
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
        if self.time[first:stop].size < RULES.mocap_frames:
            raise InputError(
                f"{self.time[first:stop].size} frames in the range", source=self.source,
                allowed=f"{RULES.mocap_frames} frames or more",
            )  # fmt: skip
        return replace(self, time=self.time[first:stop], position=self.position[first:stop])


def read_markers(
    path: Path,
    *,
    unit: str | None,
    rate: float | None,
    select: str = "",
    points: Mapping[str, Sequence[float]] | None = None,
) -> Markers:
    """Read marker tracks from a C3D file, a tracker's export, or a CSV table.

    A CSV table has one header line, a column `time_s` (or `frame`, with `rate`), and three columns
    for each marker that end in x, y, z, with or without a unit: `A_x_mm`, `A.X`, `A:z`. An empty
    cell, or a marker at exactly (0, 0, 0), was not seen. A table of poses has columns x, y, z of a
    place on the body and qw, qx, qy, qz of its rotation (scalar first) instead.

    Parameters
    ----------
    path
        The file.
    unit
        One of `UNITS`; None takes what the file says.
    rate
        Frames per second [1/s]; None takes what the file says.
    select
        `COLUMN=VALUE`: only these rows of a table.
    points
        Places on the body [m], by name, that stand for markers in a table of poses.

    Raises
    ------
    InputError
        The file cannot be read, or does not say its unit or its time.
    """
    if path.suffix.lower() == ".c3d":
        markers = _c3d(path, unit, rate)
    elif (export := read_export(path)) is not None:
        factor = metres(unit or export.unit, source=str(path), allowed=LENGTH)
        time = export.time if rate is None else np.arange(export.time.size) / rate
        markers = Markers(time, export.names, export.position * factor, str(path))
    else:
        markers = _table(path, unit, rate, select, points or {})
    if markers.time.size < RULES.mocap_frames:
        raise InputError(
            f"{markers.time.size} frames", source=str(path), allowed=f"{RULES.mocap_frames} or more"
        )
    farthest = float(np.nanmax(np.abs(markers.position), initial=0.0))
    if farthest > RULES.farthest_marker:
        raise InputError(
            f"a marker {farthest:.3g} m from the origin", source=str(path), key="unit",
            allowed=f"up to {RULES.farthest_marker:g} m",
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
    said = unit or (stated[0] if stated else "")
    factor = metres(said, source=str(path), allowed=UNITS)
    hertz = rate or (rates[0] if rates else 0.0)
    if not 0.0 < hertz < math.inf:
        raise InputError(
            "the file does not say its frame rate", source=str(path), key="frame_rate_hz",
            allowed="frames per second",
        )  # fmt: skip
    position = np.moveaxis(points, 0, 2).transpose(1, 0, 2) * factor
    position[(residuals.T < 0.0)] = np.nan
    time = np.arange(position.shape[0]) / hertz
    return Markers(time, tuple(labels), position, str(path))


def _c3d_content(path: Path) -> tuple[Array, Array, list[str], list[str], list[float]]:
    import ezc3d

    try:
        content = ezc3d.c3d(str(path))
        points = np.asarray(content["data"]["points"], dtype=np.float64)[:3]
        residuals = np.asarray(content["data"]["meta_points"]["residuals"])[0]
        labels = [str(n) for n in _parameter(content, "LABELS")][: points.shape[1]]
        stated = [str(u).strip().lower() for u in _parameter(content, "UNITS")]
        rates = [float(r) for r in _parameter(content, "RATE")]
    except Exception as error:  # the library raises its own kinds, and KeyError where a part lacks
        raise InputError(
            f"cannot be read as C3D ({first_line(error)})", source=str(path), allowed="a C3D file"
        ) from None
    return points, residuals, labels, stated, rates


def _parameter(content: Any, name: str) -> list[Any]:
    group = content["parameters"]["POINT"]
    return list(group[name]["value"]) if name in group else []


def _table(
    path: Path,
    unit: str | None,
    rate: float | None,
    select: str,
    points: Mapping[str, Sequence[float]],
) -> Markers:
    problems = Problems(str(path))
    table = read_text_table(path, _header(path), problems)
    if table is None:
        raise InputErrors(tuple(problems.found))
    if select:
        table = _selected(table, select, path)
    time = _times(table, rate, problems)
    if set(_TURN) <= set(table.columns):
        return _poses(table, time, unit, points, problems)
    groups = _groups(table)
    if not groups:
        problems.add("no marker", row=1, allowed="columns NAME_x, NAME_y, NAME_z for each marker")
    tracks = []
    for name, columns in groups.items():
        if set(columns) != set("xyz"):
            lacking = ", ".join(sorted(set("xyz") - set(columns)))
            problems.add(f"marker {name!r} has no {lacking}", row=1, allowed="x, y and z")
            continue
        factor = [LENGTH.get(unit or columns[a][1] or "", float("nan")) for a in "xyz"]
        if np.isnan(factor).any():
            problems.add(
                f"the unit of marker {name!r} is not stated", row=1,
                allowed="columns that end in _m or _mm, or the option unit",
            )  # fmt: skip
        tracks.append(
            np.stack([numbers(table, columns[a][0], problems) for a in "xyz"], axis=1) * factor
        )
    if problems.found:
        raise InputErrors(tuple(problems.found))
    return Markers(time, tuple(groups), np.stack(tracks, axis=1), str(path))


def _selected(table: TextTable, select: str, path: Path) -> TextTable:
    column, value = selection(select, source=str(path))
    if column not in table.columns:
        raise InputError(
            repr(column), source=str(path), key="select",
            allowed=f"a column of {', '.join(table.columns[:20])}",
        )  # fmt: skip
    rows = rows_with(value, table.cells[column], source=str(path))
    cells = {name: tuple(text[k] for k in rows) for name, text in table.cells.items()}
    return TextTable(table.columns, tuple(table.rows[k] for k in rows), cells)


def _poses(
    table: TextTable,
    time: Array,
    unit: str | None,
    points: Mapping[str, Sequence[float]],
    problems: Problems,
) -> Markers:
    """Return the tracks of places on a body whose pose a table gives."""
    place = {c[0]: c for c in table.columns if re.fullmatch(r"[xyz](_(m|cm|mm))?", c)}
    if set(place) != set("xyz"):
        problems.add("a pose has no place", row=1, allowed="columns x_m, y_m, z_m beside qw to qz")
    if len(points) < 3:
        problems.add("places on the body are needed for poses", allowed="a body file, 3 markers")
    if problems.found:
        raise InputErrors(tuple(problems.found))
    stated = place["x"].partition("_")[2]
    factor = metres(unit or stated, source=problems.source, allowed=UNITS)
    origin = np.stack([numbers(table, place[a], problems) for a in "xyz"], axis=1) * factor
    turn = np.stack([numbers(table, a, problems) for a in _TURN], axis=1)
    if problems.found:
        raise InputErrors(tuple(problems.found))
    known = np.isfinite(turn).all(axis=1) & (np.linalg.norm(turn, axis=1) > 0.5)
    position = np.full((time.size, len(points), 3), np.nan)
    rotation = Rotation.from_quat(turn[known], scalar_first=True).as_matrix()
    body = np.array(list(points.values()), dtype=np.float64)
    position[known] = origin[known, None] + np.einsum("kij,mj->kmi", rotation, body)
    return Markers(time, tuple(points), position, problems.source)


def _header(path: Path) -> tuple[str, ...]:
    """Return every column of the file: any name may stand in a table of markers."""
    try:
        with path.open(encoding="utf-8-sig") as stream:
            return tuple(c.strip().strip('"') for c in stream.readline().split(","))
    except (OSError, UnicodeDecodeError):
        return ()


def _times(table: TextTable, rate: float | None, problems: Problems) -> Array:
    for name in table.columns:
        found = _TIME.fullmatch(name)
        if found is not None and rate is None:
            time = numbers(table, name, problems)
            if np.isnan(time).any():
                problems.add("a time is missing", column=name, allowed="a number in every row")
            return time * (1e-3 if found["unit"] == "ms" else 1.0)
    if rate is None:
        problems.add("no column of time", row=1, allowed="time_s, or the option frame_rate_hz")
        return np.arange(len(table.rows), dtype=np.float64)
    for name in table.columns:
        if _FRAME.fullmatch(name):
            return numbers(table, name, problems) / rate
    return np.arange(len(table.rows)) / rate


def _groups(table: TextTable) -> dict[str, dict[str, tuple[str, str | None]]]:
    """Return, for each marker, the column and the stated unit of x, y, z."""
    groups: dict[str, dict[str, tuple[str, str | None]]] = {}
    for column in table.columns:
        found = _COORDINATE.fullmatch(column)
        if found is not None and not _TIME.fullmatch(column):
            axes = groups.setdefault(found["marker"], {})
            axes[found["axis"].lower()] = (column, found["unit"])
    return groups
