"""The walk from event to event: touch, advance, find the event, change phase.

DOP853 (Hairer, Norsett and Wanner) with event location: a step that crosses an event is repeated
with the length that ends on it. The independent variable changes where time is a bad one: the root
of time after a touch, the rate of penetration before the turning point, the root of the remaining
depth before the parting.
"""

from __future__ import annotations

import math

import numpy as np
from numba import boolean, float64, int64, njit, types

from .. import force as fo
from .. import surface as su
from . import layout as at
from .events import (
    by_chord,
    event_slope,
    event_values,
    first_mode,
    hermite_root,
    mark_active,
    meet,
    rest_friction,
    rubbing,
    set_segment,
    sliding_mode,
    slip_speed,
)
from .flight import TOUCHED, fly
from .layout import MODEL, WORK
from .motion import (
    PLAIN,
    STAGES,
    derivative,
    kinematics,
    loading_radius,
    pace_of,
    penetration,
    place_of,
    step,
)

# fmt: off
# The bundles are handed over by value: what each step calls is inlined.
_BITES = 40
NONE, AGAIN = -1, -2
"""Beside the events: the step held none; it is to be taken anew."""


@njit(types.void(MODEL, WORK), cache=True, **PLAIN)
def touch(m, w):
    """Begin a contact at the present state."""
    now, tally, z = w.now, w.tally, w.z
    x, _ = place_of(m, z)
    meet(m, w, w.scales[at.ORIGIN] + x)
    tally[at.CONTACTS] += 1.0
    tally[at.T_TOUCH], tally[at.X_TOUCH] = z[at.TIME], x
    now[at.VARIABLE], now[at.AT], now[at.STEP] = at.BY_ROOT_TIME, 0.0, w.scales[at.FIRST_STEP]
    now[at.FRESH], now[at.RECHECK], now[at.TO_RATE] = 1.0, 0.0, 0.0
    rigid = len(m.omega) == 0
    level = w.surface[su.STANDING] == 0.0
    now[at.SIMPLE] = float64(rigid)
    now[at.TURNING] = float64(rigid and level and m.body[at.S_PLATE] == 0.0)
    if m.body[at.COMPLIANCE] < math.inf:
        z[at.SPRING], w.scale[at.SPRING] = 0.0, w.scales[at.SPRING_FORCE]
    now[at.MODE] = 1.0
    derivative(m, w, at.BY_TIME, 0.0, z, w.stages[0], w.seen)
    now[at.SIDE] = np.sign(w.seen[at.SLIDING])
    now[at.MODE] = first_mode(m, w)


@njit(types.void(WORK), cache=True, **PLAIN)
def _by_depth(w):
    """Walk towards the next border of the loading curve by the root of the depth, else by time."""
    now, seen = w.now, w.seen
    if now[at.TO_RATE] > 0.0:
        return
    place, h = now[at.AT], now[at.STEP]
    ahead = w.branch[fo.SEGMENT_HIGH] < w.scales[at.D_REF]
    ahead = ahead and seen[at.RATE] > 0.6 * w.scales[at.SPEED]
    if ahead and now[at.VARIABLE] < at.BY_ROOT_DEPTH:
        span = h if now[at.VARIABLE] == at.BY_TIME else h * (2.0 * place + h)
        place = math.sqrt(max(seen[at.DEPTH], 0.0))
        now[at.VARIABLE], now[at.AT] = at.BY_ROOT_DEPTH, place
        now[at.STEP] = math.sqrt(place * place + seen[at.RATE] * span) - place
    elif now[at.VARIABLE] == at.BY_ROOT_DEPTH and not ahead:
        now[at.VARIABLE], now[at.STEP] = at.BY_TIME, h * (2.0 * place + h) / seen[at.RATE]
    elif now[at.VARIABLE] == at.BY_ROOT_DEPTH:
        now[at.AT] = math.sqrt(max(seen[at.DEPTH], 0.0))


@njit(types.void(WORK), cache=True, **PLAIN)
def _grip(w):
    """Let a yielding contact rest; its spring keeps the friction that it slid with."""
    w.z[at.SPRING], w.now[at.MODE] = w.seen[at.TANGENTIAL], 0.0
    if w.branch[fo.RECEDING] > 0.0:
        stiff = w.seen[at.STIFFNESS]
        w.z[at.SPRING] = w.z[at.SPRING] / stiff if stiff > 0.0 else 0.0


@njit(types.void(MODEL, WORK), cache=True, **PLAIN)
def refresh(m, w):
    """Look at the contact anew after an event: independent variable, derivative, event values."""
    now, branch, seen, z = w.now, w.branch, w.seen, w.z
    derivative(m, w, at.BY_TIME, 0.0, z, w.stages[0], seen)
    if now[at.RECHECK] > 0.0 and m.body[at.COMPLIANCE] < math.inf and now[at.MODE] != 0.0:
        slip = slip_speed(m, w, now[at.MODE], w.scales[at.AHEAD], z, w.stages[0], w.moved)
        if now[at.MODE] * slip < 0.0:
            _grip(w)
    now[at.RECHECK] = 0.0
    rest = branch[1] + branch[2]
    leaving = now[at.PHASE] == at.UNLOAD and now[at.APPROACHING] == 0.0
    if leaving and now[at.SIMPLE] > 0.0 and seen[at.DEPTH] - rest < 0.6 * (branch[0] - rest):
        now[at.VARIABLE], now[at.AT] = at.BY_ROOT_DEPTH, math.sqrt(max(seen[at.DEPTH] - rest, 0.0))
        if now[at.STEP] > 0.0:
            now[at.STEP] = -0.4 * now[at.AT]
    if now[at.PHASE] == at.LOAD and now[at.TURNING] > 0.0 and now[at.APPROACHING] > 0.0:
        _by_depth(w)
    if now[at.TO_RATE] > 0.0 or now[at.VARIABLE] == at.BY_RATE:
        now[at.VARIABLE], now[at.AT], now[at.TO_RATE] = at.BY_RATE, seen[at.RATE], 0.0
        now[at.STEP] = -seen[at.RATE]
        if not seen[at.ACCELERATION] < 0.0:
            now[at.VARIABLE], now[at.TURNING] = at.BY_TIME, 0.0
            now[at.STEP] = 1e-3 * w.scales[at.T_REF]
    derivative(m, w, int(now[at.VARIABLE]), now[at.AT], z, w.stages[0], seen)
    w.tally[at.EVALUATIONS] += 2.0
    now[at.FRESH] = 0.0
    if now[at.PHASE] == at.LOAD:
        w.tally[at.TOP_FORCE] = max(w.tally[at.TOP_FORCE], seen[at.FORCE])
    event_values(m, w, z, seen, w.values)
    # What has just crossed zero, as well as an event is met, may fall through it within the first
    # step: a hair below zero it would have no crossing there.
    still = m.body[at.TOLERANCE] * w.scales[at.SPEED]
    for event in (at.TURN, at.RETURNED, at.REST, at.REVERSAL):
        if abs(w.values[event]) <= still:
            w.values[event] = 0.0


@njit(inline="always", **PLAIN)
def _fit_step(m, w):
    """Shorten the next step to the longest allowed, to a border, or to the end of its variable."""
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
    # On loading by depth a step can end on the border of a stretch.
    pressing = variable == at.BY_ROOT_DEPTH and now[at.PHASE] == at.LOAD
    bordering = False
    if pressing:
        if seen[at.ACCELERATION] < 0.0:
            room = -0.3 * seen[at.RATE] ** 2 / seen[at.ACCELERATION]
            h = min(h, math.sqrt(place * place + room) - place)
        border = math.sqrt(w.branch[fo.SEGMENT_HIGH])
        bordering = place + 1.02 * h >= border
        h = border - place if bordering else h
    landing = variable >= at.BY_ROOT_DEPTH and place + h <= 0.02 * place
    now[at.PRESSING], now[at.BORDERING] = float64(pressing), float64(bordering)
    now[at.LANDING] = float64(landing)
    now[at.STEP] = -place if landing else h


@njit(boolean(WORK, float64), cache=True, **PLAIN)
def _give_way(w, error):
    """Shorten a step that failed, or change its variable; False: no step is left."""
    now = w.now
    h, variable, place, t_ref = now[at.STEP], now[at.VARIABLE], now[at.AT], w.scales[at.T_REF]
    h *= max(0.2, 0.9 * error**-0.125) if math.isfinite(error) else 0.1
    now[at.STEP] = h
    pressing = now[at.PRESSING] > 0.0
    lost = variable == at.BY_RATE and -h < 1e-4 * place
    lost = lost or (pressing and h < 1e-5 * max(place, 1e-3 * math.sqrt(w.scales[at.D_REF])))
    # The tip no longer leaves: depth cannot carry the motion any further.
    stays = variable == at.BY_ROOT_DEPTH and not pressing and -h < 1e-5 * place
    if lost or stays:
        now[at.VARIABLE], now[at.FRESH], now[at.STEP] = at.BY_TIME, 1.0, 1e-3 * t_ref
        if stays:
            now[at.SIMPLE] = 0.0
        else:
            now[at.TURNING] = 0.0
    return not (variable < at.BY_ROOT_DEPTH and h < 1e-14 * t_ref)


@njit(types.void(MODEL, WORK), cache=True, **PLAIN)
def _note_interval(m, w):
    """Count how far the point has come on the flat."""
    tally, z = w.tally, w.z
    x, _ = place_of(m, z)
    tally[at.SLIP_LOW] = min(tally[at.SLIP_LOW], z[at.SLIP])
    tally[at.SLIP_HIGH] = max(tally[at.SLIP_HIGH], z[at.SLIP])
    tally[at.X_LOW], tally[at.X_HIGH] = min(tally[at.X_LOW], x), max(tally[at.X_HIGH], x)


@njit(types.void(WORK), cache=True, **PLAIN)
def _note_half(w):
    """Count impulse and work of the approach or the departure that ends here."""
    tally, z = w.tally, w.z
    impulse, work = z[at.P_N] - tally[at.P_MARK], z[at.WORK_N] - tally[at.W_MARK]
    if w.now[at.APPROACHING] > 0.0:
        tally[at.P_IN] += impulse
        tally[at.W_IN] += work
    else:
        tally[at.P_OUT] += impulse
        tally[at.W_OUT] -= work
    tally[at.P_MARK], tally[at.W_MARK] = z[at.P_N], z[at.WORK_N]


@njit(types.void(MODEL, WORK), cache=True, **PLAIN)
def part(m, w):
    """End a contact, and follow the flight to the next one or to the end of the impact."""
    tally, z, seen = w.tally, w.z, w.seen_far
    penetration(m, w, z, seen)
    beyond = seen[at.DEPTH] - w.branch[1] - w.branch[2]
    if abs(beyond) > 1e-12 * w.scales[at.D_REF] and seen[at.RATE] < 0.0:
        # A step by the root of the depth ends on the parting as well as its error allows.
        move = -beyond / seen[at.RATE]
        derivative(m, w, at.BY_TIME, 0.0, z, w.spare, seen)
        for j in range(len(z)):
            z[j] += move * w.spare[j]
    _note_interval(m, w)
    _note_half(w)
    x, _ = place_of(m, z)
    su.leave(w.surface, w.scales[at.ORIGIN] + x)
    tally[at.TOUCHING] += z[at.TIME] - tally[at.T_TOUCH]
    tally[at.T_LAST] = z[at.TIME]
    for j in range(len(z)):
        w.kept[j] = z[j]
    ended = fly(m, w)
    if ended != TOUCHED:
        tally[at.ENDING] = at.FLIGHT_BUDGET if ended > TOUCHED + 1 else at.DONE
    elif tally[at.CONTACTS] >= m.body[at.MAX_CONTACTS]:
        tally[at.ENDING] = at.CONTACT_BUDGET


@njit(inline="always", **PLAIN)
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


@njit(float64(MODEL, WORK, int64, float64), cache=True, **PLAIN)
def _close_in(m, w, chosen, part):
    """Repeat the step so that it ends on the event; return the error of that step.

    The last move is linear in time; its error is the square of its share of the step.
    """
    now, h, bite = w.now, w.now[at.STEP], w.scales[at.BITE]
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
        if high - low <= 1e-15:
            break
        part = target
    return error


@njit(inline="always", **PLAIN)
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
    if now[at.BORDERING] > 0.0:
        root = math.sqrt(w.branch[fo.SEGMENT_HIGH])
        move = (w.branch[fo.SEGMENT_HIGH] - w.seen_new[at.DEPTH]) / (2.0 * root)
        for j in range(len(w.z)):
            w.z_new[j] += move * w.stages[STAGES, j]
        return at.BORDER
    if now[at.LANDING] > 0.0:
        return at.PART if now[at.VARIABLE] == at.BY_ROOT_DEPTH else at.TURN
    return NONE


@njit(inline="always", **PLAIN)
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
    approaching, pressing = now[at.APPROACHING] > 0.0, now[at.PRESSING] > 0.0
    if now[at.PHASE] == at.UNLOAD and now[at.SIMPLE] > 0.0 and variable == at.BY_TIME:
        now[at.FRESH] = float64(not approaching)
    if now[at.TURNING] > 0.0 and approaching and (variable < at.BY_ROOT_DEPTH or pressing):
        span = grown if variable == at.BY_TIME else grown * (2.0 * now[at.AT] + grown)
        span = span / seen[at.RATE] if pressing else span
        near, speed = -1.2 * seen[at.ACCELERATION] * span, w.scales[at.SPEED]
        close = seen[at.RATE] < (0.6 * speed if pressing else min(0.45 * speed, near))
        now[at.FRESH] = now[at.TO_RATE] = float64(close)


@njit(int64(MODEL, WORK), cache=True, **PLAIN)
def advance(m, w):
    """Take one step and accept what of it holds no event; return the event, NONE or AGAIN."""
    now, tally = w.now, w.tally
    _fit_step(m, w)
    error = step(m, w, now[at.STEP])
    tally[at.STEPS] += 1.0
    if not error <= 1.0:
        if not _give_way(w, error):
            tally[at.ENDING] = at.NOT_FINITE
        return AGAIN
    h = now[at.STEP]
    grown = h * min(6.0, 0.9 * max(error, 1e-12) ** -0.125)
    event = find_event(m, w)
    if event == AGAIN:
        return AGAIN
    now[at.AT] += now[at.TAKEN]
    for j in range(len(w.z)):
        w.z[j] = w.z_new[j]
    if now[at.SIDE] == 0.0:
        now[at.SIDE] = np.sign(w.seen_new[at.SLIDING])
    # A force that depends on the rate may be largest between events.
    rated = m.force[fo.DAMPING] != 0.0 or m.force[fo.RADIATION] != 0.0
    if (event >= 0 or rated) and w.seen_new[at.FORCE] > tally[at.TOP_FORCE]:
        tally[at.TOP_FORCE] = w.seen_new[at.FORCE]
    if event == NONE:
        _go_on(w, grown)
    else:
        now[at.FRESH] = 1.0
        if now[at.PRESSING] > 0.0:
            now[at.STEP] = grown
        elif now[at.VARIABLE] < at.BY_ROOT_DEPTH:
            now[at.STEP] = min(grown, max(0.5 * now[at.TAKEN], 0.05 * h))
    return event


@njit(types.void(MODEL, WORK), cache=True, **PLAIN)
def _peak(m, w):
    """End the loading: prepare the recovery, and let tip and flat keep what this peak left."""
    branch, surface, mark, tally, now = w.branch, w.surface, w.mark, w.tally, w.now
    x, speed = place_of(m, w.z)
    kinematics(m, w.z, w.seen_far)
    deep = w.seen_far[at.DEPTH]
    low, _ = su.height(surface, surface[su.STANDING], w.scales[at.ORIGIN] + x)
    depth = deep - now[at.OFFSET] - low
    slowing = 0.0
    if speed != 0.0:
        derivative(m, w, at.BY_TIME, 0.0, w.z, w.spare, w.seen_far)
        slowing = -event_slope(m, at.TURN, w.z, w.spare, w.seen_far, 1.0, 1.0)
    # Metal that was met before stays gone: the residual grows by the difference.
    tip, flat = branch[1], branch[2]
    fo.set_peak(m.loading, m.unloading, m.residual, m.par, m.force, m.factors, depth, branch)
    branch[fo.PEAK_RADIUS] = loading_radius(m, depth)
    now[at.PHASE] = at.UNLOAD
    surface[su.TIP_FLAT] += branch[1] - tip
    if branch[1] > 0.0:
        surface[su.TIP_PEAK] = max(surface[su.TIP_PEAK], depth)
    tally[at.TOP_DEPTH] = max(tally[at.TOP_DEPTH], deep)
    recovery = branch[0] - branch[1] - branch[2]
    a = m.radius(m.par, branch[4], branch[4])
    here = w.scales[at.ORIGIN] + x
    mark[su.START] = mark[su.END] = mark[su.DEEPEST] = here
    mark[su.TAKEN], mark[su.PEAK], mark[su.RADIUS] = branch[2] - flat, depth, a
    mark[su.GIVE] = min(max(m.force[fo.RADIUS] * recovery / (a * a), 0.02), 0.98)
    behind, before = 0.0, 0.0
    if slowing > 0.0 and a > 0.0:
        # The edge x -+ a of the contact goes furthest just before and just after the peak.
        growth = (branch[fo.PEAK_RADIUS] - loading_radius(m, depth * (1.0 - 1e-4))) / (1e-4 * depth)
        behind = abs(x - tally[at.X_TOUCH])
        if growth > 0.0:
            behind = min(speed * speed / (2.0 * growth * slowing), behind)
        before = min(speed * speed * recovery / (a * slowing),
                     abs(speed) * math.sqrt(2.0 * recovery / slowing))
    mark[su.FIRST] = here - a - (behind if speed > 0.0 else before)
    mark[su.LAST] = here + a + (before if speed > 0.0 else behind)
    su.press(surface, mark)


@njit(types.void(MODEL, WORK, int64), cache=True, **PLAIN)
def _regrip(m, w, event):
    """Let the contact point rest, or slide off."""
    seen, now = w.seen, w.now
    compliant = m.body[at.COMPLIANCE] < math.inf
    if event == at.SLIDE:
        pull = seen[at.M_TN] * seen[at.FORCE] + seen[at.B_T]
        if compliant:
            # At a touch the spring is still slack: the bodies' motion decides.
            slack = abs(seen[at.TANGENTIAL]) <= 1e-6 * w.scales[at.SMALL_FORCE]
            pull = seen[at.SLIDING] if slack else -seen[at.TANGENTIAL]
        now[at.MODE] = 1.0 if pull > 0.0 else -1.0
    elif compliant:
        _grip(w)
    elif rubbing(m):
        now[at.MODE] = sliding_mode(m, w, rest_friction(m, w))
    else:
        now[at.MODE] = -now[at.MODE]


@njit(types.void(MODEL, WORK, int64), cache=True, **PLAIN)
def change(m, w, event):
    """Do what the event says: another phase, another stretch, another way of sliding."""
    now, tally, z = w.now, w.tally, w.z
    compliant = m.body[at.COMPLIANCE] < math.inf
    _note_interval(m, w)
    if event <= at.RETURNED:
        _note_half(w)
    if compliant and (event == at.TURN or event == at.RETURNED):
        # The spring keeps its force while the area grows, its deformation while it shrinks.
        derivative(m, w, at.BY_TIME, 0.0, z, w.stages[0], w.seen)
        receding = event == at.TURN
        if w.seen[at.STIFFNESS] > 0.0:
            z[at.SPRING] *= 1.0 / w.seen[at.STIFFNESS] if receding else w.seen[at.STIFFNESS]
        w.branch[fo.RECEDING] = float64(receding)
        w.scale[at.SPRING] = w.scale[at.SLIP] if receding else w.scales[at.SPRING_FORCE]
    if event == at.TURN:
        now[at.APPROACHING] = 0.0
        if math.isnan(tally[at.FIRST_TURN]):
            tally[at.FIRST_TURN] = z[at.TIME]
        now[at.VARIABLE], now[at.STEP] = at.BY_TIME, 0.15 * w.scales[at.T_REF]
        if now[at.PHASE] == at.LOAD:
            _peak(m, w)
    elif event == at.RETURNED:
        now[at.APPROACHING] = 1.0
    elif event == at.RELOAD:
        now[at.PHASE], now[at.VARIABLE] = at.LOAD, at.BY_TIME
        now[at.STEP], now[at.RECHECK] = 0.02 * w.scales[at.T_REF], 1.0
        set_segment(m, w, w.branch[0])
    elif event == at.BORDER:
        now[at.RECHECK] = 1.0
        set_segment(m, w, w.branch[fo.SEGMENT_HIGH])
    elif event == at.REVERSAL:
        now[at.SIDE] = -now[at.SIDE]
    elif event == at.REST or event == at.SLIDE:
        derivative(m, w, at.BY_TIME, 0.0, z, w.stages[0], w.seen)
        _regrip(m, w, event)
