"""What an event changes: another phase, another way of sliding, or the end of the contact."""

from __future__ import annotations

import math

from numba import float64, njit

from .. import force as fo
from .. import surface as su
from . import layout as at
from .contact import kinematics, law_radius, loading_radius, penetration, place_of
from .events import event_slope, rest_friction, rubbing, sliding_mode
from .flight import TOUCHED, fly
from .layout import PLAIN
from .motion import derivative
from .touch import grip

# limit: m Y^2 F/d of a tip on a thin plate from which it stays there [-]; what comes back is
# below 1e-7 of the speed
_DAMPED = 1e3

# fmt: off


@njit(cache=True, **PLAIN)
def note_interval(m, w):
    """Count how far the point has come on the flat."""
    tally, z = w.tally, w.z
    x, _ = place_of(m, z)
    tally[at.SLIP_LOW] = min(tally[at.SLIP_LOW], z[at.SLIP])
    tally[at.SLIP_HIGH] = max(tally[at.SLIP_HIGH], z[at.SLIP])
    tally[at.X_LOW], tally[at.X_HIGH] = min(tally[at.X_LOW], x), max(tally[at.X_HIGH], x)


@njit(cache=True, **PLAIN)
def note_half(w):
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


@njit(cache=True, **PLAIN)
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
    note_interval(m, w)
    note_half(w)
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


@njit(cache=True, **PLAIN)
def bound(m):
    """Whether a tip that has once turned back while it touched will never part.

    Nothing then gives back what it keeps: its energy falls from swing to swing under its weight.
    """
    body = m.body
    leans = body[at.HALF_COS] != 0.0
    if body[at.HALF_SIN] > 0.0:
        leans = leans or body[at.V_X] != 0.0 or body[at.V_SPIN] != 0.0
    return len(m.omega) == 0 and body[at.S_MASS] == math.inf and not leans


@njit(cache=True, **PLAIN)
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
    a = law_radius(m, branch[4], branch[4])
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


@njit(cache=True, **PLAIN)
def sinks(m, w):
    """Whether a tip goes down with an endless plate that bends as fast as it comes.

    Its force is v/Y while m Y^2 k is large, and fades with its speed; k of Hertz's contact with the
    force's cube root, so that it is thrown back with some (4/(m Y^2 k))^3 of its speed alone.
    """
    derivative(m, w, at.BY_TIME, 0.0, w.z, w.spare, w.seen_far)
    left, mobility = w.seen_far[at.DEPTH], m.body[at.S_PLATE]
    if w.now[at.PHASE] == at.UNLOAD:
        left -= w.branch[1] + w.branch[2]
    damped = m.body[at.MASS] * mobility * mobility * w.seen_far[at.FORCE] > _DAMPED * left
    return bound(m) and damped and w.z[at.VY] < 0.0


@njit(cache=True, **PLAIN)
def rest(m, w):
    """End the impact of a tip that stays on what it has pressed."""
    if w.now[at.PHASE] == at.LOAD:
        _peak(m, w)
    x, _ = place_of(m, w.z)
    su.leave(w.surface, w.scales[at.ORIGIN] + x)
    w.tally[at.ENDING], w.tally[at.T_LAST] = at.RESTS, w.z[at.TIME]
    for j in range(len(w.z)):
        w.kept[j] = w.z[j]


@njit(cache=True, **PLAIN)
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
        grip(w)
    elif rubbing(m):
        now[at.MODE] = sliding_mode(m, w, rest_friction(m, w))
    else:
        now[at.MODE] = -now[at.MODE]


@njit(cache=True, **PLAIN)
def change(m, w, event):
    """Do what the event says: another phase, another stretch, another way of sliding."""
    now, z = w.now, w.z
    compliant = m.body[at.COMPLIANCE] < math.inf
    note_interval(m, w)
    if event <= at.RETURNED:
        note_half(w)
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
        if now[at.PHASE] == at.LOAD:
            _peak(m, w)
        first, branch = 0.1 * w.scales[at.T_REF], w.branch
        if now[at.SIMPLE] > 0.0 and w.seen_new[at.ACCELERATION] < 0.0:
            left = branch[0] - branch[1] - branch[2]
            first = max(0.75 * math.sqrt(-left / w.seen_new[at.ACCELERATION]), 1e-3 * first)
        elif now[at.VARIABLE] == at.BY_TIME:
            first = min(0.9 * now[at.STEP], first)
        now[at.VARIABLE], now[at.STEP] = at.BY_TIME, first
    elif event == at.RETURNED:
        now[at.APPROACHING] = 1.0
    elif event == at.RELOAD:
        now[at.PHASE], now[at.VARIABLE] = at.LOAD, at.BY_TIME
        now[at.STEP], now[at.RECHECK] = 0.02 * w.scales[at.T_REF], 1.0
    elif event == at.REVERSAL:
        now[at.SIDE] = -now[at.SIDE]
    elif event == at.REST or event == at.SLIDE:
        derivative(m, w, at.BY_TIME, 0.0, z, w.stages[0], w.seen)
        _regrip(m, w, event)
