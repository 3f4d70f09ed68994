"""Events of a contact: what ends an interval, when, and how friction goes on after it."""

from __future__ import annotations

import math

from numba import njit

from .. import force as fo
from .. import surface as su
from . import layout as at
from .contact import contact, kinematics, loading_radius, tail_of
from .layout import PLAIN
from .motion import derivative

# fmt: off


@njit(cache=True, **PLAIN)
def sliding_mode(m, w, friction):
    """Sign of sliding that follows rest: 0 when the coefficient `friction` can hold the point.

    The impact's small force stands for the force at a touch, where both sides vanish.
    """
    seen = w.seen
    f = max(seen[at.FORCE], w.scales[at.SMALL_FORCE])
    pull = seen[at.M_TN] * f + seen[at.B_T]
    if abs(pull) <= friction * seen[at.M_TT] * f:
        return 0.0
    return 1.0 if pull > 0.0 else -1.0


@njit(cache=True, **PLAIN)
def rest_friction(m, w):
    """Coefficient that holds a resting point: static and ploughing friction together."""
    return m.body[at.MU_STATIC] + w.seen[at.PLOUGHING]


@njit(cache=True, **PLAIN)
def rubbing(m):
    """Whether there is any friction."""
    return m.body[at.MU_STATIC] > 0.0 or m.body[at.MU] > 0.0 or m.body[at.PLOUGH] > 0.0


@njit(cache=True, **PLAIN)
def slip_speed(m, w, mode, ahead, z, dz, moved):
    """Speed at which a yielding contact slips [m/s]: the bodies' speed less the spring's.

    `dz` is the derivative by time; the friction limit is followed along it for the short time
    `ahead`. Overwrites `moved` and `w.seen_far`.
    """
    seen, branch, phase = w.seen_far, w.branch, w.now[at.PHASE]
    _, limit, _, stiffness = contact(m, w, z, seen)
    speed, depth, rate = seen[at.SLIDING], seen[at.DEPTH], seen[at.RATE]
    from_here = 0.0
    # Look back where looking ahead would leave this stretch of the force.
    if phase == at.UNLOAD and depth + ahead * rate < branch[1] + branch[2]:
        from_here = -2.0 * ahead
        for j in range(len(z)):
            moved[j] = z[j] + from_here * dz[j]
        _, limit, _, stiffness = contact(m, w, moved, seen)
    for j in range(len(z)):
        moved[j] = z[j] + (from_here + ahead) * dz[j]
    _, later, _, stiff = contact(m, w, moved, seen)
    if stiff <= 0.0 or stiffness <= 0.0:
        return mode * abs(speed)
    if branch[fo.RECEDING] > 0.0:
        return speed - mode * (later / stiff - limit / stiffness) / ahead
    grows = later - limit
    if phase == at.LOAD and mode * speed * ahead * stiffness < grows:
        # a jump of the force is no rate: it counts where it has grown so fast up to here as well
        for j in range(len(z)):
            moved[j] = z[j] - ahead * dz[j]
        _, before, _, _ = contact(m, w, moved, seen)
        grows = min(grows, limit - before)
    return speed - mode * grows / (ahead * stiffness)


@njit(cache=True, **PLAIN)
def _yielding_mode(m, w):
    """Sign of sliding at the touch of a contact that gives way sideways; 0 when it sticks.

    Decided a moment ahead of the touch, where friction and spring have grown from nothing.
    """
    z, dz, later, ahead = w.z, w.stages[0], w.moved, w.scales[at.AHEAD]
    for j in range(len(z)):
        later[j] = z[j] + ahead * dz[j]
    kinematics(m, later, w.seen_far)
    mode = 1.0 if w.seen_far[at.SLIDING] > 0.0 else -1.0
    speed = slip_speed(m, w, mode, 1e-3 * ahead, later, dz, w.spare)
    return mode if mode * speed > 0.0 else 0.0


@njit(cache=True, **PLAIN)
def first_mode(m, w):
    """Sign of sliding at a touch; 0 when the point rests and nothing moves it."""
    if m.body[at.COMPLIANCE] < math.inf:
        return _yielding_mode(m, w)
    sliding = w.seen[at.SLIDING]
    if abs(sliding) > 1e-14 * w.scales[at.SPEED]:
        return 1.0 if sliding > 0.0 else -1.0
    return sliding_mode(m, w, rest_friction(m, w) if rubbing(m) else 0.0)


@njit(cache=True, _nrt=False)
def hermite_root(g0, d0, g1, d1, h):
    """Return the fraction in (0, 1) at which the cubic through both ends vanishes."""
    low, high = 0.0, 1.0
    for _ in range(30):
        x = 0.5 * (low + high)
        y = 1.0 - x
        g = (1.0 + 2.0 * x) * y * y * g0 + x * y * y * h * d0
        g += x * x * (3.0 - 2.0 * x) * g1 - x * x * y * h * d1
        if (g < 0.0) == (g1 < 0.0):
            high = x
        else:
            low = x
    return 0.5 * (low + high)


@njit(cache=True, **PLAIN)
def _yielding_values(m, w, z, seen, values):
    """Write the event functions of a contact that gives way sideways."""
    mode = w.now[at.MODE]
    if mode == 0.0:
        # over the forces: near the parting friction vanishes before the spring does
        both = seen[at.FORCE] + abs(seen[at.TANGENTIAL])
        slack = w.now[at.APPROACHING] > 0.0 or z[at.SPRING] == 0.0
        values[at.SLIDE] = 0.0 if slack else -1.0
        if seen[at.FORCE] > 0.0:
            values[at.SLIDE] = -seen[at.MARGIN] / both
    else:
        derivative(m, w, at.BY_TIME, 0.0, z, w.spare, w.seen_far)
        values[at.REST] = mode * slip_speed(
            m, w, mode, w.scales[at.AHEAD], z, w.spare, w.moved)


@njit(cache=True, **PLAIN)
def event_values(m, w, z, seen, values):
    """Write the event functions at a state: each falls through zero when its event happens.

    Overwrites `w.spare`, `w.moved` and `w.seen_far`.
    """
    now, branch = w.now, w.branch
    depth, rate, sliding = seen[at.DEPTH], seen[at.RATE], seen[at.SLIDING]
    values[at.TURN], values[at.RETURNED] = rate, -rate
    values[at.PART] = depth - (branch[1] + branch[2])
    values[at.RELOAD] = branch[0] - depth
    values[at.REST], values[at.REVERSAL] = now[at.MODE] * sliding, now[at.SIDE] * sliding
    values[at.SLIDE] = -seen[at.MARGIN]
    if m.body[at.COMPLIANCE] < math.inf:
        _yielding_values(m, w, z, seen, values)


@njit(cache=True, **PLAIN)
def mark_active(m, w):
    """Mark the events that can end the present interval."""
    now, active = w.now, w.active
    approaching, variable, loading = now[at.APPROACHING] > 0.0, now[at.VARIABLE], now[at.PHASE]
    active[at.TURN] = approaching and variable != at.BY_RATE
    leaving = loading == at.UNLOAD and not approaching and variable != at.BY_ROOT_DEPTH
    active[at.PART] = active[at.RETURNED] = leaving
    active[at.RELOAD] = loading == at.UNLOAD and approaching
    active[at.REST], active[at.SLIDE] = now[at.MODE] != 0.0, now[at.MODE] == 0.0
    active[at.REVERSAL] = m.body[at.COMPLIANCE] < math.inf


@njit(cache=True, **PLAIN)
def by_chord(m, w, event):
    """Whether the event's function has no slope in closed form."""
    if event == at.SLIDE or (event == at.REST and m.body[at.COMPLIANCE] < math.inf):
        return True
    turns = event == at.TURN or event == at.RETURNED
    if turns and w.surface[su.STANDING] > 0.0:
        return True
    plate = m.body[at.S_PLATE] > 0.0
    return plate and (turns or event == at.RELOAD)


@njit(cache=True, **PLAIN)
def event_slope(m, event, z, dz, seen, sign, pace):
    """Derivative of an event function where `pace` is dt per independent variable; 0: no form."""
    if event == at.PART:
        return seen[at.RATE] * pace
    if event == at.RELOAD:
        return -seen[at.RATE] * pace
    if event == at.SLIDE:
        return 0.0
    n, c, rise = len(m.omega), seen[at.ARM], seen[at.RISE]
    if event == at.REST or event == at.REVERSAL:
        turning = dz[at.SPIN] * (rise + m.body[at.TIP]) + z[at.SPIN] ** 2 * c * pace
        pull = dz[at.VX] + turning
        for k in range(n):
            pull += m.psi[0, k] * dz[at.N_RIGID + n + k]
        return sign * pull
    push = -dz[at.VY] + dz[at.SPIN] * c - z[at.SPIN] ** 2 * rise * pace
    tail = tail_of(m.omega, m.sums)
    if tail >= 0:
        push -= dz[tail + at.W_RATE]
    for k in range(n):
        push -= m.psi[1, k] * dz[at.N_RIGID + n + k]
    return push if event == at.TURN else -push


@njit(cache=True, **PLAIN)
def meet(m, w, x):
    """Begin a contact at x: the phase, what the law's depth is counted from, the branch.

    A bed is met at its residual depth and is elastic up to the peak that it stands for; fresh metal
    is met at no depth. Either lies where the surface says that the tip meets it.
    """
    now, branch, surface = w.now, w.branch, w.surface
    surface[su.STANDING] = surface[su.COUNT]
    now[at.APPROACHING] = 1.0
    branch[fo.RECEDING] = 0.0
    for i in range(fo.PEAK_FORCE):
        branch[i] = 0.0
    now[at.PHASE], now[at.OFFSET] = at.LOAD, surface[su.TIP_FLAT]
    here = su.bed(surface, x)
    most = max(here, surface[su.TIP_PEAK])
    if most <= 0.0:
        return
    tip, flat = m.residual(m.par, most)
    share = tip / (tip + flat) if tip + flat > 0.0 else 0.0
    peak = share * surface[su.TIP_PEAK] + (1.0 - share) * here
    if peak <= 0.0:
        return
    fo.set_peak(m.loading, m.unloading, m.residual, m.par, m.force, m.factors, peak, branch)
    branch[fo.PEAK_RADIUS] = loading_radius(m, peak)
    now[at.PHASE] = at.UNLOAD
    now[at.OFFSET] -= branch[1] + branch[2]
