"""A contact between two flights: where they meet, how long it lasts, the speeds at its ends."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...core.arrays import Array, Indices
from ..measured import Measured
from ..rules import RULES
from .flights import Piece
from .joint import SHARED
from .track import Track
from .view import Launch, Stage, View

LASTS: Array = np.geomspace(RULES.shortest_contact, RULES.longest_contact, 130)
"""Durations that are tried of a contact that the samples do not resolve [s]."""


class Touch(NamedTuple):
    """Beginning and end of a contact after its flights meet, and their errors [s].

    `whole` where both errors are that of one duration, which moves both ends apart.
    """

    offsets: tuple[float, float]
    errors: tuple[float, float]
    whole: bool

    def ratio_error(self, falls: Sequence[float], approach: float, rebound: float) -> float:
        """Return the relative error of the restitution: both speeds fall with the duration."""
        parts = falls[0] * self.errors[0] / approach, falls[1] * self.errors[1] / rebound
        return abs(parts[1] - parts[0]) if self.whole else math.hypot(*parts)


def touch_of(
    track: Track, stage: Stage, view: View, flights: tuple[Piece, Piece], met: Array,
    known: Measured | None, likely: Array,
) -> Touch:  # fmt: skip
    """Return where a contact begins and ends.

    Samples that lie higher than either flight would go on are within the contact. Four or more
    show its ends; fewer bound its duration, and bodies that begin to part at the rebound speed
    share it so that both flights meet within.

    - `track`, `stage`, `view`, `flights`: samples, and the flights before and after.
    - `met`: what `speeds` gives at the meeting of the flights.
    - `known`: duration of the contact [s], if it is known.
    - `likely`: how likely the samples of this contact and of the others make each of `LASTS`.
    """
    meeting, ratio, step = float(met[0]), float(met[3]), track.step
    runs = _held(track, stage, view, flights, meeting)
    if (
        known is None
        and sum(r.size for r in runs) >= RULES.resolved
        and step < RULES.hard_contact / RULES.resolved
    ):
        ends = tuple(
            0.5 * (track.time[run[-1]] + track.time[run[-1] + way]) - meeting if run.size else 0.0
            for run, way in zip(runs, (-1, 1), strict=True)
        )
        error = step / math.sqrt(12.0)
        return Touch((float(ends[0]), float(ends[1])), (error, error), whole=False)
    lasts = known or _unseen(likely)
    shares = (ratio / (1.0 + ratio), 1.0 / (1.0 + ratio))
    return Touch(
        (-lasts.value * shares[0], lasts.value * shares[1]),
        (lasts.std * shares[0], lasts.std * shares[1]),
        whole=True,
    )


def samples_of(
    track: Track, stage: Stage, view: View, flights: tuple[Piece, Piece], turning: int,
    met: Array, likely: Array,
) -> tuple[int, int]:  # fmt: skip
    """Return how many samples before and after the lowest one belong to a contact.

    Those within the duration that is likely, and its error; where four or more show it half of what
    shows is left out beyond each end, in which the force is too small to show and yet moves the
    speed.
    """
    runs = _held(track, stage, view, flights, float(track.time[turning]))
    ratio = float(np.clip(abs(flights[1].launch.speed / flights[0].launch.speed), 0.1, 1.0))
    shares = ratio / (1.0 + ratio), 1.0 / (1.0 + ratio)
    lasts = _unseen(likely)
    longest = lasts.value + lasts.std
    first, last = np.searchsorted(
        track.time, (float(met[0]) - shares[0] * longest, float(met[0]) + shares[1] * longest)
    )
    within = max(turning - int(first), 0), max(int(last) - 1 - turning, 0)
    if not frames_show(track):
        within = 0, 0
    # slowed down over a time, a body is pushed away over that time over the restitution
    shown = max(sum(r.size for r in runs), math.ceil(runs[0].size * (1.0 + 1.0 / ratio)))
    if shown < RULES.resolved:
        return within
    before = int(turning - runs[0][-1]) if runs[0].size else 0
    after = int(runs[1][-1] - turning) if runs[1].size else 0
    more = [math.ceil(2.0 * RULES.soft_ends * share * shown) for share in shares]
    return (
        max(before + more[0], within[0]),
        max(after + more[1], math.ceil(before / ratio) + more[1], within[1]),
    )


def _held(
    track: Track, stage: Stage, view: View, flights: tuple[Piece, Piece], meeting: float
) -> list[Indices]:
    """Return the samples from the meeting outwards that the flat holds above each flight."""
    start, held = int(np.searchsorted(track.time, meeting)), []
    sides = np.arange(start - 1, 0, -1), np.arange(start, track.time.size - 1)
    for piece, side in zip(flights, sides, strict=True):
        run = side[: 1 + int(RULES.longest_contact / track.step)]
        seen = stage.seen(view, piece.launch, piece.reference, track.time[run])
        above = track.height[run] - seen > 4.0 * piece.sigma
        count = 0 if above.all() else int(np.argmin(above))
        # what is held lies lower than where it is let go
        low = track.height[run[:count]] < seen[count : count + 1] + 4.0 * piece.sigma
        held.append(run[: count if low.all() else 0])
    return held


def likely_durations(
    track: Track, stage: Stage, view: View, flights: tuple[Piece, Piece], met: Array
) -> Array:
    """Return how likely the samples next to a contact make each of `LASTS`, (n,) logarithms.

    A path bends as a spring's, whose loss may be a damping: it then bends more at first, and less
    at the end. That of a hard body, of some milliseconds at most, may bend as under a force that is
    whole at once; where frames hardly show it, it may halt at once, smeared over a whole frame.
    """
    # strays may make flights of which one goes on through the flat
    meeting, ratio, step = float(met[0]), max(float(met[3]), 0.1), track.step
    runs = _held(track, stage, view, flights, meeting)
    shares = ratio / (1.0 + ratio), 1.0 / (1.0 + ratio)
    smeared = float(met[1] + met[2]) / (2.0 * step)
    resolved = frames_show(track)
    found = np.zeros_like(LASTS)
    damping = -math.log(min(ratio, 1.0)) * np.array([1.0, -1.0])
    for piece, run, share, speed, loss in zip(
        flights, runs, shares, met[1:3], damping, strict=True
    ):
        order = np.argsort(np.abs(track.time[piece.index] - meeting))[: RULES.fewest]
        asked = np.concatenate([run, piece.index[order]])
        for index in _all_between(track, meeting, asked) if resolved else asked:
            time = track.time[index : index + 1]
            seen = stage.seen(view, piece.launch, piece.reference, time)
            above, gap = float(track.height[index] - seen[0]), abs(float(time[0]) - meeting)
            side = LASTS * share
            late = np.maximum(side - gap, 0.0)
            soft = speed * (late - side * np.sin(0.5 * np.pi * late / side) / (0.5 * np.pi))
            turn = math.pi * late / LASTS
            damped = speed * (late - LASTS / math.pi * np.exp(-loss * late / LASTS) * np.sin(turn))
            # a force that is whole at once, as a flat's or a stack's: no harder body halts sooner
            whole = speed * (late**2 / (2.0 * side) if resolved else late)
            most = np.maximum(RULES.soft_bend[1] * soft, damped)
            most = np.where(LASTS > RULES.hard_contact, most, np.maximum(most, whole))
            most = np.minimum(most, speed * late)
            most = most + smeared * max(0.5 * step - gap, 0.0) ** 2
            least = np.minimum(RULES.soft_bend[0] * soft, damped)
            off = np.maximum(np.maximum(least - above, above - most), 0.0)
            # a shadow or a stray beside the contact says little
            found -= np.minimum(0.5 * (off / piece.sigma) ** 2, RULES.touch_stray)
    return np.asarray(found - found.max())


def _all_between(track: Track, meeting: float, asked: Indices) -> Indices:
    """Return the samples of one side of a contact from the meeting to the farthest one asked."""
    start = int(np.searchsorted(track.time, meeting))
    return np.arange(min(start, asked.min()), max(start - 1, asked.max()) + 1)


def frames_show(track: Track) -> bool:
    """Whether four samples or more lie in a contact that only a soft body makes so long."""
    return track.step < 1.01 * RULES.hard_contact / RULES.resolved


def common_durations(each: Sequence[Array]) -> list[Array]:
    """Return the likelihoods of all contacts of a track together, for each of them, (n,) weights.

    Contacts of one body last about as long; those of elastic spheres vary with the inverse fifth
    root of the speed (H. Hertz, 1882). Soft bodies are rarer.
    """
    near = np.abs(np.log(LASTS[:, None] / LASTS[None, :])) <= math.log(RULES.contacts_alike)
    wide = [np.where(near, one[None, :], -np.inf).max(axis=1) for one in each]
    # whether a body is soft is one question, however often it bounces
    rare = -RULES.soft_rarer * np.maximum(np.log(LASTS / RULES.hard_contact), 0.0)
    found = []
    for k, one in enumerate(each):
        both = rare + one + sum(w for j, w in enumerate(wide) if j != k)
        found.append(np.exp(both - both.max()))
    return found


def _unseen(weight: Array) -> Measured:
    """Return a duration the logarithm of which is evenly spread, as far as each is likely."""
    part = weight / weight.sum()
    mean = float(part @ LASTS)
    return Measured(mean, max(math.sqrt(float(part @ (LASTS - mean) ** 2)), 0.1 * mean))


def speeds(
    c: Array, stage: Stage, references: tuple[float, float], guess: float,
    offsets: tuple[float, float],
) -> Array:  # fmt: skip
    """Return instant and height where two flights meet, and approach, rebound and their ratio.

    The speeds are read at `offsets` from that instant.
    """
    view = View(*c[:SHARED])
    flights = [(Launch(*c[k : k + 2]), r) for k, r in zip((5, 7), references, strict=True)]
    time = guess
    for _ in range(8):
        (yb, vb), (ya, va) = (stage.flight(view, q, np.array([time - r])) for q, r in flights)
        yb, vb, ya, va = yb[0], vb[0], ya[0], va[0]
        if va == vb:
            break
        move = (yb - ya) / (va - vb)
        time += move
        if abs(move) < 1e-9 * stage.span:
            break
    down, up = (
        float(stage.flight(view, q, np.array([time + o - r]))[1][0])
        for (q, r), o in zip(flights, offsets, strict=True)
    )
    return np.array([time, -down, up, -up / down if down != 0.0 else np.nan, yb])
