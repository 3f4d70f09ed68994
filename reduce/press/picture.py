"""The picture of a press: the curve with its zero and its end, and the slopes of unloading."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...core.output import figure
from ..measured import Measured
from ..pictures import save
from .reduction import PressReduction


def draw_press(found: PressReduction, path: Path) -> None:
    """Draw load over depth with where contact begins and ends, and what tells the stiffness."""
    made, axes = figure(1, 2, size=(12.0, 4.8))
    size, unit = (1e9, "nm") if np.ptp(found.depth) < 3e-6 else (1e6, "um")
    load_size, load_unit = (1e3, "mN") if found.largest.load.value < 1.0 else (1.0, "N")
    h, p = size * (found.depth - found.zero.value), load_size * found.record.load
    largest = found.largest
    curve = axes[0, 0]
    curve.plot(h, p, "k-", lw=0.7)
    for at, color, label in (
        (Measured(0.0, found.zero.std), "C0", "contact begins"),
        (largest.left, "C3", "stays"),
        (largest.deepest, "C2", "under load"),
    ):
        curve.axvline(size * at.value, color=color, lw=1.0, label=f"{label}: {at.scaled(size)}")
        low, high = (size * (at.value + side * at.std) for side in (-2.0, 2.0))
        curve.axvspan(low, high, color=color, alpha=0.15)
    machine = "machine taken off" if found.compliance is not None else "with the machine's own"
    curve.set(xlabel=f"depth [{unit}], {machine}", ylabel=f"load [{load_unit}]")
    curve.legend(fontsize=8, loc="upper left")
    slopes = axes[0, 1]
    for k, press in enumerate(found.presses):
        rows = press.cycle.unloading
        slopes.plot(
            h[rows] - size * press.deepest.value, p[rows] / (load_size * press.load.value),
            color=f"C{k % 8}", lw=1.0,
        )  # fmt: skip
    if largest.stiffness.value > 0.0:
        back = np.array([0.0, -largest.load.value / largest.stiffness.value])
        slopes.plot(size * back, [1.0, 0.0], "k--", lw=1.0, label=f"{largest.stiffness} N/m")
        slopes.legend(fontsize=8, loc="upper left")
    slopes.set(xlabel=f"depth less that under load [{unit}]", ylabel="load in the largest")
    save(made, path)
