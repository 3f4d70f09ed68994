"""A table of heights against time: speeds before and after each contact."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...core.arrays import Array
from ..bounces.bounce import Bounced
from ..bounces.contacts import told_bounces
from ..bounces.fall import Ball
from ..bounces.track import Track
from ..measured import Measured, Trial, labelled, labels


@dataclass(frozen=True)
class HeightReduction:
    """Contacts in a track of heights, and the rows that they make."""

    track: Track
    found: Bounced
    values: dict[str, Measured]
    trials: tuple[Trial, ...]


def reduce_heights(
    time: Array,
    height: Array,
    *,
    metres: float | None,
    std: float,
    ball: Ball,
    source: str,
    contact: Measured | None = None,
) -> HeightReduction:
    """Fit the flights of a track and read the speeds at its contacts.

    Parameters
    ----------
    time, height
        (n,): increasing [s], upwards [the table's unit].
    metres
        Size of that unit [m]; None takes it from the acceleration of the fall.
    std
        Standard deviation of a height that is believed at least [unit].
    ball
        Gravity, and the drag as far as it is known.
    contact
        Duration of a contact [s], if it is known.
    source
        The file.

    Raises
    ------
    InputError
        No contact with flight on both sides, or no fall by gravity.
    """
    track = Track(time, height, floor=std)
    scale = None if metres is None else Measured(metres, 0.0)
    found = told_bounces(
        track, ball, metres=scale, contact=contact, source=source,
        allowed="heights of a body that falls, touches and rises (see --upwards, --first-s)",
    )  # fmt: skip
    trials = tuple(
        Trial(found.row(k), found.notes, trace=found.trace(k, time, height), label=label)
        for k, label in enumerate(labels(len(found.bounces)))
    )
    values = labelled((trial.label, trial.observables) for trial in trials)
    if metres is None and found.scale.known:
        values["unit_m"] = found.scale.metres
    if metres is not None and math.isfinite(found.fall.value):
        values["fall_acceleration_m_s2"] = found.fall.scaled(metres)
    return HeightReduction(track, found, values, trials)
