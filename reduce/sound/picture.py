"""The picture of bounces that were timed: the record, the intervals, the restitution."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ...core.output import figure
from ..bounces.picture import draw_intervals, draw_restitution
from ..bounces.times import BounceTimes
from ..pictures import save
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


def _record(axis: Any, sound: Sound, found: BounceTimes) -> None:
    step = max(1, sound.samples.size // 20000)
    n = sound.samples.size // step * step
    blocks = sound.samples[:n].reshape(-1, step)
    time = sound.time[:n:step]
    if step == 1:
        axis.plot(time, blocks[:, 0], lw=0.4)
    else:
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
    axis.plot(found.chain.times[kept], 1e3 * found.time_std[kept], "o", ms=4)
    axis.set(xlabel="time [s]", ylabel="standard deviation of the onset [ms]")
    axis.set_ylim(0.0, 1.3e3 * max(float(np.nan_to_num(found.time_std[kept]).max()), 1e-9))
    axis.grid(alpha=0.3)
