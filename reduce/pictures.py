"""Pictures to check a reduction by eye: PNG files, drawn without a screen."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ..core.output import write_figure


def figure(rows: int, columns: int, *, size: tuple[float, float]) -> tuple[Figure, Any]:
    """Return a figure that needs no screen, and its axes (rows, columns)."""
    made = Figure(figsize=size, layout="constrained")
    FigureCanvasAgg(made)
    return made, made.subplots(rows, columns, squeeze=False)


def save(made: Figure, path: Path) -> None:
    """Write the picture, making its folder."""
    write_figure(made, path, dpi=110)
