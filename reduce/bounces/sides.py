"""The flights on both sides of every contact: which turning points are contacts, which flights."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache, partial

import numpy as np

from ...core.arrays import Array
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
) -> list[Before]:
    """Return what is known of fall and drag; the fall by the flights where no scale is given.

    Where the flights of a body not known differ as none do in air, it may fall in a liquid, or be
    led by a hand: what is known then comes first for the one, then for the other.
    """
    own = [own_fall(body, s) for s in sides if s is not None]
    if not own:
        return []
    if metres is not None and math.isfinite(metres.value):
        value = ball.fall(3.0).gravity / metres.value
        fall = Measured(value, value * math.hypot(RULES.stated_size, metres.std / metres.value))
    else:
        value = _shared_fall(own)
        fall = Measured(value, 100.0 * (abs(value) + min(f.std for f in own)))
    known = value > 5.0 * min(f.std for f in own) or metres is not None
    speeds = np.array([s.launch.speed for s in sides if s is not None])
    fastest = max(math.sqrt(2.0 * abs(value) * stage.reach), np.abs(speeds).max())
    if not known or not value > 0.0:
        return [Before(fall, Measured(0.0, 1e-9 / stage.reach))]
    unit = ball.fall(3.0).gravity / value
    drifts = (
        min(stage.reach * unit / RULES.drift_height, 1.0),
        min(stage.span / RULES.drift_time, 1.0),
    )
    flight = ball.fall(RULES.drag_speed * fastest * unit)
    if math.isinf(flight.terminal):
        drags, shown = [0.5 * RULES.free_drag * value / fastest**2], _braking(own, speeds)
        if shown.value - RULES.by_chance * shown.std > RULES.fall_off * value / fastest**2:
            drags.insert(0, shown.value)
        return [Before(fall, Measured(drag, drag), *drifts) for drag in drags]
    drag = flight.gravity / flight.terminal**2 * unit
    return [Before(fall, Measured(drag, 1.5 * DRAG_COEFFICIENT_STD * drag), *drifts)]


def _braking(own: Sequence[Measured], speeds: Array) -> Measured:
    """Return by how much flights next to each other fall otherwise for their speeds [1/unit]."""
    squares = np.diff(speeds * np.abs(speeds))
    if not squares.any():
        return Measured(0.0, np.inf)
    values, errors = np.array([(v.value, v.std**2) for v in own]).T
    whole = float(squares @ squares)  # pairs count by it, so that rest says nothing
    drag = float(squares @ np.diff(values)) / whole
    scatter = errors[1:] + errors[:-1] + (np.diff(values) - drag * squares) ** 2
    return Measured(drag, math.sqrt(squares**2 @ scatter) / whole)


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
    body: Track, contacts: list[int], stage: Stage, before: Before, sides: Sides
) -> tuple[list[int], Sides]:
    """Leave out what is no flight, and of two turning points without a flight between them one.

    A run of strays turns as a contact does; the one that leaves flights on both sides is kept.
    """
    every, fall_of = sides, cache(partial(own_fall, body))
    sides = _same_fall(body, fall_of, every, before, stage)
    k = 0
    while k + 1 < len(contacts):
        if sides[2 * k + 1] is None and sides[2 * k + 2] is None:
            tried = []
            for other in (k, k + 1):
                left, kept = _without(body, contacts, every, other, stage)
                found = _same_fall(body, fall_of, kept, before, stage)
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


def _same_fall(
    body: Track, fall_of: Callable[[Piece], Measured], sides: Sides, before: Before, stage: Stage
) -> Sides:
    """Leave out rest, rolling and what else is no flight: its acceleration is not that of all."""
    fall = before.fall.value
    most = max(RULES.foreign * usual_spread(sides), RULES.coarse * stage.reach)
    kept: Sides = []
    for piece in sides:
        if piece is None or piece.sigma > most:
            kept.append(None)
            continue
        own = fall_of(piece)
        allowed = max(4.0 * own.std, RULES.fall_off * abs(fall))
        straight = piece.straight(body.time, fall)
        speed = piece.launch.speed
        off = own.value - fall - before.drag.value * speed * abs(speed)
        kept.append(piece if straight or abs(off) <= allowed else None)
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
                pieces[earlier] = replace(longer, index=np.union1d(other.index, piece.index))
                places.append(earlier)
                continue
        places.append(len(pieces))
        pieces.append(piece)
    return pieces, places
