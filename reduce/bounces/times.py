"""Restitution from the times at which a ball touches the flat, again and again.

Between two contacts the ball flies up and falls back. The time of that flight gives the speeds at
both of its ends, exactly v = gT/2 in a vacuum and with quadratic drag otherwise; a bounce between
two flights has then an approach and a rebound speed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtr, stdtrit

from ...core.arrays import Array
from ...core.errors import InputError
from ..gates import Refused
from ..measured import Measured, Trial, labelled
from ..rules import RULES
from .chain import Chain, chain_of
from .options import BounceOptions


@dataclass(frozen=True)
class BouncedTimes:
    """One bounce: which contact it was, and its speeds [m/s]."""

    number: int
    time: float
    approach: Measured
    rebound: Measured
    restitution: Measured


@dataclass(frozen=True)
class BounceTimes:
    """Contacts that hang together, and the bounces between known flights, in the order of time.

    `time_std` (n,) is the standard deviation of a contact's time [s].
    """

    chain: Chain
    time_std: Array
    bounces: tuple[BouncedTimes, ...]
    notes: tuple[str, ...]

    def trials(self) -> tuple[Trial, ...]:
        """Return a row of trials.csv for each bounce."""
        several = len(self.bounces) > 1
        return tuple(
            Trial({"impact_speed_m_s": b.approach, "restitution": b.restitution},
                  label=f"bounce{b.number}" if several else "")
            for b in self.bounces
        )  # fmt: skip

    def values(self) -> dict[str, Measured]:
        """Return the numbers of every bounce by name."""
        return labelled((trial.label, trial.observables) for trial in self.trials())


def reduce_bounce_times(
    times: Array, options: BounceOptions, *, std: Array | None, source: str
) -> BounceTimes:
    """Return the bounces behind a list of instants of contact.

    - `times`: (n,), increasing: beginning of each contact [s]; missed and false ones are allowed.
    - `std`: (n,) standard deviations of the times [s]; None takes them from the scatter of the
      intervals about a smooth course, which is part of them in any case.

    Raises `InputError`: no three instants hang together, or none of them follow each other.
    """
    chain = chain_of(times)
    if chain is None:
        raise InputError(
            "no run of bounces: three or more instants whose intervals shrink by a steady factor",
            source=source, allowed="the times of successive bounces",
        )  # fmt: skip
    notes = list(chain.notes)
    scatter = chain.scatter()
    if std is None:
        if math.isnan(scatter):
            notes.append("too few bounces to tell how well the instants are known")
        else:
            if chain.free < 3:  # one or two hardly tell their own scatter (Student)
                scatter *= 0.5 * float(stdtrit(chain.free, ndtr(2.0)))
            notes.append(f"instants ± {1e3 * scatter:.2g} ms by the scatter of the intervals")
        std = np.full(times.size, scatter)
    elif scatter > float(np.median(std)):
        # an instant may be heard to a microsecond: what is timed is not as steady
        notes.append(
            f"the intervals scatter by {1e3 * scatter:.2g} ms about a smooth course: that is the "
            "error of an instant"
        )
        std = np.maximum(std, scatter)
    notes += options.left_out
    bounces = _bounces(times, std, chain, options, source)
    if not bounces:
        raise InputError(
            "no bounce with a recorded flight on both sides", source=source,
            allowed="three successive contacts or more, or release_height_m and the first two",
        )  # fmt: skip
    if options.contact_time_s == 0.0:
        notes.append("a contact counts as flight, the errors hold that: contact_time_s = 0")
        bounces = tuple(_unsure_contact(b, options.gravity_m_s2) for b in bounces)
    notes += _asked_back(bounces, options)
    gained = [b for b in bounces if b.restitution.value > 1.0 + 3.0 * b.restitution.std]
    if gained:
        raise InputError(
            f"contact {gained[0].number} gives {gained[0].restitution} of the speed back",
            source=source, allowed="bounces of a ball that falls freely: none gains speed",
        )  # fmt: skip
    if not chain.shrinks(std):
        raise Refused(
            "the intervals do not shrink beyond their scatter", source=source,
            allowed="bounces of a ball, each flight shorter than the one before: taps do not",
        )  # fmt: skip
    return BounceTimes(chain, std, bounces, tuple(notes))


def _bounces(
    times: Array, spread: Array, chain: Chain, options: BounceOptions, source: str
) -> tuple[BouncedTimes, ...]:
    found = []
    kept, single = chain.kept, chain.single
    gaps = np.diff(times[list(kept)])
    flights = gaps - options.contact_time_s
    if (flights <= 0.0).any():
        raise InputError(
            f"{options.contact_time_s:g} s, and an interval of {gaps.min():.3g} s",
            source=source, key="contact_time_s", allowed="less than every interval",
        )  # fmt: skip
    if options.release_height_m is not None and kept[0] == 0 and single[0]:
        height = Measured(options.release_height_m, options.release_height_m_std)
        vacuum = math.sqrt(2.0 * options.gravity_m_s2 * height.value)
        speed = options.fall_of(vacuum).speed(height.value)
        approach = Measured(speed, 0.5 * speed * height.std / height.value)
        after = options.fall_of(0.5 * options.gravity_m_s2 * flights[0])
        error = 0.5 * after.gravity * math.hypot(spread[0], spread[kept[1]])
        rebound = Measured(after.launch(flights[0]), error)
        found.append(BouncedTimes(1, float(times[0]), approach, rebound, rebound.over(approach)))
    found += [
        _between(times, spread, kept[k - 1 : k + 2], flights[k - 1 : k + 1], options)
        for k in range(1, len(kept) - 1)
        if single[k - 1] and single[k]
    ]
    return tuple(found)


def _asked_back(bounces: Sequence[BouncedTimes], options: BounceOptions) -> list[str]:
    """Ask back a height from which the first bounce is unlike the second, which needs none."""
    if bounces[0].number > 1 or len(bounces) < 2:
        return []
    first, second = (b.restitution.value for b in bounces[:2])
    if abs(math.log(first / second)) < RULES.sudden:
        return []
    fits = 0.5 * (bounces[0].rebound.value / second) ** 2 / options.gravity_m_s2
    return [
        f"the first bounce gives {first:.3g} of the speed back, the next {second:.3g}: is "
        f"release_height_m {options.release_height_m:g}? {fits:.2g} would fit"
    ]


def _unsure_contact(bounce: BouncedTimes, gravity: float) -> BouncedTimes:
    """Return a bounce with the error of a contact that is not known, which shortens both flights.

    Its root mean square where any order of magnitude is as likely.
    """
    low, high = RULES.shortest_contact, RULES.hard_contact
    slower = 0.5 * gravity * math.sqrt((high**2 - low**2) / (2.0 * math.log(high / low)))
    e = bounce.restitution
    part = slower / bounce.rebound.value - slower / bounce.approach.value
    return replace(
        bounce, approach=bounce.approach.widened(slower), rebound=bounce.rebound.widened(slower),
        restitution=e.widened(e.value * part),
    )  # fmt: skip


def _between(
    times: Array, spread: Array, three: Sequence[int], flights: Array, options: BounceOptions
) -> BouncedTimes:
    before, after = float(flights[0]), float(flights[1])
    down, up = (options.fall_of(0.5 * options.gravity_m_s2 * t) for t in (before, after))
    approach, rebound = down.landing(down.launch(before)), up.launch(after)
    ratio = rebound / approach
    # the middle instant lengthens one flight and shortens the other
    part = np.array([1.0 / before, 1.0 / before + 1.0 / after, 1.0 / after])
    sigma = spread[list(three)]
    half = 0.5 * down.gravity
    return BouncedTimes(
        three[1] + 1, float(times[three[1]]),
        Measured(approach, half * math.hypot(sigma[0], sigma[1])),
        Measured(rebound, half * math.hypot(sigma[1], sigma[2])),
        Measured(ratio, ratio * float(np.linalg.norm(part * sigma))),
    )  # fmt: skip
