"""Tables that instruments and spreadsheets write: text, workbooks, packed exports, tracks.

A row is data if most of its filled cells are numbers; the last other row above holds the names, or
the units of the names above it. A column is picked by its name, by the beginning of it, or by its
number.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ...core.confined import confined
from ...core.errors import InputError
from ...core.inputs.csv_table import number, rows_with, selection
from ...core.inputs.input_file import checked_file
from ..measured import Array
from ..units import UNITS
from .packed import packed_table, tracker_rows
from .workbook import workbook_rows

_BOOKS = (".xls", ".xlsx", ".xlsm", ".xlsb", ".ods")
_LARGEST = 200_000_000
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")
_KNOWN_UNITS = {unit for units in UNITS.values() for unit in units if unit} | {"V", "mV", "px"}
_UNIT = re.compile(r"[\[(]\s*([^\])]+?)\s*[\])]\s*$")


@dataclass(frozen=True)
class Columns:
    """Numbers of a table.

    Parameters
    ----------
    names
        Of the columns as the file has them, empty where it has none, m entries.
    values
        (n, m), NaN where a cell holds no number.
    cells
        The same as text, n rows of m.
    source
        The file.
    """

    names: tuple[str, ...]
    values: Array
    cells: tuple[tuple[str, ...], ...]
    source: str

    def select(self, which: str) -> Columns:
        """Return the rows that `COLUMN=VALUE` picks.

        Raises
        ------
        InputError
            Not of that form, or no row has the value.
        """
        name, value = selection(which, source=self.source)
        place = self.find(name, key="select")
        rows = rows_with(value, [row[place] for row in self.cells], source=self.source)
        return replace(self, values=self.values[rows], cells=tuple(self.cells[k] for k in rows))

    def find(self, which: str, *, key: str) -> int:
        """Return the place of a column that is named, or numbered from 1.

        Raises
        ------
        InputError
            No column, or more than one, is meant.
        """
        if which.isdecimal() and 1 <= int(which) <= len(self.names):
            return int(which) - 1
        low = [" ".join(n.split()).lower() for n in self.names]
        wanted = " ".join(which.split()).lower()
        for match in (
            [k for k, n in enumerate(low) if n == wanted],
            [k for k, n in enumerate(low) if n.startswith(wanted) and wanted],
        ):
            if len(match) == 1:
                return match[0]
        raise InputError(
            f"{which!r}", source=self.source, key=key,
            allowed=f"one of 1 to {len(self.names)}"
            + (f", or {', '.join(filter(None, self.names[:12]))}" if any(self.names) else ""),
        )  # fmt: skip

    def unit(self, place: int) -> str:
        """Return the unit in a column's name, `x (mm)`, `x [mm]` or `x_mm`; else nothing."""
        name = self.names[place]
        found = _UNIT.search(name)
        return found.group(1) if found else name.rsplit("_", 1)[-1] if "_" in name else ""

    def factor(
        self, place: int, quantity: str, *, given: str, key: str, default: str | None = None
    ) -> float:
        """Return what the numbers of a column are multiplied by.

        Parameters
        ----------
        place
            The column.
        quantity
            One of `units.UNITS`.
        given
            Unit by the user, or `"file"` for what the column's name says.
        key
            Option that gives the unit.
        default
            Unit where neither says one; None asks for it.

        Raises
        ------
        InputError
            The unit is not known.
        """
        units = UNITS[quantity]
        if given != "file":
            if given not in units:
                raise InputError(repr(given), key=key, allowed=", ".join(units))
            return units[given]
        said = self.unit(place)
        if said in units:
            return units[said]
        if default is None:
            raise InputError(
                f"column {self.names[place] or place + 1!r} does not name its unit",
                source=self.source, key=key, allowed=", ".join(units),
            )  # fmt: skip
        return units[default]


def read_columns(path: Path, *, sheet: str = "") -> Columns:
    """Read the numbers of a table.

    Parameters
    ----------
    path
        The file.
    sheet
        Name of a sheet of a workbook, a table of a packed export, a track of a tracker's file; the
        first or only one by default.

    Raises
    ------
    InputError
        Not a table, or no numbers in it.
    """
    checked_file(path, most=_LARGEST, allowed="a table")
    kind = path.suffix.lower()
    if kind == ".trk":
        names, values = tracker_rows(path, sheet)
        return columns_of([names, *([repr(float(v)) for v in row] for row in values)], str(path))
    if kind == ".zip":
        text, source = packed_table(path, sheet)
        return columns_of(text_rows(text, source), source)
    rows = (
        confined(workbook_rows, path, sheet, source=str(path))
        if kind in _BOOKS
        else text_rows(path.read_bytes(), str(path))
    )
    return columns_of(rows, str(path))


def columns_of(rows: list[list[str]], source: str) -> Columns:
    """Return the numbers in rows of cells, with the names above them.

    Raises
    ------
    InputError
        No row of numbers.
    """
    data = [(k, row) for k, row in enumerate(rows) if _is_data(row)]
    if not data:
        raise InputError("no row of numbers", source=source, allowed="columns of numbers")
    first = data[0][0]
    width = max(len(row) for _, row in data)
    values = np.full((len(data), width), np.nan)
    for line, (_, row) in enumerate(data):
        values[line, : len(row)] = [number(cell) for cell in row]
    above = rows[:first]
    units = above.pop() if len(above) > 1 and all(map(_is_unit, _filled(above[-1]))) else []
    head = next((row for row in reversed(above) if len(_filled(row)) > 1 or width == 1), [])
    if units and head:
        padded = [*units, *[""] * len(head)]
        head = [
            f"{name} [{unit.strip('()[] ')}]" if unit else name
            for name, unit in zip(head, padded, strict=False)
        ]
    head = head or units
    names = tuple((head + [""] * width)[:width])
    cells = tuple(tuple((row + [""] * width)[:width]) for _, row in data)
    return Columns(names, values, cells, source)


def _filled(row: Sequence[str]) -> list[str]:
    return [cell for cell in row if cell]


def _is_data(row: Sequence[str]) -> bool:
    filled = _filled(row)
    numbers = sum(np.isfinite(number(cell)) for cell in filled)
    return bool(2 * numbers > len(filled))


def _is_unit(cell: str) -> bool:
    bare = cell.strip("()[] ")
    return bare in _KNOWN_UNITS or (bare != cell.strip() and len(bare) < 12)


def text_rows(raw: bytes, source: str) -> list[list[str]]:
    """Return the cells of a text table.

    Raises
    ------
    InputError
        Not text, empty, or no table.
    """
    if b"\0" in raw[:4096] and not raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise InputError("not text", source=source, allowed="a text table, XLS, XLSX or ODS")
    wide = raw.startswith((b"\xff\xfe", b"\xfe\xff"))
    try:
        text = raw.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")  # old instruments write their micro and degree signs so
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    if not lines:
        raise InputError("empty", source=source, allowed="columns of numbers")
    separator = _separator(lines)
    try:
        rows = (
            [line.split() for line in lines]
            if separator == " "
            else list(csv.reader(lines, delimiter=separator, skipinitialspace=True))
        )
    except csv.Error as error:
        raise InputError(f"not a table ({error})", source=source, allowed="a table") from None
    return [[_point(cell.strip(), separator) for cell in row] for row in rows]


def _separator(lines: Sequence[str]) -> str:
    """The separator that splits the middle of the file into the most numbers."""
    sample = lines[len(lines) // 3 :][:40] or lines

    def numbers(separator: str) -> int:
        split = (line.split() if separator == " " else line.split(separator) for line in sample)
        cells = [_point(cell.strip(), separator) for line in split for cell in line]
        return sum(bool(np.isfinite(number(cell))) for cell in cells if cell)

    return max(("\t", ";", ",", " "), key=numbers)


def _point(cell: str, separator: str) -> str:
    """A decimal comma becomes a point where commas do not separate."""
    return cell.replace(",", ".") if separator != "," and _DECIMAL_COMMA.fullmatch(cell) else cell
