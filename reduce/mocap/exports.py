"""Trackers' own exports, told by their first lines: Motive, Vicon Nexus, Qualisys, OpenSim.

| export | first line | positions | time |
| --- | --- | --- | --- |
| Motive, CSV | `Format Version` | columns of type Marker, else Rigid Body | `Time (Seconds)` |
| Nexus, CSV | `Trajectories`, or another block | three columns a marker | rate in the next line |
| Qualisys, TSV | `NO_OF_FRAMES` | three columns of `MARKER_NAMES` | `FREQUENCY` |
| OpenSim, TRC | `PathFileType` | three columns a marker | `Time` |
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import takewhile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.inputs.csv_table import number
from ...core.inputs.input_file import read_bytes
from ..shared.units import LENGTH
from ..table.file import text_rows
from ..table.packed import TABLE_BYTES

_IN_WORDS = {"meters": "m", "millimeters": "mm", "centimeters": "cm", "inches": "in"}


class Export(NamedTuple):
    """Times (n,) [s], m names, positions (n, m, 3) in `unit`, NaN where a marker was not seen."""

    time: Array
    names: tuple[str, ...]
    position: Array
    unit: str


def read_export(path: Path) -> Export | None:
    """Return a tracker's export, None for any other file; refuse one without positions."""
    with path.open("rb") as stream:
        first = stream.read(4096).decode("utf-8-sig", errors="replace")
    known = {"Format Version": _motive, "NO_OF_FRAMES": _qualisys, "PathFileType": _opensim}
    for beginning, reader in known.items():
        if first.startswith(beginning):
            return reader(_rows(path), str(path))
    vicon = ("Trajectories", "Devices", "Model Outputs", "Joints", "Segments", "Events")
    if first.split("\n", 1)[0].strip(' ",;\r') in vicon:
        return _vicon(_rows(path), str(path))
    return None


def _rows(path: Path) -> list[list[str]]:
    raw = read_bytes(path, most=TABLE_BYTES, allowed="a tracker's export")
    return text_rows(raw.decode("utf-8-sig", errors="replace").splitlines(), str(path))


def _motive(rows: list[list[str]], source: str) -> Export:
    said = dict(zip(rows[0][::2], rows[0][1::2], strict=False))
    top = next((k for k, row in enumerate(rows) if row[:1] == ["Frame"]), None)
    if top is None:
        raise _none(source, "a Motive export of tracks")
    # some versions name these rows in their second cell, some do not
    typed = (k for k, row in enumerate(rows[:top]) if {"Marker", "Rigid Body"} & {*row[2:]})
    kinds, names, *_ = rows[next(typed, top - 1) :]
    what = next((row for row in rows[1:top] if "Position" in row), [])
    places: dict[str, dict[str, list[int]]] = {"Marker": {}, "Rigid Body": {}}
    for k, (kind, name, one) in enumerate(zip(kinds, names, what, strict=False)):
        if one == "Position":
            group = "Rigid Body" if kind == "Rigid Body" else "Marker"
            places[group].setdefault(name, []).append(k)
    found = places["Marker"] or places["Rigid Body"]
    unit = _IN_WORDS.get(said.get("Length Units", "Meters").lower(), "m")
    return _export(rows[top + 1 :], found, 1, 1.0, unit, source)


def _vicon(rows: list[list[str]], source: str) -> Export:
    top = next((k for k, row in enumerate(rows) if row[:1] == ["Trajectories"]), None)
    if top is None or top + 5 > len(rows):
        raise _none(source, "a block 'Trajectories'")
    rate = number(rows[top + 1][0]) if rows[top + 1] else np.nan
    titles, units = rows[top + 2], rows[top + 4]
    found = {
        name: [k, k + 1, k + 2] for k, name in enumerate(titles) if name and not name.isdigit()
    }
    unit = next((u for u in units if u in LENGTH), "mm")
    block = takewhile(any, rows[top + 5 :])  # up to the empty line that ends it
    return _export(block, found, 0, rate, unit, source)


def _qualisys(rows: list[list[str]], source: str) -> Export:
    said = {row[0]: row[1:] for row in rows if row and not _is_number(row[0])}
    names = [n for n in said.get("MARKER_NAMES", []) if n]
    rate = number((said.get("FREQUENCY") or [""])[0])
    body = [row for row in rows if row and _is_number(row[0])]
    width = max((len([c for c in row if c]) for row in body), default=0)
    before = max(width - 3 * len(names), 0)  # frame and time, where they were exported
    found = {n: [before + 3 * k + a for a in (1, 2, 3)] for k, n in enumerate(names)}
    return _export([[str(k), *row] for k, row in enumerate(body)], found, 0, rate, "mm", source)


def _opensim(rows: list[list[str]], source: str) -> Export:
    if len(rows) < 6:
        raise _none(source, "a TRC file of tracks")
    said = dict(zip(rows[1], rows[2], strict=False))
    found = {name: [k, k + 1, k + 2] for k, name in enumerate(rows[3]) if k > 1 and name}
    return _export(rows[5:], found, 1, 1.0, said.get("Units", "mm"), source)


def _is_number(cell: str) -> bool:
    return bool(np.isfinite(number(cell)))


def _export(
    rows: Iterable[list[str]], found: dict[str, list[int]], clock: int, rate: float, unit: str,
    source: str,
) -> Export:  # fmt: skip
    """Collect times (a column over a rate) and the places of every marker."""
    data = [row for row in rows if len(row) > clock and _is_number(row[clock])]
    whole = {name: place for name, place in found.items() if len(place) == 3}
    if not whole or not data:
        raise _none(source, "markers with x, y and z")
    if not rate > 0.0:
        raise InputError("no rate in its header", source=source, allowed="an export with its rate")
    width = max(max(p) for p in whole.values()) + 1
    cells = np.array([[number(c) for c in (row + [""] * width)[:width]] for row in data])
    position = np.stack([cells[:, place] for place in whole.values()], axis=1)
    return Export(cells[:, clock] / rate, tuple(whole), position, unit)


def _none(source: str, allowed: str) -> InputError:
    return InputError("a tracker's export without positions", source=source, allowed=allowed)
