"""Pictures of bounces that were timed: their intervals and their restitution."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ...core.output import figure
from ..pictures import save
from .times import BounceTimes


def draw_times(found: BounceTimes, path: Path) -> None:
    """Draw intervals and restitution of timed bounces."""
    made, axes = figure(1, 2, size=(11.0, 4.5))
    draw_bounces(axes[0], found)
    save(made, path)


def draw_bounces(axes: Any, found: BounceTimes) -> None:
    """Draw the intervals of the run, and restitution over impact speed, on two axes."""
    times, kept = found.chain.times, list(found.chain.kept)
    gaps, single = np.diff(times[kept]), np.array(found.chain.single)
    begins = times[kept[:-1]]
    axes[0].plot(begins[single], gaps[single], "o-", ms=4, label="one flight")
    axes[0].plot(begins[~single], gaps[~single], "s", mfc="none", label="a bounce missed")
    for k in np.setdiff1d(np.arange(times.size), kept):
        axes[0].axvline(times[k], color="0.7", lw=0.8, ls=":")
    axes[0].set(xlabel="time [s] (dotted: left out)", ylabel="interval [s]", yscale="log")
    axes[0].legend()
    speed, e, std = np.array([
        (b.approach.value, b.restitution.value, b.restitution.std) for b in found.bounces
    ]).T  # fmt: skip
    axes[1].errorbar(speed, e, yerr=2.0 * np.nan_to_num(std), fmt="o", ms=4, capsize=2)
    axes[1].set(xlabel="impact speed [m/s]", ylabel="restitution (bars: two standard deviations)")
