"""Curves of a trial: tip motion and force against time, cross-sections of the crater."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ..core.arrays import Array
from ..core.errors import InputError, InputErrors
from ..core.inputs.csv_table import Problems, numbers, read_text_table
from .columns import PROFILE_COLUMNS, TRACE_COLUMNS


def read_trace(path: Path) -> Mapping[str, Array]:
    """Return the columns of a trace, (n,) each, by name; every mistake is a line of one error."""
    return _read(path, TRACE_COLUMNS, needed=("time_s",), one_of=("tip_height_m", "force_N"))


def read_profile(path: Path) -> Mapping[str, Array]:
    """Return `x_m` and `z_m` of a crater's cross-section, (n,) each, likewise."""
    return _read(path, PROFILE_COLUMNS, needed=PROFILE_COLUMNS, one_of=())


def _read(
    path: Path, known: tuple[str, ...], *, needed: tuple[str, ...], one_of: tuple[str, ...]
) -> Mapping[str, Array]:
    problems = Problems(str(path))
    table = read_text_table(path, known, problems)
    columns: dict[str, Array] = {}
    if table is not None:
        for name in (n for n in needed if n not in table.columns):
            problems.add("missing", row=1, column=name, allowed="this column is needed")
        if one_of and not set(one_of) & set(table.columns):
            problems.add("no curve", row=1, allowed=" or ".join(one_of))
        columns = {name: numbers(table, name, problems) for name in table.columns}
        if len(table.rows) < 2:
            problems.add(f"{len(table.rows)} points", allowed="at least 2")
        for name in (n for n in needed if n in columns):
            empty = [r for r, c in zip(table.rows, table.cells[name], strict=True) if not c]
            for row in empty:
                problems.add("empty", row=row, column=name, allowed="a number")
        first = needed[0]
        if first in columns:
            back = np.flatnonzero(~(np.diff(columns[first]) > 0.0))
            known_steps = [i for i in back if np.isfinite(columns[first][i : i + 2]).all()]
            for i in known_steps[:1]:
                problems.add(
                    f"{columns[first][i + 1]:g} after {columns[first][i]:g}", row=table.rows[i + 1],
                    column=first, allowed="a column that increases",
                )  # fmt: skip
    if problems.found:
        raise InputErrors(tuple(problems.found))
    for column in columns.values():
        column.flags.writeable = False
    return columns


def series_in(folder: Path, trials: tuple[str, ...], mistakes: list[InputError]) -> dict[str, Path]:
    """Return the files of a folder by trial; what is wrong with them is added to `mistakes`.

    A file without its trial is a mistake, too.
    """
    files = sorted(folder.glob("*.csv"))
    mistakes += [
        InputError(
            f"there is no trial {path.stem!r}", source=str(path),
            allowed="the name of a trial in trials.csv",
        )
        for path in files if path.stem not in trials
    ]  # fmt: skip
    found = {path.stem: path for path in files if path.stem in trials}
    reader = read_trace if folder.name == "traces" else read_profile
    for path in found.values():
        try:
            reader(path)
        except InputErrors as several:
            mistakes += several.errors
    return found
