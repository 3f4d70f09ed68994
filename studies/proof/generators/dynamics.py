"""One impact of a rod or a ball, in time steps (leapfrog).

The striker is a rigid body in the plane, or a chain of beam elements with lumped mass. Friction is
found by impulses: the force that would stop the contact point within the step, cut at the limit of
friction. After the first parting the tip is followed as long as `FOLLOW` says, so that a vibrating
rod may touch again.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from . import chain, foundation
from . import parameters as at
from .normal import EDGE, FREED, LAST, LAYER_MOST, N_MEMORY, PEAK, RADIUS_NOW, normal_force


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


@njit(cache=True)
def impact(p, result, trace):
    """Run one impact; write `result` (N_RESULTS,) and samples of `trace` (k, 4).

    Parameters
    ----------
    p
        (N_PARAMETERS,), see `parameters`.
    result
        (N_RESULTS,), written.
    trace
        (k, 4) of time, height of the tip, normal force, tangential place; every step while room is
        left, thinned by two whenever it is full. Its first row is (number of rows, 0, 0, 0).
    """
    m, inertia, R = p[at.MASS], p[at.INERTIA], p[at.TIP]
    g = p[at.GRAVITY]
    half = 0.5 * p[at.LENGTH]
    theta = p[at.THETA]
    scale, dt = _scales(p)
    memory = np.zeros(N_MEMORY)
    plastic = np.zeros(foundation.N_SPRINGS)
    memory[EDGE] = math.sqrt(3.2 * R * 3.0 * scale + p[at.FLAT] ** 2)
    c, s = half * math.cos(theta), half * math.sin(theta) + R
    n = int(p[at.BEAM]) + 1 if p[at.BEAM] > 0.0 else 0
    vx = p[at.TANGENTIAL_SPEED]
    w0 = p[at.SPIN]
    # the contact point approaches at the normal speed
    vy = -p[at.NORMAL_SPEED] + w0 * c
    x0, y0 = c, s
    x, y, turn = x0, y0, 0.0
    e_in = 0.5 * m * (vx * vx + vy * vy) + 0.5 * inertia * w0 * w0
    tip_in = vy - w0 * c
    size = max(n, 1)
    u, w, f = np.zeros(size), np.zeros(size), np.zeros(size)
    du, dw, df = np.zeros(size), np.zeros(size), np.zeros(size)
    fu, fw, ff = np.zeros(size), np.zeros(size), np.zeros(size)
    ct, st = math.cos(theta), math.sin(theta)
    mass = np.ones(size)
    rotary = 1.0
    element = 1.0
    stable = math.inf
    if n:
        element = p[at.LENGTH] / (n - 1)
        for i in range(n):
            mass[i] = m / (n - 1) * (0.5 if i == 0 or i == n - 1 else 1.0)
            arm = i * element - half
            # velocity of node i of the moving rigid rod, along and across the axis
            ax, ay = vx - w0 * arm * st, vy + w0 * arm * ct
            du[i] = ax * ct + ay * st
            dw[i] = -ax * st + ay * ct
            df[i] = w0
        rotary = p[at.BEAM_ROTARY] * element
        wave = element / math.sqrt(p[at.BEAM_EA] * (n - 1) * element / m)
        # stable step of the chain: axial waves, and the fastest rotation of a section
        stable = 0.5 * min(wave, math.sqrt(p[at.BEAM_ROTARY] / p[at.BEAM_GA]))
        dt = min(dt, stable)
    mobility = 1.0 / mass[0] + R * R / rotary if n else 1.0 / m + s * s / inertia
    approach, tip_x = 0.0, 0.0
    if p[at.FILM_VISCOSITY] > 0.0:
        approach = -p[at.FILM_THICKNESS]
    sw, sdw = 0.0, 0.0
    start = approach
    Fn, Ft, a_last = 0.0, 0.0, 0.0
    t, first, last, parted = 0.0, -1.0, 0.0, 0.0
    most, least, slid, place = 0.0, 0.0, 0.0, 0.0
    peak = 0.0
    Pn, Pt, work = 0.0, 0.0, 0.0
    contacts = 0
    touching = False
    room = len(trace) - 1
    every, count, kept = 1, 0, 0
    done = False
    budget = 4000000
    while budget > 0:
        budget -= 1
        step = dt
        if contacts > 0 and not touching and approach < memory[PEAK] - 0.2 * scale:
            step = min(4.0 * dt, stable)
        # speeds of the contact point
        if n:
            tvx = du[0] * ct - dw[0] * st + R * df[0]
            tvy = du[0] * st + dw[0] * ct
        else:
            tvx = vx + w0 * s
            tvy = vy - w0 * c
        speed = -tvy - sdw
        Fn = normal_force(p, memory, approach, speed, step, plastic)
        a = memory[RADIUS_NOW]
        turned = 0.0 if n else -s * c / inertia
        Ft = _tangential(p, Fn, tvx, mobility, turned, step, a, a_last, Ft)
        a_last = a
        if room > 0:
            if count % every == 0:
                if kept == room:
                    for i in range(room // 2):
                        trace[1 + i] = trace[1 + 2 * i]
                    kept = room // 2
                    every *= 2
                kept += 1
                trace[kept, 0] = t
                trace[kept, 1] = -approach - sw
                trace[kept, 2] = Fn
                trace[kept, 3] = tip_x
            count += 1
        solid = Fn > 0.0 and memory[LAST] > 0.0
        if solid and not touching:
            touching = True
            contacts += 1
            if first < 0.0:
                first = t
        elif touching and not solid:
            touching = False
            last = t
            parted = t
        if solid and Fn > peak:
            peak = Fn
        Pn += Fn * step
        Pt += Ft * step
        # new speeds, then new places
        if n:
            chain.elastic_forces(
                u, w, f, du, dw, df, element, p[at.BEAM_EA], p[at.BEAM_EI], p[at.BEAM_GA],
                p[at.BEAM_LOSS], fu, fw, ff,
            )  # fmt: skip
            fu[0] += Ft * ct + Fn * st
            fw[0] += -Ft * st + Fn * ct
            ff[0] += R * Ft
            for i in range(n):
                du[i] += step * (fu[i] / mass[i] - g * st)
                dw[i] += step * (fw[i] / mass[i] - g * ct)
                turning = rotary * (0.5 if i == 0 or i == n - 1 else 1.0)
                df[i] += step * ff[i] / turning
                u[i] += step * du[i]
                w[i] += step * dw[i]
                f[i] += step * df[i]
            nvx = du[0] * ct - dw[0] * st + R * df[0]
            nvy = du[0] * st + dw[0] * ct
        else:
            vx += step * Ft / m
            vy += step * (Fn / m - g)
            w0 += step * (Ft * s - Fn * c) / inertia
            x += step * vx
            y += step * vy
            turn += step * w0
            c = half * math.cos(theta + turn)
            s = half * math.sin(theta + turn) + R
            nvx = vx + w0 * s
            nvy = vy - w0 * c
        work += step * (Fn * 0.5 * (tvy + nvy) + Ft * 0.5 * (tvx + nvx))
        sw, sdw = _support_step(p, Fn, sw, sdw, step)
        t += step
        if n:
            approach = start - (u[0] * st + w[0] * ct) - sw
            tip_x, rolled = u[0] * ct - w[0] * st, R * f[0]
        else:
            approach = start - ((y - s) - (y0 - half * math.sin(theta) - R)) - sw
            tip_x, rolled = (x - c) - (x0 - half * math.cos(theta)), R * turn
        # the material point that touches: with the tip's centre, and with its turning; what it
        # travels between two contacts is no sliding
        if touching:
            slid += tip_x + rolled - place
            most, least = max(most, slid), min(least, slid)
        place = tip_x + rolled
        if contacts > 0 and not touching and t - parted > p[at.FOLLOW]:
            freed = memory[FREED] - approach
            if (
                freed > max(p[at.ADHESION_RANGE], p[at.FILM_THICKNESS])
                or t > 50.0 * scale / abs(tip_in) + 4.0 * p[at.FOLLOW]
            ):
                done = True
                break
        if first < 0.0 and t > 100.0 * scale / abs(tip_in):
            break
    if n:
        vx, vy, w0 = 0.0, 0.0, 0.0
        total = 0.0
        for i in range(n):
            arm = i * element - half
            turning = rotary * (0.5 if i == 0 or i == n - 1 else 1.0)
            vx += mass[i] / m * (du[i] * ct - dw[i] * st)
            vy += mass[i] / m * (du[i] * st + dw[i] * ct)
            w0 += mass[i] * arm * dw[i] + turning * df[i]
            total += mass[i] * arm * arm + turning
        w0 /= total
        c, s = half * ct, half * st + R
        inertia = total
    else:
        c, s = half * math.cos(theta), half * math.sin(theta) + R
    vy += g * (t - last)
    result[at.RESTITUTION] = -(vy - w0 * c) / tip_in
    result[at.TIME] = last - first
    result[at.PEAK_FORCE] = peak
    result[at.REBOUND_SPIN] = w0
    result[at.IMPULSE_RATIO] = abs(Pt) / Pn if Pn > 0.0 else 0.0
    result[at.SLIDING] = most - least
    result[at.REBOUND] = vy
    result[at.TANGENTIAL_REBOUND] = vx
    result[at.NORMAL_IMPULSE] = Pn
    result[at.TANGENTIAL_IMPULSE] = Pt
    result[at.WORK] = work
    result[at.ENERGY_IN] = e_in
    result[at.ENERGY_OUT] = 0.5 * m * (vx * vx + vy * vy) + 0.5 * inertia * w0 * w0
    result[at.CONTACTS] = contacts
    result[at.PEAK_DEPTH] = memory[PEAK]
    result[at.DEPTH] = memory[FREED] + memory[LAYER_MOST] * p[at.ROUGH_LOSS]
    result[at.COMPLETED] = 1.0 if done else 0.0
    if room > 0:
        trace[0, 0] = kept


@njit(cache=True)
def impacts(rows, results):
    """Run n impacts; rows (n, N_PARAMETERS), results (n, N_RESULTS) written."""
    none = np.zeros((1, 4))
    for i in range(len(rows)):
        impact(rows[i], results[i], none)
