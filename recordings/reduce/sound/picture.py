"""The picture of bounces that were timed: the record, the intervals, the restitution."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..bounce_times import BounceTimes
from ..pictures import figure, save
from .file import Sound
from .onsets import Onsets


def draw_sound(sound: Sound, onsets: Onsets, found: BounceTimes, path: Path) -> None:
    """Draw the record with its onsets, three onsets from near, intervals and restitution."""
    made, axes = figure(2, 3, size=(14.0, 7.5))
    grid = axes[0, 0].get_gridspec()
    for axis in axes[0, :2]:
        axis.remove()
    whole = made.add_subplot(grid[0, :2])
    _record(whole, sound, found)
    for rise, time in zip(onsets.rise_db, onsets.time, strict=True):
        whole.annotate(f"{rise:.0f} dB", (time, 0.9), xycoords=("data", "axes fraction"),
                       fontsize=6, rotation=90, ha="right", va="top")  # fmt: skip
    _near(axes[0, 2], sound, found)
    draw_intervals(axes[1, 0], found)
    draw_restitution(axes[1, 1], found)
    _picks(axes[1, 2], found)
    save(made, path)


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


def _record(axis: Any, sound: Sound, found: BounceTimes) -> None:
    step = max(1, sound.samples.size // 20000)
    n = sound.samples.size // step * step
    blocks = sound.samples[:n].reshape(-1, step)
    time = sound.time[:n:step]
    axis.fill_between(time, blocks.min(axis=1), blocks.max(axis=1), lw=0.3)
    times = found.chain.times
    for k, at in enumerate(times):
        used = k in found.chain.kept
        axis.axvline(at, color="C3" if used else "0.6", lw=1.0, ls="-" if used else ":")
    axis.set(xlabel="time [s]", ylabel="sound (red: contacts used, grey: left out)")


def _near(axis: Any, sound: Sound, found: BounceTimes) -> None:
    kept = found.chain.kept
    for row, k in enumerate((kept[0], kept[len(kept) // 2], kept[-1])):
        at = found.chain.times[k]
        near = np.abs(sound.time - at) < 4e-3
        part = sound.samples[near]
        axis.plot(1e3 * (sound.time[near] - at), part / np.abs(part).max() - 2.2 * row, lw=0.8)
    axis.axvline(0.0, color="C3", lw=1.0)
    axis.set(xlabel="time from the onset [ms]", yticks=[], ylabel="first, middle, last contact")


def _picks(axis: Any, found: BounceTimes) -> None:
    kept = list(found.chain.kept)
    axis.semilogy(found.chain.times[kept], 1e3 * found.time_std[kept], "o", ms=4)
    axis.set(xlabel="time [s]", ylabel="standard deviation of the onset [ms]")
    axis.grid(alpha=0.3, which="both")
