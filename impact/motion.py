"""Equations of motion of striker, contact and support, and one step of DOP853 over them."""

from __future__ import annotations

import math

import numpy as np
from numba import float64, int64, njit, types
from scipy.integrate import DOP853

from ..models.kernel import VECTOR
from .force import (
    BRANCH,
    DAMPING,
    EDGE,
    FLAT,
    LOADING,
    MODULUS,
    PEAK_RADIUS,
    RADIATION,
    RADIUS,
    RECEDING,
    SEGMENT_HIGH,
    SEGMENT_LOW,
    loading_window,
    static_loading,
    static_unloading,
    unloading_window,
)
from .layout import (
    ACCELERATION,
    ARM,
    B_T,
    BY_ROOT_DEPTH,
    BY_ROOT_TIME,
    BY_TIME,
    COMPLIANCE,
    DEPTH,
    FLY,
    FORCE,
    GRAVITY,
    HALF_COS,
    HALF_SIN,
    INERTIA,
    LOAD,
    LOSS,
    M_TN,
    M_TT,
    MARGIN,
    MASS,
    MATRIX,
    MU,
    MU_SPEED,
    MU_STATIC,
    N_RIGID,
    P_N,
    P_T,
    PHI,
    PLOUGH,
    PLOUGHING,
    RATE,
    RISE,
    S_DAMP,
    S_MASS,
    S_PLATE,
    S_STIFF,
    SLIDING,
    SLIP,
    SPIN,
    SPOT_CENTRE,
    SPOT_FLAT,
    SPOT_RADIUS,
    SPRING,
    STIFFNESS,
    TANGENTIAL,
    TIME,
    TIP,
    UNLOAD,
    VX,
    VY,
    W_RATE,
    WORK_D,
    WORK_N,
    WORK_S,
    WORK_T,
    W,
    X,
    Y,
)

# fmt: off
STAGES = int(DOP853.n_stages)
# Row i gives the state of stage i; the last row is the step's own result.
_A = np.ascontiguousarray(np.vstack([DOP853.A[:STAGES, :STAGES], DOP853.B]))
_C = np.ascontiguousarray(np.append(DOP853.C[:STAGES], 1.0))
_E3 = np.ascontiguousarray(DOP853.E3[: STAGES + 1])
_E5 = np.ascontiguousarray(DOP853.E5[: STAGES + 1])
_FAST = {"reassoc", "contract"}  # the loops over the modes may be summed in vectors
# Nothing here or in `force` and `events` allocates: _nrt=False leaves out numba's counting of
# references, which took half of an impact.
_PLAIN = {"error_model": "numpy", "fastmath": _FAST, "_nrt": False}


@njit(
    types.void(VECTOR, VECTOR, MATRIX, int64, VECTOR),
    cache=True, _nrt=False,
    error_model="numpy",
    fastmath=_FAST,
)
def kinematics(body, z, psi, n_modes, seen):
    """Write penetration (without crater offset), its rate and the sliding speed into `seen`."""
    sine, cosine = math.sin(0.5 * z[PHI]), math.cos(0.5 * z[PHI])
    c0, s0 = body[HALF_COS], body[HALF_SIN]
    twice, gone = 2.0 * sine * cosine, 2.0 * sine * sine
    c = c0 - c0 * gone - s0 * twice
    rise = s0 - s0 * gone + c0 * twice
    # The tip sinks by (L/2) (sin(theta) - sin(theta_0)), written without cancellation.
    depth = -z[Y] + 2.0 * sine * (c0 * cosine - s0 * sine) - z[W]
    rate = -z[VY] + z[SPIN] * c - z[W_RATE]
    sliding = z[VX] + z[SPIN] * (rise + body[TIP])
    seen[ARM], seen[RISE] = c, rise
    if n_modes > 0:
        across, along = psi[0], psi[1]
        q, p = z[N_RIGID : N_RIGID + n_modes], z[N_RIGID + n_modes :]
        for k in range(n_modes):
            depth -= along[k] * q[k]
            rate -= along[k] * p[k]
            sliding += across[k] * p[k]
    seen[DEPTH] = depth
    seen[RATE] = rate
    seen[SLIDING] = sliding


@njit(float64(VECTOR, VECTOR, MATRIX, int64), cache=True, _nrt=False)
def tip_x(body, z, psi, n):
    """Tangential position of the contact point on the flat [m], 0 at first touch."""
    sine, cosine = math.sin(0.5 * z[PHI]), math.cos(0.5 * z[PHI])
    x = z[X] + 2.0 * sine * (body[HALF_SIN] * cosine + body[HALF_COS] * sine)
    for k in range(n):
        x += psi[0, k] * z[N_RIGID + k]
    return x


@njit(float64(VECTOR, float64), cache=True, _nrt=False)
def crater(spot, x):
    """Depth of the crater at the tangential position x [m], a parabola about its centre."""
    if spot[SPOT_RADIUS] <= 0.0:
        return 0.0
    r = (x - spot[SPOT_CENTRE]) / spot[SPOT_RADIUS]
    return spot[SPOT_FLAT] * max(0.0, 1.0 - r * r)


@njit(float64(int64, float64, VECTOR), cache=True, _nrt=False, error_model="numpy")
def pace_of(variable, place, seen):
    """Time per unit of the independent variable, dt / d(place)."""
    if variable == BY_TIME:
        return 1.0
    if variable == BY_ROOT_TIME:
        return 2.0 * place
    if variable == BY_ROOT_DEPTH:
        return 2.0 * place / seen[RATE]
    return 1.0 / seen[ACCELERATION]


@njit(float64(BRANCH, VECTOR, VECTOR, float64), cache=True, _nrt=False, error_model="numpy")
def loading_radius(radius, par, force, depth):
    """Contact radius [m] on loading, with a flat of the tip and the tip's edge."""
    b = force[FLAT]
    a = radius(par, depth, depth) if b == 0.0 else 0.0
    if b > 0.0:
        x = depth + b * b / (2.0 * force[RADIUS])
        a = max(b, radius(par, x, x))
    return min(a, force[EDGE])


def _contact_of(loading, radius, unloading, par, force, factors, body, psi, n, branch, phase,
                offset, z, seen):
    """Return normal force, friction limit, ploughing and tangential stiffness at the state `z`.

    Depth, rate and sliding speed go into `seen`. The tangential stiffness is a multiple of the
    normal one, 2 E' a; during the recovery a falls as the root of the depth left, as Hertz's does
    about the residual depth.
    """
    kinematics(body, z, psi, n, seen)
    depth = seen[DEPTH] - offset
    seen[DEPTH] = depth
    f, ploughing, stiffness, limit = 0.0, 0.0, 0.0, 0.0
    if phase != FLY:
        if phase == LOAD:
            d = min(max(depth, branch[SEGMENT_LOW]), branch[SEGMENT_HIGH])
            f = static_loading(loading, par, force, factors, d)
        else:
            f = static_unloading(unloading, par, branch, depth)
        if body[PLOUGH] != 0.0:
            a = 0.0
            if depth > 0.0:
                a = radius(par, depth, max(depth, branch[0] if phase == UNLOAD else depth))
            ploughing = body[PLOUGH] * 4.0 / (3.0 * math.pi) * a / body[TIP]
        if force[RADIATION] != 0.0:
            # the waves' power is kappa (dF/dt)^2
            if phase == LOAD:
                low, high = loading_window(d, branch[SEGMENT_LOW], branch[SEGMENT_HIGH])
                rise = static_loading(loading, par, force, factors, high)
                rise -= static_loading(loading, par, force, factors, low)
            else:
                low, high = unloading_window(branch, depth)
                rise = static_unloading(unloading, par, branch, high)
                rise -= static_unloading(unloading, par, branch, low)
            slope = rise / (high - low) if high > low else 0.0
            f += force[RADIATION] * slope * slope * seen[RATE]
        if force[DAMPING] != 0.0:
            f += f * force[DAMPING] * seen[RATE]
        f = max(f, 0.0)
        if body[COMPLIANCE] < math.inf:
            a = 0.0
            if phase == LOAD and depth > 0.0:
                a = loading_radius(radius, par, force, depth)
            elif phase == UNLOAD:
                rest = branch[1] + branch[2]
                a = branch[PEAK_RADIUS] * math.sqrt(
                    max(depth - rest, 0.0) / (branch[0] - rest))
            stiffness = 2.0 * body[COMPLIANCE] * force[MODULUS] * a
        mu = body[MU]
        if body[MU_STATIC] != body[MU]:
            mu += (body[MU_STATIC] - mu) * math.exp(-abs(seen[SLIDING]) / body[MU_SPEED])
        limit = (mu + ploughing) * f
    # A plate's surface gives way at a speed proportional to the force.
    seen[RATE] -= body[S_PLATE] * f
    return f, limit, ploughing, stiffness


_CONTACT = types.UniTuple(float64, 4)(LOADING, BRANCH, BRANCH, VECTOR, VECTOR, VECTOR, VECTOR,
                                      MATRIX, int64, VECTOR, int64, float64, VECTOR, VECTOR)
_contact_inlined = njit(inline="always", **_PLAIN)(_contact_of)
contact = njit(_CONTACT, cache=True, **_PLAIN)(_contact_of)


def _derivative_of(loading, radius, unloading, par, force, factors, body, omega, psi, shape, branch,
                   phase, mode, offset, variable, place, z, dz, seen):
    """Write the state's derivative and what is seen of the contact.

    `mode` is the sign of sliding, 0 for rest; `place` is the value of the independent variable.
    """
    n = len(omega)
    f, limit, ploughing, stiffness = _contact_inlined(
        loading, radius, unloading, par, force, factors, body, psi, n, branch, phase, offset, z,
        seen)
    sliding = seen[SLIDING]
    c = seen[ARM]
    s = seen[RISE] + body[TIP]
    m, inertia, spin = body[MASS], body[INERTIA], z[SPIN]
    plate = body[S_PLATE]
    mtt = 1.0 / m + s * s / inertia + shape[0]
    mtn = -c * s / inertia + shape[1]
    bt = spin * spin * c
    loss = body[LOSS]
    if n > 0:
        across, along = psi[0], psi[1]
        q, p = z[N_RIGID : N_RIGID + n], z[N_RIGID + n :]
        for k in range(n):
            bt -= across[k] * omega[k] * (omega[k] * q[k] + loss * p[k])
    need = -(mtn * f + bt) / mtt
    compliant = body[COMPLIANCE] < math.inf
    if compliant:
        dz[SPRING] = 0.0
        if mode == 0.0 and phase != FLY:
            if branch[RECEDING] > 0.0:
                need = stiffness * z[SPRING]
                dz[SPRING] = -sliding
            else:
                need = z[SPRING]
                dz[SPRING] = -stiffness * sliding
        seen[STIFFNESS] = stiffness
    ft = need if mode == 0.0 else -mode * limit
    if phase == FLY:
        ft = 0.0
    seen[FORCE], seen[TANGENTIAL], seen[PLOUGHING] = f, ft, ploughing
    seen[MARGIN] = abs(need) - (body[MU_STATIC] + ploughing) * f
    seen[M_TT], seen[M_TN], seen[B_T] = mtt, mtn, bt
    dz[X], dz[Y], dz[PHI] = z[VX], z[VY], spin
    dz[VX] = ft / m
    dz[VY] = f / m - body[GRAVITY]
    dz[SPIN] = (ft * s - f * c) / inertia
    if body[S_MASS] < math.inf:
        dz[W] = z[W_RATE]
        dz[W_RATE] = (f - body[S_STIFF] * z[W] - body[S_DAMP] * z[W_RATE]) / body[S_MASS]
        dz[WORK_S] = f * z[W_RATE]
    else:
        dz[W] = plate * f
        dz[W_RATE] = 0.0
        dz[WORK_S] = f * plate * f
    dz[SLIP] = sliding
    dz[P_N], dz[P_T] = f, ft
    dz[WORK_N] = f * seen[RATE]
    dz[WORK_T] = -ft * sliding
    lost = 0.0
    if n > 0:
        across, along = psi[0], psi[1]
        q, p = z[N_RIGID : N_RIGID + n], z[N_RIGID + n :]
        dq, dp = dz[N_RIGID : N_RIGID + n], dz[N_RIGID + n :]
        for k in range(n):
            dq[k] = p[k]
            dp[k] = across[k] * ft + along[k] * f - omega[k] * (omega[k] * q[k] + loss * p[k])
        if loss > 0.0:
            for k in range(n):
                lost += loss * omega[k] * p[k] * p[k]
    dz[WORK_D] = lost
    dz[TIME] = 1.0
    # Only used for a body without modes.
    seen[ACCELERATION] = -dz[VY] + dz[SPIN] * c - spin * spin * seen[RISE] - dz[W_RATE]
    if variable != BY_TIME:
        pace = pace_of(variable, place, seen)
        for j in range(len(z)):
            dz[j] *= pace


_DERIVATIVE = types.void(LOADING, BRANCH, BRANCH, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX,
                         VECTOR, VECTOR, int64, float64, float64, int64, float64, VECTOR, VECTOR,
                         VECTOR)
_derivative_inlined = njit(inline="always", **_PLAIN)(_derivative_of)
derivative = njit(_DERIVATIVE, cache=True, **_PLAIN)(_derivative_of)


@njit(
    float64(LOADING, BRANCH, BRANCH, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX, VECTOR,
            VECTOR, int64, float64, float64, int64, float64, float64, VECTOR, MATRIX, VECTOR,
            VECTOR, VECTOR, VECTOR, VECTOR),
    cache=True, _nrt=False, error_model="numpy", fastmath=_FAST,
)
def step(loading, radius, unloading, par, force, factors, body, omega, psi, shape, branch, phase,
          mode, offset, variable, place, h, z, stages, z_new, work, z_err, scale, seen):
    """Take one DOP853 step from `z` (derivative in stages[0]); return the error in tolerances.

    The last row of `stages` holds the derivative at the new state, `seen` what is seen there.
    """
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
        _derivative_inlined(loading, radius, unloading, par, force, factors, body, omega, psi,
                            shape, branch, phase, mode, offset, variable, place + _C[i] * h,
                            z_new, stages[i], seen)
    # Row by row, so that the inner loops run over the state without a chain of sums.
    for j in range(size):
        work[j] = 0.0
        z_err[j] = 0.0
    for k in range(STAGES + 1):
        e5, e3 = _E5[k], _E3[k]
        if e5 != 0.0 or e3 != 0.0:
            for j in range(size):
                work[j] += e5 * stages[k, j]
                z_err[j] += e3 * stages[k, j]
    five, three = 0.0, 0.0
    for j in range(size):
        five += (work[j] / scale[j]) ** 2
        three += (z_err[j] / scale[j]) ** 2
    if five == 0.0 and three == 0.0:
        return 0.0
    return abs(h) * five / math.sqrt((five + 0.01 * three) * size)
