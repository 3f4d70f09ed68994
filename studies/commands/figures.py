"""`dentscope figures`: the thesis's figures redrawn from our own numbers."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ...cli.shared.places import folder_option, one_of
from ..thesis.figures.names import CHAPTERS, FIELDS


def figures(
    chapter: Annotated[
        list[str] | None,
        typer.Option(help='1, 2, 3 or "4 and 5"; may be repeated. Default: all.'),
    ] = None,
    fields: Annotated[
        list[str] | None,
        typer.Option(help="Solve the stress field of 2.2, 2.3, 2.4 or 3.7 anew (minutes) first."),
    ] = None,
    out: Annotated[Path, folder_option("Folder of the pages.")] = Path("docs/thesis"),
) -> None:
    """Draw the thesis again: a picture and a computed line for every figure."""
    chosen = [one_of(name, CHAPTERS, key="--chapter") for name in chapter or CHAPTERS]
    numbers = [one_of(number, FIELDS, key="--fields") for number in fields or ()]
    from ..thesis.figures.fields import solve_field
    from ..thesis.figures.gallery import build

    for number in numbers:
        typer.echo(f"written: {solve_field(number)}")
    root = Path(__file__).resolve().parents[2]
    for entry in build(out, chapters=chosen, root=root):
        typer.echo(f"{entry.number:>8}  {entry.title}: {entry.note}")
    typer.echo(f"written: {out / 'README.md'}")
