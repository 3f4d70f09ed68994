"""Where the tip is, how deep it presses, and what forces that gives."""

from __future__ import annotations

import math

from numba import float64, njit, types

from ...models.kernel import VECTOR
from .. import force as fo
from ..surface import STANDING, height
from . import layout as at
from .layout import MODEL, PLAIN, WORK

# fmt: off


@njit(cache=True, forceinline=True, **PLAIN)
def half_turn(x):
    """Sine and cosine of half a rotation; by their series where these are exact to rounding."""
    y = x * x
    if y > 0.01:
        return math.sin(x), math.cos(x)
    sine = 1.0 + y * (-1 / 6 + y * (1 / 120 + y * (-1 / 5040 + y * (1 / 362880))))
    cosine = -1 / 720 + y * (1 / 40320 + y * (-1 / 3628800))
    cosine = 1.0 + y * (-1 / 2 + y * (1 / 24 + y * cosine))
    return x * sine, cosine


@njit(cache=True, **PLAIN)
def tail_of(omega, sums):
    """Place in the state behind the modes; -1 where there is nothing."""
    return at.N_RIGID + 2 * len(omega) if sums[at.HAS_TAIL] > 0.0 else -1


def _kinematics_of(m, z, seen):
    """Write the tip's depth below the fresh flat, its rate and the sliding speed into `seen`."""
    body = m.body
    sine, cosine = half_turn(0.5 * z[at.PHI])
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


# What each stage of a step calls is inlined there, and only there.
_SEEN = types.void(MODEL, VECTOR, VECTOR)
_kinematics_inlined = njit(_SEEN, cache=True, forceinline=True, **PLAIN)(_kinematics_of)
kinematics = njit(_SEEN, cache=True, **PLAIN)(_kinematics_of)


@njit(cache=True, **PLAIN)
def place_of(m, z):
    """Tangential position of the tip's centre [m], 0 at first touch, and its rate [m/s]."""
    body = m.body
    sine, cosine = half_turn(0.5 * z[at.PHI])
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


_MET = types.void(MODEL, WORK, VECTOR, VECTOR)
_penetration_inlined = njit(_MET, cache=True, forceinline=True, **PLAIN)(_penetration_of)
penetration = njit(_MET, cache=True, **PLAIN)(_penetration_of)


@njit(cache=True, **PLAIN)
def law_radius(m, depth, peak):
    """Contact radius [m] of the law and the metal's strength, at a depth below a peak."""
    return fo.law_radius(m.radius, m.par, m.force, m.factors, depth, peak)


@njit(cache=True, **PLAIN)
def loading_radius(m, depth):
    """Contact radius [m] on loading, with a flat of the tip and the tip's edge."""
    return fo.static_radius(m.radius, m.par, m.force, m.factors, depth)


@njit(cache=True, **PLAIN)
def slope_of(m, branch, depth, phase):
    """Slope of the static force over the depth [N/m], by a difference."""
    if phase == at.LOAD:
        low, high = fo.loading_window(depth)
        rise = fo.static_loading(m.loading, m.par, m.force, m.factors, high)
        rise -= fo.static_loading(m.loading, m.par, m.force, m.factors, low)
    else:
        low, high = fo.unloading_window(branch, depth)
        rise = fo.static_unloading(m.unloading, m.par, branch, high)
        rise -= fo.static_unloading(m.unloading, m.par, branch, low)
    return rise / (high - low) if high > low else 0.0


@njit(cache=True, **PLAIN)
def _contact_radius(m, branch, depth, phase):
    """Contact radius [m]; in the recovery it falls as the root of the depth left, as Hertz's."""
    if phase == at.LOAD:
        return loading_radius(m, depth) if depth > 0.0 else 0.0
    if phase != at.UNLOAD:
        return 0.0
    rest = branch[1] + branch[2]
    return branch[fo.PEAK_RADIUS] * math.sqrt(max(depth - rest, 0.0) / (branch[0] - rest))


def _contact_of(m, w, z, seen):
    """Return normal force, friction limit, ploughing and tangential stiffness at the state `z`.

    Depth, rate and sliding speed go into `seen`; over an imprint depth and rate are those from the
    remembered surface, which may lean. The tangential stiffness is a multiple of the
    normal one, 2 E' a.
    """
    _penetration_inlined(m, w, z, seen)
    body, force, branch, phase = m.body, m.force, w.branch, w.now[at.PHASE]
    depth = seen[at.DEPTH]
    ploughing, stiffness, waves = 0.0, 0.0, 0.0
    if phase == at.LOAD:
        f = fo.static_loading(m.loading, m.par, force, m.factors, depth)
    else:
        f = fo.static_unloading(m.unloading, m.par, branch, depth)
    if body[at.PLOUGH] != 0.0:
        a = 0.0
        if depth > 0.0:
            peak = max(depth, branch[0] if phase == at.UNLOAD else depth)
            a = law_radius(m, depth, peak)
        ploughing = body[at.PLOUGH] * 4.0 / (3.0 * math.pi) * a / body[at.TIP]
    seen[at.STATIC] = f
    if force[fo.RADIATION] != 0.0:
        # the waves' power is kappa (dF/dt)^2, at the rate that a plate leaves of the approach's
        slope = slope_of(m, branch, depth, int(phase))
        resists = force[fo.RADIATION] * slope * slope
        waves = resists * (seen[at.RATE] - body[at.S_PLATE] * f)
        waves /= 1.0 + resists * body[at.S_PLATE]
        f += waves
    if force[fo.DAMPING] != 0.0 and seen[at.STATIC] > 0.0:
        chi = force[fo.DAMPING]
        if force[fo.DAMPING_EXPONENT] != 0.0:
            elastic = 4.0 / 3.0 * force[fo.MODULUS] * _contact_radius(m, branch, depth, phase)
            chi *= (elastic * fo.DAMPING_DEPTH / seen[at.STATIC]) ** force[fo.DAMPING_EXPONENT]
        f += f * chi * seen[at.RATE]
    seen[at.RADIATED] = max(waves, -seen[at.STATIC])
    f = max(f, 0.0)
    if body[at.COMPLIANCE] < math.inf:
        a = _contact_radius(m, branch, depth, phase)
        stiffness = 2.0 * body[at.COMPLIANCE] * force[fo.MODULUS] * a
    mu = body[at.MU]
    if body[at.MU_STATIC] != body[at.MU]:
        mu += (body[at.MU_STATIC] - mu) * math.exp(-abs(seen[at.SLIDING]) / body[at.MU_SPEED])
    # A plate's surface gives way at a speed proportional to the force.
    seen[at.RATE] -= body[at.S_PLATE] * f
    return f, (mu + ploughing) * f, ploughing, stiffness


_FORCES = types.UniTuple(float64, 4)(MODEL, WORK, VECTOR, VECTOR)
contact_inlined = njit(_FORCES, cache=True, forceinline=True, **PLAIN)(_contact_of)
contact = njit(_FORCES, cache=True, **PLAIN)(_contact_of)
