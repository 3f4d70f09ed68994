"""A laboratory's sheet from its file: the table in it, its headers, and what it became."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from ....core.errors import InputError
from ....core.inputs.csv_table import rows_with, selection
from ....core.inputs.input_file import checked_file
from ....core.inputs.names import names_a_file
from ....core.processes.confined import confined
from ..file import WIDE, cells_of, decoded, is_book, refuse_torn, wide_coding
from ..heading import is_unit
from ..packed import TABLE_BYTES
from ..workbook import NumberCell, rows_of_sheets
from .cell import decimals_of, turn_signs
from .headers import Head, SheetColumn, columns_of, given_columns, head_of
from .kinds import SUMMARY, kind_of, without_unit
from .rows import SeveralBallsError, Sheet, SheetRows, trials_of
from .words import BODY, NOTE, bare

_TYPED = str.maketrans({
    "\u2212": "-", "\u00a0": " ", "\u2009": " ", "\u202f": " ", "\u3000": " ", "℃": "°C",
    "㎜": "mm", "㎝": "cm", "㎛": "µm", "㎲": "µs", "㎳": "ms",
    **{wide: chr(ord(wide) - 0xFEE0) for wide in map(chr, range(0xFF01, 0xFF5F))},
})  # fmt: skip
"""Signs of typesetters as they are typed: the minus, blanks that do not break, wide letters."""
_CODINGS = ("cp1250", "gb18030", "cp932", "mac_roman", "big5", "euc_jp")
"""Of old spreadsheets, beside Latin: Polish, Chinese, Japanese, of Macintosh, Taiwan, Unix."""
_RULER = re.compile(r"(?=.*(--|==|__))[-=_+|: ]+")
"""A line between headers and rows."""
# limit: lines by which encoding and separator are chosen [-]: headers, and numbers below them
_LINES = 100


def read_sheet(
    path: Path, columns: Sequence[str] = (), *, sheet: str = "", select: str = ""
) -> Sheet:
    """Read a laboratory's sheet: a workbook, or a text table in any usual encoding.

    Drop and rebound height give the restitution, the root of their ratio, and one in a column of
    its own counts where they do not; where it differs from them, that is told. A drop height or a
    ball that is written once for several rows holds for the rows below; several columns of one
    quantity are readings of one trial, their mean is taken. A column of trials names them where its
    entries differ; other texts become notes; a ball's diameter and mass that are the same in all
    rows are the striker's.

    `columns`, `HEADER=quantity unit` each, say what headers mean where they do not themselves;
    `sheet` takes the place of the first whose headers are understood; `select`, `COLUMN=VALUE`,
    picks rows. Refused where no row of headers is understood, or a column names no unit.
    """
    checked_file(path, most=TABLE_BYTES, allowed="a sheet")
    source, others, between, given = str(path), list[str](), "", given_columns(columns)
    if is_book(path):
        rows, head, others = _of_book(path, given, sheet)
    else:
        between, rows, head = _of_text(path.read_bytes(), source, given)
    if not any(map(any, rows)):
        raise InputError("empty", source=source, allowed="columns of numbers")
    for said in given:
        _place(head, said, source, "column")
    kept, told = columns_of(rows, head, source)
    _fill_balls(rows[head.end :], kept)
    told = _join_units(rows[head.end :], kept, told)
    if select:
        name, value = selection(select, source=source)
        place = _place(head, name, source, "select")
        picked = rows_with(value, [row[place] for row in rows[head.end :]], source=source)
        below = [row if k in picked else [""] * len(row) for k, row in enumerate(rows[head.end :])]
        rows = [*rows[: head.end], *below]
    # where commas part the cells, points part no thousands
    points = between == "," and not any("," in c for row in rows for c in row)
    decimals = decimals_of(rows[head.end :], kept, between) or "." * points
    turn_signs(rows[head.end :], kept, decimals)
    found = trials_of(SheetRows(rows, head.end, kept, decimals, source), told)
    return replace(found, left_out=(*found.left_out, *others))


def _fill_balls(rows: Sequence[list[str]], columns: Sequence[SheetColumn]) -> None:
    """Write a ball that stands once, merged or above, into the rows of numbers below it."""
    numbers = [c.place for c in columns if c.kind.quantity != "text" and c.kind.name not in BODY]
    for place in (c.place for c in columns if c.kind.name in ("ball", *BODY) and not c.spread):
        last = ""
        for row in rows:
            if row[place] and not SUMMARY.fullmatch(bare(row[place])):
                last = row[place]
            elif not row[place] and any(row[k] for k in numbers):
                row[place] = last


def _join_units(
    rows: Sequence[list[str]], columns: Sequence[SheetColumn], told: Sequence[tuple[str, str]]
) -> list[tuple[str, str]]:
    """Write a unit that stands in the next column, 50;cm, behind its number; tell what it became.

    `told` is what became of the columns that are not understood.
    """
    taken, joined = {column.place for column in columns}, dict[str, str]()
    for column in (c for c in columns if c.unit is None and c.place + 1 not in taken):
        place = column.place
        if all(is_unit(row[place + 1]) for row in rows if any(row[place + 1 : place + 2])):
            joined[f"column {place + 2}"] = f"units of {column.header!r}"
        for row in rows:
            number, *unit = row[place : place + 2]
            if number and any(map(is_unit, unit)):
                row[place] = type(number)(f"{number} {unit[0]}")
    return [(header, joined.get(header, became)) for header, became in told]


def read_balls(path: Path, columns: Sequence[str] = (), *, sheet: str = "") -> dict[str, Sheet]:
    """Read a laboratory's sheet by the names of its balls, "" for the only one.

    Refused, as `read_sheet` refuses it, where not every row says which it is of.
    """
    try:
        return {"": read_sheet(path, columns, sheet=sheet)}
    except SeveralBallsError as several:
        if not several.balls or not all(map(names_a_file, several.balls)):
            raise
        balls = several.balls.items()
    return {ball: read_sheet(path, columns, sheet=sheet, select=only) for ball, only in balls}


def _place(head: Head, name: str, source: str, key: str) -> int:
    """The column that has a header, with or without its unit."""
    for k, header in enumerate(head.headers):
        if header and bare(name) in (bare(header), bare(without_unit(header))):
            return k
    raise InputError(
        f"no header {name!r}", source=source, key=key, allowed=", ".join(filter(None, head.headers))
    )


def _of_book(
    path: Path, given: Mapping[str, str], sheet: str
) -> tuple[list[list[str]], Head, list[str]]:
    """Rows and headers of the sheet of a workbook, and a line for each of the others."""
    found = confined(rows_of_sheets, path, source=str(path))
    sheets = {k: _typed(rows) for k, rows in found.items() if any(map(any, rows))}
    if sheet and sheet not in sheets:
        raise InputError(
            f"no sheet {sheet!r}", source=str(path), key="sheet", allowed=", ".join(sheets)
        )
    heads = {k: head_of(rows, given) for k, rows in sheets.items() if sheet in ("", k)}
    known = [k for k, head in heads.items() if head.understood > 1]
    name = next(iter([*known, *heads]), "")
    others = [f"sheet {k!r}: left out; --sheet {k!r} takes it" for k in sheets if k != name]
    return sheets.get(name, []), heads.get(name, Head()), others


def _typed(rows: Sequence[Sequence[str]]) -> list[list[str]]:
    """Cells as they are typed, all rows as wide as the widest."""
    width = max(map(len, rows), default=0)
    return [
        [*(c if isinstance(c, NumberCell) else c.translate(_TYPED) for c in row),
         *[""] * (width - len(row))]
        for row in rows
    ]  # fmt: skip


def _of_text(
    raw: bytes, source: str, given: Mapping[str, str]
) -> tuple[str, list[list[str]], Head]:
    """Separator, cells and headers, as they are understood best.

    Units in the cells hide the separator from a guess by numbers; old encodings do not say which
    they are.
    """
    texts = [decoded(raw, source)]
    utf8 = raw.decode(errors="ignore").encode() == raw
    if not utf8 and not wide_coding(raw):
        texts += [raw.decode(coding, errors="replace") for coding in _CODINGS]
    each = [text.splitlines(keepends=True) for text in texts]
    every = [["\n" if _RULER.fullmatch(line.strip()) else line for line in one] for one in each]
    tried = [
        (lines, between, head_of(_typed(rows), given).known)
        for lines in every for one in ("", ";", "\t", ",", "|", WIDE)
        for between, rows in [cells_of(lines[:_LINES], source, separator=one)]
    ]  # fmt: skip
    # blanks part words too: where another separator shows numbers, it is that
    lines, between, _ = max(tried, key=lambda one: (one[1] != " " and one[2][1] > 1, one[2]))
    cells = cells_of(lines, source, separator=between)[1]
    head = head_of(rows := _typed(cells), given)
    if between == "," and head.headers:
        says = head.says[: max(map(len, cells[head.first : head.end]))]
        named = [text * (kind_of(text) is not NOTE) for text in says]
        refuse_torn(cells[head.end :], named, source)
    return between, rows, head
