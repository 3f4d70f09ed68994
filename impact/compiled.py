"""The compiled integrator: one impact after another through the same scalar kernels.

DOP853 (Hairer, Norsett and Wanner) with event location: a step that crosses an event is repeated
with the length that ends on it. `integrate.py` holds the reference that this one must agree with.
"""

from __future__ import annotations

import math

import numpy as np
from numba import boolean, float64, int64, njit, types
from scipy.integrate import DOP853

from ..models.base import VECTOR
from .force import (
    BRANCH,
    DAMPING,
    LOADING,
    MODULUS,
    N_BRANCH,
    RADIATION,
    SEGMENT_HIGH,
    SEGMENT_LOW,
    SPLIT,
    set_peak,
    static_loading,
    static_unloading,
)

# The kernels take their state as plain vectors; the calls stay on few lines.
# fmt: off
MATRIX = types.Array(types.float64, 2, "C", readonly=False)

# The state vector: rise of the centre of mass, rotation, their rates, the support's sinking and
# its rate, slip and the integrals; modal coordinates and their rates follow.
X, Y, PHI, VX, VY, SPIN, W, W_RATE, SLIP, P_N, P_T, WORK_N, WORK_T, WORK_S, WORK_D, TIME = range(16)
N_RIGID = 16

# The body vector.
(MASS, INERTIA, HALF_COS, HALF_SIN, TIP, GRAVITY, MU, MU_STATIC, MU_SPEED, PLOUGH, S_MASS, S_STIFF,
 S_DAMP, S_PLATE, V_X, V_Y, V_SPIN, FLIGHT, LOSS, TOLERANCE, MAX_STEPS,
 MAX_CONTACTS) = range(22)
N_BODY = 22

# The spot vector: memory of crater and tip.
SPOT_PEAK, SPOT_FLAT, SPOT_TIP, SPOT_CENTRE, SPOT_RADIUS = range(5)
N_SPOT = 5

# What a contact evaluation tells besides the derivative.
(DEPTH, RATE, FORCE, TANGENTIAL, SLIDING, MARGIN, M_TT, M_TN, B_T, ARM, RISE,
 ACCELERATION) = range(12)
N_SEEN = 12

OBSERVABLES = (
    "restitution", "kinetic_restitution", "energetic_restitution", "tangential_restitution",
    "residual_sphere_m", "residual_flat_m", "peak_depth_m", "contact_time_s", "touching_time_s",
    "loading_time_s", "peak_force_N", "rebound_spin_rad_s", "sliding_length_m", "scar_travel_m",
    "friction_impulse_ratio", "normal_impulse_Ns", "tangential_impulse_Ns", "contact_work_J",
    "friction_work_J", "modal_energy_J", "support_energy_J", "rebound_speed_m_s",
    "tangential_rebound_m_s", "energy_residual", "momentum_residual",
    "tip_rebound_m_s",
)
(O_E, O_KINETIC, O_ENERGETIC, O_TANGENTIAL, O_RES_S, O_RES_F, O_PEAK, O_TIME, O_TOUCHING, O_LOADING,
 O_FORCE, O_SPIN, O_SLIDING, O_SCAR, O_RATIO, O_PN, O_PT, O_WORK, O_FRICTION, O_MODAL, O_SUPPORT,
 O_VY, O_VX, O_ENERGY, O_MOMENTUM, O_TIP) = range(26)
COUNTS = ("ending", "contacts", "steps", "evaluations", "stuck")
N_OUT = len(OBSERVABLES) + len(COUNTS)
FIRST_COUNT = len(OBSERVABLES)

_BREAK_GAP = 1e-13

DONE, STEP_BUDGET, CONTACT_BUDGET, NOT_FINITE = range(4)
LOAD, UNLOAD, FLY = range(3)

# The independent variable of a step: time; the square root of the time since touch, in which the
# force grows smoothly; the square root of the depth left to separation, in which it fades so; the
# rate of penetration, which ends on the turning point.
BY_TIME, BY_ROOT_TIME, BY_ROOT_DEPTH, BY_RATE = range(4)

_STAGES = int(DOP853.n_stages)
# Row i gives the state of stage i; the last row is the step's own result.
_A = np.ascontiguousarray(np.vstack([DOP853.A[:_STAGES, :_STAGES], DOP853.B]))
_C = np.ascontiguousarray(np.append(DOP853.C[:_STAGES], 1.0))
_E3 = np.ascontiguousarray(DOP853.E3[: _STAGES + 1])
_E5 = np.ascontiguousarray(DOP853.E5[: _STAGES + 1])
_BITES = 40
_FAST = {"reassoc", "contract"}  # the loops over the modes may be summed in vectors


@njit(
    types.void(VECTOR, VECTOR, MATRIX, int64, VECTOR),
    cache=True,
    error_model="numpy",
    fastmath=_FAST,
)
def _kinematics(body, z, psi, n_modes, seen):
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


@njit(float64(int64, float64, VECTOR), cache=True, error_model="numpy")
def _pace(variable, place, seen):
    """Time per unit of the independent variable, dt / d(place)."""
    if variable == BY_TIME:
        return 1.0
    if variable == BY_ROOT_TIME:
        return 2.0 * place
    if variable == BY_ROOT_DEPTH:
        return 2.0 * place / seen[RATE]
    return 1.0 / seen[ACCELERATION]


def _derivative_of(loading, radius, unloading, par, force, factors, body, omega, psi, shape, branch,
                phase, mode, offset, variable, place, z, dz, seen):
    """Write the state's derivative and what is seen of the contact.

    `mode` is the sign of sliding, 0 for stick; `place` is the value of the independent variable.
    """
    n = len(omega)
    _kinematics(body, z, psi, n, seen)
    c = seen[ARM]
    s = seen[RISE] + body[TIP]
    m, inertia, spin = body[MASS], body[INERTIA], z[SPIN]
    depth = seen[DEPTH] - offset
    seen[DEPTH] = depth
    plate = body[S_PLATE]
    f = 0.0
    ploughing = 0.0
    if phase != FLY:
        if phase == LOAD:
            d = min(max(depth, branch[SEGMENT_LOW]), branch[SEGMENT_HIGH])
            f = static_loading(loading, par, force, factors, d)
        else:
            f = static_unloading(unloading, par, branch, depth)
        if force[RADIATION] != 0.0 or body[PLOUGH] != 0.0:
            a = 0.0
            if depth > 0.0:
                a = radius(par, depth, max(depth, branch[0] if phase == UNLOAD else depth))
            ploughing = body[PLOUGH] * 4.0 / (3.0 * math.pi) * a / body[TIP]
            f += force[RADIATION] * (2.0 * force[MODULUS] * a) ** 2 * seen[RATE]
        if force[DAMPING] != 0.0:
            f += f * force[DAMPING] * seen[RATE]
        f = max(f, 0.0)
    # A plate's surface gives way at a speed proportional to the force.
    seen[RATE] -= plate * f
    mtt = 1.0 / m + s * s / inertia + shape[0]
    mtn = -c * s / inertia + shape[1]
    bt = spin * spin * c
    loss = body[LOSS]
    if n > 0:
        across, along = psi[0], psi[1]
        q, p = z[N_RIGID : N_RIGID + n], z[N_RIGID + n :]
        for k in range(n):
            bt -= across[k] * omega[k] * (omega[k] * q[k] + loss * p[k])
    sliding = seen[SLIDING]
    rest = body[MU_STATIC] + ploughing
    need = -(mtn * f + bt) / mtt
    if mode == 0.0:
        ft = need
    else:
        mu = body[MU]
        if body[MU_STATIC] != body[MU]:
            mu += (body[MU_STATIC] - mu) * math.exp(-abs(sliding) / body[MU_SPEED])
        ft = -mode * (mu + ploughing) * f
    if phase == FLY:
        ft = 0.0
    seen[FORCE], seen[TANGENTIAL] = f, ft
    seen[MARGIN] = abs(need) - rest * f
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
        pace = _pace(variable, place, seen)
        for j in range(len(z)):
            dz[j] *= pace


_DERIVATIVE = types.void(LOADING, BRANCH, BRANCH, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX,
                         VECTOR, VECTOR, int64, float64, float64, int64, float64, VECTOR, VECTOR,
                         VECTOR)
_derivative_inlined = njit(inline="always", error_model="numpy", fastmath=_FAST)(_derivative_of)
_derivative = njit(_DERIVATIVE, cache=True, error_model="numpy", fastmath=_FAST)(_derivative_of)


@njit(
    float64(LOADING, BRANCH, BRANCH, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX, VECTOR,
            VECTOR, int64, float64, float64, int64, float64, float64, VECTOR, MATRIX, VECTOR,
            VECTOR, VECTOR, VECTOR, VECTOR),
    cache=True, error_model="numpy", fastmath=_FAST,
)
def _step(loading, radius, unloading, par, force, factors, body, omega, psi, shape, branch, phase,
          mode, offset, variable, place, h, z, stages, z_new, work, z_err, scale, seen):
    """Take one DOP853 step from `z` (derivative in stages[0]); return the error in tolerances.

    The last row of `stages` holds the derivative at the new state, `seen` what is seen there.
    """
    size = len(z)
    for i in range(1, _STAGES + 1):
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
    for k in range(_STAGES + 1):
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


@njit(float64(VECTOR, float64, float64), cache=True)
def _sliding_mode(seen, rest_friction, small_force):
    """Sign of sliding that follows rest: 0 when friction can hold the contact point.

    `small_force` stands for the force at a touch, where both sides of the question vanish.
    """
    f = max(seen[FORCE], small_force)
    pull = seen[M_TN] * f + seen[B_T]
    if abs(pull) <= rest_friction * seen[M_TT] * f:
        return 0.0
    return 1.0 if pull > 0.0 else -1.0


@njit(float64(VECTOR, float64, float64, boolean, float64), cache=True)
def _first_mode(seen, rest_friction, small_force, rubbing, speed):
    """Sign of sliding at a touch; 0 when the point rests and nothing moves it."""
    if abs(seen[SLIDING]) > 1e-14 * speed:
        return 1.0 if seen[SLIDING] > 0.0 else -1.0
    return _sliding_mode(seen, rest_friction if rubbing else 0.0, small_force)


@njit(float64(float64, float64, float64, float64, float64), cache=True)
def _hermite_root(g0, d0, g1, d1, h):
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


@njit(float64(int64, VECTOR, float64, VECTOR), cache=True)
def _event_value(event, seen, mode, branch):
    """Event functions: each falls through zero when its event happens."""
    if event == 0:
        return seen[RATE]
    if event == 1:
        return seen[DEPTH] - (branch[1] + branch[2])
    if event == 2:
        return -seen[RATE]
    if event == 3:
        return branch[0] - seen[DEPTH]
    if event == 4:
        return mode * seen[SLIDING]
    if event == 5:
        return -seen[MARGIN]
    if event == 7:
        return branch[SEGMENT_HIGH] - seen[DEPTH]
    return -seen[DEPTH]


@njit(float64(int64, VECTOR, VECTOR, VECTOR, MATRIX, int64, VECTOR, float64, float64), cache=True,
      error_model="numpy")
def _event_slope(event, body, z, dz, psi, n, seen, mode, pace):
    """Derivative of an event function where `pace` is dt per independent variable; 0: no form."""
    if event == 1:
        return seen[RATE] * pace
    if event == 3 or event == 6 or event == 7:
        return -seen[RATE] * pace
    if event == 5:
        return 0.0
    c, rise = seen[ARM], seen[RISE]
    if event == 4:
        pull = dz[VX] + dz[SPIN] * (rise + body[TIP]) + z[SPIN] ** 2 * c * pace
        for k in range(n):
            pull += psi[0, k] * dz[N_RIGID + n + k]
        return mode * pull
    push = -dz[VY] + dz[SPIN] * c - z[SPIN] ** 2 * rise * pace - dz[W_RATE]
    for k in range(n):
        push -= psi[1, k] * dz[N_RIGID + n + k]
    return push if event == 0 else -push


@njit(float64(VECTOR, VECTOR, MATRIX, int64), cache=True)
def _tip_x(body, z, psi, n):
    """Tangential position of the contact point on the flat [m], 0 at first touch."""
    sine, cosine = math.sin(0.5 * z[PHI]), math.cos(0.5 * z[PHI])
    x = z[X] + 2.0 * sine * (body[HALF_SIN] * cosine + body[HALF_COS] * sine)
    for k in range(n):
        x += psi[0, k] * z[N_RIGID + k]
    return x


@njit(float64(VECTOR, float64), cache=True)
def _crater(spot, x):
    """Depth of the crater at the tangential position x [m], a parabola about its centre."""
    if spot[SPOT_RADIUS] <= 0.0:
        return 0.0
    r = (x - spot[SPOT_CENTRE]) / spot[SPOT_RADIUS]
    return spot[SPOT_FLAT] * max(0.0, 1.0 - r * r)


@njit(
    types.UniTuple(float64, 3)(
        LOADING, BRANCH, SPLIT, VECTOR, VECTOR, VECTOR, VECTOR, float64, VECTOR
    ),
    cache=True,
)
def _meet(loading, unloading, residual, par, force, factors, spot, x, branch):
    """Begin a contact at x: return (phase, offset of the law's depth, crater depth here).

    The hardened crater is met within half its radius, and the flattened tip everywhere when the
    tip is the weaker body; else fresh metal.
    """
    local = _crater(spot, x)
    offset = local + spot[SPOT_TIP]
    if spot[SPOT_PEAK] <= 0.0:
        return float(LOAD), offset, local
    set_peak(loading, unloading, residual, par, force, factors, spot[SPOT_PEAK], branch)
    same = abs(x - spot[SPOT_CENTRE]) <= 0.5 * spot[SPOT_RADIUS]
    if same or branch[1] > branch[2]:
        return float(UNLOAD), offset - branch[1] - branch[2], local
    for i in range(SEGMENT_LOW):
        branch[i] = 0.0
    return float(LOAD), offset, local


@njit(types.void(VECTOR, VECTOR, VECTOR, float64, VECTOR), cache=True, error_model="numpy")
def _coast(body, z, omega, t, z_new):
    """Write the state after a flight of duration t: ballistic motion, free damped vibration."""
    n = len(omega)
    for j in range(len(z)):
        z_new[j] = z[j]
    z_new[X] += z[VX] * t
    z_new[Y] += z[VY] * t - 0.5 * body[GRAVITY] * t * t
    z_new[VY] -= body[GRAVITY] * t
    z_new[PHI] += z[SPIN] * t
    z_new[TIME] += t
    zeta = 0.5 * body[LOSS]
    root = math.sqrt(1.0 - zeta * zeta)
    for k in range(n):
        q, p, w = z[N_RIGID + k], z[N_RIGID + n + k], omega[k]
        fade = math.exp(-zeta * w * t)
        cosine, sine = math.cos(w * root * t), math.sin(w * root * t) / root
        z_new[N_RIGID + k] = fade * (q * (cosine + zeta * sine) + p / w * sine)
        z_new[N_RIGID + n + k] = fade * (p * (cosine - zeta * sine) - q * w * sine)
        energy = p * p + w * w * q * q
        left = z_new[N_RIGID + n + k] ** 2 + (w * z_new[N_RIGID + k]) ** 2
        z_new[WORK_D] += 0.5 * (energy - left)


@njit(float64(VECTOR, VECTOR, VECTOR, float64, MATRIX, VECTOR), cache=True, error_model="numpy")
def _clearance(body, spot, z, centre, psi, seen):
    """How far the tip is from meeting the flat below it [m]; negative when it would be inside."""
    n = psi.shape[1]
    _kinematics(body, z, psi, n, seen)
    return spot[SPOT_TIP] + _crater(spot, centre + _tip_x(body, z, psi, n)) - seen[DEPTH]


@njit(
    boolean(VECTOR, VECTOR, VECTOR, MATRIX, float64, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR),
    cache=True, error_model="numpy",
)
def _fly(body, spot, omega, psi, centre, z, z_new, z_now, z_far, seen):
    """Follow a free flight to the next touch; write it into `z_new`; return whether there is one.

    The vibration is known in closed form: the tip is looked at twelve times in each period of
    the fastest mode, and no longer once no vibration can bring it back.
    """
    n = len(omega)
    step = 2.0 * math.pi / (12.0 * omega[n - 1])
    reach = 0.0
    for k in range(n):
        q, p = z[N_RIGID + k], z[N_RIGID + n + k] / omega[k]
        reach += abs(psi[1, k]) * math.sqrt(q * q + p * p)
    for j in range(N_RIGID):
        z_far[j] = z[j]
    for j in range(N_RIGID, len(z)):
        z_far[j] = 0.0
    # Rotation of each mode over one step, so that a look costs no sine.
    turn = np.empty((4, n))
    zeta = 0.5 * body[LOSS]
    root = math.sqrt(1.0 - zeta * zeta)
    for k in range(n):
        w = omega[k]
        fade = math.exp(-zeta * w * step)
        cosine, sine = math.cos(w * root * step), math.sin(w * root * step) / root
        turn[0, k], turn[1, k] = fade * (cosine + zeta * sine), fade * sine / w
        turn[2, k], turn[3, k] = -fade * w * sine, fade * (cosine - zeta * sine)
    for j in range(len(z)):
        z_now[j] = z[j]
    start, end = z[TIME], z[TIME] + body[FLIGHT]
    # The rim of the crater just left is no obstacle: the tip must first have come clear of it.
    clear = _clearance(body, spot, z, centre, psi, seen) >= 0.0
    q, p = z_now[N_RIGID : N_RIGID + n], z_now[N_RIGID + n :]
    look, touched = 0, False
    while z_now[TIME] < end and not touched:
        look += 1
        t = look * step
        z_now[TIME] = start + t
        z_now[X] = z[X] + z[VX] * t
        z_now[Y] = z[Y] + z[VY] * t - 0.5 * body[GRAVITY] * t * t
        z_now[PHI] = z[PHI] + z[SPIN] * t
        for k in range(n):
            q0 = q[k]
            q[k] = turn[0, k] * q0 + turn[1, k] * p[k]
            p[k] = turn[2, k] * q0 + turn[3, k] * p[k]
        g = _clearance(body, spot, z_now, centre, psi, seen)
        touched = g < 0.0 and clear and seen[RATE] > 0.0
        clear = g >= 0.0 or (clear and touched)
        if look % 16 == 0 and not touched:
            z_far[X], z_far[Y], z_far[PHI] = z_now[X], z_now[Y], z_now[PHI]
            z_far[VY] = z[VY] - body[GRAVITY] * t
            _kinematics(body, z_far, psi, n, seen)
            left = end - z_now[TIME]
            far = seen[DEPTH] + reach + 0.5 * body[GRAVITY] * left * left < spot[SPOT_TIP]
            if far and seen[RATE] < 0.0:
                return False
    if not touched:
        return False
    # The touch lies in (t - step, t]: false position on the exact motion.
    low, high = (look - 1) * step, look * step
    _coast(body, z, omega, low, z_new)
    g_low = max(_clearance(body, spot, z_new, centre, psi, seen), 1e-300)
    _coast(body, z, omega, high, z_new)
    g_high = _clearance(body, spot, z_new, centre, psi, seen)
    side = 0
    for _ in range(100):
        t = (low * g_high - high * g_low) / (g_high - g_low)
        if not low < t < high:
            t = 0.5 * (low + high)
        _coast(body, z, omega, t, z_new)
        g = _clearance(body, spot, z_new, centre, psi, seen)
        if g < 0.0:
            high, g_high = t, g
            if side == -1:
                g_low *= 0.5
            side = -1
        else:
            low, g_low = t, max(g, 1e-300)
            if side == 1:
                g_high *= 0.5
            side = 1
        if high - low <= 1e-15 * (start + high) or g == 0.0:
            break
    return True


@njit(types.void(VECTOR, float64, VECTOR), cache=True)
def _set_segment(breaks, depth, branch):
    """Bound the loading curve to its smooth stretch around `depth`."""
    branch[SEGMENT_LOW], branch[SEGMENT_HIGH] = 0.0, math.inf
    for border in breaks:
        if border <= depth * (1.0 + 2.0 * _BREAK_GAP):
            branch[SEGMENT_LOW] = border
        else:
            branch[SEGMENT_HIGH] = border * (1.0 - _BREAK_GAP)
            break


@njit(float64(LOADING, VECTOR, VECTOR, VECTOR, float64, float64), cache=True)
def _reference_depth(loading, par, force, factors, energy, R):
    """Depth [m] at which about `energy` [J] has been taken up; the scale of the tolerances."""
    d = 1e-12 * R
    taken, last = 0.0, 0.0
    while taken < energy and d < 10.0 * R:
        f = static_loading(loading, par, force, factors, d)
        taken += 0.25 * d * (f + last)
        last = f
        d *= 2.0
    return d


@njit(
    types.void(LOADING, BRANCH, BRANCH, SPLIT, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR, VECTOR,
               VECTOR, MATRIX, VECTOR),
    cache=True, error_model="numpy",
)
def one_impact(loading, radius, unloading, residual, par, force, factors, breaks, body, spot, omega,
               psi, out):
    """Integrate one impact; fill `out` with OBSERVABLES and COUNTS and update `spot`.

    Follows the contact through loading, unloading, flight and re-contact, and the contact point
    through sliding, reversal and stick, from event to event.
    """
    n = len(omega)
    size = N_RIGID + 2 * n
    z, z_new, work, z_err = np.zeros(size), np.zeros(size), np.zeros(size), np.zeros(size)
    scale, seen, seen_new = np.ones(size), np.zeros(N_SEEN), np.zeros(N_SEEN)
    stages, branch, shape = np.zeros((_STAGES + 1, size)), np.zeros(N_BRANCH), np.zeros(3)
    values, values_new = np.zeros(8), np.zeros(8)
    for k in range(n):
        shape[0] += psi[0, k] ** 2
        shape[1] += psi[0, k] * psi[1, k]
        shape[2] += psi[1, k] ** 2
    out[:] = np.nan
    m, inertia = body[MASS], body[INERTIA]
    rubbing = body[MU_STATIC] > 0.0 or body[MU] > 0.0 or body[PLOUGH] > 0.0
    centre0 = spot[SPOT_CENTRE] if spot[SPOT_PEAK] > 0.0 else 0.0
    phase_f, offset, local = _meet(
        loading, unloading, residual, par, force, factors, spot, centre0, branch)
    phase = int(phase_f)
    _set_segment(breaks, 0.0, branch)
    z[Y] = -(offset + (branch[1] + branch[2] if phase == UNLOAD else 0.0))
    y_start = z[Y]
    z[VX], z[VY], z[SPIN] = body[V_X], body[V_Y], body[V_SPIN]
    _kinematics(body, z, psi, n, seen)
    v_n, v_t = seen[RATE], seen[SLIDING]
    c0 = body[HALF_COS]
    reduced = 1.0 / (1.0 / m + c0 * c0 / inertia)
    d_ref = _reference_depth(loading, par, force, factors, 0.5 * reduced * v_n * v_n, body[TIP])
    t_ref = d_ref / v_n
    small_force = 1e-7 * reduced * v_n / t_ref
    arm = math.sqrt(inertia / m)
    tolerance = body[TOLERANCE]
    # The last move to an event is linear in time; its error is the square of its share of a step.
    bite = 0.1 * math.sqrt(tolerance)
    # Yield begins within the first step: the finer the tolerance, the less may be skipped.
    first_step = 0.15 * math.sqrt(t_ref) * min(1.0, (tolerance / 1e-7) ** 0.25)
    scale[X] = tolerance * (d_ref + abs(body[V_X]) * t_ref)
    scale[SLIP] = tolerance * (d_ref + abs(v_t) * t_ref)
    scale[Y] = scale[W] = tolerance * d_ref
    scale[TIME] = tolerance * t_ref
    scale[PHI] = tolerance * (d_ref / arm + abs(body[V_SPIN]) * t_ref)
    scale[VX] = tolerance * (v_n + abs(body[V_X]))
    scale[VY] = scale[W_RATE] = tolerance * v_n
    scale[SPIN] = tolerance * (v_n / arm + abs(body[V_SPIN]))
    scale[P_N] = scale[P_T] = tolerance * reduced * v_n
    scale[WORK_N:N_RIGID] = tolerance * reduced * v_n * v_n
    scale[WORK_T] = tolerance * reduced * v_n * (v_n + abs(v_t))
    root_mass = math.sqrt(m)
    for k in range(n):
        scale[N_RIGID + k] = tolerance * d_ref * root_mass
        scale[N_RIGID + n + k] = tolerance * v_n * root_mass

    _derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape, branch,
                phase, 1.0, offset, BY_TIME, 0.0, z, stages[0], seen)
    mode = _first_mode(seen, body[MU_STATIC], small_force, rubbing, v_n)
    approaching = True
    t_touch, touching, first_turn, t_last = 0.0, 0.0, np.nan, 0.0
    p_mark, w_mark, p_in, p_out, w_in, w_out = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    slip_low, slip_high, slip_base, x_low, x_high = 0.0, 0.0, 0.0, 0.0, 0.0
    peak_force, peak_depth, deepest_s, deepest_f = 0.0, 0.0, spot[SPOT_TIP], spot[SPOT_FLAT]
    contacts, steps, evaluations, ending = 1, 0, 0, DONE
    # The state at the latest separation is the outcome; a flight that meets nothing is dropped.
    kept = z.copy()
    simple = n == 0
    turning, to_rate = n == 0 and body[S_PLATE] == 0.0, False
    sprung = body[S_MASS] < math.inf
    # A force that depends on the rate may be largest between events.
    rated = force[DAMPING] != 0.0 or force[RADIATION] != 0.0
    stuck, variable, place = 0.0, BY_ROOT_TIME, 0.0
    h = first_step
    fresh, clear = True, True
    while True:
        if fresh:
            _derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                        branch, phase, mode, offset, BY_TIME, place, z, stages[0], seen)
            rest = branch[1] + branch[2]
            if (phase == UNLOAD and simple and not approaching
                    and seen[DEPTH] - rest < 0.6 * (branch[0] - rest)):
                variable, place = BY_ROOT_DEPTH, math.sqrt(max(seen[DEPTH] - rest, 0.0))
                h = -0.4 * place if h > 0.0 else h
            if to_rate or variable == BY_RATE:
                variable, place, to_rate = BY_RATE, seen[RATE], False
                h = -place
                if not seen[ACCELERATION] < 0.0:
                    variable, turning, h = BY_TIME, False, 1e-3 * t_ref
            _derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                        branch, phase, mode, offset, variable, place, z, stages[0], seen)
            evaluations += 2
            fresh = False
            if phase == LOAD:
                peak_force = max(peak_force, seen[FORCE])
            for event in range(8):
                values[event] = _event_value(event, seen, mode, branch)
            if phase == FLY:
                values[6] = spot[SPOT_TIP] + _crater(spot, centre0 + _tip_x(body, z, psi, n))
                values[6] -= seen[DEPTH]
        if mode == 0.0 and rubbing and phase != FLY:
            stuck = 1.0
        if steps >= body[MAX_STEPS]:
            ending = STEP_BUDGET
            break
        if phase == FLY and n > 0 and not sprung:
            if not _fly(body, spot, omega, psi, centre0, z, z_new, work, z_err, seen):
                break
            for j in range(size):
                z[j] = z_new[j]
            if contacts >= body[MAX_CONTACTS]:
                ending = CONTACT_BUDGET
                break
            contacts += 1
            t_touch = z[TIME]
            approaching, fresh = True, True
            phase_f, offset, local = _meet(
                loading, unloading, residual, par, force, factors, spot,
                centre0 + _tip_x(body, z, psi, n), branch)
            phase = int(phase_f)
            _set_segment(breaks, 0.0, branch)
            variable, place, h = BY_ROOT_TIME, 0.0, first_step
            _derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                        branch, phase, 1.0, offset, BY_TIME, place, z, stages[0], seen)
            mode = _first_mode(seen, body[MU_STATIC], small_force, rubbing, v_n)
            continue
        if phase == FLY:
            left = t_last + body[FLIGHT] - z[TIME]
            if left <= 1e-12 * body[FLIGHT]:
                break
            h = min(h, left, body[FLIGHT] / 60.0)
        landing = variable >= BY_ROOT_DEPTH and place + h <= 0.02 * place
        if landing:
            h = -place
        error = _step(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                      branch, phase, mode, offset, variable, place, h, z, stages, z_new, work,
                      z_err, scale, seen_new)
        evaluations += _STAGES
        steps += 1
        if not error <= 1.0:
            h *= max(0.2, 0.9 * error**-0.125) if math.isfinite(error) else 0.1
            if variable == BY_RATE and -h < 1e-4 * place:
                variable, turning, fresh, h = BY_TIME, False, True, 1e-3 * t_ref
            elif variable == BY_ROOT_DEPTH and -h < 1e-5 * place:
                # The tip no longer leaves: depth cannot carry the motion any further.
                variable, simple, fresh, h = BY_TIME, False, True, 1e-3 * t_ref
            elif variable < BY_ROOT_DEPTH and h < 1e-14 * t_ref:
                ending = NOT_FINITE
                break
            continue
        grown = h * min(6.0, 0.9 * max(error, 1e-12) ** -0.125)
        for event in range(8):
            values_new[event] = _event_value(event, seen_new, mode, branch)
        values_new[6] = 1.0
        if phase == FLY:
            values_new[6] = spot[SPOT_TIP] + _crater(spot, centre0 + _tip_x(body, z_new, psi, n))
            values_new[6] -= seen_new[DEPTH]
        chosen, where = -1, 2.0
        pace, pace_new = _pace(variable, place, seen), _pace(variable, place + h, seen_new)
        for event in range(8):
            if phase == FLY:
                active = event == 6 and clear
            elif event == 0:
                active = approaching and variable != BY_RATE
            elif event == 1 or event == 2:
                active = phase == UNLOAD and not approaching and variable != BY_ROOT_DEPTH
            elif event == 3:
                active = phase == UNLOAD and approaching
            elif event == 7:
                active = phase == LOAD
            elif event == 4:
                active = mode != 0.0
            else:
                active = event == 5 and mode == 0.0
            if active and values[event] >= 0.0 and values_new[event] < 0.0:
                d0 = _event_slope(event, body, z, stages[0], psi, n, seen, mode, pace)
                d1 = _event_slope(event, body, z_new, stages[_STAGES], psi, n, seen_new, mode,
                                  pace_new)
                if event == 5:
                    d0 = d1 = (values_new[5] - values[5]) / h
                part = _hermite_root(values[event], d0, values_new[event], d1, h)
                if part < where:
                    chosen, where = event, part
        taken = h
        if chosen >= 0:
            low, high, g_low, g_high = 0.0, 1.0, values[chosen], values_new[chosen]
            part = where
            for _ in range(_BITES):
                x = part * h
                error = _step(loading, radius, unloading, par, force, factors, body, omega, psi,
                      shape, branch, phase, mode, offset, variable, place, x, z, stages, z_new,
                      work, z_err, scale, seen_new)
                evaluations += _STAGES
                g = _event_value(chosen, seen_new, mode, branch)
                if chosen == 6:
                    g = spot[SPOT_TIP] + _crater(spot, centre0 + _tip_x(body, z_new, psi, n))
                    g -= seen_new[DEPTH]
                taken = x
                if g < 0.0:
                    high, g_high = part, g
                else:
                    low, g_low = part, g
                pace_new = _pace(variable, place + x, seen_new)
                slope = h * _event_slope(chosen, body, z_new, stages[_STAGES], psi, n, seen_new,
                                         mode, pace_new)
                if chosen == 5 or (chosen != 1 and body[S_PLATE] > 0.0 and chosen != 4):
                    slope = (g_high - g_low) / (high - low)
                move = -g / slope if slope < 0.0 else 0.5 * (low + high) - part
                target = part + move
                if not low < target < high:
                    target = 0.5 * (low + high)
                    move = target - part
                if abs(move) <= bite and slope < 0.0:
                    for j in range(size):
                        z_new[j] += move * h * stages[_STAGES, j]
                    taken = x + move * h
                    break
                if high - low <= 1e-15:
                    break
                part = target
            if not error <= 1.0:
                # The kink beyond the event hid the error of the way to it: come nearer first.
                h = 0.5 * where * h
                continue
        elif landing:
            chosen = 1 if variable == BY_ROOT_DEPTH else 0
        place += taken
        for j in range(size):
            z[j] = z_new[j]
        if phase != FLY and (chosen >= 0 or rated) and seen_new[FORCE] > peak_force:
            peak_force = seen_new[FORCE]
        if chosen == 6 and seen_new[RATE] <= 0.0:
            # The tip brushes the crater's rim on its way out: no contact.
            chosen, clear, fresh = -1, False, True
        elif phase == FLY and chosen < 0:
            clear = clear or values_new[6] >= 0.0
        if chosen < 0:
            h = grown
            for j in range(size):
                stages[0, j] = stages[_STAGES, j]
            for j in range(N_SEEN):
                seen[j] = seen_new[j]
            for event in range(8):
                values[event] = values_new[event]
            if phase == UNLOAD and simple and variable == BY_TIME and not approaching:
                fresh = True
            if turning and approaching and variable < BY_ROOT_DEPTH and phase != FLY:
                span = grown if variable == BY_TIME else grown * (2.0 * place + grown)
                fresh = seen[RATE] < min(0.45 * v_n, -1.2 * seen[ACCELERATION] * span)
                to_rate = fresh
            continue

        # An event: close the interval that ends here, then change phase or mode.
        fresh = True
        if variable < BY_ROOT_DEPTH:
            h = min(grown, max(0.5 * taken, 0.05 * h))
        _kinematics(body, z, psi, n, seen)
        depth = seen[DEPTH] - offset
        x_tip = centre0 + _tip_x(body, z, psi, n)
        if phase != FLY:
            slip_low = min(slip_low, z[SLIP] - slip_base)
            slip_high = max(slip_high, z[SLIP] - slip_base)
            x_low, x_high = min(x_low, x_tip - centre0), max(x_high, x_tip - centre0)
        if chosen <= 2:
            if approaching:
                p_in += z[P_N] - p_mark
                w_in += z[WORK_N] - w_mark
            else:
                p_out += z[P_N] - p_mark
                w_out -= z[WORK_N] - w_mark
            p_mark, w_mark = z[P_N], z[WORK_N]
        if chosen == 0:
            approaching = False
            if math.isnan(first_turn):
                first_turn = z[TIME]
            variable, h = BY_TIME, 0.15 * t_ref
            if phase == LOAD:
                phase = UNLOAD
                # Metal that was met before stays gone: the residual grows by the difference.
                deepest_s -= branch[1]
                local -= branch[2]
                set_peak(loading, unloading, residual, par, force, factors, depth, branch)
                deepest_s += branch[1]
                local += branch[2]
                deepest_f = max(deepest_f, local)
                spot[SPOT_TIP], spot[SPOT_FLAT] = deepest_s, local
                spot[SPOT_PEAK], spot[SPOT_CENTRE] = depth, x_tip
                spot[SPOT_RADIUS] = radius(par, branch[4], branch[4])
                peak_depth = max(peak_depth, depth + offset)
        elif chosen == 1:
            phase = FLY
            touching += z[TIME] - t_touch
            t_last = z[TIME]
            for j in range(size):
                kept[j] = z[j]
            offset = 0.0
            mode, clear = 1.0, True
            variable, h = BY_TIME, 0.02 * body[FLIGHT]
            if body[FLIGHT] <= 0.0:
                break
        elif chosen == 2:
            approaching = True
        elif chosen == 3:
            phase, variable, h = LOAD, BY_TIME, 0.02 * t_ref
            _set_segment(breaks, branch[0], branch)
        elif chosen == 7:
            _set_segment(breaks, branch[SEGMENT_HIGH], branch)
        elif chosen == 4:
            _derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                        branch, phase, mode, offset, BY_TIME, place, z, stages[0], seen)
            if rubbing:
                mode = _sliding_mode(seen, body[MU_STATIC], small_force)
            else:
                mode = -mode
        elif chosen == 5:
            _derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                        branch, phase, mode, offset, BY_TIME, place, z, stages[0], seen)
            pull = seen[M_TN] * seen[FORCE] + seen[B_T]
            mode = 1.0 if pull > 0.0 else -1.0
        else:
            if contacts >= body[MAX_CONTACTS]:
                ending = CONTACT_BUDGET
                break
            contacts += 1
            t_touch = z[TIME]
            approaching = True
            phase_f, offset, local = _meet(
                loading, unloading, residual, par, force, factors, spot, x_tip, branch)
            phase = int(phase_f)
            _set_segment(breaks, 0.0, branch)
            slip_base += z[SLIP] - kept[SLIP]
            variable, place, h = BY_ROOT_TIME, 0.0, 0.25 * math.sqrt(t_ref)
            _derivative(loading, radius, unloading, par, force, factors, body, omega, psi, shape,
                        branch, phase, 1.0, offset, BY_TIME, place, z, stages[0], seen)
            mode = _first_mode(seen, body[MU_STATIC], small_force, rubbing, v_n)

    if ending == STEP_BUDGET or ending == NOT_FINITE:
        for j in range(size):
            kept[j] = z[j]
        t_last = z[TIME]
    _kinematics(body, kept, psi, n, seen)
    c, s = seen[ARM], seen[RISE] + body[TIP]
    rebound = kept[VY] - kept[SPIN] * c
    out[O_E], out[O_TIP] = rebound / v_n, rebound
    out[O_KINETIC] = p_out / p_in if p_in > 0.0 else np.nan
    out[O_ENERGETIC] = math.sqrt(max(w_out, 0.0) / w_in) if w_in > 0.0 else np.nan
    out[O_TANGENTIAL] = (kept[VX] + kept[SPIN] * s) / v_t if v_t != 0.0 else np.nan
    out[O_RES_S], out[O_RES_F], out[O_PEAK] = deepest_s, deepest_f, peak_depth
    out[O_TIME], out[O_TOUCHING], out[O_LOADING] = t_last, touching, first_turn
    out[O_FORCE], out[O_SPIN] = peak_force, kept[SPIN]
    out[O_SLIDING], out[O_SCAR] = slip_high - slip_low, x_high - x_low
    out[O_PN], out[O_PT] = kept[P_N], kept[P_T]
    out[O_RATIO] = abs(kept[P_T]) / kept[P_N] if kept[P_N] > 0.0 else np.nan
    out[O_WORK], out[O_FRICTION] = kept[WORK_N], kept[WORK_T]
    modal = 0.0
    for k in range(n):
        q, p = kept[N_RIGID + k], kept[N_RIGID + n + k]
        modal += 0.5 * (p * p + (omega[k] * q) ** 2)
    out[O_MODAL] = modal + kept[WORK_D]
    out[O_SUPPORT] = kept[WORK_S]
    out[O_VY], out[O_VX] = kept[VY], kept[VX]
    before = 0.5 * (m * (body[V_X] ** 2 + body[V_Y] ** 2) + inertia * body[V_SPIN] ** 2)
    after = 0.5 * (m * (kept[VX] ** 2 + kept[VY] ** 2) + inertia * kept[SPIN] ** 2)
    fallen = -m * body[GRAVITY] * (kept[Y] - y_start)
    given = out[O_WORK] + out[O_FRICTION] + out[O_MODAL] + out[O_SUPPORT]
    out[O_ENERGY] = (before + fallen - after - given) / before
    drift_y = m * (kept[VY] - body[V_Y]) + m * body[GRAVITY] * t_last - kept[P_N]
    drift_x = m * (kept[VX] - body[V_X]) - kept[P_T]
    out[O_MOMENTUM] = math.hypot(drift_x, drift_y) / (m * v_n)
    out[FIRST_COUNT], out[FIRST_COUNT + 1], out[FIRST_COUNT + 2] = ending, contacts, steps
    out[FIRST_COUNT + 3], out[FIRST_COUNT + 4] = evaluations, stuck


@njit(
    types.void(LOADING, BRANCH, BRANCH, SPLIT, MATRIX, MATRIX, MATRIX, VECTOR, MATRIX, MATRIX,
               MATRIX,
               types.Array(types.float64, 3, "C"), MATRIX),
    cache=True, nogil=True,
)
def many_impacts(loading, radius, unloading, residual, par, force, factors, breaks, body, spot,
                 omega, psi, out):
    """Integrate row after row; all but `breaks` and `body` hold one row or one per impact."""
    for i in range(len(body)):
        one_impact(loading, radius, unloading, residual, par[min(i, len(par) - 1)],
                   force[min(i, len(force) - 1)], factors[min(i, len(factors) - 1)], breaks,
                   body[i], spot[i],
                   omega[min(i, len(omega) - 1)], psi[min(i, len(psi) - 1)], out[i])
