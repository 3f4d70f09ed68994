"""Contacts in the track of a falling body: where its path turns, and the speeds on both sides.

Every flight is fitted from its contact outwards; all share one fall, one drag and one drift of the
scale. Speeds are read where two flights meet, or at both ends of a contact that the track resolves.
What lies between the last sample of a flight and the contact is bridged by gravity and drag, and
the error grows with it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...core.arrays import Array, Indices
from ...core.errors import InputError
from ..gates import Refused, is_restitution
from ..measured import Measured, propagate
from ..rules import RULES
from .fall import Ball
from .flights import Piece
from .joint import SHARED, Before, JointSolution, fit_together
from .scale import Scale, check_scale, floor_drift, frames_lost, scale_of
from .sides import Sides, joined, known_before, sides_of, true_contacts, usual_spread
from .touch import common_durations, likely_durations, samples_of, speeds, touch_of
from .track import Track, on_the_body, turning_points
from .view import Stage, View


@dataclass(frozen=True)
class Bounce:
    """One contact: velocities just before and after, in the track's unit of length per second."""

    time: Measured
    approach: Measured
    """Downward speed of the point at the contact."""
    rebound: Measured
    restitution: Measured
    height: Measured
    """At which the flights meet, above the stage's floor."""
    turning: int
    """Index of the lowest sample."""
    before: Piece
    after: Piece

    @property
    def near(self) -> tuple[int, int]:
        """Last sample of the flight before, and first one of the flight after the contact."""
        before, after = self.before.index, self.after.index
        return int(before[before < self.turning][-1]), int(after[after > self.turning][0])


@dataclass(frozen=True)
class Bounced:
    """The contacts of a track in the order of time, and what its flights share.

    Ranges and the likeliest shared unknowns; the acceleration at rest that the track itself shows,
    nan if it shows none [unit/s²]; the size of the unit.
    """

    bounces: tuple[Bounce, ...]
    stage: Stage
    view: View
    fall: Measured
    scale: Scale
    notes: tuple[str, ...]

    def heights(self, piece: Piece, time: Array) -> Array:
        """Return the heights of a flight as the camera sees them, (n,) [unit]."""
        return self.stage.seen(self.view, piece.launch, piece.reference, time)

    def row(self, k: int) -> dict[str, Measured]:
        """Return the columns of trials.csv that contact `k` tells: ratios alone without a scale."""
        bounce, row = self.bounces[k], {"restitution": self.bounces[k].restitution}
        if self.scale.known:
            row["impact_speed_m_s"] = bounce.approach.times(self.scale.metres)
            row["rebound_speed_m_s"] = bounce.rebound.times(self.scale.metres)
        return row

    def part(self, k: int) -> slice:
        """Return the samples from the contact before `k` to the one after it."""
        low = self.bounces[k - 1].turning if k > 0 else 0
        return slice(low, self.bounces[k + 1].turning if k + 1 < len(self.bounces) else None)

    def trace(self, k: int, time: Array, height: Array) -> dict[str, Array]:
        """Return time [s] and height [m] of these samples from contact `k`; {} without a scale."""
        if not self.scale.known:
            return {}
        bounce, part = self.bounces[k], self.part(k)
        touch = self.stage.floor + bounce.height.value
        return {
            "time_s": time[part] - bounce.time.value,
            "tip_height_m": (height[part] - touch) * self.scale.metres.value,
        }


def told_bounces(
    track: Track, ball: Ball, *, metres: Measured | None, contact: Measured | None = None,
    source: str, allowed: str,
) -> Bounced:  # fmt: skip
    """Return what `find_bounces` finds.

    Refuses a unit or a rate that contradicts gravity, with the values that would fit; a track
    without any restitution that is one, and without a contact between two flights.
    """
    found = find_bounces(track, ball, metres=metres, contact=contact)
    if found is not None:
        check_scale(found.scale, source=source)
        return _believed(found, source)
    # a fall that is not the stated one hides every flight
    alone = None if metres is None else find_bounces(track, ball, metres=None, contact=contact)
    if alone is not None:
        check_scale(scale_of(alone.fall, ball.fall(3.0).gravity, metres), source=source)
    raise InputError("no contact with flight before and after it", source=source, allowed=allowed)


def _believed(found: Bounced, source: str) -> Bounced:
    """Leave out contacts whose restitution is no number; refuse a track without any other."""
    kept = tuple(b for b in found.bounces if is_restitution(b.restitution))
    if kept == found.bounces:
        return found
    wrong = [b for b in found.bounces if b not in kept]
    said = ", ".join(f"{b.restitution} at {b.time.value:.4g} s" for b in wrong[:3])
    if not kept:
        raise Refused(
            f"no restitution is known: {said}", source=source,
            allowed="flights before and after a contact that tell one between 0 and 1",
        )  # fmt: skip
    notes = (*found.notes, f"left out, no restitution is known: {said}")
    return replace(found, bounces=kept, notes=notes)


def find_bounces(
    track: Track, ball: Ball, *, metres: Measured | None, contact: Measured | None = None
) -> Bounced | None:
    """Return every contact that has a usable flight on both sides, or None if there is none.

    `metres` is the size of the track's unit [m], if it is known otherwise than by the fall;
    `contact` the duration of a contact [s], if it is known.
    """
    chosen = on_the_body(track)
    body = replace(track, time=track.time[chosen], height=track.height[chosen])
    contacts = turning_points(body)
    if not contacts:
        return None
    floor = float(np.median(body.height[contacts]))
    stage = Stage(
        floor, max(float(body.height.max()) - floor, 1e-12), float(body.time[0]),
        float(np.ptp(body.time)),
    )  # fmt: skip
    sides = sides_of(body, contacts, stage, None)
    if usual_spread(sides) > RULES.same_flat * stage.reach:  # noise turns everywhere
        return None
    found = (
        _found_with(before, body, chosen, contacts, sides, stage, ball, metres, contact)
        for before in known_before(body, sides, ball, metres, stage)
    )
    # where a wrong drag is believed, flights are left out
    return max(filter(None, found), key=lambda one: len(one.bounces), default=None)


def _found_with(
    before: Before, body: Track, chosen: Indices, contacts: list[int], sides: Sides, stage: Stage,
    ball: Ball, metres: Measured | None, contact: Measured | None,
) -> Bounced | None:  # fmt: skip
    """Return what `find_bounces` finds with one belief of fall and drag."""
    view = View(before.fall.value, before.drag.value, 0.0, 0.0, 0.0)
    contacts, sides = true_contacts(body, contacts, stage, before, sides)
    for again in reversed(range(RULES.contact_rounds)):
        if not any(a and b for a, b in zip(sides[::2], sides[1::2], strict=True)):
            return None
        pieces, places = joined(sides)
        try:
            with np.errstate(over="raise", invalid="raise", divide="raise"):
                pieces, solutions = fit_together(body, pieces, stage, view, before)
        except (FloatingPointError, np.linalg.LinAlgError):  # no fall, no drag makes them flights
            return None
        view = solutions[0].view
        every = (
            _meeting(body, turning, stage, pieces, places[2 * k : 2 * k + 2], solutions)
            for k, turning in enumerate(contacts)
        )
        seen = [m for m in every if m is not None]
        possible = common_durations([
            likely_durations(body, stage, view, m.flights, m.numbers) for m in seen
        ])  # fmt: skip
        if again:
            moved = {
                m.turning: samples_of(body, stage, view, m.flights, m.turning, m.numbers, lasts)
                for m, lasts in zip(seen, possible, strict=True)
            }
            held = [moved.get(turning, (0, 0)) for turning in contacts]
            sides = sides_of(body, contacts, stage, view, held, [s is not None for s in sides])
    found = [
        _bounce(body, stage, solutions, meeting, contact, lasts)
        for meeting, lasts in zip(seen, possible, strict=True)
    ]
    bounces = _on_one_flat([b for b in found if b is not None], stage)
    if not bounces:
        return None
    return _whole(bounces, chosen, stage, view, solutions, before, ball, metres, body.step)


class _Meeting(NamedTuple):
    """Two flights that meet in a contact."""

    turning: int
    """Index of the lowest sample."""
    flights: tuple[Piece, Piece]
    unknowns: list[int]
    """Places of what they share, and of their launches, in a solution."""
    numbers: Array
    """What `speeds` gives where they meet."""
    gaps: tuple[float, float]
    """Times to the meeting from the last, and from it to the first sample of a flight [s]."""


def _meeting(
    body: Track, turning: int, stage: Stage, pieces: Sequence[Piece],
    place: Sequence[int | None], solutions: Sequence[JointSolution],
) -> _Meeting | None:  # fmt: skip
    b, a = place
    if b is None or a is None:
        return None
    before, after = pieces[b], pieces[a]
    last, first = _nearest(before, turning, -1), _nearest(after, turning, 1)
    if last is None or first is None:
        return None
    index = [*range(SHARED), *(SHARED + 2 * p + j for p in (b, a) for j in (0, 1))]
    references = before.reference, after.reference
    start = speeds(solutions[0].x[index], stage, references, float(body.time[turning]), (0.0, 0.0))
    gaps = float(start[0] - body.time[last]), float(body.time[first] - start[0])
    # a contact lies between its flights: where they meet elsewhere one of them is none
    there = min(gaps) >= -body.step
    return _Meeting(turning, (before, after), index, start, gaps) if there else None


def _bounce(
    body: Track, stage: Stage, solutions: Sequence[JointSolution], meeting: _Meeting,
    contact: Measured | None, likely: Array,
) -> Bounce | None:  # fmt: skip
    before, after = meeting.flights
    view, step, index = solutions[0].view, body.step, meeting.unknowns
    touch = touch_of(body, stage, view, meeting.flights, meeting.numbers, contact, likely)
    references, guess = (before.reference, after.reference), float(body.time[meeting.turning])

    def numbers(c: Array) -> Array:
        return speeds(c, stage, references, guess, touch.offsets)

    found = [
        (s.weight, propagate(numbers, s.x[index], s.covariance[np.ix_(index, index)]))
        for s in solutions if s.weight > 0.01
    ]  # fmt: skip
    time, approach, rebound, ratio, height = (
        _mixed([(w, values[k]) for w, values in found]) for k in range(5)
    )
    if not (approach.value > 0.0 and rebound.value > 0.0):
        return None
    fall = abs(solutions[0].view.fall)
    values = (approach.value, rebound.value)
    # drag works against gravity on the way down and with it on the way up
    falls = fall - view.drag * values[0] ** 2, fall + view.drag * values[1] ** 2
    late = [abs(f) * e for f, e in zip(falls, touch.errors, strict=True)]
    bridged = []
    for gap, piece, speed in zip(meeting.gaps, meeting.flights, values, strict=True):
        lasts = piece.duration(body.time)
        bridged.append(math.hypot(
            fall * RULES.uneven_fall * max(gap - 2.0 * step, 0.0), body.drift(speed * lasts) / lasts
        ))  # fmt: skip
    more = [math.hypot(e, g) for e, g in zip(late, bridged, strict=True)]
    both = touch.ratio_error(falls, *values)
    part = ratio.value * math.hypot(both, *(g / v for g, v in zip(bridged, values, strict=True)))
    # the flights meet below the flat where a contact takes time
    height = replace(height, value=height.value - touch.offsets[0] * approach.value)
    height = height.widened(sum(touch.errors) * ratio.value / (1.0 + ratio.value) * values[0])
    return Bounce(
        time, approach.widened(more[0]), rebound.widened(more[1]), ratio.widened(part),
        height, meeting.turning, before, after,
    )  # fmt: skip


def _on_one_flat(bounces: list[Bounce], stage: Stage) -> list[Bounce]:
    """Leave out contacts at another height than most: strays that turn, a hand."""
    if not bounces:
        return []
    level = float(np.median([b.height.value for b in bounces]))
    limit = RULES.same_flat * stage.reach
    return [b for b in bounces if abs(b.height.value - level) <= limit + 4.0 * b.height.std]


def _nearest(piece: Piece, turning: int, way: int) -> int | None:
    """Return the sample of a flight that is nearest to a contact on its side."""
    there = piece.index[piece.index * way > turning * way]
    return None if there.size == 0 else int(there[0] if way > 0 else there[-1])


def _mixed(values: Sequence[tuple[float, Measured]]) -> Measured:
    """Return mean and standard deviation of a mixture."""
    weight = sum(w for w, _ in values)
    mean = sum(w * v.value for w, v in values) / weight
    variance = sum(w * (v.std**2 + (v.value - mean) ** 2) for w, v in values) / weight
    return Measured(mean, math.sqrt(variance))


def _whole(
    bounces: list[Bounce], chosen: Indices, stage: Stage, view: View,
    solutions: Sequence[JointSolution], before: Before, ball: Ball,
    metres: Measured | None, step: float,
) -> Bounced:  # fmt: skip
    """Take the drift of the flat off the speeds, and find the scale."""
    fallen = solutions[0].view.fall
    bounces = _with_lost_frames(bounces, step, fallen)
    notes = []
    drift = floor_drift([(b.time, b.height) for b in bounces], fallen)
    if abs(drift.value) > 3.0 * drift.std:
        notes.append(f"the flat drifts by {drift} units/s through the picture: taken off")
    moved = []
    for b in bounces:
        approach = Measured(b.approach.value + drift.value, math.hypot(b.approach.std, drift.std))
        rebound = b.rebound.minus(drift)
        read = b.restitution.value * b.approach.value / b.rebound.value
        e = rebound.value / approach.value * read
        std = math.hypot(b.restitution.std, drift.std * (1.0 + e) / approach.value)
        moved.append(Bounce(
            b.time, approach, rebound, Measured(e, std), b.height, int(chosen[b.turning]),
            *(replace(piece, index=chosen[piece.index]) for piece in (b.before, b.after)),
        ))  # fmt: skip
    own = _mixed([
        (s.weight, Measured(s.view.fall, math.sqrt(s.covariance[0, 0]))) for s in solutions
    ])  # fmt: skip
    fall = _without(own, before.fall)
    scale = scale_of(fall, ball.fall(3.0).gravity, metres)
    return Bounced(tuple(moved), stage, view, fall, scale, (*notes, *scale.notes))


def _with_lost_frames(bounces: list[Bounce], step: float, fall: float) -> list[Bounce]:
    """Take out what a frame that is missing in a contact without a word does to it.

    The flight after it comes a frame early: both meet above the flat, and are read too late and too
    early by parts of the frame.
    """
    sums = [b.approach.value + b.rebound.value for b in bounces]
    rises = [
        step * b.approach.value * b.rebound.value / s for b, s in zip(bounces, sums, strict=True)
    ]
    lost = frames_lost([(b.time, b.height) for b in bounces], rises, fall)
    found = []
    for b, total, rise, part in zip(bounces, sums, rises, lost, strict=True):
        down, up = (fall * step * v.value / total for v in (b.rebound, b.approach))
        approach, rebound = b.approach.value + down, b.rebound.value + up
        change = rebound / approach * b.approach.value / b.rebound.value - 1.0
        found.append(replace(
            b, approach=_in_part(b.approach, down, part), rebound=_in_part(b.rebound, up, part),
            restitution=_in_part(b.restitution, change * b.restitution.value, part),
            height=_in_part(b.height, -rise, part),
        ))  # fmt: skip
    return found


def _in_part(value: Measured, more: float, part: float) -> Measured:
    """Return a value that is by `more` larger with a probability of `part`."""
    spread = math.sqrt(part * (1.0 - part)) * more
    return Measured(value.value + part * more, math.hypot(value.std, spread))


def _without(value: Measured, prior: Measured) -> Measured:
    """Return what the data alone say, where a normal prior took part."""
    information = 1.0 / value.std**2 - 1.0 / prior.std**2
    if not information > 0.01 / prior.std**2:
        return Measured(math.nan, math.nan)
    mean = (value.value / value.std**2 - prior.value / prior.std**2) / information
    return Measured(mean, 1.0 / math.sqrt(information))
