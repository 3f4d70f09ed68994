"""Equations of motion of striker, contact and support, and one step of DOP853 over them."""

from __future__ import annotations

import math

import numpy as np
from numba import float64, int64, njit, types
from scipy.integrate import DOP853

from ...models.kernel import VECTOR
from .. import force as fo
from ..surface import STANDING, height
from . import layout as at
from .layout import MODEL, WORK

# fmt: off
STAGES = int(DOP853.n_stages)
# Row i gives the state of stage i; the last row is the step's own result.
_A = np.ascontiguousarray(np.vstack([DOP853.A[:STAGES, :STAGES], DOP853.B]))
_C = np.ascontiguousarray(np.append(DOP853.C[:STAGES], 1.0))
_E3 = np.ascontiguousarray(DOP853.E3[: STAGES + 1])
_E5 = np.ascontiguousarray(DOP853.E5[: STAGES + 1])
# The loops over the modes may be summed in vectors. Nothing here or in `force` and `events`
# allocates: _nrt=False leaves out numba's counting of references, which took half of an impact.
PLAIN = {"error_model": "numpy", "fastmath": {"reassoc", "contract"}, "_nrt": False}


@njit(int64(VECTOR, VECTOR), cache=True, **PLAIN)
def tail_of(omega, sums):
    """Place in the state behind the modes; -1 where there is nothing."""
    return at.N_RIGID + 2 * len(omega) if sums[at.HAS_TAIL] > 0.0 else -1


def _kinematics_of(m, z, seen):
    """Write the tip's depth below the fresh flat, its rate and the sliding speed into `seen`."""
    body = m.body
    sine, cosine = math.sin(0.5 * z[at.PHI]), math.cos(0.5 * z[at.PHI])
    c0, s0 = body[at.HALF_COS], body[at.HALF_SIN]
    twice, gone = 2.0 * sine * cosine, 2.0 * sine * sine
    c = c0 - c0 * gone - s0 * twice
    rise = s0 - s0 * gone + c0 * twice
    # The tip sinks by (L/2) (sin(theta) - sin(theta_0)), written without cancellation.
    depth = -z[at.Y] + 2.0 * sine * (c0 * cosine - s0 * sine)
    rate = -z[at.VY] + z[at.SPIN] * c
    sliding = z[at.VX] + z[at.SPIN] * (rise + body[at.TIP])
    seen[at.ARM], seen[at.RISE] = c, rise
    n = len(m.omega)
    if n > 0:
        across, along = m.psi[0], m.psi[1]
        q, p = z[at.N_RIGID : at.N_RIGID + n], z[at.N_RIGID + n :]
        for k in range(n):
            depth -= along[k] * q[k]
            rate -= along[k] * p[k]
            sliding += across[k] * p[k]
    tail = tail_of(m.omega, m.sums)
    if tail >= 0:
        depth -= z[tail + at.W]
        rate -= z[tail + at.W_RATE]
    seen[at.DEPTH] = depth
    seen[at.RATE] = rate
    seen[at.SLIDING] = sliding


# The bundles are handed over by value, field for field: what each stage of a step calls is inlined.
_kinematics_inlined = njit(inline="always", **PLAIN)(_kinematics_of)
kinematics = njit(types.void(MODEL, VECTOR, VECTOR), cache=True, **PLAIN)(_kinematics_of)


@njit(types.UniTuple(float64, 2)(MODEL, VECTOR), cache=True, **PLAIN)
def place_of(m, z):
    """Tangential position of the tip's centre [m], 0 at first touch, and its rate [m/s]."""
    body = m.body
    sine, cosine = math.sin(0.5 * z[at.PHI]), math.cos(0.5 * z[at.PHI])
    s0, c0 = body[at.HALF_SIN], body[at.HALF_COS]
    x = z[at.X] + 2.0 * sine * (s0 * cosine + c0 * sine)
    rise = s0 - s0 * 2.0 * sine * sine + c0 * 2.0 * sine * cosine
    speed = z[at.VX] + z[at.SPIN] * rise
    n = len(m.omega)
    if n > 0:
        place = m.psi[2]
        q, p = z[at.N_RIGID : at.N_RIGID + n], z[at.N_RIGID + n :]
        for k in range(n):
            x += place[k] * q[k]
            speed += place[k] * p[k]
    return x, speed


def _penetration_of(m, w, z, seen):
    """Write the law's depth, its rate and the slope of the metal that the touch stands on."""
    _kinematics_inlined(m, z, seen)
    seen[at.DEPTH] -= w.now[at.OFFSET]
    seen[at.SLOPE] = 0.0
    if w.surface[STANDING] > 0.0:
        x, speed = place_of(m, z)
        low, slope = height(w.surface, w.surface[STANDING], w.scales[at.ORIGIN] + x)
        seen[at.DEPTH] -= low
        seen[at.RATE] -= slope * speed
        seen[at.SLOPE], seen[at.TRAVEL] = slope, speed


_penetration_inlined = njit(inline="always", **PLAIN)(_penetration_of)
penetration = njit(types.void(MODEL, WORK, VECTOR, VECTOR), cache=True, **PLAIN)(_penetration_of)


@njit(float64(int64, float64, VECTOR), cache=True, **PLAIN)
def pace_of(variable, place, seen):
    """Time per unit of the independent variable, dt / d(place)."""
    if variable == at.BY_TIME:
        return 1.0
    if variable == at.BY_ROOT_TIME:
        return 2.0 * place
    if variable == at.BY_ROOT_DEPTH:
        return 2.0 * place / seen[at.RATE]
    return 1.0 / seen[at.ACCELERATION]


@njit(float64(MODEL, float64), cache=True, **PLAIN)
def loading_radius(m, depth):
    """Contact radius [m] on loading, with a flat of the tip and the tip's edge."""
    b = m.force[fo.FLAT]
    a = m.radius(m.par, depth, depth) if b == 0.0 else 0.0
    if b > 0.0:
        x = depth + b * b / (2.0 * m.force[fo.RADIUS])
        a = max(b, m.radius(m.par, x, x))
    return min(a, m.force[fo.EDGE])


@njit(float64(MODEL, VECTOR, float64, int64, float64), cache=True, **PLAIN)
def slope_of(m, branch, depth, phase, d):
    """Slope of the static force over the depth [N/m], by a difference inside a smooth stretch."""
    if phase == at.LOAD:
        low, high = fo.loading_window(d, branch[fo.SEGMENT_LOW], branch[fo.SEGMENT_HIGH])
        rise = fo.static_loading(m.loading, m.par, m.force, m.factors, high)
        rise -= fo.static_loading(m.loading, m.par, m.force, m.factors, low)
    else:
        low, high = fo.unloading_window(branch, depth)
        rise = fo.static_unloading(m.unloading, m.par, branch, high)
        rise -= fo.static_unloading(m.unloading, m.par, branch, low)
    return rise / (high - low) if high > low else 0.0


def _contact_of(m, w, z, seen):
    """Return normal force, friction limit, ploughing and tangential stiffness at the state `z`.

    Depth, rate and sliding speed go into `seen`; over an imprint depth and rate are those from the
    remembered surface, which may lean. The tangential stiffness is a multiple of the
    normal one, 2 E' a; during the recovery a falls as the root of the depth left, as Hertz's does
    about the residual depth.
    """
    _penetration_inlined(m, w, z, seen)
    body, force, branch, phase = m.body, m.force, w.branch, w.now[at.PHASE]
    depth = seen[at.DEPTH]
    ploughing, stiffness, waves = 0.0, 0.0, 0.0
    d = depth
    if phase == at.LOAD:
        d = min(max(depth, branch[fo.SEGMENT_LOW]), branch[fo.SEGMENT_HIGH])
        f = fo.static_loading(m.loading, m.par, force, m.factors, d)
    else:
        f = fo.static_unloading(m.unloading, m.par, branch, depth)
    if body[at.PLOUGH] != 0.0:
        a = 0.0
        if depth > 0.0:
            peak = max(depth, branch[0] if phase == at.UNLOAD else depth)
            a = m.radius(m.par, depth, peak)
        ploughing = body[at.PLOUGH] * 4.0 / (3.0 * math.pi) * a / body[at.TIP]
    seen[at.STATIC] = f
    if force[fo.RADIATION] != 0.0:
        # the waves' power is kappa (dF/dt)^2
        slope = slope_of(m, branch, depth, int(phase), d)
        waves = force[fo.RADIATION] * slope * slope * seen[at.RATE]
        f += waves
    if force[fo.DAMPING] != 0.0:
        f += f * force[fo.DAMPING] * seen[at.RATE]
    seen[at.RADIATED] = max(waves, -seen[at.STATIC])
    f = max(f, 0.0)
    if body[at.COMPLIANCE] < math.inf:
        a = 0.0
        if phase == at.LOAD and depth > 0.0:
            a = loading_radius(m, depth)
        elif phase == at.UNLOAD:
            rest = branch[1] + branch[2]
            a = branch[fo.PEAK_RADIUS] * math.sqrt(max(depth - rest, 0.0) / (branch[0] - rest))
        stiffness = 2.0 * body[at.COMPLIANCE] * force[fo.MODULUS] * a
    mu = body[at.MU]
    if body[at.MU_STATIC] != body[at.MU]:
        mu += (body[at.MU_STATIC] - mu) * math.exp(-abs(seen[at.SLIDING]) / body[at.MU_SPEED])
    # A plate's surface gives way at a speed proportional to the force.
    seen[at.RATE] -= body[at.S_PLATE] * f
    return f, (mu + ploughing) * f, ploughing, stiffness


_contact_inlined = njit(inline="always", **PLAIN)(_contact_of)
contact = njit(
    types.UniTuple(float64, 4)(MODEL, WORK, VECTOR, VECTOR), cache=True, **PLAIN)(_contact_of)


@njit(float64(VECTOR, int64, float64, VECTOR, VECTOR), cache=True, **PLAIN)
def _tail(body, tail, f, z, dz):
    """Write the support's part of the derivative; return the acceleration of its sinking."""
    if body[at.S_MASS] == math.inf:
        plate = body[at.S_PLATE]
        dz[tail + at.W], dz[tail + at.W_RATE] = plate * f, 0.0
        dz[tail + at.WORK_S] = f * plate * f
        return 0.0
    w, rate = z[tail + at.W], z[tail + at.W_RATE]
    sinking = (f - body[at.S_STIFF] * w - body[at.S_DAMP] * rate) / body[at.S_MASS]
    dz[tail + at.W], dz[tail + at.W_RATE] = rate, sinking
    dz[tail + at.WORK_S] = f * rate
    return sinking


def _derivative_of(m, w, variable, place, z, dz, seen):
    """Write the state's derivative and what is seen of the contact.

    `variable` is the independent one and `place` its value. The normal force acts along the normal
    of the remembered surface, through the tip's centre; friction along the flat.
    """
    body, omega, mode = m.body, m.omega, w.now[at.MODE]
    n = len(omega)
    f, limit, ploughing, stiffness = _contact_inlined(m, w, z, seen)
    sliding, slope = seen[at.SLIDING], seen[at.SLOPE]
    c = seen[at.ARM]
    s = seen[at.RISE] + body[at.TIP]
    sums, spin = m.sums, z[at.SPIN]
    per_mass, per_inertia = sums[at.PER_MASS], sums[at.PER_INERTIA]
    mtt = per_mass + s * s * per_inertia + sums[at.S_XX]
    mtn = -c * s * per_inertia + sums[at.S_XY]
    if slope != 0.0:
        mtn += slope * (per_mass + s * seen[at.RISE] * per_inertia + sums[at.S_XP])
    bt = spin * spin * c
    loss = body[at.LOSS]
    if n > 0:
        across, along, aside = m.psi[0], m.psi[1], m.psi[2]
        q, p = z[at.N_RIGID : at.N_RIGID + n], z[at.N_RIGID + n :]
        for k in range(n):
            bt -= across[k] * omega[k] * (omega[k] * q[k] + loss * p[k])
    need = -(mtn * f + bt) / mtt
    if body[at.COMPLIANCE] < math.inf:
        dz[at.SPRING] = 0.0
        if mode == 0.0:
            if w.branch[fo.RECEDING] > 0.0:
                need = stiffness * z[at.SPRING]
                dz[at.SPRING] = -sliding
            else:
                need = z[at.SPRING]
                dz[at.SPRING] = -stiffness * sliding
        seen[at.STIFFNESS] = stiffness
    ft = need if mode == 0.0 else -mode * limit
    wall = slope * f
    seen[at.FORCE], seen[at.TANGENTIAL], seen[at.PLOUGHING] = f, ft, ploughing
    seen[at.MARGIN] = abs(need) - (body[at.MU_STATIC] + ploughing) * f
    seen[at.M_TT], seen[at.M_TN], seen[at.B_T] = mtt, mtn, bt
    turning = ft * s - f * c + wall * seen[at.RISE]
    dz[at.X], dz[at.Y], dz[at.PHI] = z[at.VX], z[at.VY], spin
    dz[at.VX] = (ft + wall) * per_mass
    dz[at.VY] = f * per_mass - body[at.GRAVITY]
    dz[at.SPIN] = turning * per_inertia
    dz[at.SLIP] = sliding
    dz[at.P_N], dz[at.P_T], dz[at.P_SPIN] = f, ft + wall, turning
    dz[at.WORK_N] = f * seen[at.RATE]
    dz[at.WORK_T] = -ft * sliding
    dz[at.TIME] = 1.0
    lost, sinking = 0.0, 0.0
    if n > 0:
        dq, dp = dz[at.N_RIGID : at.N_RIGID + n], dz[at.N_RIGID + n :]
        for k in range(n):
            dq[k] = p[k]
            push = across[k] * ft + along[k] * f + aside[k] * wall
            dp[k] = push - omega[k] * (omega[k] * q[k] + loss * p[k])
        if loss > 0.0:
            for k in range(n):
                lost += loss * omega[k] * p[k] * p[k]
    tail = tail_of(omega, sums)
    if tail >= 0:
        sinking = _tail(body, tail, f, z, dz)
        dz[tail + at.WORK_D] = lost
        dz[tail + at.WORK_R] = seen[at.RADIATED] * seen[at.RATE]
        dz[tail + at.WORK_C] = (f - seen[at.STATIC] - seen[at.RADIATED]) * seen[at.RATE]
    # Only used for a body without modes, over metal that does not lean.
    acceleration = -dz[at.VY] + dz[at.SPIN] * c - spin * spin * seen[at.RISE] - sinking
    seen[at.ACCELERATION] = acceleration
    if variable != at.BY_TIME:
        pace = pace_of(variable, place, seen)
        for j in range(len(z)):
            dz[j] *= pace


_derivative_inlined = njit(inline="always", **PLAIN)(_derivative_of)
derivative = njit(
    types.void(MODEL, WORK, int64, float64, VECTOR, VECTOR, VECTOR), cache=True, **PLAIN,
)(_derivative_of)


@njit(float64(MODEL, WORK, float64), cache=True, **PLAIN)
def step(m, w, h):
    """Take one DOP853 step of h from `w.z` into `w.z_new`; return the error in tolerances.

    The first row of `w.stages` holds the derivative at the start, the last one that at the new
    state, `w.seen_new` what is seen there.
    """
    z, z_new, stages, scale = w.z, w.z_new, w.stages, w.scale
    variable, place = int(w.now[at.VARIABLE]), w.now[at.AT]
    size = len(z)
    for i in range(1, STAGES + 1):
        for j in range(size):
            z_new[j] = 0.0
        for k in range(i):
            a = _A[i, k]
            if a != 0.0:
                for j in range(size):
                    z_new[j] += a * stages[k, j]
        for j in range(size):
            z_new[j] = z[j] + h * z_new[j]
        _derivative_inlined(m, w, variable, place + _C[i] * h, z_new, stages[i], w.seen_new)
    # Row by row, so that the inner loops run over the state without a chain of sums.
    fifth, third = w.moved, w.spare
    for j in range(size):
        fifth[j] = 0.0
        third[j] = 0.0
    for k in range(STAGES + 1):
        e5, e3 = _E5[k], _E3[k]
        if e5 != 0.0 or e3 != 0.0:
            for j in range(size):
                fifth[j] += e5 * stages[k, j]
                third[j] += e3 * stages[k, j]
    five, three = 0.0, 0.0
    for j in range(size):
        five += (fifth[j] / scale[j]) ** 2
        three += (third[j] / scale[j]) ** 2
    w.tally[at.EVALUATIONS] += STAGES
    if five == 0.0 and three == 0.0:
        return 0.0
    return abs(h) * five / math.sqrt((five + 0.01 * three) * m.sums[at.SIZE])
