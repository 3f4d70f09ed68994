"""Axisymmetric dynamic finite elements: a bar strikes a block, explicit in time.

Four-node elements with one point and hourglass control (Flanagan and Belytschko, Int. J. Numer.
Methods Eng. 17 (1981) 679); Cauchy stress turned with the spin; von Mises plasticity with Voce
hardening and a logarithmic overstress; frictionless contact without penetration by multipliers that
are found anew in every step (forward increments: Carpenter, Taylor and Katona, Int. J. Numer.
Methods Eng. 32 (1991) 103). Bar, block and pad all have inertia; nothing is added as a term.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

# per body: density, shear modulus, bulk modulus, Voce rise, Voce strain, rate C, reference rate
RHO, SHEAR, BULK, RISE, STRAIN, RATE, REFERENCE = range(7)

_BULK_VISCOSITY = 0.04
_HOURGLASS = 0.02
_HOURGLASS_VISCOSITY = 0.02


@njit(cache=True, fastmath=True)
def _flow(k, base, strain, rate):
    voce = 1.0 + k[RISE] * (1.0 - math.exp(-strain / k[STRAIN]))
    thermal = 1.0 + k[RATE] * math.log1p(rate / k[REFERENCE]) if k[RATE] > 0.0 else 1.0
    return base * voce * thermal


@njit(cache=True, fastmath=True)
def _plastic_step(k, base, q, strain, dt):
    """Plastic strain increment that brings the trial stress `q` onto the flow stress."""
    G3 = 3.0 * k[SHEAR]
    low, high = 0.0, q / G3
    d = (q - _flow(k, base, strain, 0.0)) / G3
    if k[RATE] == 0.0 and k[RISE] == 0.0:
        return d
    for _ in range(20):
        miss = q - G3 * d - _flow(k, base, strain + d, d / dt)
        if miss > 0.0:
            low = d
        else:
            high = d
        if abs(miss) < 1e-7 * q:
            break
        slope = -G3 - base * k[RISE] * math.exp(-(strain + d) / k[STRAIN]) / k[STRAIN]
        if k[RATE] > 0.0:
            slope -= base * k[RATE] / (k[REFERENCE] * dt + d)
        new = d - miss / slope
        d = new if low < new < high else 0.5 * (low + high)
    return d


@njit(cache=True, fastmath=True, inline="always")  # a call an element costs a tenth
def _stressed(k, s, err, ezz, ett, lrz, lzr, base, strain, dt):
    """Take the stress `s` (rr, zz, rz, tt) over a step; return the plastic strain that it brings.

    The step's displacement gradient turns the stress (Jaumann), strains it elastically, and brings
    what lies beyond the flow stress back along the radius.
    """
    spin = 0.5 * (lrz - lzr)
    turn = 2.0 * spin * s[2]
    flip = spin * (s[1] - s[0])
    volume = err + ezz + ett
    third = volume / 3.0
    G2 = 2.0 * k[SHEAR]
    pressure = (s[0] + s[1] + s[3]) / 3.0
    t0 = s[0] - pressure + turn + G2 * (err - third)
    t1 = s[1] - pressure - turn + G2 * (ezz - third)
    t2 = s[2] + flip + G2 * 0.5 * (lrz + lzr)
    t3 = s[3] - pressure + G2 * (ett - third)
    pressure += k[BULK] * volume
    more, scale = 0.0, 1.0
    q = math.sqrt(1.5 * (t0 * t0 + t1 * t1 + t3 * t3 + 2.0 * t2 * t2))
    # the first test spares the exponential where nothing can yield
    if q > base * (1.0 + min(k[RISE], 0.0)) and q > _flow(k, base, strain, 0.0):
        more = _plastic_step(k, base, q, strain, dt)
        scale = 1.0 - 3.0 * k[SHEAR] * more / q
    s[0] = t0 * scale + pressure
    s[1] = t1 * scale + pressure
    s[2] = t2 * scale
    s[3] = t3 * scale + pressure
    return more


@njit(cache=True, fastmath=True)
def _forces(x, v, quads, body, materials, dt, stress, peeq, hour, base, force):
    """Add the internal forces; stresses, plastic strains and hourglass forces are updated."""
    worst = 1e9
    for e in range(len(quads)):
        a, b, c, d = quads[e, 0], quads[e, 1], quads[e, 2], quads[e, 3]
        k = materials[body[e]]
        # half a step back: the rates belong to the middle of the step
        h = -0.5 * dt
        ra, rb = x[a, 0] + h * v[a, 0], x[b, 0] + h * v[b, 0]
        rc, rd = x[c, 0] + h * v[c, 0], x[d, 0] + h * v[d, 0]
        za, zb = x[a, 1] + h * v[a, 1], x[b, 1] + h * v[b, 1]
        zc, zd = x[c, 1] + h * v[c, 1], x[d, 1] + h * v[d, 1]
        area = 0.5 * ((rc - ra) * (zd - zb) + (rb - rd) * (zc - za))
        mean = 0.25 * (ra + rb + rc + rd)
        i2 = 0.5 / area
        ba, bb = (zb - zd) * i2, (zc - za) * i2
        ga, gb = (rd - rb) * i2, (ra - rc) * i2
        vra, vrb, vrc, vrd = v[a, 0], v[b, 0], v[c, 0], v[d, 0]
        vza, vzb, vzc, vzd = v[a, 1], v[b, 1], v[c, 1], v[d, 1]
        lrr = ba * (vra - vrc) + bb * (vrb - vrd)
        lrz = ga * (vra - vrc) + gb * (vrb - vrd)
        lzr = ba * (vza - vzc) + bb * (vzb - vzd)
        lzz = ga * (vza - vzc) + gb * (vzb - vzd)
        ltt = 0.25 * (vra + vrb + vrc + vrd) / mean
        s = stress[e]
        peeq[e] += _stressed(k, s, lrr * dt, lzz * dt, ltt * dt, lrz * dt, lzr * dt, base[e],
                             peeq[e], dt)  # fmt: skip
        volume = (lrr + lzz + ltt) * dt
        c1 = math.sqrt((k[BULK] + 4.0 / 3.0 * k[SHEAR]) / k[RHO])
        size = area / math.sqrt(
            max((rc - ra) ** 2 + (zc - za) ** 2, (rd - rb) ** 2 + (zd - zb) ** 2)
        )
        worst = min(worst, size / c1)
        bulk = _BULK_VISCOSITY * k[RHO] * c1 * size * volume / dt
        w = 2.0 * math.pi * area * mean
        f0, f1, f2 = w * (s[0] + bulk), w * (s[1] + bulk), w * s[2]
        hoop = 2.0 * math.pi * area * 0.25 * (s[3] + bulk)
        # hourglass shape, orthogonal to linear fields
        hr, hz = ra - rb + rc - rd, za - zb + zc - zd
        na = 0.25 * (1.0 - ba * hr - ga * hz)
        nb = 0.25 * (-1.0 - bb * hr - gb * hz)
        nc = 0.25 * (1.0 + ba * hr + ga * hz)
        nd = 0.25 * (-1.0 + bb * hr + gb * hz)
        grad = 2.0 * (ba * ba + bb * bb + ga * ga + gb * gb)
        wr = na * vra + nb * vrb + nc * vrc + nd * vrd
        wz = na * vza + nb * vzb + nc * vzc + nd * vzd
        stiff = _HOURGLASS * k[SHEAR] * grad * w * 4.0
        hour[e, 0] += stiff * wr * dt
        hour[e, 1] += stiff * wz * dt
        damp = _HOURGLASS_VISCOSITY * k[RHO] * c1 * w * math.sqrt(grad) * 4.0
        qr, qz = hour[e, 0] + damp * wr, hour[e, 1] + damp * wz
        force[a, 0] -= f0 * ba + f2 * ga + hoop + na * qr
        force[b, 0] -= f0 * bb + f2 * gb + hoop + nb * qr
        force[c, 0] -= -f0 * ba - f2 * ga + hoop + nc * qr
        force[d, 0] -= -f0 * bb - f2 * gb + hoop + nd * qr
        force[a, 1] -= f2 * ba + f1 * ga + na * qz
        force[b, 1] -= f2 * bb + f1 * gb + nb * qz
        force[c, 1] -= -f2 * ba - f1 * ga + nc * qz
        force[d, 1] -= -f2 * bb - f1 * gb + nd * qz
    return worst


@njit(cache=True)
def _contact(x, v, force, mass, tip, top, dt, push):
    """Forces of the block's nodes on the bar that leave no penetration; return their sum [N].

    `push` (len(top),) holds the multipliers; Gauss and Seidel sweeps from those of the last step.
    """
    n = len(top)
    where = np.zeros(n, dtype=np.int64)
    share = np.zeros(n)
    gap = np.zeros(n)
    near = 0
    j = 0
    for i in range(n):
        t = top[i]
        r = x[t, 0]
        while j < len(tip) - 2 and x[tip[j + 1], 0] < r:
            j += 1
        p, q = tip[j], tip[j + 1]
        span = x[q, 0] - x[p, 0]
        s = (r - x[p, 0]) / span if span > 0.0 else 0.0
        if r > x[tip[-1], 0]:
            break
        s = min(max(s, 0.0), 1.0)
        zt = x[t, 1] + dt * (v[t, 1] + dt * force[t, 1] / mass[t])
        zp = x[p, 1] + dt * (v[p, 1] + dt * force[p, 1] / mass[p])
        zq = x[q, 1] + dt * (v[q, 1] + dt * force[q, 1] / mass[q])
        where[i], share[i] = j, s
        gap[i] = (1.0 - s) * zp + s * zq - zt
        near = i + 1
        if gap[i] > 0.2 * (x[q, 0] - x[p, 0]) and push[i] == 0.0:
            break
    total = 0.0
    shift = np.zeros(len(tip))
    sunk = np.zeros(n)
    for i in range(near):
        _spread(push[i], i, where, share, mass, tip, top, dt, shift, sunk)
    for _ in range(12):
        for i in range(near):
            p, s = where[i], share[i]
            now = gap[i] + (1.0 - s) * shift[p] + s * shift[p + 1] - sunk[i]
            ease = (
                dt
                * dt
                * (1.0 / mass[top[i]] + (1.0 - s) ** 2 / mass[tip[p]] + s * s / mass[tip[p + 1]])
            )
            new = max(push[i] - now / ease, 0.0)
            change = new - push[i]
            if change != 0.0:
                _spread(change, i, where, share, mass, tip, top, dt, shift, sunk)
                push[i] = new
    for i in range(n):
        if i >= near:
            push[i] = 0.0
        f = push[i]
        if f > 0.0:
            p, s = where[i], share[i]
            force[top[i], 1] -= f
            force[tip[p], 1] += (1.0 - s) * f
            force[tip[p + 1], 1] += s * f
            total += f
    return total


@njit(cache=True)
def _spread(f, i, where, share, mass, tip, top, dt, shift, sunk):
    p, s = where[i], share[i]
    shift[p] += dt * dt * (1.0 - s) * f / mass[tip[p]]
    shift[p + 1] += dt * dt * s * f / mass[tip[p + 1]]
    sunk[i] -= dt * dt * f / mass[top[i]]


@njit(cache=True)
def lumped_mass(x, quads, body, materials):
    """Nodal masses (n,) [kg]."""
    mass = np.zeros(len(x))
    for e in range(len(quads)):
        a, b, c, d = quads[e]
        area = 0.5 * (
            (x[c, 0] - x[a, 0]) * (x[d, 1] - x[b, 1]) + (x[b, 0] - x[d, 0]) * (x[c, 1] - x[a, 1])
        )
        mean = 0.25 * (x[a, 0] + x[b, 0] + x[c, 0] + x[d, 0])
        quarter = 0.25 * materials[body[e], RHO] * 2.0 * math.pi * mean * area
        for n in (a, b, c, d):
            mass[n] += quarter
    return mass


class Strike(NamedTuple):
    """What a strike gave.

    Parameters
    ----------
    rebound
        Speed of the bar's centre of mass [m/s].
    duration, peak
        Contact time [s], peak force [N].
    depth
        Residual depth [m].
    rows, steps
        Rows of the history, time steps.
    impulse
        Of the contact [N s].
    mass
        Of the bar [kg].
    vibration
        Kinetic energy left in the bar's vibration [J].
    parted
        1 if the bar parted in time.
    """

    rebound: float
    duration: float
    peak: float
    depth: float
    rows: int
    steps: int
    impulse: float
    mass: float
    vibration: float
    parted: float


@njit(cache=True)
def _nodes_of_bar(n, quads, body):
    """Whether each of the n nodes is the bar's."""
    bar = np.zeros(n, dtype=np.bool_)
    for e in range(len(quads)):
        if body[e] == 0:
            for k in range(4):
                bar[quads[e, k]] = True
    return bar


@njit(cache=True)
def _advanced(x, v, force, mass, bar, held, dt):
    """Move the nodes by a step; momentum [kg m/s] and first moment [kg m] of the bar, upward."""
    n = len(x)
    center = 0.0
    up = 0.0
    for i in range(n):
        for k in range(2):
            v[i, k] += dt * force[i, k] / mass[i]
        if x[i, 0] <= 0.0:
            v[i, 0] = 0.0
        if bar[i]:
            up += mass[i] * v[i, 1]
            center += mass[i] * x[i, 1]
    for i in held:
        v[i, 0] = 0.0
        v[i, 1] = 0.0
    for i in range(n):
        x[i, 0] += dt * v[i, 0]
        x[i, 1] += dt * v[i, 1]
    return up, center


@njit(cache=True)
def _kept(history, kept, every, t, total, height):
    """Write a row of the history, every other one dropped when it is full."""
    if kept == len(history):
        for i in range(kept // 2):
            history[i] = history[2 * i]
        kept //= 2
        every *= 2
    history[kept, 0] = t
    history[kept, 1] = total
    history[kept, 2] = height
    return kept + 1, every


@njit(cache=True)
def _motion_of_bar(v, mass, bar, bar_mass):
    """Speed of the bar's centre of mass [m/s], and energy of its motion about it [J]."""
    up, square = 0.0, 0.0
    for i in range(len(v)):
        if bar[i]:
            up += mass[i] * v[i, 1]
            square += 0.5 * mass[i] * (v[i, 0] ** 2 + v[i, 1] ** 2)
    rebound = up / bar_mass
    return rebound, square - 0.5 * bar_mass * rebound * rebound


@njit(cache=True)
def strike(x, quads, body, tip, top, held, materials, base, speed, most, settle, history):
    """Let the bar strike the block; return a `Strike`.

    Parameters
    ----------
    x, quads, body, tip, top, held
        The mesh; `x` is moved.
    materials
        (3, 7) of bar, block and pad.
    base
        (m,) static strength of each element [Pa].
    speed
        Of the bar, downward [m/s].
    most
        Longest time [s].
    settle
        Time for which the block is left to come to rest, damped [s].
    history
        (k, 3) written: time, force, height of the bar's centre of mass; thinned when full.
    """
    n = len(x)
    v = np.zeros((n, 2))
    force = np.zeros((n, 2))
    stress = np.zeros((len(quads), 4))
    peeq = np.zeros(len(quads))
    hour = np.zeros((len(quads), 2))
    push = np.zeros(len(top))
    mass = lumped_mass(x, quads, body, materials)
    bar = _nodes_of_bar(n, quads, body)
    bar_mass = 0.0
    for i in range(n):
        if bar[i]:
            v[i, 1] = -speed
            bar_mass += mass[i]
    dt = 0.9 * _forces(x, v, quads, body, materials, 1e-12, stress, peeq, hour, base, force)
    stress[:] = 0.0
    hour[:] = 0.0
    t, first, last = 0.0, -1.0, 0.0
    peak, impulse = 0.0, 0.0
    quiet = 0.0
    kept, every, steps = 0, 1, 0
    done = 0.0
    while t < most:
        force[:] = 0.0
        _forces(x, v, quads, body, materials, dt, stress, peeq, hour, base, force)
        total = _contact(x, v, force, mass, tip, top, dt, push)
        up, center = _advanced(x, v, force, mass, bar, held, dt)
        t += dt
        steps += 1
        impulse += total * dt
        if total > 0.0:
            if first < 0.0:
                first = t
            last = t
            quiet = 0.0
        else:
            quiet += dt
        peak = max(peak, total)
        if steps % every == 0:
            kept, every = _kept(history, kept, every, t, total, center / bar_mass)
        if not math.isfinite(total) or not math.isfinite(up):
            break
        if first >= 0.0 and quiet > settle and up > 0.0:
            done = 1.0
            break
    rebound, vibration = _motion_of_bar(v, mass, bar, bar_mass)
    depth = _settled(
        x, v, quads, body, materials, dt, stress, peeq, hour, base, force, mass, bar, top, held,
        settle,
    )  # fmt: skip
    return Strike(
        rebound, last - first, peak, depth, kept, steps, impulse, bar_mass, vibration, done
    )


@njit(cache=True)
def _settled(
    x, v, quads, body, materials, dt, stress, peeq, hour, base, force, mass, bar, top, held, settle
):  # fmt: skip
    """Residual depth below the surface around, averaged over the end of a damped rest."""
    alone = quads[body > 0]
    kinds = body[body > 0]
    s, p, h, b = stress[body > 0], peeq[body > 0], hour[body > 0], base[body > 0]
    count = int(2.0 * settle / dt)
    keep = math.exp(-dt / (0.15 * settle))
    around = 0
    for i in range(len(top)):
        if x[top[i], 0] < 0.35 * x[top[-1], 0]:
            around = i
    total, n = 0.0, 0
    for k in range(count):
        force[:] = 0.0
        _forces(x, v, alone, kinds, materials, dt, s, p, h, b, force)
        for i in range(len(x)):
            if bar[i]:
                continue
            for j in range(2):
                v[i, j] = keep * (v[i, j] + dt * force[i, j] / mass[i])
            if x[i, 0] <= 0.0:
                v[i, 0] = 0.0
        for i in held:
            v[i, 0] = 0.0
            v[i, 1] = 0.0
        for i in range(len(x)):
            if not bar[i]:
                x[i, 0] += dt * v[i, 0]
                x[i, 1] += dt * v[i, 1]
        if 2 * k > count:
            total += x[top[around], 1] - x[top[0], 1]
            n += 1
    return total / max(n, 1)
