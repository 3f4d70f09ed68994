"""The picture of a sound: the record with its onsets, the intervals, the restitution."""

from __future__ import annotations

from pathlib import Path

from ...core.output import figure
from ..bounces.picture import draw_bounces
from ..bounces.times import BounceTimes
from ..pictures import save
from .file import Sound
from .onsets import Onsets


def draw_sound(sound: Sound, onsets: Onsets, found: BounceTimes, path: Path) -> None:
    """Draw the record with its onsets and how far each rises, intervals and restitution."""
    made, axes = figure(1, 3, size=(15.0, 4.5))
    step = max(1, sound.samples.size // 20000)
    n = sound.samples.size // step * step
    blocks = sound.samples[:n].reshape(-1, step)
    record = axes[0, 0]
    record.fill_between(sound.time[:n:step], blocks.min(axis=1), blocks.max(axis=1), lw=0.3)
    for k, (at, rise) in enumerate(zip(onsets.time, onsets.rise_db, strict=True)):
        used = k in found.chain.kept
        record.axvline(at, color="C3" if used else "0.6", lw=1.0, ls="-" if used else ":")
        record.annotate(f"{rise:.0f} dB", (at, 0.9), xycoords=("data", "axes fraction"),
                        fontsize=6, rotation=90, ha="right", va="top")  # fmt: skip
    record.set(xlabel="time [s]", ylabel="sound (red: contacts used, grey: left out)")
    draw_bounces(axes[0, 1:], found)
    save(made, path)
