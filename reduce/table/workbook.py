"""Cells of a workbook: XLS, XLSX or ODS; read in a process of its own (`core.processes`)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...core.errors import InputError, missing_extra


def workbook_rows(path: Path, sheet: str) -> list[list[str]]:
    """Return the cells of a sheet as text, the first sheet by default.

    Raises
    ------
    InputError
        Not a workbook, or no such sheet.
    """
    try:
        import python_calamine as calamine
    except ImportError:
        raise missing_extra("reading workbooks", "tables") from None
    try:
        book: Any = calamine.CalamineWorkbook.from_path(str(path))
        names = book.sheet_names
        by_name = {n.strip(): n for n in names}
        if sheet and sheet.strip() not in by_name:
            raise InputError(
                f"no sheet {sheet!r}", source=str(path), key="sheet", allowed=", ".join(by_name)
            )
        rows = book.get_sheet_by_name(by_name.get(sheet.strip(), names[0])).to_python()
    except (calamine.CalamineError, OSError, IndexError) as error:
        raise InputError(
            f"not a workbook that can be read ({error})", source=str(path),
            allowed="XLS, XLSX or ODS without a password",
        ) from None  # fmt: skip
    return [[_cell(cell) for cell in row] for row in rows]


def _cell(cell: object) -> str:
    return repr(cell) if isinstance(cell, int | float) else str(cell).strip()
