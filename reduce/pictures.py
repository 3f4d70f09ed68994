"""Pictures to check a reduction by eye: PNG files, drawn without a screen."""

from __future__ import annotations

from pathlib import Path
from textwrap import wrap

from matplotlib.figure import Figure

from ..core.arrays import Array
from ..core.output import figure, write_figure


def save(made: Figure, path: Path) -> None:
    """Write the picture, making its folder."""
    write_figure(made, path, dpi=110)


def draw_refused(x: Array, y: Array, path: Path, reason: str, *, axes: tuple[str, str]) -> None:
    """Draw a record that gave no number, the reason above it."""
    made, grid = figure(1, 1, size=(10.0, 5.0))
    grid[0, 0].plot(x, y, lw=0.7, marker=".", ms=2)
    grid[0, 0].set(xlabel=axes[0], ylabel=axes[1])
    grid[0, 0].set_title("\n".join(wrap(f"no number: {reason}", 90)), fontsize=9, color="C3")
    grid[0, 0].grid(alpha=0.3)
    save(made, path)
