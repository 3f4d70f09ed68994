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
    out: Annotated[Path, typer.Option(help="Folder of the gallery.")] = Path("docs/gallery"),
) -> None:
    """Draw the gallery: a picture and a computed line for every figure."""
    from ..figures.gallery import CHAPTERS, build

    chosen = chapter or list(CHAPTERS)
    root = Path(__file__).resolve().parents[1]
    out.mkdir(parents=True, exist_ok=True)
    for picture in build(out, chapters=chosen, root=root):
        typer.echo(f"{picture.number:>8}  {picture.title}: {picture.note}")
    typer.echo(f"written: {out / 'README.md'}")
