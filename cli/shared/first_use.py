"""What a command says before it compiles for a minute: once for each state of the source."""

from __future__ import annotations

import os
from pathlib import Path

import typer

_IMPACTS = "compiled._impacts-*.nbi"
"""Files of numba by which the compiled code of impacts is known."""


def tell_first_use() -> None:
    """Say on standard error that what impacts need is compiled first, if it is not there yet."""
    folder = Path(os.environ.get("NUMBA_CACHE_DIR", ""))
    if next(folder.rglob(_IMPACTS), None) is None:
        typer.echo(
            "first use: compiling, a minute or so; it is kept, and later commands start at once",
            err=True,
        )
