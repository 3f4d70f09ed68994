"""What commands print: tables that keep every character, whatever the width; first uses."""

from __future__ import annotations

import os
import shutil
import sys
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import typer

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

# limit: columns that a table takes to be there [-]: half a terminal
_NARROWEST = 40

_COMPILED = "compiled._impacts-*.nbi"  # files of numba by which compiled impacts are known


def new_console() -> Console:
    """Return a console for text in which square brackets are units, and no markup."""
    from rich.console import Console

    return Console(markup=False, highlight=False, emoji=False)


def show_table(
    to: Console, head: Sequence[str], rows: Sequence[Sequence[str]], *, title: str = "",
    align: Literal["left", "right"] = "right",
) -> None:  # fmt: skip
    """Print a table, in parts where the width does not hold all columns, the first one in each.

    The first column stands on the left; `align` is that of the others.
    """
    if title:
        to.print(title)
    for table in parts(head, rows, width=to.width, align=align):
        to.print(table)


def parts(
    head: Sequence[str], rows: Sequence[Sequence[str]], *, width: int,
    align: Literal["left", "right"] = "right",
) -> list[Table]:  # fmt: skip
    """Return tables of as many columns as the width holds, each with the first column."""
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    columns = zip(head, *rows, strict=True)
    size = [max(len(line) for cell in c for line in cell.split("\n")) + 2 for c in columns]
    room = max(width, _NARROWEST) - size[0] - 1
    tables: list[Table] = []
    left = list(range(1, len(head)))
    while left:
        taken: list[int] = []
        while left and (not taken or sum(size[k] for k in [*taken, left[0]]) <= room):
            taken.append(left.pop(0))
        table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0), highlight=False)
        table.add_column(head[0], overflow="fold")
        for k in taken:
            table.add_column(head[k], justify=align, overflow="fold")
        for row in rows:
            table.add_row(row[0], *(row[k] for k in taken))
        tables.append(table)
    return tables


def say(line: str) -> None:
    """Print a line of prose: wrapped between words on a terminal, whole in a file or a pipe."""
    if not sys.stdout.isatty() or len(line) <= _columns():
        typer.echo(line)
        return
    typer.echo(wrapped(line.strip(), indent=len(line) - len(line.lstrip()), further=2))


def _columns() -> int:
    return max(shutil.get_terminal_size().columns, _NARROWEST)


def wrapped(text: str, indent: int = 0, further: int = 0) -> str:
    """Return a text in lines of a terminal, all but the first indented by `further` more."""
    lines = textwrap.wrap(
        text, _columns(), initial_indent=" " * indent, subsequent_indent=" " * (indent + further),
        break_long_words=False, break_on_hyphens=False,
    )  # fmt: skip
    return "\n".join(lines)


def tell_first_use() -> None:
    """Say on standard error that what impacts need is compiled first, if it is not there yet."""
    folder = Path(os.environ.get("NUMBA_CACHE_DIR", ""))
    if next(folder.rglob(_COMPILED), None) is None:
        typer.echo(
            "first use: compiling, a minute or so; it is kept, and later commands start at once",
            err=True,
        )


def entry(name: str, text: str) -> None:
    """Print a name, and what is said of it indented below."""
    typer.echo(name)
    typer.echo(wrapped(f"{text.rstrip('.')}.", indent=4))
