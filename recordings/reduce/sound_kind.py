"""The sound of a bouncing ball, read, timed and drawn."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from pydantic import Field, model_validator

from ...core.errors import InputError
from .bounce_times import BounceOptions, reduce_bounce_times
from .measured import Measured
from .reduced import Reduced
from .sound_file import Sound, read_sound
from .sound_onsets import find_onsets
from .sound_picture import draw_sound


class Options(BounceOptions):
    """Options of the reduction of a sound."""

    first_s: float = Field(0.0, ge=0.0, description="beginning of the part to use")
    last_s: float | None = Field(None, gt=0.0, description="its end")
    least_rise_db: float = Field(
        12.0, gt=0.0, description="rise of the energy within a millisecond that counts as a contact"
    )
    least_interval_s: float = Field(
        0.02, gt=0.0, description="shortest time between two contacts; echoes come sooner"
    )
    lowest_hz: float = Field(300.0, gt=0.0, description="lower frequencies are taken out")

    @model_validator(mode="after")
    def _order(self) -> Options:
        if self.last_s is not None and self.last_s <= self.first_s:
            raise ValueError("last_s is later than first_s")
        return self


def reduce(path: Path, options: Options) -> Reduced:
    """Time the contacts by their sound and return the restitution of each bounce.

    Raises
    ------
    InputError
        The file cannot be decoded, or no run of bounces is heard.
    """
    sound = _part(read_sound(path), options)
    onsets = find_onsets(
        sound, least_rise_db=options.least_rise_db, least_interval=options.least_interval_s,
        lowest_hz=options.lowest_hz,
    )  # fmt: skip
    if onsets.time.size < 3:
        raise InputError(
            f"{onsets.time.size} contacts are heard", source=str(path),
            allowed="three or more (see --least-rise-db, --lowest-hz, --first-s, --last-s)",
        )  # fmt: skip
    found = reduce_bounce_times(onsets.time, options, std=onsets.std, source=str(path))
    notes = list(found.notes)
    if sound.clipped > 1e-3:
        notes.append(f"{100.0 * sound.clipped:.2g} % of the samples are at full scale")
    values = found.values() | {
        "onset_std_s": Measured(float(np.median(found.time_std)), math.nan),
        "contacts_heard": Measured(float(onsets.time.size), math.nan),
    }
    return Reduced(
        source=path, values=values, trials=found.trials(), notes=tuple(notes),
        draw=lambda to: draw_sound(sound, onsets, found, to),
    )  # fmt: skip


def _part(sound: Sound, options: Options) -> Sound:
    first = round(options.first_s * sound.rate)
    last = None if options.last_s is None else round(options.last_s * sound.rate)
    part = sound.samples[first:last]
    if part.size < 0.1 * sound.rate:
        raise InputError(
            f"{part.size / sound.rate:.3g} s of sound", source=sound.source, key="first_s",
            allowed="a part of 0.1 s or more",
        )  # fmt: skip
    return Sound(part, sound.rate, sound.clipped, sound.source)
