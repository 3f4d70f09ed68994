"""Pictures of bounces that were timed: their intervals and their restitution."""

from __future__ import annotations

from typing import Any

import numpy as np

from .times import BounceTimes


def draw_intervals(axis: Any, found: BounceTimes) -> None:
    """Draw the intervals of the run over the time of their beginning."""
    times = found.chain.times
    kept = list(found.chain.kept)
    gaps = np.diff(times[kept])
    single = np.array(found.chain.single)
    axis.plot(times[kept[:-1]][single], gaps[single], "o-", ms=4, label="one flight")
    if not single.all():
        axis.plot(
            times[kept[:-1]][~single], gaps[~single], "s", mfc="none", label="a bounce missed"
        )
    left = np.setdiff1d(np.arange(times.size), kept)
    for k in left:
        axis.axvline(times[k], color="0.7", lw=0.8, ls=":")
    axis.set(xlabel="time [s] (dotted: left out)", ylabel="interval [s]", yscale="log")
    for which in (axis.yaxis.set_major_formatter, axis.yaxis.set_minor_formatter):
        which("{x:.3g}")
    axis.legend()
    axis.grid(alpha=0.3, which="both")


def draw_restitution(axis: Any, found: BounceTimes) -> None:
    """Draw restitution over impact speed with two standard deviations."""
    speed = np.array([b.approach.value for b in found.bounces])
    e = np.array([b.restitution.value for b in found.bounces])
    bar = 2.0 * np.nan_to_num([b.restitution.std for b in found.bounces])
    axis.errorbar(speed, e, yerr=bar, fmt="o", ms=4, capsize=2)
    axis.set(xlabel="impact speed [m/s]", ylabel="restitution (bars: two standard deviations)")
    axis.grid(alpha=0.3)
