"""Figures that need no screen."""

from __future__ import annotations

import math
from typing import Any

from matplotlib.figure import Figure


def figure(rows: int, columns: int, *, size: tuple[float, float]) -> tuple[Figure, Any]:
    """Return a figure of some size [inch] and its axes (rows, columns)."""
    made = Figure(figsize=size, layout="constrained")
    return made, made.subplots(rows, columns, squeeze=False)


def panels(count: int) -> tuple[Figure, list[Any]]:
    """Return a figure of `count` panels and no empty one, two or three a row."""
    columns = 2 if count in (2, 4) else max(min(count, 3), 1)
    rows = max(math.ceil(count / columns), 1)
    made, axes = figure(rows, columns, size=(4.4 * columns, 3.6 * rows))
    for spare in axes.flat[count:]:
        spare.remove()
    return made, list(axes.flat[:count])
