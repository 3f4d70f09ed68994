"""The sound of a bouncing ball, read, timed and drawn."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..bounces.times import reduce_bounce_times
from ..gates import Refused
from ..measured import Measured
from ..reduced import Reduced
from ..rules import RULES
from .file import Sound, read_sound
from .onsets import find_onsets
from .options import SoundOptions
from .picture import draw_sound


def reduce(path: Path, options: SoundOptions) -> Reduced:
    """Time the contacts by their sound and return the restitution of each bounce."""
    sound = _part(read_sound(path), options)
    check_level(sound)
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
    values = found.values() | {
        "onset_std_s": Measured(float(np.median(found.time_std)), math.nan),
        "contacts_heard": Measured(float(onsets.time.size), math.nan),
    }
    return Reduced(
        source=path, values=values, trials=found.trials(), notes=found.notes,
        draw=lambda to: draw_sound(sound, onsets, found, to),
    )  # fmt: skip


def check_level(sound: Sound) -> None:
    """Refuse a recording that is at full scale between the contacts too: they fill less of it."""
    if sound.clipped > RULES.full_scale:
        raise Refused(
            f"{sound.clipped:.0%} of the samples are at full scale",
            source=sound.source, allowed="a recording that only contacts drive there: less gain",
        )  # fmt: skip


def _part(sound: Sound, options: SoundOptions) -> Sound:
    part = sound.samples[options.keeps(sound.time)]
    if part.size < 0.1 * sound.rate:
        raise InputError(
            f"{part.size / sound.rate:.3g} s of sound", source=sound.source, key="first_s",
            allowed="a part of 0.1 s or more",
        )  # fmt: skip
    return Sound(part, sound.rate, sound.clipped, sound.source)
