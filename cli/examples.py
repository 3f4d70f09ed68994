"""`dentscope examples`: the example files that are installed with the package."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..core.output import write_file
from .shared.places import folder_option

FOLDER = Path(__file__).resolve().parents[1] / "examples"


def examples(
    to: Annotated[Path | None, folder_option("Folder to copy them into.", name="--to")] = None,
) -> None:
    """List the examples, or copy them to start from."""
    for path in sorted(p for p in FOLDER.iterdir() if p.is_file()):
        if to is None:
            about = "the same as a notebook"
            if path.suffix != ".ipynb":
                about = path.read_text(encoding="utf-8").splitlines()[0].strip('#" ')
            typer.echo(f"{path.name:28} {about}")
        else:
            typer.echo(f"written: {write_file(to / path.name, path.read_bytes())}")
