"""A table of heights against time: speeds before and after each contact."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ....core.errors import InputError
from ..flight import Bounce, Track, bounces, scale_from_fall
from ..measured import Array, Measured, Trial


@dataclass(frozen=True)
class HeightReduction:
    """Contacts in a track of heights; `scale` is metres in its unit, nan if unknown."""

    track: Track
    found: tuple[Bounce, ...]
    scale: Measured
    values: dict[str, Measured]
    trials: tuple[Trial, ...]
    notes: tuple[str, ...]


def reduce_heights(
    time: Array, height: Array, *, metres: float | None, std: float, gravity: float, source: str
) -> HeightReduction:
    """Fit the flights of a track and read the speeds where they meet.

    Parameters
    ----------
    time, height
        (n,): increasing [s], upwards [the table's unit].
    metres
        Size of that unit [m]; None takes it from the acceleration of the fall.
    std
        Standard deviation of a height that is believed at least [unit].
    gravity
        Acceleration of the fall [m/s²].
    source
        The file.

    Raises
    ------
    InputError
        No contact with flight on both sides.
    """
    track = Track(time, height, np.zeros_like(height), floor=std)
    known = None if metres is None else gravity / metres
    found = bounces(track, acceleration=known)
    if not found:
        raise InputError(
            "no contact with flight before and after it", source=source,
            allowed="heights of a body that falls, touches and rises (see --upwards, --first-s)",
        )  # fmt: skip
    notes = []
    scale = Measured(metres or math.nan, 0.0)
    if metres is None:
        scale, origin = scale_from_fall(found, gravity)
        if math.isfinite(scale.value):
            notes.append(f"unit of the heights {scale} m from {origin}")
        else:
            notes.append("no length scale: ratios only")
            found = bounces(track, acceleration=0.0)
    trials = tuple(_trial(track, found, k, scale, tuple(notes)) for k in range(len(found)))
    values: dict[str, Measured] = {}
    for trial in trials:
        label = f"{trial.label}_" if trial.label else ""
        values |= {label + name: v for name, v in trial.observables.items()}
    if metres is not None:
        free = bounces(track, acceleration=None)
        falls = [f.fitted_acceleration for b in free for f in (b.before, b.after)]
        longest = min((f for f in falls if f is not None), key=lambda f: f.std, default=None)
        if longest is not None:
            values["fall_acceleration_m_s2"] = longest.scaled(metres)
    return HeightReduction(track, tuple(found), scale, values, trials, tuple(notes))


def _trial(
    track: Track, found: list[Bounce], k: int, scale: Measured, notes: tuple[str, ...]
) -> Trial:
    bounce = found[k]
    row, trace = {"restitution": bounce.restitution}, {}
    if math.isfinite(scale.value):
        row["impact_speed_m_s"] = bounce.approach.times(scale)
        row["rebound_speed_m_s"] = bounce.rebound.times(scale)
        low = 0 if k == 0 else found[k - 1].turning
        high = track.time.size if k + 1 == len(found) else found[k + 1].turning
        touch = float(bounce.before.heights(np.array([bounce.time.value]))[0])
        trace = {
            "time_s": track.time[low:high] - bounce.time.value,
            "tip_height_m": (track.height[low:high] - touch) * scale.value,
        }
    return Trial(row, notes, trace=trace, label=f"bounce{k + 1}" if len(found) > 1 else "")
