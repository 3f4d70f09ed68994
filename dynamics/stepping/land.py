"""The event that a step crosses first, and the step's end on it.

A step that crosses an event is repeated with the length that ends near it; the rest of the way is
gone by the derivatives at both of its ends.
"""

from __future__ import annotations

from numba import float64, njit

from . import layout as at
from .events import by_chord, event_slope, event_values, hermite_root, mark_active
from .layout import PLAIN
from .motion import derivative, pace_of
from .step import STAGES, step

# fmt: off

# limit: trials of a landing step [-]
_BITES = 40
NONE, AGAIN = -1, -2
"""Beside the events: the step held none; it is to be taken anew."""


@njit(cache=True, **PLAIN)
def _first_crossing(m, w):
    """Return the event that the step crosses first, -1 for none, and its share of the step."""
    now, h = w.now, w.now[at.STEP]
    pace = pace_of(int(now[at.VARIABLE]), now[at.AT], w.seen)
    pace_new = pace_of(int(now[at.VARIABLE]), now[at.AT] + h, w.seen_new)
    chosen, where = -1.0, 2.0
    for event in range(at.N_EVENTS):
        if not (w.active[event] and w.values[event] >= 0.0 and w.values_new[event] < 0.0):
            continue
        sign = now[at.SIDE] if event == at.REVERSAL else now[at.MODE]
        if event == at.SLIDE or by_chord(m, w, event):
            d0 = d1 = (w.values_new[event] - w.values[event]) / h
        else:
            d0 = event_slope(m, event, w.z, w.stages[0], w.seen, sign, pace)
            d1 = event_slope(m, event, w.z_new, w.stages[STAGES], w.seen_new, sign, pace_new)
        part = 0.5
        if w.values[event] > 0.0 or d0 * h > 0.0:
            part = hermite_root(w.values[event], d0, w.values_new[event], d1, h)
        if part < where:
            chosen, where = float64(event), part
    return chosen, where


@njit(cache=True, **PLAIN)
def _land(m, w, chosen, x, move):
    """Go on from the end of the step, at x, to the event that lies `move` of the step away.

    By the mean of the derivatives at both ends: two evaluations where a step takes twelve, with an
    error of the cube of the move. False, and nothing moved, where the event is not near.
    """
    now, h, z, bite, leap = w.now, w.now[at.STEP], w.z_new, w.scales[at.BITE], w.scales[at.LEAP]
    variable, start, g0 = int(now[at.VARIABLE]), now[at.AT] + x, w.values_new[chosen]
    first, last, base = w.stages[STAGES], w.stages[1], w.stages[2]
    for j in range(len(z)):
        base[j] = z[j]
    for _ in range(4):
        dx = move * h
        for j in range(len(z)):
            z[j] = base[j] + dx * first[j]
        derivative(m, w, variable, start + dx, z, last, w.seen_new)
        for j in range(len(z)):
            z[j] = base[j] + 0.5 * dx * (first[j] + last[j])
        derivative(m, w, variable, start + dx, z, last, w.seen_new)
        w.tally[at.EVALUATIONS] += 2.0
        event_values(m, w, z, w.seen_new, w.values_new)
        slope = (w.values_new[chosen] - g0) / move
        if not slope < 0.0:
            break
        more = -w.values_new[chosen] / slope
        if abs(more) <= bite:
            for j in range(len(z)):
                z[j] += more * h * last[j]
            now[at.TAKEN] = x + dx + more * h
            return True
        move += more
        if abs(move) > leap:
            break
    for j in range(len(z)):
        z[j] = base[j]
    return False


@njit(cache=True, **PLAIN)
def _close_in(m, w, chosen, part):
    """Repeat the step so that it ends near the event, and land on it; return the step's error."""
    now, h, bite, leap = w.now, w.now[at.STEP], w.scales[at.BITE], w.scales[at.LEAP]
    low, high = 0.0, now[at.TAKEN] / h
    g_low, g_high = w.values[chosen], w.values_new[chosen]
    chord, kept_end, error = by_chord(m, w, chosen), 0, 0.0
    sign = now[at.SIDE] if chosen == at.REVERSAL else now[at.MODE]
    for bites in range(_BITES):
        x = part * h
        error = step(m, w, x)
        event_values(m, w, w.z_new, w.seen_new, w.values_new)
        g = w.values_new[chosen]
        now[at.TAKEN] = x
        # A chord that keeps its other end is steepened (the Illinois rule).
        if g < 0.0:
            high, g_high = part, g
            g_low *= 0.5 if kept_end < 0 else 1.0
            kept_end = -1
        else:
            low, g_low = part, g
            g_high *= 0.5 if kept_end > 0 else 1.0
            kept_end = 1
        pace = pace_of(int(now[at.VARIABLE]), now[at.AT] + x, w.seen_new)
        slope = h * event_slope(m, chosen, w.z_new, w.stages[STAGES], w.seen_new, sign, pace)
        if chord:
            slope = (g_high - g_low) / (high - low)
        move = -g / slope if slope < 0.0 else 0.5 * (low + high) - part
        target = part + move
        if not low < target < high or (chord and bites % 3 == 2):
            target = 0.5 * (low + high)
            move = target - part
        near = abs(move) <= bite and slope < 0.0
        if near and not (chord and high - low > 10.0 * bite):
            for j in range(len(w.z)):
                w.z_new[j] += move * h * w.stages[STAGES, j]
            now[at.TAKEN] = x + move * h
            break
        if abs(move) <= leap and _land(m, w, chosen, x, move):
            break
        if high - low <= 1e-15:
            break
        part = target
    return error


@njit(cache=True, **PLAIN)
def find_event(m, w):
    """Return the event that ends the step just taken, and end it there; NONE, or AGAIN."""
    now, h = w.now, w.now[at.STEP]
    event_values(m, w, w.z_new, w.seen_new, w.values_new)
    mark_active(m, w)
    now[at.TAKEN] = h
    found, part = _first_crossing(m, w)
    chosen, first, error = int(found), part, 0.0
    while chosen >= 0:
        w.active[chosen] = False
        error = _close_in(m, w, chosen, part)
        # Another event may hide before the one found.
        earlier = -1
        for event in range(at.N_EVENTS):
            if w.active[event] and w.values[event] >= 0.0:
                if w.values_new[event] < -1e-7 * w.values[event]:
                    earlier = event
        if earlier < 0:
            break
        chosen = earlier
        past = w.values[chosen] - w.values_new[chosen]
        part = (now[at.TAKEN] / h) * w.values[chosen] / past
    if chosen >= 0:
        if not error <= 1.0:
            # The kink beyond the event hid the error of the way to it: come nearer first.
            now[at.STEP] = 0.5 * first * h
            return AGAIN
        return chosen
    if now[at.LANDING] > 0.0:
        return at.PART if now[at.VARIABLE] == at.BY_ROOT_DEPTH else at.TURN
    return NONE
