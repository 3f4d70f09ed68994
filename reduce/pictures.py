"""Pictures to check a reduction by eye: PNG files, drawn without a screen."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from textwrap import wrap

from matplotlib.figure import Figure

from ..core.arrays import Array
from ..core.output import figure, write_figure
from .gates import Refused


def save(made: Figure, path: Path) -> None:
    """Write the picture, a grid behind its curves, making its folder."""
    for axis in made.axes:
        if not axis.images and axis.get_label() != "<colorbar>":
            axis.grid(alpha=0.3)
    write_figure(made, path, dpi=110)


@contextmanager
def drawn_if_refused(x: Array, y: Array, *, axes: tuple[str, str]) -> Iterator[None]:
    """Give a refusal from within the picture of the record, (n,) each, the reason above it."""

    def draw(reason: str, path: Path) -> None:
        made, grid = figure(1, 1, size=(10.0, 5.0))
        grid[0, 0].plot(x, y, lw=0.7, marker=".", ms=2)
        grid[0, 0].set(xlabel=axes[0], ylabel=axes[1])
        grid[0, 0].set_title("\n".join(wrap(f"no number: {reason}", 90)), fontsize=9, color="C3")
        save(made, path)

    try:
        yield
    except Refused as refused:
        refused.draw = partial(draw, refused.message)
        raise
