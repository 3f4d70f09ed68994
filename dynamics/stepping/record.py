"""What an impact begins with and what it ends in: scales and start, observables and balances."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from .. import force as fo
from .. import surface as su
from . import layout as at
from .contact import kinematics, penetration, place_of, tail_of
from .flight import clearance, coast
from .layout import PLAIN
from .motion import derivative

# fmt: off


@njit(cache=True, **PLAIN)
def fill(vector, value):
    """Set all entries; numba's own way with slices compiles a broadcast."""
    for j in range(len(vector)):
        vector[j] = value


@njit(cache=True, **PLAIN)
def _reference_depth(m, energy):
    """Depth [m] at which about `energy` [J] has been taken up; the scale of the tolerances.

    Doubled from far below the depth at which elastic bodies have taken it, the least there is.
    """
    tip = m.body[at.TIP]
    stiff = 8.0 / 15.0 * m.force[fo.MODULUS] * math.sqrt(tip)
    d = 1e-12 * tip
    low = 1e-3 * (energy / stiff) ** 0.4
    while d < low:
        d *= 2.0
    taken, last = 0.0, 0.0
    while taken < energy and d < 10.0 * tip:
        f = fo.static_loading(m.loading, m.par, m.force, m.factors, d)
        taken += 0.25 * d * (f + last)
        last = f
        d *= 2.0
    return d


@njit(cache=True, **PLAIN)
def begin(m, w):
    """Put the striker at its first touch and set the impact's scales."""
    body, z, scales, tally = m.body, w.z, w.scales, w.tally
    fill(z, 0.0)
    fill(tally, 0.0)
    fill(w.now, 0.0)
    fill(w.branch, 0.0)
    tally[at.TOP_TIME], tally[at.ENDING] = np.nan, at.GOING
    scales[at.ORIGIN] = w.surface[su.BEGIN]
    low, _ = su.height(w.surface, w.surface[su.COUNT], scales[at.ORIGIN])
    z[at.Y] = scales[at.START_Y] = -(w.surface[su.TIP_FLAT] + low)
    z[at.VX], z[at.VY], z[at.SPIN] = body[at.V_X], body[at.V_Y], body[at.V_SPIN]
    kinematics(m, z, w.seen)
    v_n, v_t, c0 = w.seen[at.RATE], w.seen[at.SLIDING], body[at.HALF_COS]
    mass, inertia = body[at.MASS], body[at.INERTIA]
    reduced = 1.0 / (1.0 / mass + c0 * c0 / inertia)
    d_ref = _reference_depth(m, 0.5 * reduced * v_n * v_n)
    t_ref = d_ref / v_n
    tolerance = body[at.TOLERANCE]
    scales[at.SPEED], scales[at.SPEED_T] = v_n, v_t
    scales[at.D_REF], scales[at.T_REF] = d_ref, t_ref
    scales[at.SMALL_FORCE] = 1e-7 * reduced * v_n / t_ref
    scales[at.AHEAD] = 1e-6 * t_ref
    scales[at.SPRING_FORCE] = tolerance * reduced * v_n / t_ref
    scales[at.BITE], scales[at.LEAP] = 0.1 * math.sqrt(tolerance), 0.3 * tolerance ** (1.0 / 3.0)
    # Yield begins within the first step: the finer the tolerance, the less may be skipped.
    scales[at.FIRST_STEP] = 0.15 * math.sqrt(t_ref) * min(1.0, (tolerance / 1e-7) ** 0.25)
    arm, scale = math.sqrt(inertia / mass), w.scale
    fill(scale, 1.0)
    scale[at.X] = tolerance * (d_ref + abs(body[at.V_X]) * t_ref)
    scale[at.SLIP] = tolerance * (d_ref + abs(v_t) * t_ref)
    scale[at.Y] = tolerance * d_ref
    scale[at.TIME] = tolerance * t_ref
    scale[at.PHI] = tolerance * (d_ref / arm + abs(body[at.V_SPIN]) * t_ref)
    scale[at.VX] = tolerance * (v_n + abs(body[at.V_X]))
    scale[at.VY] = tolerance * v_n
    scale[at.SPIN] = tolerance * (v_n / arm + abs(body[at.V_SPIN]))
    scale[at.P_N] = scale[at.P_T] = tolerance * reduced * v_n
    scale[at.P_SPIN] = scale[at.P_N] * arm
    scale[at.WORK_N] = tolerance * reduced * v_n * v_n
    scale[at.WORK_T] = tolerance * reduced * v_n * (v_n + abs(v_t))
    root_mass, n = math.sqrt(mass), len(m.omega)
    for k in range(n):
        scale[at.N_RIGID + k] = tolerance * d_ref * root_mass
        scale[at.N_RIGID + n + k] = tolerance * v_n * root_mass
    tail = tail_of(m.omega, m.sums)
    if tail >= 0:
        scale[tail + at.W], scale[tail + at.W_RATE] = tolerance * d_ref, tolerance * v_n
        for j in range(tail + at.WORK_S, tail + at.N_TAIL):
            scale[j] = scale[at.WORK_N]


@njit(cache=True, **PLAIN)
def _balance(m, w):
    """Where the energy went and what momentum came from where."""
    body, out, z = m.body, w.out, w.kept
    mass, inertia, n = body[at.MASS], body[at.INERTIA], len(m.omega)
    ringing = 0.0
    for k in range(n):
        q, p = z[at.N_RIGID + k], z[at.N_RIGID + n + k]
        ringing += 0.5 * (p * p + (m.omega[k] * q) ** 2)
    held, given, lost, waves, damped = 0.0, 0.0, 0.0, 0.0, 0.0
    tail = tail_of(m.omega, m.sums)
    if tail >= 0:
        given, lost = z[tail + at.WORK_S], z[tail + at.WORK_D]
        waves, damped = z[tail + at.WORK_R], z[tail + at.WORK_C]
        if body[at.S_MASS] < math.inf:
            held = 0.5 * body[at.S_MASS] * z[tail + at.W_RATE] ** 2
            held += 0.5 * body[at.S_STIFF] * z[tail + at.W] ** 2
    before = mass * (body[at.V_X] ** 2 + body[at.V_Y] ** 2) + inertia * body[at.V_SPIN] ** 2
    after = mass * (z[at.VX] ** 2 + z[at.VY] ** 2) + inertia * z[at.SPIN] ** 2
    fallen = -mass * body[at.GRAVITY] * (z[at.Y] - w.scales[at.START_Y])
    out[at.O_BEFORE], out[at.O_AFTER], out[at.O_FALLEN] = 0.5 * before, 0.5 * after, fallen
    out[at.O_WORK], out[at.O_FRICTION] = z[at.WORK_N], z[at.WORK_T]
    out[at.O_RADIATED], out[at.O_DAMPING] = waves, damped
    out[at.O_PLASTIC] = z[at.WORK_N] - waves - damped
    out[at.O_RINGING], out[at.O_LOSS], out[at.O_MODAL] = ringing, lost, ringing + lost
    out[at.O_SUPPORT], out[at.O_HELD], out[at.O_DASHPOT] = given, held, given - held
    given += z[at.WORK_N] + z[at.WORK_T] + ringing + lost
    out[at.O_ENERGY] = (0.5 * before + fallen - 0.5 * after - given) / (0.5 * before)
    time, scale = w.tally[at.T_LAST], mass * w.scales[at.SPEED]
    up = mass * (z[at.VY] - body[at.V_Y]) + mass * body[at.GRAVITY] * time - z[at.P_N]
    along = mass * (z[at.VX] - body[at.V_X]) - z[at.P_T]
    turned = inertia * (z[at.SPIN] - body[at.V_SPIN]) - z[at.P_SPIN]
    out[at.O_MOMENTUM] = math.hypot(along, up) / scale
    out[at.O_ANGULAR] = abs(turned) / (scale * math.sqrt(inertia / mass))


@njit(cache=True, **PLAIN)
def finish(m, w):
    """Fill `w.out` with the observables, balances and counts."""
    tally, out, kept, scales = w.tally, w.out, w.kept, w.scales
    ending = tally[at.ENDING]
    if ending == at.STEP_BUDGET or ending == at.NOT_FINITE:
        for j in range(len(kept)):
            kept[j] = w.z[j]
        tally[at.T_LAST] = kept[at.TIME]
    fill(out, np.nan)
    kinematics(m, kept, w.seen)
    c, s = w.seen[at.ARM], w.seen[at.RISE] + m.body[at.TIP]
    v_n, v_t = scales[at.SPEED], scales[at.SPEED_T]
    rebound = kept[at.VY] - kept[at.SPIN] * c
    p_in, w_in = tally[at.P_IN], tally[at.W_IN]
    out[at.O_E], out[at.O_TIP] = rebound / v_n, rebound
    out[at.O_KINETIC] = tally[at.P_OUT] / p_in if p_in > 0.0 else np.nan
    out[at.O_ENERGETIC] = math.sqrt(max(tally[at.W_OUT], 0.0) / w_in) if w_in > 0.0 else np.nan
    out[at.O_TANGENTIAL] = (kept[at.VX] + kept[at.SPIN] * s) / v_t if v_t != 0.0 else np.nan
    out[at.O_RES_S], out[at.O_PEAK] = w.surface[su.TIP_FLAT], tally[at.TOP_DEPTH]
    out[at.O_RES_F], place = su.dent(w.surface)
    w.surface[su.BEGIN] = place
    out[at.O_TIME], out[at.O_TOUCHING] = tally[at.T_LAST], tally[at.TOUCHING]
    out[at.O_LOADING] = tally[at.TOP_TIME]
    out[at.O_FORCE], out[at.O_SPIN] = tally[at.TOP_FORCE], kept[at.SPIN]
    out[at.O_SLIDING] = tally[at.SLIP_HIGH] - tally[at.SLIP_LOW]
    out[at.O_TRAVEL] = tally[at.X_HIGH] - tally[at.X_LOW]
    length, width, excess = su.scar(w.surface, m.body[at.SCAN_STEP], m.body[at.SCAN_LEVEL])
    out[at.O_LENGTH], out[at.O_WIDTH], out[at.O_EXCESS] = length, width, excess
    out[at.O_PN], out[at.O_PT] = kept[at.P_N], kept[at.P_T]
    out[at.O_RATIO] = abs(kept[at.P_T]) / kept[at.P_N] if kept[at.P_N] > 0.0 else np.nan
    out[at.O_VY], out[at.O_VX] = kept[at.VY], kept[at.VX]
    _balance(m, w)
    out[at.O_CLEAR], out[at.O_LEAVING] = clearance(m, w, kept)
    first = at.FIRST_COUNT
    out[first], out[first + 1], out[first + 2] = ending, tally[at.CONTACTS], tally[at.STEPS]
    out[first + 3], out[first + 4] = tally[at.EVALUATIONS], tally[at.STUCK]


@njit(cache=True, **PLAIN)
def _write(m, w, z, depth, gap, force, friction):
    """Write one row of the history."""
    row = w.history[int(w.tally[at.ROWS])]
    kinematics(m, z, w.seen_far)
    seen, body = w.seen_far, m.body
    x, _ = place_of(m, z)
    row[0], row[1], row[2], row[3] = z[at.TIME], depth, force, friction
    tail = tail_of(m.omega, m.sums)
    sunk, sinking = (z[tail + at.W], z[tail + at.W_RATE]) if tail >= 0 else (0.0, 0.0)
    row[4], row[5] = -seen[at.RATE] - sinking, seen[at.SLIDING]
    row[6], row[7] = -(seen[at.DEPTH] + sunk), z[at.SLIP]
    row[8] = math.atan2(body[at.HALF_SIN], body[at.HALF_COS]) + z[at.PHI]
    row[9], row[10], row[11] = z[at.SPIN], x, gap
    w.tally[at.ROWS] += 1.0


@njit(cache=True, **PLAIN)
def note(m, w):
    """Add the present state of a contact to the history, as far as there are rows left."""
    row = int(w.tally[at.ROWS])
    if row >= len(w.history):
        return
    derivative(m, w, at.BY_TIME, 0.0, w.z, w.spare, w.seen_far)
    seen = w.seen_far
    force, friction = seen[at.FORCE], seen[at.TANGENTIAL] + seen[at.SLOPE] * seen[at.FORCE]
    penetration(m, w, w.z, seen)
    rest = w.branch[1] + w.branch[2] if w.now[at.PHASE] == at.UNLOAD else 0.0
    _write(m, w, w.z, seen[at.DEPTH], rest - seen[at.DEPTH], force, friction)


@njit(cache=True, **PLAIN)
def note_flight(m, w, end):
    """Add the flight from the latest parting to the time `end` to the history."""
    if len(w.history) == 0:
        return
    start = w.kept[at.TIME]
    count = int(min(max((end - start) / m.body[at.LONGEST], 2.0), 2000.0))
    for i in range(count + 1):
        if int(w.tally[at.ROWS]) >= len(w.history):
            return
        coast(m, w.kept, (end - start) * i / count, w.z_new)
        gap, _ = clearance(m, w, w.z_new)
        _write(m, w, w.z_new, w.seen_far[at.DEPTH], gap, 0.0, 0.0)
