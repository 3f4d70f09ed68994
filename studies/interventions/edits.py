"""One side of a pair as a recording set: the base, with what the plan says done to it."""

from __future__ import annotations

import math
import shutil
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import tomlkit

from ...core.errors import InputError
from ...recordings import read
from .bases import Rows, rows_of, write_rows
from .plan import Side


def write_side(side: Side, made: Path, folder: Path) -> None:
    """Write the set of one side.

    `side`: what is done; `made`: the base; `folder`: receives set.toml and trials.csv; must not be
    there.

    Raises `InputError`: a key, column or row of the plan that the base doesn't have. `InputErrors`:
    the set is no sound one then.
    """
    folder.mkdir(parents=True)
    shutil.copyfile(made / "set.toml", folder / "set.toml")
    write_rows(_rows(side, rows_of(made)), folder)
    document = tomlkit.parse((folder / "set.toml").read_text(encoding="utf-8"))
    for key, value in side.stated.items():
        *path, last = key.split(".")
        table: Any = document
        for name in path:
            table = table.setdefault(name, tomlkit.table())
        table[last] = value
    for key in side.left_out:
        *path, last = key.split(".")
        table = document
        for name in path:
            table = table[name]
        del table[last]
    (folder / "set.toml").write_text(tomlkit.dumps(document), encoding="utf-8")
    read(folder)


def _rows(side: Side, rows: Rows) -> Rows:
    wanted = side.rows or ("*",)
    kept = [row for row in rows if any(fnmatchcase(row["trial"], one) for one in wanted)]
    for pattern in side.rows:
        if not any(fnmatchcase(row["trial"], pattern) for row in kept):
            raise InputError(repr(pattern), key="rows", allowed="names of trials")
    for column in (*side.columns_left_out, *side.scaled):
        if not any(column in row for row in rows):
            raise InputError(repr(column), key="columns", allowed=", ".join(rows[0]))
    for row in kept:
        for column, factor in side.scaled.items():
            if row[column]:
                row[column] = repr(float(row[column]) * factor)
        if side.turned_deg:
            _turn(row, side.turned_deg)
    gone = set(side.columns_left_out)
    return [{name: text for name, text in row.items() if name not in gone} for row in kept]


def _turn(row: dict[str, str], turned_deg: float) -> None:
    """State the angle of a ball's flight otherwise: the total speed stays."""
    angle = float(row["angle_deg"])
    total = float(row["impact_speed_m_s"]) / math.sin(math.radians(angle))
    row["angle_deg"] = repr(angle + turned_deg)
    row["impact_speed_m_s"] = repr(total * math.sin(math.radians(angle + turned_deg)))
