"""Which columns of a machine's file hold load, depth and time, and what its header states."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.inputs.input_file import checked_file
from ...core.processes.confined import confined
from ..shared.units import LENGTH, UNITS
from ..table.cells import value_of
from ..table.channels import CHANNELS
from ..table.file import (
    BOOKS,
    Columns,
    columns_of,
    is_data,
    numbered_lines,
    read_columns,
    text_rows,
)  # fmt: skip
from ..table.packed import TABLE_BYTES
from ..table.sheet.words import bare
from ..table.workbook import sheets_of
from .options import PressOptions

_LOADS = (
    r"(load|force|.*kraft|last|fn|p|f)\b",
    r".*(load|force|kraft|charge|effort|forza|fuerza|carico|carga)",
)
_DEPTHS = (
    r"(depth|.*eindring\w*|.*tiefe|indentation|penetra\w*|enfoncement|pd|h)\b",
    r".*prof(ond|und)\w*",
    r"(disp|displacement)\b", r".*(standardweg|extenso|lvdt|gauge)", r".*(displacement|depth|disp)",
    r".*(deplacement|desplaza|spostament|desloca)",
    r".*(extension|weg|stroke|travel|crosshead|position|course|traverse|corsa|carrera)",
)  # fmt: skip
_TIMES = (r"(time|.*zeit|t|temps|tempo|tiempo)\b", r".*time")
"""Words of Zwick, Instron, MTS, Bruker and Hysitron, Agilent and Keysight, Anton Paar and CSM,
Fischer, the best first."""

_STATED = re.compile(
    r"(?P<of>machine|frame|instrument|system)\W*(?P<what>compliance|comp|stiffness)\b[^:=;,\d]*"
    r"[:=;,\s]\s*(?P<number>[\d.]+(?:[eE][+-]?\d+)?)\s*[\[(]?(?P<unit>[^\s\])]+/[^\s\])]+)", re.I
)  # fmt: skip


@dataclass(frozen=True)
class PressRecord:
    """Load against depth, in the order of time.

    - `load`, `depth`: (n,) [N, m]; the load upwards, the depth growing with it.
    - `missed`, `gap`: how many rows hold no number; how many of them stand just before each row,
      (n,).
    - `stated`: compliance of the machine that the file states [m/N]; none if it does not.
    """

    load: Array
    depth: Array
    missed: int
    gap: Array
    stated: float | None
    source: str


def read_press(path: Path, options: PressOptions) -> PressRecord:
    """Read load and depth of a machine's file; refuse what has neither in known units."""
    tables = list(_tables(path, options))
    found = next((t for t in tables if _has_both(t, options)), tables[0])
    load, depth = (_column(found, *which, path, options) for which in _wanted(options))
    newtons = found.factor(load, "force", given=options.load_unit, key="load_unit")
    metres = found.factor(depth, "length", given=options.depth_unit, key="depth_unit")
    columns = [found.values[:, load] * newtons, found.values[:, depth] * metres]
    clock = found.find(options.time, key="time") if options.time else _named(found, _TIMES, "time")
    rows = np.arange(float(len(found.values)))
    time = rows
    if clock is not None:
        unit = found.factor(clock, "time", given=options.time_unit, key="time_unit", default="s")
        time = found.values[:, clock] * unit
    known = np.isfinite(columns[0]) & np.isfinite(columns[1]) & np.isfinite(time)
    used = known & options.keeps(np.where(known, time, 0.0))
    gap = np.diff(rows[used], prepend=-1.0) - 1.0
    p, h = (c[used] for c in columns)
    if p.size:
        p = p * np.sign(p[np.argmax(np.abs(p))])
        top = int(np.argmax(p))
        h = h * (-1.0 if h[top] < np.median(h[: max(top // 5, 1)]) else 1.0)
    return PressRecord(p, h, int((~known).sum()), gap, _compliance(tables), str(path))


def _wanted(options: PressOptions) -> tuple[tuple[str, str, tuple[str, ...], str], ...]:
    return ("load", options.load, _LOADS, "force"), ("depth", options.depth, _DEPTHS, "length")


def _tables(path: Path, options: PressOptions) -> Iterator[Columns]:
    """Yield the tables of a file: instruments write several below each other into one text."""
    checked_file(path, most=TABLE_BYTES, allowed="a table of load against depth")
    if path.suffix.lower() in (*BOOKS, *CHANNELS, ".zip"):
        yield read_columns(path, sheet=options.sheet)
        return
    lines = numbered_lines(path.read_bytes(), str(path))
    rows = text_rows([line for _number, line in lines], str(path))
    data = [is_data(row) for row in rows]
    begins = [0]
    for k in range(1, len(rows)):
        if data[k - 1] or not data[k] or len([c for c in rows[k - 1] if c]) < 2:
            continue  # not the end of a header
        if any(np.isfinite(value_of(cell)) for cell in rows[k - 1]):
            continue  # a load out of range beside a depth
        first = k - 1
        while first > 0 and not data[first - 1]:
            first -= 1
        if first > 0 and len(rows[first - 1]) > 1:
            begins.append(first)
    for begin, end in zip(begins, [*begins[1:], len(rows)], strict=True):
        yield columns_of(rows[begin:end], str(path))


def _has_both(table: Columns, options: PressOptions) -> bool:
    return all(
        given or _named(table, words, quantity) is not None
        for _key, given, words, quantity in _wanted(options)
    )


def _named(table: Columns, words: Sequence[str], quantity: str) -> int | None:
    """The column that is named so, in a unit of that kind; the first of the best words."""
    units = UNITS[quantity]
    for word in words:
        for k, name in enumerate(table.names):
            text = bare(re.sub(r"[\[(_].*", "", name))
            said = table.unit(k)
            if re.match(word, text) and (said in units or not said or said.lower() == text):
                return k
    return None


def _column(
    table: Columns, key: str, given: str, words: Sequence[str], quantity: str, path: Path,
    options: PressOptions,
) -> int:  # fmt: skip
    if given:
        return table.find(given, key=key)
    found = _named(table, words, quantity)
    if found is not None:
        return found
    sheets: tuple[str, ...] = ()
    if path.suffix.lower() in BOOKS and not options.sheet:
        sheets = confined(sheets_of, path, source=str(path))
    known = ", ".join(filter(None, table.names[:12]))
    raise InputError(
        f"no column is named as a {key}", source=str(path), key=key,
        allowed=f"--sheet, one of {', '.join(sheets[:20])}" if len(sheets) > 1
        else f"a name or number of {len(table.names)} columns{f': {known}' if known else ''}",
    )  # fmt: skip


def _compliance(tables: Sequence[Columns]) -> float | None:
    """The machine's compliance as the headers state it [m/N]; one of 0 states nothing."""
    for table in tables:
        for cells in table.heading.said:
            found = _STATED.search(" ".join(cells))
            if found is None:
                continue
            number = float(found["number"])
            above, _, below = found["unit"].partition("/")
            stiff = found["what"].lower() == "stiffness"
            over = (below, above) if stiff else (above, below)
            if over[0] not in LENGTH or over[1] not in UNITS["force"] or not number > 0.0:
                continue
            size = LENGTH[over[0]] / UNITS["force"][over[1]]
            return size / number if stiff else size * number
    return None
