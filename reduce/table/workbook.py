"""Cells of a workbook: XLS, XLSX or ODS; read in a process of its own (`core.processes`)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ...core.errors import InputError, missing_extra


class NumberCell(str):
    """A cell that holds a number and no text: its point is none of thousands."""

    __slots__ = ()


def sheets_of(path: Path) -> tuple[str, ...]:
    """Return the names of a workbook's sheets.

    Raises
    ------
    InputError
        Not a workbook.
    """
    with _opened(path) as book:
        return tuple(book.sheet_names)


def workbook_rows(path: Path, sheet: str) -> list[list[str]]:
    """Return the cells of a sheet as text, the first sheet by default.

    Raises
    ------
    InputError
        Not a workbook, or no such sheet.
    """
    with _opened(path) as book:
        by_name = {n.strip(): n for n in book.sheet_names}
        if sheet and sheet.strip() not in by_name:
            raise InputError(
                f"no sheet {sheet!r}", source=str(path), key="sheet", allowed=", ".join(by_name)
            )
        name = by_name.get(sheet.strip(), book.sheet_names[0])
        rows = book.get_sheet_by_name(name).to_python()
    return [[_cell(cell) for cell in row] for row in rows]


def rows_of_sheets(path: Path) -> dict[str, list[list[str]]]:
    """Return the cells of every sheet as text, counted from its first row and column.

    Raises
    ------
    InputError
        Not a workbook.
    """
    with _opened(path) as book:
        found = {n: book.get_sheet_by_name(n) for n in book.sheet_names}
        rows = {n: sheet.to_python(skip_empty_area=False) for n, sheet in found.items()}
    return {n: [[_typed(cell) for cell in row] for row in each] for n, each in rows.items()}


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    try:
        import python_calamine as calamine
    except ImportError:
        raise missing_extra("reading workbooks", "tables") from None
    try:
        yield calamine.CalamineWorkbook.from_path(str(path))
    except (calamine.CalamineError, OSError, IndexError) as error:
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
