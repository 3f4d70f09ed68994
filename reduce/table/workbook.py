"""Cells of a workbook: XLS, XLSX or ODS; read in a process of its own (`core.processes`)."""

from __future__ import annotations

import posixpath
import re
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from string import ascii_uppercase
from typing import Any
from xml.etree import ElementTree

from ...core.errors import InputError, optional, reading

_UNCOUNTED = "formula without a stored number"


class NumberCell(str):
    """A cell that holds a number and no text: its point is none of thousands."""

    __slots__ = ()


def sheets_of(path: Path) -> tuple[str, ...]:
    """Return the names of a workbook's sheets; refuse what is none."""
    with _opened(path) as book:
        return tuple(book.sheet_names)


def workbook_rows(path: Path, sheet: str) -> list[list[str]]:
    """Return the cells of a sheet as text, the first by default; refuse what has no such sheet."""
    with _opened(path) as book:
        by_name = {n.strip(): n for n in book.sheet_names}
        if sheet and sheet.strip() not in by_name:
            raise InputError(
                f"no sheet {sheet!r}", source=str(path), key="sheet", allowed=", ".join(by_name)
            )
        name = by_name.get(sheet.strip(), book.sheet_names[0])
        found = book.get_sheet_by_name(name)
        rows = [[_cell(cell) for cell in row] for row in found.to_python()]
        _put_errors(rows, _errors(path).get(name, {}), found.start or (0, 0))
    return rows


def rows_of_sheets(path: Path) -> dict[str, list[list[str]]]:
    """Return the cells of every sheet as text, counted from its first row and column."""
    with _opened(path) as book:
        found = {n: book.get_sheet_by_name(n) for n in book.sheet_names}
        rows = {
            n: [[_typed(cell) for cell in row] for row in sheet.to_python(skip_empty_area=False)]
            for n, sheet in found.items()
        }
        for name, errors in _errors(path).items():
            _put_errors(rows.get(name, []), errors, (0, 0))
        for name, sheet in found.items():
            for (top, left), (_, right) in sheet.merged_cell_ranges or ():
                _spread(rows[name], top, left, right)
    return rows


def _spread(rows: list[list[str]], top: int, left: int, right: int) -> None:
    """Write the words of merged cells into each cell of their first row."""
    row = rows[top] if top < len(rows) else []
    if left < len(row) and not isinstance(row[left], NumberCell):
        row[left : right + 1] = [row[left]] * len(row[left : right + 1])


def _put_errors(
    rows: list[list[str]], errors: dict[tuple[int, int], str], start: tuple[int, int]
) -> None:
    for (row, column), error in errors.items():
        k, j = row - start[0], column - start[1]
        if 0 <= k < len(rows) and 0 <= j < len(rows[k]):
            rows[k][j] = error


def _errors(path: Path) -> dict[str, dict[tuple[int, int], str]]:
    """Return the errors, as `#DIV/0!`, that cells of each sheet hold, by row and column from 0.

    And the formulas whose number was not stored. The reader of workbooks leaves both empty in XLSX;
    ODS is another archive, XLS is none.
    """
    if not zipfile.is_zipfile(path):
        return {}
    found = {}
    with zipfile.ZipFile(path) as packed:
        if "xl/workbook.xml" not in packed.namelist():
            return {}
        book, relations = (
            ElementTree.fromstring(packed.read(f"xl/{name}"))
            for name in ("workbook.xml", "_rels/workbook.xml.rels")
        )
        targets = {one.get("Id"): one.get("Target", "") for one in relations}
        for sheet in book.iterfind(".//{*}sheet"):
            key = next((value for name, value in sheet.items() if name.endswith("}id")), "")
            cells = packed.read(posixpath.normpath(posixpath.join("/xl", targets[key]))[1:])
            if b't="e"' in cells or b"<f" in cells:  # the quick look spares most the slow one
                found[sheet.get("name", "")] = {
                    _place(cell.get("r", "")): cell.findtext("{*}v") or _UNCOUNTED
                    for cell in ElementTree.fromstring(cells).iterfind(".//{*}c")
                    if cell.get("t") == "e"
                    or (
                        cell.find("{*}f") is not None
                        and not cell.findtext("{*}v")
                        and cell.get("t") != "str"
                    )
                }
    return found


def _place(where: str) -> tuple[int, int]:
    """Row and column from 0 of a cell such as `B7`; before all others for what is none."""
    named = re.fullmatch(r"([A-Z]+)(\d+)", where)
    if named is None:
        return -1, -1
    column = 0
    for letter in named[1]:
        column = 26 * column + ascii_uppercase.index(letter) + 1
    return int(named[2]) - 1, column - 1


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    calamine = optional("python_calamine", "reading workbooks", "tables")
    damaged = (calamine.CalamineError, zipfile.BadZipFile, ElementTree.ParseError)
    allowed, failed = "XLS, XLSX or ODS without a password", "not a workbook that can be read"
    with reading(path, allowed, failed, raised=(*damaged, OSError, LookupError)):
        yield calamine.CalamineWorkbook.from_path(str(path))


def _typed(cell: object) -> str:
    if isinstance(cell, int | float) and not isinstance(cell, bool):
        return NumberCell(repr(cell).removesuffix(".0"))
    return _cell(cell)


def _cell(cell: object) -> str:
    return repr(cell) if isinstance(cell, int | float) else str(cell).strip()
