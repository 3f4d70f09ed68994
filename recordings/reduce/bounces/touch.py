"""A contact between two flights: where they meet, how long it lasts, the speeds at its ends."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..measured import Array, Measured
from .flights import Piece
from .joint import SHARED
from .track import Track
from .view import Launch, Stage, View

_RESOLVED = 4
"""Samples within a contact from which on its two ends are told apart."""

_SHORTEST, _LONGEST = 3e-5, 4e-3
"""Contacts of balls and rods, steel on steel to a marble on a stack of paper, at a few metres a
second [s]; one that no sample shows lies between, any order of magnitude as likely as another."""

_BEYOND = 0.5
"""Part of what shows of a contact by which both of its ends reach farther: force sets in softly."""

_HIDDEN = 8.0
"""Spreads of a sample that the path may turn within without a sample that shows the contact."""

_SLOWEST = 0.02
"""Longest contact that samples can show [s]."""


class Touch(NamedTuple):
    """Beginning and end of a contact after its flights meet, and their errors [s].

    `whole` where both errors are that of one duration, which moves both ends apart.
    """

    offsets: tuple[float, float]
    errors: tuple[float, float]
    whole: bool

    def ratio_error(self, fall: float, approach: float, rebound: float) -> float:
        """Return the relative error of the restitution: both speeds fall with the duration."""
        parts = fall * self.errors[0] / approach, fall * self.errors[1] / rebound
        return abs(parts[1] - parts[0]) if self.whole else math.hypot(*parts)


def touch_of(
    track: Track, stage: Stage, view: View, flights: tuple[Piece, Piece], met: Array,
    known: Measured | None,
) -> Touch:  # fmt: skip
    """Return where a contact begins and ends.

    Samples that lie higher than either flight would go on are within the contact. Four or more
    show its ends; fewer bound its duration, and bodies that begin to part at the rebound speed
    share it so that both flights meet within.

    Parameters
    ----------
    track, stage, view, flights
        Samples, and the flights before and after.
    met
        What `speeds` gives at the meeting of the flights.
    known
        Duration of the contact [s], if it is known.
    """
    meeting, ratio, step = float(met[0]), float(met[3]), track.step
    runs = [
        _held(track, stage, view, piece, meeting, way)
        for piece, way in zip(flights, (-1, 1), strict=True)
    ]
    moved = sum(r.size for r in runs)
    if known is None and moved >= _RESOLVED:
        ends = tuple(
            0.5 * (track.time[run[-1]] + track.time[run[-1] + way]) - meeting if run.size else 0.0
            for run, way in zip(runs, (-1, 1), strict=True)
        )
        error = step / math.sqrt(12.0)
        return Touch((float(ends[0]), float(ends[1])), (error, error), whole=False)
    spread = max(p.sigma for p in flights)
    lasts = known or _unseen(moved, step + _HIDDEN * spread / max(float(met[1]), 1e-12))
    shares = (ratio / (1.0 + ratio), 1.0 / (1.0 + ratio))
    return Touch(
        (-lasts.value * shares[0], lasts.value * shares[1]),
        (lasts.std * shares[0], lasts.std * shares[1]),
        whole=True,
    )


def samples_of(
    track: Track, stage: Stage, view: View, flights: tuple[Piece, Piece], turning: int
) -> tuple[int, int]:
    """Return how many samples before and after the lowest one belong to a contact.

    None where fewer than four show it; else half of what shows is left out beyond each end, in
    which the force is too small to show and yet moves the speed.
    """
    lowest = float(track.time[turning])
    runs = [
        _held(track, stage, view, piece, lowest, way)
        for piece, way in zip(flights, (-1, 1), strict=True)
    ]
    ratio = float(np.clip(abs(flights[1].launch.speed / flights[0].launch.speed), 0.1, 1.0))
    # slowed down over a time, a body is pushed away over that time over the restitution
    shown = max(sum(r.size for r in runs), math.ceil(runs[0].size * (1.0 + 1.0 / ratio)))
    if shown < _RESOLVED:
        return 0, 0
    before = int(turning - runs[0][-1]) if runs[0].size else 0
    after = int(runs[1][-1] - turning) if runs[1].size else 0
    shares = ratio / (1.0 + ratio), 1.0 / (1.0 + ratio)
    more = [math.ceil(2.0 * _BEYOND * share * shown) for share in shares]
    return before + more[0], max(after, math.ceil(before / ratio)) + more[1]


def _held(
    track: Track, stage: Stage, view: View, piece: Piece, meeting: float, way: int
) -> npt.NDArray[np.int_]:
    """Return the samples from the meeting outwards that the flat holds above a flight."""
    start = int(np.searchsorted(track.time, meeting))
    run = np.arange(start, track.time.size - 1) if way > 0 else np.arange(start - 1, 0, -1)
    run = run[: 1 + int(_SLOWEST / track.step)]
    seen = stage.seen(view, piece.launch, piece.reference, track.time[run])
    above = track.height[run] - seen > 4.0 * piece.sigma
    if above.all():
        return run[:0]
    count = int(np.argmin(above))
    # what is held lies lower than where it is let go
    low = bool((track.height[run[:count]] < seen[count] + 4.0 * piece.sigma).all())
    return run[: count if low else 0]


def _unseen(moved: int, step: float) -> Measured:
    """Return how long a contact lasts in which `moved` samples lie, a few at the most [s].

    `step` is the longest time without a sample that would show it.
    """
    if moved:
        low, high = max((moved - 1) * step, _SHORTEST), (moved + 1) * step
        return Measured(0.5 * (low + high), (high - low) / math.sqrt(12.0))
    high = max(min(step, _LONGEST), 1.1 * _SHORTEST)
    # mean and spread of a duration whose logarithm is evenly spread
    span = math.log(high / _SHORTEST)
    mean = (high - _SHORTEST) / span
    square = (high**2 - _SHORTEST**2) / (2.0 * span)
    return Measured(mean, math.sqrt(square - mean**2))


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
