"""The flights on both sides of every contact: which turning points are contacts, which flights."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ...core.drag import DRAG_COEFFICIENT_STD
from ..measured import Measured
from ..rules import RULES
from .fall import Ball
from .flights import Piece, own_fall, side
from .joint import Before
from .track import Track
from .view import Stage, View

Sides = list[Piece | None]
"""Two for each contact, before and after."""


def sides_of(
    body: Track, contacts: Sequence[int], stage: Stage, view: View | None,
    held: Sequence[tuple[int, int]] = (), known: Sequence[bool] = (),
) -> Sides:  # fmt: skip
    """Return the flights before and after each turning point.

    `held` are samples before and after each that the contact has moved; `known` says for each
    whether there is a flight, else all are looked for.
    """
    edges = [-1, *contacts, body.time.size]
    moved = [(0, 0), *(held or [(0, 0)] * len(contacts)), (0, 0)]
    found: Sides = []
    for k, contact in enumerate(contacts, start=1):
        # a flight ends where the contact beyond it begins
        ends = edges[k - 1] + 1 + moved[k - 1][1], edges[k + 1] - 1 - moved[k + 1][0]
        there = known[2 * k - 2 : 2 * k] or (True, True)
        found += [
            side(body, contact, end, stage, view, off=count) if is_there else None
            for end, count, is_there in zip(ends, moved[k], there, strict=True)
        ]
    return found


def usual_spread(sides: Sides) -> float:
    """Return the spread of a sample of the best quarter of the flights [unit]."""
    spreads = [s.sigma for s in sides if s is not None]
    return float(np.quantile(spreads, 0.25)) if spreads else 0.0


def known_before(
    body: Track, sides: Sides, ball: Ball, metres: Measured | None, stage: Stage
) -> Before | None:
    """Return what is known of fall and drag; the fall by the flights where no scale is given."""
    own = [own_fall(body, s) for s in sides if s is not None]
    if not own:
        return None
    if metres is not None and math.isfinite(metres.value):
        value = ball.fall(3.0).gravity / metres.value
        fall = Measured(value, value * math.hypot(RULES.stated_size, metres.std / metres.value))
    else:
        value = _shared_fall(own)
        fall = Measured(value, 100.0 * (abs(value) + min(f.std for f in own)))
    known = value > 5.0 * min(f.std for f in own) or metres is not None
    speeds = [abs(s.launch.speed) for s in sides if s is not None]
    fastest = max(math.sqrt(2.0 * abs(value) * stage.reach), *speeds)
    if not known or not value > 0.0:
        return Before(fall, Measured(0.0, 1e-9 / stage.reach))
    unit = ball.fall(3.0).gravity / value
    drifts = (
        min(stage.reach * unit / RULES.drift_height, 1.0),
        min(stage.span / RULES.drift_time, 1.0),
    )
    flight = ball.fall(RULES.drag_speed * fastest * unit)
    if math.isinf(flight.terminal):
        drag = 0.5 * RULES.free_drag * value / fastest**2
        return Before(fall, Measured(drag, drag), *drifts)
    drag = flight.gravity / flight.terminal**2 * unit
    return Before(fall, Measured(drag, 1.5 * DRAG_COEFFICIENT_STD * drag), *drifts)


def _shared_fall(own: Sequence[Measured]) -> float:
    """Return the acceleration on which the most flights agree, the better known ones more."""
    clear = [v for v in own if v.value > 5.0 * v.std] or list(own)

    def agreement(one: Measured) -> float:
        return sum(
            min(abs(v.value / max(v.std, 1e-12)), 100.0)
            for v in clear
            if abs(v.value - one.value) < 0.5 * RULES.fall_off * abs(one.value) + one.std
        )

    return max(clear, key=agreement).value


def true_contacts(
    body: Track, contacts: list[int], stage: Stage, fall: float, sides: Sides
) -> tuple[list[int], Sides]:
    """Leave out what is no flight, and of two turning points without a flight between them one.

    A run of strays turns as a contact does; the one that leaves flights on both sides is kept.
    """
    every, falls = sides, _Falls(body)
    sides = _same_fall(falls, every, fall, stage)
    k = 0
    while k + 1 < len(contacts):
        if sides[2 * k + 1] is None and sides[2 * k + 2] is None:
            tried = []
            for other in (k, k + 1):
                left, kept = _without(body, contacts, every, other, stage)
                found = _same_fall(falls, kept, fall, stage)
                pair = found[2 * k : 2 * k + 2]
                size = sum(p.index.size for p in pair if p) if all(pair) else 0
                tried.append((size, left, kept, found))
            size, left, kept, found = max(tried, key=lambda t: t[0])
            if size:
                contacts, every, sides = left, kept, found
                continue
        k += 1
    return contacts, sides


def _without(
    body: Track, contacts: list[int], sides: Sides, other: int, stage: Stage
) -> tuple[list[int], Sides]:
    """Leave out one turning point: only the flights beside it reach farther then."""
    left = contacts[:other] + contacts[other + 1 :]
    kept = sides[: 2 * other] + sides[2 * other + 2 :]
    edges = [-1, *left, body.time.size]
    if other > 0:
        kept[2 * other - 1] = side(body, left[other - 1], edges[other + 1] - 1, stage, None)
    if other < len(left):
        kept[2 * other] = side(body, left[other], edges[other] + 1, stage, None)
    return left, kept


class _Falls:
    """The acceleration of each flight by itself, fitted once."""

    def __init__(self, body: Track) -> None:
        self.body = body
        self._found: dict[int, tuple[Piece, Measured]] = {}

    def of(self, piece: Piece) -> Measured:
        if id(piece) not in self._found:  # the piece is kept, so that no other takes its place
            self._found[id(piece)] = piece, own_fall(self.body, piece)
        return self._found[id(piece)][1]


def _same_fall(falls: _Falls, sides: Sides, fall: float, stage: Stage) -> Sides:
    """Leave out rest, rolling and what else is no flight: its acceleration is not that of all."""
    most = max(RULES.foreign * usual_spread(sides), RULES.coarse * stage.reach)
    kept: Sides = []
    for piece in sides:
        if piece is None or piece.sigma > most:
            kept.append(None)
            continue
        own = falls.of(piece)
        allowed = max(4.0 * own.std, RULES.fall_off * abs(fall))
        straight = piece.straight(falls.body.time, fall)
        kept.append(piece if straight or abs(own.value - fall) <= allowed else None)
    return kept


def joined(sides: Sides) -> tuple[list[Piece], list[int | None]]:
    """Join the two sides of one flight; the pieces, and which of them each side is."""
    pieces: list[Piece] = []
    places: list[int | None] = []
    for k, piece in enumerate(sides):
        earlier = places[-1] if k % 2 == 0 and places else None
        if piece is None:
            places.append(None)
            continue
        if earlier is not None:
            other = pieces[earlier]
            common = np.intersect1d(other.index, piece.index).size
            if 2 * common >= min(other.index.size, piece.index.size):
                longer = max(other, piece, key=lambda p: p.index.size)
                pieces[earlier] = Piece(
                    np.union1d(other.index, piece.index), longer.reference, longer.launch,
                    longer.sigma,
                )  # fmt: skip
                places.append(earlier)
                continue
        places.append(len(pieces))
        pieces.append(piece)
    return pieces, places
