"""Cells of a workbook: XLS, XLSX or ODS; read in a process of its own (`core.processes`)."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from html import unescape
from pathlib import Path
from typing import Any

from ...core.errors import InputError, missing_extra

_SHEET, _RELATION = re.compile(r"<sheet\b[^>]*>"), re.compile(r"<Relationship\b[^>]*>")
_ERROR = re.compile(
    r'<c\b[^>]*\br="([A-Z]+\d+)"[^>]*\bt="e"[^>]*>(?:(?!</c>).)*?<v>([^<]*)</v>', re.S
)


class NumberCell(str):
    """A cell that holds a number and no text: its point is none of thousands."""

    __slots__ = ()


def sheets_of(path: Path) -> tuple[str, ...]:
    """Return the names of a workbook's sheets."""
    with _opened(path) as book:
        return tuple(book.sheet_names)


def workbook_rows(path: Path, sheet: str) -> list[list[str]]:
    """Return the cells of a sheet as text, the first sheet by default."""
    with _opened(path) as book:
        by_name = {n.strip(): n for n in book.sheet_names}
        if sheet and sheet.strip() not in by_name:
            raise InputError(
                f"no sheet {sheet!r}", source=str(path), key="sheet", allowed=", ".join(by_name)
            )
        name = by_name.get(sheet.strip(), book.sheet_names[0])
        sheet_found = book.get_sheet_by_name(name)
        rows = [[_cell(cell) for cell in row] for row in sheet_found.to_python()]
    first_row, first_column = sheet_found.start or (0, 0)
    for (row, column), error in _errors(path).get(name, {}).items():
        if 0 <= row - first_row < len(rows) and column - first_column < len(rows[0]):
            rows[row - first_row][column - first_column] = error
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
        for (row, column), error in errors.items():
            if row < len(rows[name]) and column < len(rows[name][row]):
                rows[name][row][column] = error
    return rows


def _errors(path: Path) -> dict[str, dict[tuple[int, int], str]]:
    """Return the errors, as `#DIV/0!`, that cells of each sheet hold, by row and column from 0.

    The reader of workbooks leaves them empty. XLSX alone, for others keep them as text or not.
    """
    if path.suffix.lower() not in (".xlsx", ".xlsm"):
        return {}
    with zipfile.ZipFile(path) as packed:
        book = packed.read("xl/workbook.xml").decode("utf-8", "replace")
        relations = packed.read("xl/_rels/workbook.xml.rels").decode("utf-8", "replace")
        found = {}
        for sheet in _SHEET.findall(book):
            place = _attribute(sheet, "r:id")
            target = next(
                (_attribute(one, "Target") for one in _RELATION.findall(relations)
                 if _attribute(one, "Id") == place), "",
            )  # fmt: skip
            name = target.lstrip("/") if target.startswith("/") else f"xl/{target}"
            if name in packed.namelist():
                cells = packed.read(name).decode("utf-8", "replace")
                found[unescape(_attribute(sheet, "name"))] = {
                    _place(where): error for where, error in _ERROR.findall(cells)
                }
    return found


def _attribute(tag: str, name: str) -> str:
    found = re.search(rf'\b{name}="([^"]*)"', tag)
    return found[1] if found else ""


def _place(where: str) -> tuple[int, int]:
    """Row and column from 0 of a cell such as `B7`."""
    column = 0
    for letter in where.rstrip("0123456789"):
        column = 26 * column + ord(letter) - 64
    return int(where.lstrip("ABCDEFGHIJKLMNOPQRSTUVWXYZ")) - 1, column - 1


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    try:
        import python_calamine as calamine
    except ImportError:
        raise missing_extra("reading workbooks", "tables") from None
    try:
        yield calamine.CalamineWorkbook.from_path(str(path))
    except (calamine.CalamineError, OSError, IndexError, KeyError, zipfile.BadZipFile) as error:
        raise InputError(
            f"not a workbook that can be read ({error})", source=str(path),
            allowed="XLS, XLSX or ODS without a password",
        ) from None  # fmt: skip


def _typed(cell: object) -> str:
    if isinstance(cell, int | float) and not isinstance(cell, bool):
        return NumberCell(repr(cell).removesuffix(".0"))
    return _cell(cell)


def _cell(cell: object) -> str:
    return repr(cell) if isinstance(cell, int | float) else str(cell).strip()
