"""Comma-separated tables that a person may have typed: every mistake with its row and column."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from ..arrays import Array
from ..errors import InputError
from .input_file import read_bytes

# limit: mistakes of a table that are kept one by one [-]: nobody reads more
_PROBLEMS_KEPT = 1000

# limit: most columns of a table [-]: a logger has hundreds
_TABLE_COLUMNS = 2000

# limit: largest table that is read [bytes]: memory of a small machine
_TABLE_BYTES = 100_000_000

_FORMULA = re.compile(r"'*[=+\-@].")
"""How a text begins that spreadsheets run, behind apostrophes or not."""
_OF_FORTRAN = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)[dD][+-]?\d+")
"""A number in double precision."""


@dataclass(slots=True)
class Problems:
    """The mistakes found so far in one file."""

    source: str
    found: list[InputError] = field(default_factory=list)
    further: int = 0

    def add(self, message: str, *, row: int = 0, column: str = "", allowed: str = "") -> None:
        """Note a mistake; rows count from 1, the header's, as a spreadsheet shows them."""
        self.further += len(self.found) >= _PROBLEMS_KEPT
        if self.further:
            return
        parts = (f"row {row}" if row else "", f"column {column}" if column else "")
        key = ", ".join(part for part in parts if part)
        self.found.append(InputError(message, source=self.source, key=key, allowed=allowed))


@dataclass(frozen=True, slots=True)
class TextTable:
    """The cells of a file as text, by column in the file's order.

    `rows` are numbers of the rows in the file (the header is row 1), shape (n,).
    """

    columns: tuple[str, ...]
    rows: tuple[int, ...]
    cells: Mapping[str, tuple[str, ...]]


def read_text_table(
    path: Path, known: Iterable[str], problems: Problems, *, free: str = ""
) -> TextTable | None:
    """Read a table of UTF-8, commas, one header line as text.

    `None` if it holds nothing to go on with.

    Mistakes go to `problems`. `known` are names that a column may have; any may begin with `free`.
    """
    try:
        raw = read_bytes(path, most=_TABLE_BYTES, allowed="a table of comma-separated values")
        text = raw.decode("utf-8-sig")
    except InputError as error:
        problems.found.append(error)
        return None
    except UnicodeDecodeError as error:
        problems.add(f"not UTF-8 text (byte {error.start})", allowed="UTF-8")
        return None
    try:
        lines = list(csv.reader(io.StringIO(text), strict=True))
    except csv.Error as error:
        problems.add(f"not comma-separated values ({error})", allowed="quotes closed, no NUL")
        return None
    each = enumerate(lines, 1)
    numbered = [(n, [_as_meant(c.strip()) for c in line]) for n, line in each if any(line)]
    numbered = [(n, line) for n, line in numbered if any(line)]
    if not numbered:
        problems.add("empty", allowed="a header line and rows")
        return None
    header_row, header = numbered[0]
    own = [name for name in header if free and name.startswith(free) and len(name) > len(free)]
    names = (*known, *dict.fromkeys(own))
    if not _header_is_sound(header, header_row, names, problems):
        return None
    return _body(header, numbered[1:], names, problems)


def inert(cell: str) -> str:
    """Return a text behind an apostrophe where a spreadsheet would run it as a formula.

    Examples
    --------
    >>> [inert(text) for text in ("=1+1", "-0.5", "-ok", "loose")]
    ["'=1+1", '-0.5', "'-ok", 'loose']
    """
    try:
        float(cell)
    except ValueError:
        return f"'{cell}" if _FORMULA.match(cell) else cell
    return cell


def _as_meant(cell: str) -> str:
    """A text as it was before `inert`."""
    return cell[1:] if cell.startswith("'") and _FORMULA.match(cell) else cell


def _header_is_sound(
    header: Sequence[str], row: int, known: tuple[str, ...], problems: Problems
) -> bool:
    if len(header) == 1 and (";" in header[0] or "\t" in header[0]):
        problems.add("columns are not separated by commas", row=row, allowed="commas")
        return False
    if len(header) > _TABLE_COLUMNS:
        problems.add(f"{len(header)} columns", row=row, allowed=f"up to {_TABLE_COLUMNS}")
        return False
    before = len(problems.found)
    for place, name in enumerate(header):
        if not name:
            problems.add(f"column {place + 1} has no name", row=row, allowed="a name")
        elif name not in known:
            close = get_close_matches(name, known, n=1)
            hint = f"did you mean {close[0]}?" if close else ", ".join(known)
            problems.add("unknown column", row=row, column=name, allowed=hint)
        elif name in header[:place]:
            problems.add("given twice", row=row, column=name, allowed="each column once")
    return len(problems.found) == before or len(set(header) & set(known)) > 0


def _body(
    header: Sequence[str],
    body: Sequence[tuple[int, list[str]]],
    known: Iterable[str],
    problems: Problems,
) -> TextTable:
    whole = []
    for row, line in body:
        extra = [cell for cell in line[len(header) :] if cell]
        if extra:
            problems.add(
                f"{len(line)} cells under {len(header)} columns", row=row,
                allowed="as many cells as columns; a decimal point, not a comma",
            )  # fmt: skip
        whole.append((line + [""] * len(header))[: len(header)])
    first = {name: header.index(name) for name in header if name in known}
    cells = {name: tuple(line[place] for line in whole) for name, place in first.items()}
    return TextTable(tuple(first), tuple(row for row, _ in body), cells)


def number(cell: str) -> float:
    """Return the number in a cell, or NaN for text, infinities and NaN.

    Examples
    --------
    >>> number("1.5e-3"), number("1.5D-03"), number("left")
    (0.0015, 0.0015, nan)
    """
    try:
        value = float(cell)
    except ValueError:
        if not _OF_FORTRAN.fullmatch(cell.strip()):
            return math.nan
        value = float(cell.replace("d", "e").replace("D", "e"))
    # float() takes "1_000"; a spreadsheet would not
    return value if math.isfinite(value) and "_" not in cell else math.nan


def numbers(table: TextTable, column: str, problems: Problems) -> Array:
    """Return a column as numbers, NaN for empty cells; other cells are noted as mistakes."""
    values = np.full(len(table.rows), np.nan)
    for i, cell in enumerate(table.cells[column]):
        if cell:
            values[i] = number(cell)
            if math.isnan(values[i]):
                problems.add(
                    f"{shown(cell)}", row=table.rows[i], column=column,
                    allowed="a finite number with a decimal point, or empty for 'not measured'",
                )  # fmt: skip
    return values


def selection(which: str, *, source: str) -> tuple[str, str]:
    """Return column and value of `COLUMN=VALUE`, the rows that an option picks."""
    column, sign, value = which.partition("=")
    if not sign:
        raise InputError(repr(which), source=source, key="select", allowed="COLUMN=VALUE")
    return column.strip(), value.strip()


def rows_with(value: str, cells: Sequence[str], *, source: str) -> list[int]:
    """Return the places of a value in a column, or refuse one that is not there."""
    rows = [k for k, cell in enumerate(cells) if cell == value]
    if not rows:
        raise InputError(
            f"no row with {value!r}", source=source, key="select",
            allowed=", ".join(sorted(set(cells))[:12]),
        )  # fmt: skip
    return rows


def shown(text: str, limit: int = 40) -> str:
    """Return a text in quotes, control characters escaped, shortened to `limit`."""
    whole = repr(text)
    return whole if len(whole) <= limit else f"{whole[: limit - 4]}...{whole[-1]}"
