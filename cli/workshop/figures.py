"""`dentscope figures`: the thesis's figures redrawn from our own numbers."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def figures(
    chapter: Annotated[
        list[str] | None,
        typer.Option(help='1, 2, 3, "4 and 5" or outside; may be repeated. Default: all.'),
    ] = None,
    fields: Annotated[
        list[str] | None,
        typer.Option(help="Solve the stress field of 2.2, 2.3, 2.4 or 3.7 anew (minutes) first."),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder of the gallery.")] = Path("docs/gallery"),
) -> None:
    """Draw the gallery: a picture and a computed line for every figure."""
    from ...core.errors import InputError
    from ...studies.thesis.figures.fields import WANTED, solve_field
    from ...studies.thesis.figures.gallery import CHAPTERS, build

    for number in fields or ():
        if number not in WANTED:
            raise InputError(f"{number!r}", key="fields", allowed=", ".join(WANTED))
        typer.echo(f"written: {solve_field(number)}")

    chosen = chapter or list(CHAPTERS)
    root = Path(__file__).resolve().parents[2]
    for entry in build(out, chapters=chosen, root=root):
        typer.echo(f"{entry.number:>8}  {entry.title}: {entry.note}")
    typer.echo(f"written: {out / 'README.md'}")
