"""One step of the walk: as long as it may be, accepted as far as it holds no event."""

from __future__ import annotations

import math

import numpy as np
from numba import float64, njit

from .. import force as fo
from . import layout as at
from .land import AGAIN, NONE, find_event
from .layout import PLAIN
from .step import STAGES, step

# fmt: off


@njit(cache=True, **PLAIN)
def _fit_step(m, w):
    """Shorten the next step to the longest allowed, or to the end of its variable."""
    now, seen = w.now, w.seen
    variable, place, h = now[at.VARIABLE], now[at.AT], now[at.STEP]
    longest = m.body[at.LONGEST]
    if longest < math.inf:
        if variable == at.BY_TIME:
            h = min(h, longest)
        elif variable == at.BY_ROOT_TIME:
            h = min(h, math.sqrt(place * place + longest) - place)
        elif variable == at.BY_RATE:
            h = max(h, longest * seen[at.ACCELERATION])
        else:
            most = longest * abs(seen[at.RATE])
            most = most / place if place * place > most else math.sqrt(most)
            h = min(max(h, -most), most)
    if variable == at.BY_ROOT_TIME and now[at.TURNING] > 0.0 and seen[at.ACCELERATION] < 0.0:
        # not past the turning point, which the rate comes to in one step
        room = -0.5 * seen[at.RATE] / seen[at.ACCELERATION]
        h = min(h, math.sqrt(place * place + room) - place)
    landing = variable >= at.BY_ROOT_DEPTH and place + h <= 0.02 * place
    now[at.LANDING] = float64(landing)
    now[at.STEP] = -place if landing else h


@njit(cache=True, **PLAIN)
def _give_way(m, w, error):
    """Shorten a step that failed, or change its variable; False: no step is left."""
    now = w.now
    if not math.isfinite(error):
        # what is no number in the lanes that only fill the state up would stay there
        springs = 1 if m.body[at.COMPLIANCE] < math.inf else 0
        for i in range(len(w.stages)):
            for j in range(int(m.sums[at.SIZE]) - springs, len(w.z) - springs):
                w.stages[i, j] = 0.0
    h, variable, place, t_ref = now[at.STEP], now[at.VARIABLE], now[at.AT], w.scales[at.T_REF]
    h *= max(0.2, 0.9 * error**-0.125) if math.isfinite(error) else 0.1
    now[at.STEP] = h
    lost = variable == at.BY_RATE and -h < 1e-4 * place
    # The tip no longer leaves: depth cannot carry the motion any further.
    stays = variable == at.BY_ROOT_DEPTH and -h < 1e-5 * place
    if lost or stays:
        now[at.VARIABLE], now[at.FRESH], now[at.STEP] = at.BY_TIME, 1.0, 1e-3 * t_ref
        if stays:
            now[at.SIMPLE] = 0.0
        else:
            now[at.TURNING] = 0.0
    return not (variable < at.BY_ROOT_DEPTH and h < 1e-14 * t_ref)


@njit(cache=True, **PLAIN)
def _go_on(w, grown):
    """Carry the end of a step over as the beginning of the next one."""
    now, seen, variable = w.now, w.seen, w.now[at.VARIABLE]
    now[at.STEP] = grown
    for j in range(len(w.z)):
        w.stages[0, j] = w.stages[STAGES, j]
    for j in range(at.N_SEEN):
        seen[j] = w.seen_new[j]
    for event in range(at.N_EVENTS):
        w.values[event] = w.values_new[event]
    approaching = now[at.APPROACHING] > 0.0
    if now[at.PHASE] == at.UNLOAD and now[at.SIMPLE] > 0.0 and variable == at.BY_TIME:
        now[at.FRESH] = float64(not approaching)
    if variable == at.BY_ROOT_TIME and now[at.SIMPLE] == 0.0:
        # the modes rule from here on, and they ask for even steps of time
        span, place = grown * (2.0 * now[at.AT] - now[at.TAKEN]), 2.0 * now[at.AT]
        now[at.VARIABLE], now[at.STEP] = at.BY_TIME, span
        for j in range(len(w.z)):
            w.stages[0, j] /= place
    if now[at.TURNING] > 0.0 and approaching and variable < at.BY_ROOT_DEPTH:
        span = grown if variable == at.BY_TIME else grown * (2.0 * now[at.AT] + grown)
        near, speed = -1.2 * seen[at.ACCELERATION] * span, w.scales[at.SPEED]
        close = seen[at.RATE] < min(0.45 * speed, near)
        now[at.FRESH] = now[at.TO_RATE] = float64(close)


@njit(cache=True, **PLAIN)
def _note_force(m, w, event):
    """Keep the largest force and its time: at an event, or within a step where it knows the rate.

    There it is the parabola with the force at both ends and the step's impulse.
    """
    tally, f0, f1 = w.tally, w.seen[at.FORCE], w.seen_new[at.FORCE]
    rated = m.force[fo.DAMPING] != 0.0 or m.force[fo.RADIATION] != 0.0
    if not (event >= 0 or rated):
        return
    top, place, span = f1, 1.0, w.z_new[at.TIME] - w.z[at.TIME]
    if rated and span > 0.0:
        mean = (w.z_new[at.P_N] - w.z[at.P_N]) / span
        slope, bend = 6.0 * mean - 4.0 * f0 - 2.0 * f1, 3.0 * (f0 + f1 - 2.0 * mean)
        if 0.0 < slope < -2.0 * bend:
            top, place = f0 - 0.25 * slope * slope / bend, -0.5 * slope / bend
    if top > tally[at.TOP_FORCE]:
        tally[at.TOP_FORCE], tally[at.TOP_TIME] = top, w.z[at.TIME] + place * span


@njit(cache=True, **PLAIN)
def advance(m, w):
    """Take one step and accept what of it holds no event; return the event, NONE or AGAIN."""
    now, tally = w.now, w.tally
    _fit_step(m, w)
    error = step(m, w, now[at.STEP])
    tally[at.STEPS] += 1.0
    if not error <= 1.0:
        if not _give_way(m, w, error):
            tally[at.ENDING] = at.NOT_FINITE
        return AGAIN
    h = now[at.STEP]
    grown = h * min(6.0, 0.9 * max(error, 1e-12) ** -0.125)
    cut_short = h < 1e-3 * now[at.AT]
    if now[at.VARIABLE] == at.BY_ROOT_TIME and now[at.SIMPLE] > 0.0 and not cut_short:
        # equal steps of the root grow in time as they come; one that a bend of the force has cut
        # short would stay so to the end, where nothing changes the variable (over a plate)
        grown = min(grown, h if now[at.AT] > 0.0 else 1.22 * h)
    event = find_event(m, w)
    if event == AGAIN:
        return AGAIN
    now[at.AT] += now[at.TAKEN]
    _note_force(m, w, event)
    for j in range(len(w.z)):
        w.z[j] = w.z_new[j]
    if now[at.SIDE] == 0.0:
        now[at.SIDE] = np.sign(w.seen_new[at.SLIDING])
    if event == NONE:
        _go_on(w, grown)
    else:
        now[at.FRESH] = 1.0
        if now[at.VARIABLE] < at.BY_ROOT_DEPTH:
            # only friction and the surface bend sharply
            smooth = now[at.VARIABLE] == at.BY_TIME and event <= at.RETURNED
            now[at.STEP] = grown if smooth else min(grown, max(now[at.TAKEN], 0.5 * h))
    return event
