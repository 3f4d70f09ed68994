"""Events of an impact: what ends an interval, when, and how friction goes on after it."""

from __future__ import annotations

import math

from numba import boolean, float64, int64, njit, types

from ..models.kernel import VECTOR
from .force import (
    BRANCH,
    LOADING,
    PEAK_RADIUS,
    RECEDING,
    SEGMENT_HIGH,
    SEGMENT_LOW,
    SPLIT,
    set_peak,
    static_loading,
)
from .layout import (
    ARM,
    B_T,
    BORDER,
    BY_RATE,
    BY_ROOT_DEPTH,
    BY_TIME,
    COMPLIANCE,
    DEPTH,
    FLY,
    FORCE,
    LOAD,
    M_TN,
    M_TT,
    MARGIN,
    MATRIX,
    N_RIGID,
    PART,
    RATE,
    RELOAD,
    REST,
    RETURNED,
    REVERSAL,
    RISE,
    SLIDE,
    SLIDING,
    SPIN,
    SPOT_CENTRE,
    SPOT_PEAK,
    SPOT_RADIUS,
    SPOT_TIP,
    SPRING,
    TANGENTIAL,
    TIP,
    TOUCH,
    TURN,
    UNLOAD,
    VX,
    VY,
    W_RATE,
)
from .motion import contact, crater, derivative, kinematics, loading_radius, tip_x

# fmt: off
_BREAK_GAP = 1e-13


@njit(float64(VECTOR, float64, float64), cache=True, _nrt=False)
def sliding_mode(seen, rest_friction, small_force):
    """Sign of sliding that follows rest: 0 when friction can hold the contact point.

    `small_force` stands for the force at a touch, where both sides of the question vanish.
    """
    f = max(seen[FORCE], small_force)
    pull = seen[M_TN] * f + seen[B_T]
    if abs(pull) <= rest_friction * seen[M_TT] * f:
        return 0.0
    return 1.0 if pull > 0.0 else -1.0


@njit(float64(VECTOR, float64, float64, boolean, float64), cache=True, _nrt=False)
def first_mode(seen, rest_friction, small_force, rubbing, speed):
    """Sign of sliding at a touch; 0 when the point rests and nothing moves it."""
    if abs(seen[SLIDING]) > 1e-14 * speed:
        return 1.0 if seen[SLIDING] > 0.0 else -1.0
    return sliding_mode(seen, rest_friction if rubbing else 0.0, small_force)


@njit(
    float64(LOADING, BRANCH, BRANCH, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX, VECTOR, int64, float64,
            float64, float64, VECTOR, VECTOR, VECTOR, VECTOR),
    cache=True, _nrt=False, error_model="numpy",
)
def slip_speed(loading, radius, unloading, par, force, factors, body, psi, branch, phase, mode,
               offset, ahead, z, dz, moved, seen):
    """Speed at which a yielding contact slips [m/s]: the bodies' speed less the spring's.

    `dz` is the derivative by time; the friction limit is followed along it for the short time
    `ahead`. Overwrites `moved` and `seen`.
    """
    n = psi.shape[1]
    _, limit, _, stiffness = contact(
        loading, radius, unloading, par, force, factors, body, psi, n, branch, phase, offset, z,
        seen)
    speed, depth, rate = seen[SLIDING], seen[DEPTH], seen[RATE]
    from_here = 0.0
    # Look back where looking ahead would leave this stretch of the force.
    if phase == UNLOAD and depth + ahead * rate < branch[1] + branch[2]:
        from_here = -2.0 * ahead
        for j in range(len(z)):
            moved[j] = z[j] + from_here * dz[j]
        _, limit, _, stiffness = contact(
            loading, radius, unloading, par, force, factors, body, psi, n, branch, phase, offset,
            moved, seen)
    elif phase == LOAD and depth + ahead * rate > branch[SEGMENT_HIGH]:
        ahead = -ahead
    for j in range(len(z)):
        moved[j] = z[j] + (from_here + ahead) * dz[j]
    _, later, _, stiff = contact(
        loading, radius, unloading, par, force, factors, body, psi, n, branch, phase, offset, moved,
        seen)
    if stiff <= 0.0 or stiffness <= 0.0:
        return mode * abs(speed)
    if branch[RECEDING] > 0.0:
        return speed - mode * (later / stiff - limit / stiffness) / ahead
    return speed - mode * (later - limit) / (ahead * stiffness)


@njit(
    float64(LOADING, BRANCH, BRANCH, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX, VECTOR, int64, float64,
            float64, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR),
    cache=True, _nrt=False, error_model="numpy",
)
def yielding_mode(loading, radius, unloading, par, force, factors, body, psi, branch, phase, offset,
                  ahead, z, dz, moved, further, seen):
    """Sign of sliding at the touch of a contact that gives way sideways; 0 when it sticks.

    Decided a moment `ahead` of the touch, where friction and spring have grown from nothing.
    """
    for j in range(len(z)):
        moved[j] = z[j] + ahead * dz[j]
    kinematics(body, moved, psi, psi.shape[1], seen)
    mode = 1.0 if seen[SLIDING] > 0.0 else -1.0
    speed = slip_speed(loading, radius, unloading, par, force, factors, body, psi, branch, phase,
                       mode, offset, 1e-3 * ahead, moved, dz, further, seen)
    return mode if mode * speed > 0.0 else 0.0


@njit(float64(float64, float64, float64, float64, float64), cache=True, _nrt=False)
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


@njit(
    types.void(LOADING, BRANCH, BRANCH, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX,
               VECTOR, VECTOR, int64, float64, boolean, float64, float64, float64, float64, VECTOR,
               VECTOR, VECTOR, VECTOR, VECTOR, VECTOR),
    cache=True, _nrt=False, error_model="numpy",
)
def event_values(loading, radius, unloading, par, force, factors, body, spot, omega, psi, shape,
                 branch, phase, mode, approaching, side, offset, ahead, centre0, z, dz, moved, seen,
                 seen_far, values):
    """Write the event functions at a state: each falls through zero when its event happens.

    Overwrites `dz`, `moved` and `seen_far`.
    """
    depth, rate, sliding = seen[DEPTH], seen[RATE], seen[SLIDING]
    values[TURN], values[RETURNED] = rate, -rate
    values[PART], values[RELOAD] = depth - (branch[1] + branch[2]), branch[0] - depth
    values[REST], values[REVERSAL] = mode * sliding, side * sliding
    values[SLIDE], values[BORDER] = -seen[MARGIN], branch[SEGMENT_HIGH] - depth
    values[TOUCH] = 1.0
    if phase == FLY:
        values[TOUCH] = (
            spot[SPOT_TIP] + crater(spot, centre0 + tip_x(body, z, psi, psi.shape[1])) - depth)
    elif body[COMPLIANCE] < math.inf:
        if mode == 0.0:
            # over the forces: near the parting friction vanishes before the spring does
            both = seen[FORCE] + abs(seen[TANGENTIAL])
            slack = approaching or z[SPRING] == 0.0
            values[SLIDE] = 0.0 if slack else -1.0
            if seen[FORCE] > 0.0:
                values[SLIDE] = -seen[MARGIN] / both
        else:
            derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                       branch, phase, mode, offset, BY_TIME, 0.0, z, dz, seen_far)
            values[REST] = mode * slip_speed(
                loading, radius, unloading, par, force, factors, body, psi, branch, phase, mode,
                offset, ahead, z, dz, moved, seen_far)


@njit(types.void(int64, float64, boolean, boolean, boolean, int64, types.boolean[::1]),
      cache=True, _nrt=False)
def mark_active(phase, mode, approaching, clear, compliant, variable, active):
    """Mark the events that can end the present interval."""
    pressed = phase != FLY
    active[TURN] = pressed and approaching and variable != BY_RATE
    leaving = phase == UNLOAD and not approaching and variable != BY_ROOT_DEPTH
    active[PART] = active[RETURNED] = leaving
    active[RELOAD] = phase == UNLOAD and approaching
    active[BORDER] = phase == LOAD and variable != BY_ROOT_DEPTH
    active[REST], active[SLIDE] = pressed and mode != 0.0, pressed and mode == 0.0
    active[REVERSAL] = pressed and compliant
    active[TOUCH] = not pressed and clear


@njit(float64(int64, VECTOR, VECTOR, VECTOR, MATRIX, int64, VECTOR, float64, float64),
      cache=True, _nrt=False, error_model="numpy")
def event_slope(event, body, z, dz, psi, n, seen, sign, pace):
    """Derivative of an event function where `pace` is dt per independent variable; 0: no form."""
    if event == PART:
        return seen[RATE] * pace
    if event == RELOAD or event == TOUCH or event == BORDER:
        return -seen[RATE] * pace
    if event == SLIDE:
        return 0.0
    c, rise = seen[ARM], seen[RISE]
    if event == REST or event == REVERSAL:
        pull = dz[VX] + dz[SPIN] * (rise + body[TIP]) + z[SPIN] ** 2 * c * pace
        for k in range(n):
            pull += psi[0, k] * dz[N_RIGID + n + k]
        return sign * pull
    push = -dz[VY] + dz[SPIN] * c - z[SPIN] ** 2 * rise * pace - dz[W_RATE]
    for k in range(n):
        push -= psi[1, k] * dz[N_RIGID + n + k]
    return push if event == TURN else -push


@njit(
    types.UniTuple(float64, 3)(
        LOADING, BRANCH, BRANCH, SPLIT, VECTOR, VECTOR, VECTOR, VECTOR, float64, VECTOR
    ),
    cache=True, _nrt=False,
)
def meet(loading, radius, unloading, residual, par, force, factors, spot, x, branch):
    """Begin a contact at x: return (phase, offset of the law's depth, crater depth here).

    The hardened crater is met within half its radius, and the flattened tip everywhere when the
    tip is the weaker body; else fresh metal.
    """
    local = crater(spot, x)
    offset = local + spot[SPOT_TIP]
    branch[RECEDING] = 0.0
    if spot[SPOT_PEAK] <= 0.0:
        return float(LOAD), offset, local
    set_peak(loading, unloading, residual, par, force, factors, spot[SPOT_PEAK], branch)
    branch[PEAK_RADIUS] = loading_radius(radius, par, force, branch[0])
    same = abs(x - spot[SPOT_CENTRE]) <= 0.5 * spot[SPOT_RADIUS]
    if same or branch[1] > branch[2]:
        return float(UNLOAD), offset - branch[1] - branch[2], local
    for i in range(SEGMENT_LOW):
        branch[i] = 0.0
    return float(LOAD), offset, local


@njit(types.void(VECTOR, float64, VECTOR), cache=True, _nrt=False)
def set_segment(breaks, depth, branch):
    """Bound the loading curve to its smooth stretch around `depth`."""
    branch[SEGMENT_LOW], branch[SEGMENT_HIGH] = 0.0, math.inf
    for border in breaks:
        if border <= depth * (1.0 + 2.0 * _BREAK_GAP):
            branch[SEGMENT_LOW] = border * (1.0 + _BREAK_GAP)
        else:
            branch[SEGMENT_HIGH] = border * (1.0 - _BREAK_GAP)
            break


@njit(float64(LOADING, VECTOR, VECTOR, VECTOR, float64, float64), cache=True, _nrt=False)
def reference_depth(loading, par, force, factors, energy, R):
    """Depth [m] at which about `energy` [J] has been taken up; the scale of the tolerances."""
    d = 1e-12 * R
    taken, last = 0.0, 0.0
    while taken < energy and d < 10.0 * R:
        f = static_loading(loading, par, force, factors, d)
        taken += 0.25 * d * (f + last)
        last = f
        d *= 2.0
    return d
