"""The picture of a tracked clip: the striker's outline over frames, flights and residuals."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ...core.output import figure
from ..bounces.flights import Piece
from ..images.clip import Clip
from ..pictures import save
from .reduction import VideoReduction


def draw_video(result: VideoReduction, clip: Clip, path: Path) -> None:
    """Draw the tracked point over frames, its path with the fitted flights, and residuals."""
    made, axes = figure(2, 3, size=(14.0, 8.0))
    bounce = result.bounces[0]
    shown = [0, bounce.turning, result.frame.size - 1]
    for axis, index in zip(axes[0], shown, strict=True):
        number = int(result.frame[index])
        axis.imshow(clip.frames[number], cmap="gray", vmin=0, vmax=255, aspect="equal")
        axis.plot(result.column[: index + 1], result.row[: index + 1], "c-", lw=0.6)
        axis.plot(result.column[index], result.row[index], "r+", ms=12)
        _outline(axis, result, index)
        axis.set_title(f"frame {number}" + (" (lowest)" if index == bounce.turning else ""))
    time = 1e3 * result.time
    axes[1, 0].plot(time, -result.row, "k.", ms=2)
    for number, one in enumerate(result.bounces):
        for piece in (one.before, one.after):
            _flight(axes[1], result, piece, f"C{number % 8}")
        axes[1, 0].annotate(
            f"e = {one.restitution}", (time[one.turning], -result.row[one.turning]), (0, 8),
            textcoords="offset points", fontsize=7, rotation=90, va="bottom", ha="center",
        )  # fmt: skip
    axes[1, 0].set(xlabel="time [ms]", ylabel="height of the tip [pixel]")
    axes[1, 1].axhline(0.0, color="k", lw=0.5)
    axes[1, 1].set(
        xlabel="time [ms]", ylabel="residual of the flights [pixel]", title="crosses: left out"
    )
    if result.shape == "rod":
        axes[1, 2].plot(time, np.degrees(result.lean), "k.", ms=2)
        axes[1, 2].set(xlabel="time [ms]", ylabel="lean [deg]")
    else:
        axes[1, 2].plot(time, result.column, "k.", ms=2)
        axes[1, 2].set(xlabel="time [ms]", ylabel="column [pixel]")
    save(made, path)


def _flight(axes: Any, result: VideoReduction, piece: Piece, colour: str) -> None:
    """Draw a fitted flight, and how far the samples in it lie off."""
    part = np.arange(piece.first, piece.last + 1)
    span, out = result.time[part], np.isin(part, piece.index, invert=True)
    heights = result.found.heights(piece, span)
    residual = -result.row[part] - heights
    axes[0].plot(1e3 * span, heights, colour, lw=1.2)
    axes[1].plot(1e3 * span[~out], residual[~out], ".", color=colour, ms=3)
    axes[1].plot(1e3 * span[out], residual[out], "x", color="r", ms=4)


def _outline(axis: Any, result: VideoReduction, index: int) -> None:
    x, y = result.column[index], result.row[index]
    angle = np.linspace(-np.pi, np.pi, 200)
    if result.shape == "sphere":
        r = result.half_width.value
        axis.plot(x + r * np.cos(angle), y + r * np.sin(angle), "r-", lw=0.7)
        return
    half, radius, lean = result.half_width.value, result.tip_radius, result.lean[index]
    across = np.linspace(-half, half, 60)
    up = radius - np.sqrt(np.maximum(radius**2 - across**2, 0.0))
    across = np.concatenate([[-half], across, [half]])
    up = np.concatenate([[2.5 * half], up, [2.5 * half]])
    axis.plot(
        x + across * np.cos(lean) + up * np.sin(lean),
        y + across * np.sin(lean) - up * np.cos(lean), "r-", lw=0.7,
    )  # fmt: skip
