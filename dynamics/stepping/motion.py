"""Equations of motion of striker, contact and support."""

from __future__ import annotations

import math

from numba import njit

from .. import force as fo
from . import layout as at
from .contact import contact_inlined, tail_of
from .layout import PLAIN

# fmt: off


@njit(cache=True, **PLAIN)
def pace_of(variable, place, seen):
    """Time per unit of the independent variable, dt / d(place)."""
    if variable == at.BY_TIME:
        return 1.0
    if variable == at.BY_ROOT_TIME:
        return 2.0 * place
    if variable == at.BY_ROOT_DEPTH:
        return 2.0 * place / seen[at.RATE]
    return 1.0 / seen[at.ACCELERATION]


@njit(cache=True, **PLAIN)
def _sinking(body, tail, f, z):
    """Return the acceleration of the support's sinking."""
    if body[at.S_MASS] == math.inf:
        return 0.0
    w, rate = z[tail + at.W], z[tail + at.W_RATE]
    return (f - body[at.S_STIFF] * w - body[at.S_DAMP] * rate) / body[at.S_MASS]


@njit(cache=True, **PLAIN)
def _support(body, tail, f, z, dz, sinking, pace):
    """Write the support's part of the derivative."""
    # a plate's surface gives way at a speed proportional to the force
    held = body[at.S_MASS] == math.inf
    rate = body[at.S_PLATE] * f if held else z[tail + at.W_RATE]
    dz[tail + at.W], dz[tail + at.W_RATE] = pace * rate, pace * sinking
    dz[tail + at.WORK_S] = pace * (f * rate)


@njit(cache=True, forceinline=True, **PLAIN)
def _held(m, w, z, dz, seen, f, stiffness):
    """Return the tangential force that holds the point, or that its spring takes at rest."""
    body, omega, sums, spin = m.body, m.omega, m.sums, z[at.SPIN]
    n, c, s, slope = len(omega), seen[at.ARM], seen[at.RISE] + body[at.TIP], seen[at.SLOPE]
    mtt = sums[at.PER_MASS] + s * s * sums[at.PER_INERTIA] + sums[at.S_XX]
    mtn = -c * s * sums[at.PER_INERTIA] + sums[at.S_XY]
    if slope != 0.0:
        lean = sums[at.PER_MASS] + s * seen[at.RISE] * sums[at.PER_INERTIA] + sums[at.S_XP]
        mtn += slope * lean
    bt, loss = spin * spin * c, body[at.LOSS]
    if n > 0:
        across = m.psi[0]
        q, p = z[at.N_RIGID : at.N_RIGID + n], z[at.N_RIGID + n :]
        for k in range(n):
            bt -= across[k] * omega[k] * (omega[k] * q[k] + loss * p[k])
    seen[at.M_TT], seen[at.M_TN], seen[at.B_T] = mtt, mtn, bt
    need = -(mtn * f + bt) / mtt
    if body[at.COMPLIANCE] < math.inf:
        dz[at.SPRING] = 0.0
        if w.now[at.MODE] == 0.0:
            if w.branch[fo.RECEDING] > 0.0:
                need = stiffness * z[at.SPRING]
                dz[at.SPRING] = -seen[at.SLIDING]
            else:
                need = z[at.SPRING]
                dz[at.SPRING] = -stiffness * seen[at.SLIDING]
        seen[at.STIFFNESS] = stiffness
    return need


@njit(cache=True, forceinline=True, **PLAIN)
def _ring(m, z, dz, f, ft, wall, pace):
    """Write the modes' part of the derivative; return the power that the structure loses."""
    omega, n, loss, lost = m.omega, len(m.omega), m.body[at.LOSS], 0.0
    if n > 0:
        across, along, aside = m.psi[0], m.psi[1], m.psi[2]
        q, p = z[at.N_RIGID : at.N_RIGID + n], z[at.N_RIGID + n :]
        dq, dp = dz[at.N_RIGID : at.N_RIGID + n], dz[at.N_RIGID + n :]
        for k in range(n):
            dq[k] = pace * p[k]
            push = across[k] * ft + along[k] * f + aside[k] * wall
            dp[k] = pace * (push - omega[k] * (omega[k] * q[k] + loss * p[k]))
        if loss > 0.0:
            for k in range(n):
                lost += loss * omega[k] * p[k] * p[k]
    return lost


@njit(cache=True, **PLAIN)
def derivative(m, w, variable, place, z, dz, seen):
    """Write the state's derivative and what is seen of the contact.

    `variable` is the independent one and `place` its value. The normal force acts along the normal
    of the remembered surface, through the tip's centre; friction along the flat.
    """
    body, mode, sums, spin = m.body, w.now[at.MODE], m.sums, z[at.SPIN]
    f, limit, ploughing, stiffness = contact_inlined(m, w, z, seen)
    need = _held(m, w, z, dz, seen, f, stiffness)
    ft = need if mode == 0.0 else -mode * limit
    wall = seen[at.SLOPE] * f
    seen[at.FORCE], seen[at.TANGENTIAL], seen[at.PLOUGHING] = f, ft, ploughing
    seen[at.MARGIN] = abs(need) - (body[at.MU_STATIC] + ploughing) * f
    c, rise = seen[at.ARM], seen[at.RISE]
    turning = ft * (rise + body[at.TIP]) - f * c + wall * rise
    along = (ft + wall) * sums[at.PER_MASS]
    up = f * sums[at.PER_MASS] - body[at.GRAVITY]
    twist = turning * sums[at.PER_INERTIA]
    tail, sinking = tail_of(m.omega, sums), 0.0
    if tail >= 0:
        sinking = _sinking(body, tail, f, z)
    # Only used for a body without modes, over metal that does not lean.
    seen[at.ACCELERATION] = twist * c - up - spin * spin * rise - sinking
    pace = pace_of(variable, place, seen)
    dz[at.X], dz[at.Y], dz[at.PHI] = pace * z[at.VX], pace * z[at.VY], pace * spin
    dz[at.VX], dz[at.VY], dz[at.SPIN] = pace * along, pace * up, pace * twist
    dz[at.SLIP], dz[at.TIME] = pace * seen[at.SLIDING], pace
    dz[at.P_N], dz[at.P_T], dz[at.P_SPIN] = pace * f, pace * (ft + wall), pace * turning
    dz[at.WORK_N] = pace * (f * seen[at.RATE])
    dz[at.WORK_T] = pace * (-ft * seen[at.SLIDING])
    lost = _ring(m, z, dz, f, ft, wall, pace)
    if tail >= 0:
        _support(body, tail, f, z, dz, sinking, pace)
        dz[tail + at.WORK_D] = pace * lost
        dz[tail + at.WORK_R] = pace * (seen[at.RADIATED] * seen[at.RATE])
        dz[tail + at.WORK_C] = pace * ((f - seen[at.STATIC] - seen[at.RADIATED]) * seen[at.RATE])
    if body[at.COMPLIANCE] < math.inf:
        dz[at.SPRING] *= pace
