"""A table of what an instrument or a person wrote down, read, measured and drawn."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from ..reduced import Reduced
from .file import read_columns
from .options import TableOptions

_READ_BY = {
    "force": "force", "acceleration": "force", "height": "height", "bounces": "instants",
    "rebounds": "rebounds", "leeb": "leeb", "tension": "tension",
}  # fmt: skip
"""The module of what a table holds, loaded when one is read: some take longer than the file."""


def reduce(path: Path, options: TableOptions) -> Reduced:
    """Measure what a table holds."""
    if options.holds == "trials":
        from .sheet import read_sheet

        columns = options.column.split(";")
        return read_sheet(path, columns, sheet=options.sheet, select=options.select).reduced(path)
    table = read_columns(path, sheet=options.sheet)
    if options.select:
        table = table.select(options.select)
    module = import_module(f".{_READ_BY[options.holds]}", __package__)
    reduced: Reduced = module.reduce(path, table, options)
    return reduced
