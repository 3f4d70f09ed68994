"""One impact of a rod or a ball, in time steps (leapfrog).

The striker is a rigid body in the plane, or a chain of beam elements with lumped mass. Friction is
found by impulses: the force that would stop the contact point within the step, cut at the limit of
friction. After the first parting the tip is followed as long as `FOLLOW` says, so that a vibrating
rod may touch again.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from ....core.arrays import Array
from . import chain, foundation
from . import parameters as at
from .normal import EDGE, FREED, LAST, LAYER_MOST, N_MEMORY, PEAK, RADIUS_NOW, normal_force

_BUDGET = 4000000
"""Most steps of an impact."""


@njit(cache=True)
def _scales(p):
    """Depth [m] and time step [s] from the energy of the blow."""
    m, inertia, R = p[at.MASS], p[at.INERTIA], p[at.TIP]
    c = 0.5 * p[at.LENGTH] * math.cos(p[at.THETA])
    heavy = 1.0 / (1.0 / m + c * c / inertia)
    v = abs(p[at.NORMAL_SPEED])
    elastic = (15.0 * heavy * v * v / (16.0 * math.sqrt(R) * p[at.MODULUS])) ** 0.4
    plastic = 0.0
    if not math.isinf(p[at.STRENGTH]):
        plastic = v * math.sqrt(heavy / (2.0 * math.pi * R * 2.8 * p[at.STRENGTH]))
    depth = max(elastic, plastic)
    return depth, depth / v / p[at.STEPS]


@njit(cache=True)
def _friction_limit(p, force, slip, a):
    """Largest tangential force [N] at a sliding speed and a contact radius."""
    mu = p[at.MU]
    kind = p[at.FRICTION_KIND]
    speed = abs(slip) / p[at.FRICTION_B] if kind > 0.0 else 0.0
    if kind == 1.0:
        mu *= 1.0 + p[at.FRICTION_A] / (1.0 + speed)
    elif kind == 2.0:
        mu *= max(1.0 - p[at.FRICTION_A] * math.log1p(speed), 0.2)
    elif kind == 3.0:
        mu *= 1.0 + p[at.FRICTION_A] * math.exp(-speed)
    limit = mu * force
    x = min(a / p[at.TIP], 1.0)
    if p[at.PLOUGH_KIND] == 1.0 and x > 0.0:
        # front of a spherical cap pushed through metal of the dent's mean pressure
        front = (math.asin(x) - x * math.sqrt(max(1.0 - x * x, 0.0))) / (x * x)
        limit += p[at.PLOUGH] * 2.0 / math.pi * force * front
    elif p[at.PLOUGH_KIND] == 2.0:
        limit += p[at.PLOUGH] * force * x**0.7
    return limit


@njit(cache=True)
def _tangential(p, force, slip, mobility, turned, dt, a, a_last, held):
    """Tangential force [N] on the striker; `held` is that of the last step.

    `turned` is what the normal force adds to the slip's rate [1/kg]: a contact sticks against it.
    """
    if force <= 0.0:
        return 0.0
    limit = _friction_limit(p, force, slip, a)
    ratio = p[at.TANGENTIAL_RATIO]
    if ratio > 0.0:
        stiffness = ratio * 2.0 * p[at.MODULUS] * a
        if p[at.LAW] == at.FOUNDATION and limit > 0.0:
            # partial slip softens the contact (Mindlin and Deresiewicz 1953)
            against = max(-held * math.copysign(1.0, slip) / limit, 0.0)
            stiffness *= max(1.0 - min(against, 1.0), 1e-3) ** (1.0 / 3.0)
        wanted = held * (min(a / a_last, 1.0) if a_last > 0.0 else 0.0) - stiffness * slip * dt
    else:
        wanted = -(slip / dt + turned * force) / mobility
    return min(max(wanted, -limit), limit)


@njit(cache=True)
def _support_step(p, force, w, dw, dt):
    """Motion of the flat, downward positive: new displacement and speed."""
    if p[at.PLATE] > 0.0:
        dw = force * p[at.PLATE]
        return w + dt * dw, dw
    if p[at.SUPPORT_MASS] > 0.0:
        k = p[at.SUPPORT_STIFFNESS]
        back = k * w
        if p[at.SUPPORT_GAP] > 0.0:
            back = 0.02 * k * w + k * max(w - p[at.SUPPORT_GAP], 0.0)
        dw += dt * (force - back - p[at.SUPPORT_DAMPING] * dw) / p[at.SUPPORT_MASS]
        return w + dt * dw, dw
    return 0.0, 0.0


class _Body(NamedTuple):
    """A rigid striker: speeds, place, turn, and the arm (c, s) from its tip to its centre."""

    vx: float
    vy: float
    spin: float
    x: float
    y: float
    turn: float
    c: float
    s: float


class _Rod(NamedTuple):
    """A striker of n nodes: places, speeds and forces along u, across w and turning f; masses."""

    n: int
    u: Array
    w: Array
    f: Array
    du: Array
    dw: Array
    df: Array
    fu: Array
    fw: Array
    ff: Array
    mass: Array
    element: float
    rotary: float
    stable: float


class _Touches(NamedTuple):
    """Whether the striker touches, how often it has, when it first did, last did, and parted."""

    now: bool
    contacts: int
    first: float
    last: float
    parted: float


class _Sums(NamedTuple):
    """Impulses [N s] and work [J] of the contact so far, and its largest force [N]."""

    normal: float
    tangential: float
    work: float
    peak: float


class _Slid(NamedTuple):
    """Where the contact is on the flat, how far it has slid, and the ends of that way [m]."""

    place: float
    way: float
    most: float
    least: float


@njit(cache=True)
def _body(p):
    """State of the striker as it comes in: the contact point approaches at the normal speed."""
    half = 0.5 * p[at.LENGTH]
    c, s = half * math.cos(p[at.THETA]), half * math.sin(p[at.THETA]) + p[at.TIP]
    spin = p[at.SPIN]
    return _Body(p[at.TANGENTIAL_SPEED], -p[at.NORMAL_SPEED] + spin * c, spin, c, s, 0.0, c, s)


@njit(cache=True)
def _rod(p, body):
    """Nodes of a rod that moves as the rigid body does; one node of no meaning for a rigid one."""
    m, half = p[at.MASS], 0.5 * p[at.LENGTH]
    ct, st = math.cos(p[at.THETA]), math.sin(p[at.THETA])
    n = int(p[at.BEAM]) + 1 if p[at.BEAM] > 0.0 else 0
    size = max(n, 1)
    u, w, f = np.zeros(size), np.zeros(size), np.zeros(size)
    du, dw, df = np.zeros(size), np.zeros(size), np.zeros(size)
    fu, fw, ff = np.zeros(size), np.zeros(size), np.zeros(size)
    mass = np.ones(size)
    element, rotary, stable = 1.0, 1.0, math.inf
    if n:
        element = p[at.LENGTH] / (n - 1)
        for i in range(n):
            mass[i] = m / (n - 1) * (0.5 if i == 0 or i == n - 1 else 1.0)
            arm = i * element - half
            # velocity of node i of the moving rigid rod, along and across the axis
            ax, ay = body.vx - body.spin * arm * st, body.vy + body.spin * arm * ct
            du[i] = ax * ct + ay * st
            dw[i] = -ax * st + ay * ct
            df[i] = body.spin
        rotary = p[at.BEAM_ROTARY] * element
        wave = element / math.sqrt(p[at.BEAM_EA] * (n - 1) * element / m)
        # stable step of the chain: axial waves, and the fastest rotation of a section
        stable = 0.5 * min(wave, math.sqrt(p[at.BEAM_ROTARY] / p[at.BEAM_GA]))
    return _Rod(n, u, w, f, du, dw, df, fu, fw, ff, mass, element, rotary, stable)


@njit(cache=True)
def _contact_speed(p, body, rod):
    """Speed of the contact point along and out of the flat [m/s]."""
    if rod.n:
        ct, st = math.cos(p[at.THETA]), math.sin(p[at.THETA])
        along = rod.du[0] * ct - rod.dw[0] * st + p[at.TIP] * rod.df[0]
        return along, rod.du[0] * st + rod.dw[0] * ct
    return body.vx + body.spin * body.s, body.vy - body.spin * body.c


@njit(cache=True)
def _moved_rod(p, rod, Fn, Ft, step):
    """Write new speeds, then new places, of the nodes under a force at the tip."""
    n, g = rod.n, p[at.GRAVITY]
    ct, st = math.cos(p[at.THETA]), math.sin(p[at.THETA])
    chain.elastic_forces(
        rod.u, rod.w, rod.f, rod.du, rod.dw, rod.df, rod.element, p[at.BEAM_EA], p[at.BEAM_EI],
        p[at.BEAM_GA], p[at.BEAM_LOSS], rod.fu, rod.fw, rod.ff,
    )  # fmt: skip
    rod.fu[0] += Ft * ct + Fn * st
    rod.fw[0] += -Ft * st + Fn * ct
    rod.ff[0] += p[at.TIP] * Ft
    for i in range(n):
        rod.du[i] += step * (rod.fu[i] / rod.mass[i] - g * st)
        rod.dw[i] += step * (rod.fw[i] / rod.mass[i] - g * ct)
        turning = rod.rotary * (0.5 if i == 0 or i == n - 1 else 1.0)
        rod.df[i] += step * rod.ff[i] / turning
        rod.u[i] += step * rod.du[i]
        rod.w[i] += step * rod.dw[i]
        rod.f[i] += step * rod.df[i]


@njit(cache=True)
def _moved_body(p, body, Fn, Ft, step):
    """New speeds, then the new place, of a rigid striker."""
    m, inertia, half = p[at.MASS], p[at.INERTIA], 0.5 * p[at.LENGTH]
    vx = body.vx + step * Ft / m
    vy = body.vy + step * (Fn / m - p[at.GRAVITY])
    spin = body.spin + step * (Ft * body.s - Fn * body.c) / inertia
    turn = body.turn + step * spin
    c = half * math.cos(p[at.THETA] + turn)
    s = half * math.sin(p[at.THETA] + turn) + p[at.TIP]
    return _Body(vx, vy, spin, body.x + step * vx, body.y + step * vy, turn, c, s)


@njit(cache=True)
def _tip_place(p, body, rod):
    """How far the tip has moved along and out of the flat, and rolled on it [m]."""
    half, R, theta = 0.5 * p[at.LENGTH], p[at.TIP], p[at.THETA]
    ct, st = math.cos(theta), math.sin(theta)
    if rod.n:
        along = rod.u[0] * ct - rod.w[0] * st
        return along, rod.u[0] * st + rod.w[0] * ct, R * rod.f[0]
    x0, y0 = half * ct, half * st + R
    along = (body.x - body.c) - (x0 - half * ct)
    return along, (body.y - body.s) - (y0 - half * st - R), R * body.turn


@njit(cache=True)
def _sampled(trace, kept, every, count, t, height, force, along):
    """Write a sample where it is due, every other one dropped when the room is full."""
    room = len(trace) - 1
    if count % every == 0:
        if kept == room:
            for i in range(room // 2):
                trace[1 + i] = trace[1 + 2 * i]
            kept = room // 2
            every *= 2
        kept += 1
        trace[kept, 0] = t
        trace[kept, 1] = height
        trace[kept, 2] = force
        trace[kept, 3] = along
    return kept, every


@njit(cache=True)
def _touched(touches, solid, t):
    """Touches after a step in which the solids press on each other or do not."""
    if solid and not touches.now:
        first = t if touches.first < 0.0 else touches.first
        return _Touches(True, touches.contacts + 1, first, touches.last, touches.parted)
    if touches.now and not solid:
        return _Touches(False, touches.contacts, touches.first, t, t)
    return touches


@njit(cache=True)
def _slid(slid, touching, place):
    """Sliding after a step: what is travelled between two contacts is none."""
    way, most, least = slid.way, slid.most, slid.least
    if touching:
        way += place - slid.place
        most, least = max(most, way), min(least, way)
    return _Slid(place, way, most, least)


@njit(cache=True)
def _energy(m, inertia, vx, vy, spin):
    """Kinetic energy of the striker [J]."""
    return 0.5 * m * (vx * vx + vy * vy) + 0.5 * inertia * spin * spin


@njit(cache=True)
def _leaving(p, body, rod):
    """Rigid motion of the striker that leaves, and its moment of inertia [kg m2]."""
    m, half, theta = p[at.MASS], 0.5 * p[at.LENGTH], p[at.THETA]
    n = rod.n
    if not n:
        c, s = half * math.cos(theta), half * math.sin(theta) + p[at.TIP]
        return _Body(body.vx, body.vy, body.spin, body.x, body.y, body.turn, c, s), p[at.INERTIA]
    ct, st = math.cos(theta), math.sin(theta)
    vx, vy, spin, total = 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        arm = i * rod.element - half
        turning = rod.rotary * (0.5 if i == 0 or i == n - 1 else 1.0)
        vx += rod.mass[i] / m * (rod.du[i] * ct - rod.dw[i] * st)
        vy += rod.mass[i] / m * (rod.du[i] * st + rod.dw[i] * ct)
        spin += rod.mass[i] * arm * rod.dw[i] + turning * rod.df[i]
        total += rod.mass[i] * arm * arm + turning
    c, s = half * ct, half * st + p[at.TIP]
    return _Body(vx, vy, spin / total, body.x, body.y, body.turn, c, s), total


@njit(cache=True)
def _given_up(p, memory, approach, t, touches, scale, speed):
    """Whether the striker has parted for good (1), or never arrives (2)."""
    if touches.contacts > 0 and not touches.now and t - touches.parted > p[at.FOLLOW]:
        freed = memory[FREED] - approach
        if (
            freed > max(p[at.ADHESION_RANGE], p[at.FILM_THICKNESS])
            or t > 50.0 * scale / speed + 4.0 * p[at.FOLLOW]
        ):
            return 1
    return 2 if touches.first < 0.0 and t > 100.0 * scale / speed else 0


@njit(cache=True)
def _written(p, result, body, inertia, touches, sums, memory, vy):
    """Write what the contact gave and how the striker leaves, at `vy` when it parts [m/s]."""
    result[at.TIME] = touches.last - touches.first
    result[at.PEAK_FORCE] = sums.peak
    result[at.REBOUND_SPIN] = body.spin
    result[at.IMPULSE_RATIO] = abs(sums.tangential) / sums.normal if sums.normal > 0.0 else 0.0
    result[at.REBOUND] = vy
    result[at.TANGENTIAL_REBOUND] = body.vx
    result[at.NORMAL_IMPULSE] = sums.normal
    result[at.TANGENTIAL_IMPULSE] = sums.tangential
    result[at.WORK] = sums.work
    result[at.ENERGY_OUT] = _energy(p[at.MASS], inertia, body.vx, vy, body.spin)
    result[at.CONTACTS] = touches.contacts
    result[at.PEAK_DEPTH] = memory[PEAK]
    result[at.DEPTH] = memory[FREED] + memory[LAYER_MOST] * p[at.ROUGH_LOSS]


@njit(cache=True)
def impact(p, result, trace):
    """Run one impact; write `result` (N_RESULTS,) and samples of `trace` (k, 4).

    - `p`: (N_PARAMETERS,), see `parameters`.
    - `result`: (N_RESULTS,), written.
    - `trace`: (k, 4) of time, height of the tip, normal force, tangential place; every step while
      room is left, thinned by two whenever it is full. Its first row is (number of rows, 0, 0, 0).
    """
    m, inertia, R = p[at.MASS], p[at.INERTIA], p[at.TIP]
    scale, dt = _scales(p)
    memory, plastic = np.zeros(N_MEMORY), np.zeros(foundation.N_SPRINGS)
    memory[EDGE] = math.sqrt(3.2 * R * 3.0 * scale + p[at.FLAT] ** 2)
    body = _body(p)
    rod = _rod(p, body)
    if rod.n:
        dt = min(dt, rod.stable)
    mobility = 1.0 / rod.mass[0] + R * R / rod.rotary if rod.n else 1.0 / m + body.s**2 / inertia
    e_in = _energy(m, inertia, body.vx, body.vy, body.spin)
    tip_in = body.vy - body.spin * body.c
    start = -p[at.FILM_THICKNESS] if p[at.FILM_VISCOSITY] > 0.0 else 0.0
    approach, tip_x, sw, sdw = start, 0.0, 0.0, 0.0
    Ft, a_last, t = 0.0, 0.0, 0.0
    touches = _Touches(False, 0, -1.0, 0.0, 0.0)
    slid, sums = _Slid(0.0, 0.0, 0.0, 0.0), _Sums(0.0, 0.0, 0.0, 0.0)
    every, kept, ended = 1, 0, 0
    for count in range(_BUDGET):
        step = dt
        if touches.contacts > 0 and not touches.now and approach < memory[PEAK] - 0.2 * scale:
            step = min(4.0 * dt, rod.stable)
        along, out = _contact_speed(p, body, rod)
        Fn = normal_force(p, memory, approach, -out - sdw, step, plastic)
        a = memory[RADIUS_NOW]
        turned = 0.0 if rod.n else -body.s * body.c / inertia
        Ft = _tangential(p, Fn, along, mobility, turned, step, a, a_last, Ft)
        a_last = a
        if len(trace) > 1:
            kept, every = _sampled(trace, kept, every, count, t, -approach - sw, Fn, tip_x)
        solid = Fn > 0.0 and memory[LAST] > 0.0
        touches = _touched(touches, solid, t)
        if rod.n:
            _moved_rod(p, rod, Fn, Ft, step)
        else:
            body = _moved_body(p, body, Fn, Ft, step)
        new_along, new_out = _contact_speed(p, body, rod)
        sums = _Sums(
            sums.normal + Fn * step, sums.tangential + Ft * step,
            sums.work + step * (Fn * 0.5 * (out + new_out) + Ft * 0.5 * (along + new_along)),
            Fn if solid and Fn > sums.peak else sums.peak,
        )  # fmt: skip
        sw, sdw = _support_step(p, Fn, sw, sdw, step)
        t += step
        tip_x, height, rolled = _tip_place(p, body, rod)
        approach = start - height - sw
        # the material point that touches: with the tip's centre, and with its turning
        slid = _slid(slid, touches.now, tip_x + rolled)
        ended = _given_up(p, memory, approach, t, touches, scale, abs(tip_in))
        if ended:
            break
    body, inertia = _leaving(p, body, rod)
    vy = body.vy + p[at.GRAVITY] * (t - touches.last)
    _written(p, result, body, inertia, touches, sums, memory, vy)
    result[at.RESTITUTION] = -(vy - body.spin * body.c) / tip_in
    result[at.SLIDING], result[at.ENERGY_IN] = slid.most - slid.least, e_in
    result[at.COMPLETED] = 1.0 if ended == 1 else 0.0
    if len(trace) > 1:
        trace[0, 0] = kept


@njit(cache=True)
def impacts(rows, results):
    """Run n impacts; rows (n, N_PARAMETERS), results (n, N_RESULTS) written."""
    none = np.zeros((1, 4))
    for i in range(len(rows)):
        impact(rows[i], results[i], none)
