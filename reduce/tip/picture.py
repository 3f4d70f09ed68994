"""The picture of a tip: photograph with edge points and circle, and how far the edge is off it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...core.output import figure
from ..images.picture_file import Frame
from ..pictures import save
from .reduction import TipReduction


def draw_tip(result: TipReduction, picture: Frame, path: Path) -> None:
    """Draw the photograph with what was fitted, and the residuals along the arc."""
    made, axes = figure(1, 2, size=(13.0, 6.0))
    photo, plot = axes[0]
    photo.imshow(picture, cmap="gray", vmin=0, vmax=255)
    angle = np.linspace(-np.pi, np.pi, 400)
    radius = result.radius.value
    photo.plot(result.x + radius * np.sin(angle), result.y + radius * np.cos(angle), "c-", lw=0.7)
    used = result.used
    photo.plot(*result.edge[used].T, "r.", ms=2)
    photo.plot(*result.edge[~used].T, "yx", ms=4)
    for side in result.sides or ():
        rows = np.array([0.0, result.y])
        photo.plot(side[0] + side[1] * rows, rows, "m-", lw=0.7)
    photo.set(xlim=(0, picture.shape[1]), ylim=(picture.shape[0], 0))
    at = np.degrees(np.arctan2(result.edge[:, 0] - result.x, result.edge[:, 1] - result.y))
    plot.plot(at[used], result.residual[used], "k.", ms=3)
    shown = ~used & (np.abs(result.residual) < 5.0)
    plot.plot(at[shown], result.residual[shown], "rx", ms=4)
    plot.axhline(0.0, color="k", lw=0.5)
    plot.set(xlabel="angle from the middle of the tip [deg]", ylabel="outside the circle [pixel]")
    size = result.tip_radius
    known = np.isfinite(size.value)
    plot.set_title(f"tip radius {size.scaled(1e3)} mm" if known else f"radius {result.radius} px")
    save(made, path)
