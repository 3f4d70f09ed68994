"""Tables that instruments and spreadsheets write: text, workbooks, packed exports, tracks.

A row is data if most of its filled cells are numbers; the last other row above holds the names, or
the units of the names above it. A column is picked by its name, by the beginning of it, or by its
number.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain, pairwise, zip_longest
from pathlib import Path

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.inputs.csv_table import rows_with, selection
from ...core.inputs.input_file import checked_file
from ...core.processes.confined import confined
from ..shared.units import UNITS, quantity_of
from .cells import DAY, commas_between, instant, plain, since_first, value_of
from .channels import CHANNELS, Shown, channels_of
from .heading import Heading, heading_of, labview_rows, unit_in
from .packed import TABLE_BYTES, packed_table, tracker_rows
from .workbook import workbook_rows

BOOKS = (".xls", ".xlsx", ".xlsm", ".xlsb", ".ods")
"""Endings of workbooks."""
WIDE = "  "
"""Two blanks or more, of columns that stand one below the other."""
_MINUS = "\u2212"
"""As typesetters write it."""
_POINT = re.compile(r"[+-]?\d*\.\d+")
_UNIT = re.compile(r"[\[(]\s*([^\])]+?)\s*[\])]\s*$")


@dataclass(frozen=True)
class Columns:
    """Numbers of a table.

    - `names`: of the columns as the file has them, empty where it has none, m entries.
    - `values`: (n, m), NaN where a cell holds no number.
    - `cells`: the same as text, n rows of m.
    - `heading`: what stands above the numbers.
    """

    names: tuple[str, ...]
    values: Array
    cells: Sequence[tuple[str, ...]]
    source: str
    heading: Heading = field(default_factory=Heading)

    def select(self, which: str) -> Columns:
        """Return the rows that `COLUMN=VALUE` picks; refuse another form, or no such row."""
        name, value = selection(which, source=self.source)
        place = self.find(name, key="select")
        rows = rows_with(value, [row[place] for row in self.cells], source=self.source)
        return replace(self, values=self.values[rows], cells=tuple(self.cells[k] for k in rows))

    def find(self, which: str, *, key: str) -> int:
        """Return the place of a column by its name, or number from 1; refuse none, or several."""
        if which.isdecimal() and 1 <= int(which) <= len(self.names):
            return int(which) - 1
        low = [" ".join(n.split()).lower() for n in self.names]
        wanted = " ".join(which.split()).lower()
        bare = _UNIT.sub("", wanted).strip()
        for match in (
            [k for k, n in enumerate(low) if n == wanted],
            [k for k, n in enumerate(low) if bare and _UNIT.sub("", n).strip() == bare],
            [k for k, n in enumerate(low) if n.startswith(wanted) and wanted],
        ):
            if len(match) == 1:
                return match[0]
            if match:
                raise InputError(
                    f"{which!r} may be any of columns {', '.join(str(k + 1) for k in match)}",
                    source=self.source, key=key, allowed="the number of one of them",
                )  # fmt: skip
        raise InputError(
            f"{which!r}", source=self.source, key=key,
            allowed=f"one of 1 to {len(self.names)}"
            + (f", or {', '.join(filter(None, self.names[:12]))}" if any(self.names) else ""),
        )  # fmt: skip

    def unit(self, place: int) -> str:
        """Return the unit in a column's name, else nothing."""
        return unit_in(self.names[place])

    def factor(
        self, place: int, quantity: str, *, given: str, key: str, default: str | None = None
    ) -> float:
        """Return what the numbers of a column are multiplied by; refuse a unit that is not known.

        `quantity` is one of `units.UNITS`; `given` the unit by the user, or `"file"` for what the
        column's name says; `key` the option that gives it; `default` counts where neither says one.
        """
        units = UNITS[quantity]
        if given != "file":
            if given not in units:
                raise InputError(repr(given), key=key, allowed=", ".join(units))
            return units[given]
        said = self.unit(place)
        if said in units:
            return units[said]
        bracketed = said if any(sign in self.names[place] for sign in "[(<") else ""
        if default is None or bracketed:
            column = f"column {self.names[place] or place + 1!r}"
            told = "does not name its unit"
            if other := quantity_of(said):
                told = f"is of {other}, in {said}"
            elif bracketed:
                told += f", {said!r} is none that is known"
            raise InputError(
                f"{column} {told}", source=self.source, key=key, allowed=", ".join(units)
            )
        return units[default]


def read_columns(path: Path, *, sheet: str = "") -> Columns:
    """Read the numbers of a table; refuse what is none, or holds none.

    `sheet` names a sheet of a workbook, a table of a packed export, a track of a tracker's file;
    the first or only one by default.
    """
    checked_file(path, most=TABLE_BYTES, allowed="a table")
    kind = path.suffix.lower()
    if kind == ".trk":
        named, rows = tracker_rows(path, sheet)
        return Columns(named, rows, Shown(rows), str(path))
    if kind == ".zip":
        text, source = packed_table(path, sheet)
        return text_columns(text, source, sheet)
    if kind in CHANNELS:
        names, numbers = confined(channels_of, path, sheet, source=str(path))
        return Columns(tuple(names), numbers, Shown(numbers), str(path))
    if is_book(path):
        return columns_of(confined(workbook_rows, path, sheet, source=str(path)), str(path))
    return text_columns(path.read_bytes(), str(path), sheet)


def is_book(path: Path) -> bool:
    """Return whether a file is a workbook; instruments name their text .xls too."""
    if path.suffix.lower() != ".xls":
        return path.suffix.lower() in BOOKS
    with path.open("rb") as stream:
        return stream.read(2) in (b"PK", b"\xd0\xcf")


def text_columns(raw: bytes, source: str, sheet: str = "") -> Columns:
    """Read the numbers of a text table, of a LabVIEW file's segments that which is named."""
    lines = [line for _number, line in numbered_lines(raw, source)]
    found = labview_rows(lines, sheet, source)
    if found is None:
        between = _separator(lines, source)
        columns = columns_of(text_rows(lines, source, separator=between), source)
        names = columns.heading.names
        if between == "," and any(quantity_of(unit_in(name)) for name in names):
            refuse_torn(columns.cells, names[: sum(map(bool, names))], source)
        return columns
    body, heading = found
    columns = columns_of(text_rows(body, source, separator=heading.separator), source)
    names = (*heading.names, *[""] * len(columns.names))[: len(columns.names)]
    steps = np.diff(columns.values[:, 0])
    if heading.step_s is not None and not (steps < 0.0).any() and not (steps > 0.0).all():
        columns.values[:, 0] = heading.step_s * np.arange(len(columns.values))
    return replace(columns, names=names, heading=heading)


def columns_of(rows: list[list[str]], source: str) -> Columns:
    """Return the numbers in rows of cells, with the names above them; refuse rows without any."""
    known = [is_data(row) for row in rows]
    first = _first(rows, known)
    if first is None:
        seen = next(filter(any, rows[len(rows) // 2 :]), rows[0] if rows else [])
        raise InputError(
            f"no row of numbers, but {' '.join(seen)[:60]!r}" if any(seen)
            else "no row of numbers", source=source, allowed="columns of numbers",
        )  # fmt: skip
    held = [_is_number(cell) for cell in rows[first]]
    data = [
        row
        for row, is_known in zip(rows[first:], known[first:], strict=True)
        if is_known or _has_hole(row, held)
    ]
    width = max(map(len, data))
    cells = tuple(tuple((row + [""] * width)[:width]) for row in data)
    values = np.array([[value_of(cell) for cell in row] for row in cells])
    heading = heading_of(rows[:first], width)
    names = list(heading.names)
    for place, column in enumerate(zip(*cells, strict=True)):
        if (first_instant := instant(column[0])) >= 0.0:
            day = first_instant // DAY  # seconds from the year 1 on keep no microseconds
            values[:, place] = since_first(np.array([instant(cell, day) for cell in column]))
            names[place] = f"{_UNIT.sub('', names[place]).strip() or 'time'} [s]"
    return Columns(tuple(names), values, cells, source, heading)


def _filled(row: Sequence[str]) -> list[str]:
    return [cell for cell in row if cell]


def _first(rows: Sequence[Sequence[str]], known: Sequence[bool]) -> int | None:
    """The first row of numbers, as `known`, that is not alone among the lines of a header."""
    data = [k for k, row_is in enumerate(known) if row_is]
    filled = [k for k, row in enumerate(rows) if _filled(row)]
    together = [k for k, after in pairwise(filled) if known[k] and known[after]]
    return together[0] if len(together) > 1 else data[0] if data else None


def is_data(row: Sequence[str]) -> bool:
    """Whether most of a row's filled cells are numbers; an instant counts beside a number."""
    filled = _filled(row)
    numbers = sum(bool(np.isfinite(value_of(cell))) for cell in filled)
    if 2 * numbers > len(filled) or numbers == 0:
        return numbers > 0
    return 2 * (numbers + sum(bool(np.isfinite(instant(cell))) for cell in filled)) > len(filled)


def _is_number(cell: str) -> bool:
    return bool(np.isfinite(value_of(cell)) or np.isfinite(instant(cell)))


def _has_hole(row: Sequence[str], held: Sequence[bool]) -> bool:
    """Whether a row of several cells misses a number and has one where the first row has it."""
    kept = (_is_number(c) for c, h in zip(row, held, strict=False) if h)
    return len(_filled(row)) > 1 and any(kept)


def numbered_lines(raw: bytes, source: str) -> list[tuple[int, str]]:
    """Return the lines that hold something and are no comment, by number from 1; refuse none."""
    each = enumerate(decoded(raw, source).splitlines(), start=1)
    lines = [(k, line) for k, line in each if line.strip() and not line.startswith("#")]
    if not lines:
        raise InputError("empty", source=source, allowed="columns of numbers")
    return lines


def decoded(raw: bytes, source: str) -> str:
    """Return the text of a file in any usual encoding; refuse what is none."""
    wide = wide_coding(raw)
    if b"\0" in raw[:4096] and not wide:
        raise InputError("not text", source=source, allowed="a text table, XLS, XLSX or ODS")
    try:
        text = raw.decode(wide or "utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")  # old instruments write their micro and degree signs so
    return text.replace(_MINUS, "-")


def wide_coding(raw: bytes) -> str:
    """Return the encoding of a text of two bytes a sign, by its mark or its zeros; else nothing."""
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        return "utf-16"
    first, second = (raw[k:4096:2].count(0) for k in (0, 1))
    # without a mark: what is mostly Latin has a zero in nearly each pair, always on one side
    if min(first, second) or 4 * max(first, second) < len(raw[:4096]):
        return ""
    return "utf-16-be" if first else "utf-16-le"


def text_rows(lines: Sequence[str], source: str, *, separator: str = "") -> list[list[str]]:
    """Return the cells of a text table, its numbers with decimal points; refuse what is none.

    `separator` is known, or that which fits best.
    """
    separator, rows = cells_of(lines, source, separator=separator)
    between = commas_between(chain.from_iterable(rows), separator)
    return [[plain(cell, between) for cell in row] for row in rows]


def cells_of(
    lines: Sequence[str], source: str, *, separator: str = ""
) -> tuple[str, list[list[str]]]:
    """Return the separator of a text table and its cells as written; refuse what is none."""
    separator = separator or _separator(lines, source)
    return separator, [[cell.strip() for cell in row] for row in _split(lines, source, separator)]


def refuse_torn(rows: Iterable[Sequence[str]], headers: Sequence[str], source: str) -> None:
    """Refuse rows that decimal commas tore: longer than headers, whole numbers under none of them.

    A decimal point in the row says that its commas part cells.
    """
    for row in rows:
        beyond = [c for name, c in zip_longest(headers, row, fillvalue="") if not name]
        torn = len(row) > len(headers) and any(map(str.isdecimal, beyond))
        if torn and not any(map(_POINT.fullmatch, row)):
            raise InputError(
                f"{','.join(row).strip(',')[:60]!r}: {len(row)} cells below {len(headers)} headers",
                source=source, allowed="semicolons between cells, or points before decimals: these "
                "commas do both",
            )  # fmt: skip


def _split(lines: Sequence[str], source: str, by: str, above: int = 0) -> Iterator[list[str]]:
    """The cells of lines with others above them; blanks separate as many as there are."""
    if by == " ":
        yield from (line.split() for line in lines)
        return
    if by == WIDE:
        yield from _in_columns([line.expandtabs().rstrip() for line in lines])
        return
    reader = csv.reader(lines, delimiter=by, skipinitialspace=True)
    try:
        yield from reader
    except csv.Error as error:
        raise InputError(
            f"not a table ({error})", source=source, key=f"row {above + reader.line_num}",
            allowed="a table",
        ) from None  # fmt: skip


def _in_columns(lines: Sequence[str]) -> Iterator[list[str]]:
    """The cells of lines that two blanks part at one place in each; titles are a cell of theirs."""
    words = [len(re.split(r" {2,}", line.strip())) for line in lines]
    most = max(words, default=0)
    parted = [2 * n >= most > 1 for n in words]
    table = [line for line, is_row in zip(lines, parted, strict=True) if is_row]
    held = "".join(
        "x" if any(c > " " for c in at) else " " for at in zip_longest(*table, fillvalue=" ")
    )
    starts = [found.start() for found in re.finditer(r"(?<![^ ] )(?<![^ ])x", held)]
    pairs = list(zip_longest(starts, starts[1:]))
    for line, is_row in zip(lines, parted, strict=True):
        yield [line[a:b] for a, b in (pairs if is_row else [(0, None)])]


def _separator(lines: Sequence[str], source: str) -> str:
    """The separator that splits the middle of the file into the most numbers."""
    above = len(lines) // 3
    sample = lines[above:][:40]

    def numbers(separator: str) -> tuple[int, bool]:
        cells = [c.strip() for row in _split(sample, source, separator, above) for c in row]
        between = commas_between(cells, separator)
        found = [np.isfinite(value_of(plain(cell, between))) for cell in cells if cell]
        # decimal commas between blanks are as many numbers between commas, and words beside them
        return sum(map(bool, found)), all(found)

    return max(("\t", ";", ",", " "), key=numbers)
