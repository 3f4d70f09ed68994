"""Free flight of the striker between two contacts, and where it touches again.

Nothing acts but gravity and the vibrations' own springs, so that the motion is known in closed
form. A touch is found from the side on which the tip is free: with the gap g, its rate g' and a
bound B of its second derivative nothing can touch before tau, g + g' tau - B tau^2/2 = 0; the
flight goes on by tau until g is nothing. Such a search can miss no touch, whatever its steps.
"""

from __future__ import annotations

import math

from numba import njit

from .. import surface as su
from . import layout as at
from .contact import kinematics, place_of, tail_of
from .layout import PLAIN

# fmt: off

# limit: looks at the gap in one flight [-]: beyond it the flight ends unfinished
LOOKS = 100_000
CLEAR, TOUCHED, HORIZON, LOST = range(4)

# Rows of the scratch matrix: amplitude of each mode at the tip, its largest acceleration there.
_REACH, _PUSH = range(2)
N_FAST = 2

# pi/2 as a sum: the first two parts have few digits, so that their multiples are exact
_QUARTER = (1.57079632673412561417e0, 6.07710050630396597660e-11, 2.02226624879595063154e-21)


@njit(cache=True, _nrt=False, error_model="numpy")
def turned(x):
    """Cosine and sine of 0 <= x < 1e5, right to 2e-16: without branches, so that modes go in fours.

    The polynomials are those of the C library fdlibm, about the nearest multiple of pi/2.
    """
    count = math.floor(x * 0.63661977236758134308 + 0.5)
    r = ((x - count * _QUARTER[0]) - count * _QUARTER[1]) - count * _QUARTER[2]
    y = r * r
    sine = 1.58969099521155010221e-10
    for a in (-2.50507602534068634195e-8, 2.75573137070700676789e-6, -1.98412698298579493134e-4,
              8.33333333332248946124e-3, -1.66666666666666324348e-1):
        sine = a + y * sine
    sine = r + r * y * sine
    cosine = -1.13596475577881948265e-11
    for a in (2.08757232129817482790e-9, -2.75573143513906633035e-7, 2.48015872894767294178e-5,
              -1.38888888888741095749e-3, 4.16666666666666019037e-2):
        cosine = a + y * cosine
    cosine = 1.0 - 0.5 * y + y * y * cosine
    quarter = count - 4.0 * math.floor(0.25 * count)
    odd = quarter == 1.0 or quarter == 3.0
    c, s = (sine, cosine) if odd else (cosine, sine)
    return (-c if quarter == 1.0 or quarter == 2.0 else c), (-s if quarter >= 2.0 else s)


@njit(cache=True, **PLAIN)
def _support(body, w, v, t):
    """Sinking of the free support and its rate after the time t."""
    b = 0.5 * body[at.S_DAMP] / body[at.S_MASS]
    square = body[at.S_STIFF] / body[at.S_MASS]
    left = square - b * b
    root = math.sqrt(abs(left))
    if left > 0.0:
        fade = math.exp(-b * t)
        c, s = fade * math.cos(root * t), fade * math.sin(root * t) / root
    else:
        slow, fast = math.exp((root - b) * t), math.exp(-(root + b) * t)
        c = 0.5 * (slow + fast)
        s = (slow - fast) / (2.0 * root) if root * t > 1e-9 else t * math.exp(-b * t)
    return w * (c + b * s) + v * s, v * (c - b * s) - square * w * s


@njit(cache=True, **PLAIN)
def _ring_down(m, z, t, z_new):
    """Write the modes after a flight of duration t, and what their damping took."""
    omega, n, tail = m.omega, len(m.omega), tail_of(m.omega, m.sums)
    zeta = 0.5 * m.body[at.LOSS]
    root = math.sqrt(1.0 - zeta * zeta)
    for k in range(n):
        q, p, w = z[at.N_RIGID + k], z[at.N_RIGID + n + k], omega[k]
        fade = math.exp(-zeta * w * t) if zeta > 0.0 else 1.0
        cosine, sine = math.cos(w * root * t), math.sin(w * root * t) / root
        q_new = fade * (q * (cosine + zeta * sine) + p / w * sine)
        p_new = fade * (p * (cosine - zeta * sine) - q * w * sine)
        z_new[at.N_RIGID + k], z_new[at.N_RIGID + n + k] = q_new, p_new
        if zeta > 0.0:
            z_new[tail + at.WORK_D] += 0.5 * (p * p + (w * q) ** 2 - p_new**2 - (w * q_new) ** 2)


@njit(cache=True, **PLAIN)
def coast(m, z, t, z_new):
    """Write the state after a flight of duration t: ballistic motion, free damped vibrations."""
    body, omega = m.body, m.omega
    n = len(omega)
    for j in range(len(z)):
        z_new[j] = z[j]
    z_new[at.X] += z[at.VX] * t
    z_new[at.Y] += z[at.VY] * t - 0.5 * body[at.GRAVITY] * t * t
    z_new[at.VY] -= body[at.GRAVITY] * t
    z_new[at.PHI] += z[at.SPIN] * t
    z_new[at.TIME] += t
    tail = tail_of(omega, m.sums)
    if body[at.S_MASS] < math.inf:
        sinking = _support(body, z[tail + at.W], z[tail + at.W_RATE], t)
        z_new[tail + at.W], z_new[tail + at.W_RATE] = sinking
    if body[at.LOSS] > 0.0 or (n > 0 and omega[n - 1] * t >= 1e5):
        _ring_down(m, z, t, z_new)
        return
    first, rates = at.N_RIGID, at.N_RIGID + n
    for k in range(n):
        q, p, w = z[first + k], z[rates + k], omega[k]
        cosine, sine = turned(w * t)
        z_new[first + k] = q * cosine + p / w * sine
        z_new[rates + k] = p * cosine - q * w * sine


@njit(cache=True, **PLAIN)
def clearance(m, w, z):
    """How far the tip is from the remembered surface [m], and how fast that grows [m/s].

    Overwrites `w.seen_far`, which then holds depth and rate below the fresh flat.
    """
    kinematics(m, z, w.seen_far)
    gap, rate = w.surface[su.TIP_FLAT] - w.seen_far[at.DEPTH], -w.seen_far[at.RATE]
    if w.surface[su.COUNT] > 0.0:
        x, speed = place_of(m, z)
        low, slope = su.height(w.surface, w.surface[su.COUNT], w.scales[at.ORIGIN] + x)
        gap += low
        rate += slope * speed
    return gap, rate


@njit(cache=True, **PLAIN)
def _free_for(gap, rate, bound):
    """Time that nothing can happen in: gap + rate t - bound t^2/2 >= 0 before it."""
    if gap < 0.0:
        return 0.0
    if bound <= 0.0:
        return gap / -rate if rate < 0.0 else math.inf
    root = math.sqrt(rate * rate + 2.0 * bound * gap)
    return (rate + root) / bound if rate > 0.0 else 2.0 * gap / (root - rate)


@njit(cache=True, **PLAIN)
def _safe(m, w, z, gap, rate, bound):
    """Longest time without a touch: the slow modes by their acceleration, the rest by their reach.

    `gap` and `rate` hold all modes, `bound` none.
    """
    n = len(m.omega)
    along, reach, push = m.psi[1], w.fast[_REACH], w.fast[_PUSH]
    tail = 0.0
    for k in range(n):
        tail += along[k] * z[at.N_RIGID + k] + reach[k]
        rate -= along[k] * z[at.N_RIGID + n + k]
    best = _free_for(gap - tail, rate, bound)
    for k in range(n):
        tail -= along[k] * z[at.N_RIGID + k] + reach[k]
        rate += along[k] * z[at.N_RIGID + n + k]
        bound += push[k]
        best = max(best, _free_for(gap - max(tail, 0.0), rate, bound))
    return best


@njit(cache=True, **PLAIN)
def _bounds(m, w):
    """Fill `w.fast`; return bounds of the rigid motion's and of the leaning gap's acceleration."""
    z, body = w.kept, m.body
    n = len(m.omega)
    half = math.hypot(body[at.HALF_COS], body[at.HALF_SIN])
    rigid = body[at.GRAVITY] + z[at.SPIN] ** 2 * half
    if body[at.S_MASS] < math.inf:
        tail, mass, stiff = tail_of(m.omega, m.sums), body[at.S_MASS], body[at.S_STIFF]
        energy = mass * z[tail + at.W_RATE] ** 2 + stiff * z[tail + at.W] ** 2
        rigid += (math.sqrt(stiff * energy) + body[at.S_DAMP] * math.sqrt(energy / mass)) / mass
    aside = abs(z[at.VX]) + abs(z[at.SPIN]) * half
    aside_push = z[at.SPIN] ** 2 * half
    for k in range(n):
        q, p, omega = z[at.N_RIGID + k], z[at.N_RIGID + n + k], m.omega[k]
        size = math.sqrt(q * q + (p / omega) ** 2)
        push = omega * omega * size * (1.0 + body[at.LOSS])
        w.fast[_REACH, k] = abs(m.psi[1, k]) * size
        w.fast[_PUSH, k] = abs(m.psi[1, k]) * push
        aside += abs(m.psi[2, k]) * omega * size
        aside_push += abs(m.psi[2, k]) * push
    slope, curvature = su.roughest(w.surface, w.surface[su.COUNT])
    return rigid, slope * aside_push + curvature * aside * aside


@njit(cache=True, **PLAIN)
def _until_clear(m, w, z):
    """About how long until no vibration and no wall can bring the leaving tip back; 0 once so.

    Infinite while the body does not leave. `w.seen_far` holds depth and rate of the tip.
    """
    n = len(m.omega)
    body = m.body
    gap, rate = w.surface[su.TIP_FLAT] - w.seen_far[at.DEPTH], -w.seen_far[at.RATE]
    swings = body[at.S_MASS] < math.inf and body[at.S_STIFF] > 0.0
    if swings:
        tail = tail_of(m.omega, m.sums)
        sunk, sinking = z[tail + at.W], z[tail + at.W_RATE]
        gap -= sunk + math.sqrt(sunk**2 + body[at.S_MASS] * sinking**2 / body[at.S_STIFF])
        rate -= sinking
    for k in range(n):
        gap -= m.psi[1, k] * z[at.N_RIGID + k] + w.fast[_REACH, k]
        rate -= m.psi[1, k] * z[at.N_RIGID + n + k]
    if rate <= 0.0:
        return math.inf
    if gap > 0.0:
        return 0.0
    if n == 0 and not swings:
        # A rigid body: it leaves a crater that no wall is steep enough to hold it in.
        slope, _ = su.roughest(w.surface, w.surface[su.COUNT])
        half = math.hypot(body[at.HALF_COS], body[at.HALF_SIN])
        if rate > slope * (abs(z[at.VX]) + abs(z[at.SPIN]) * half):
            return 0.0
    return -1.01 * gap / rate


@njit(cache=True, **PLAIN)
def fly(m, w):
    """Follow a flight from `w.kept` to the next touch, written into `w.z`; say how it ended."""
    z0, z = w.kept, w.z
    horizon = m.body[at.FLIGHT]
    if horizon <= 0.0:
        return HORIZON
    rigid, leaning = _bounds(m, w)
    near = 1e-13 * w.scales[at.D_REF]
    t = 0.0
    coast(m, z0, t, z)
    gap, rate = clearance(m, w, z)
    gap = max(gap, 0.0)
    for look in range(LOOKS):
        left = _until_clear(m, w, z)
        if left == 0.0:
            return CLEAR
        if look > 0 and gap <= near and rate < 0.0:
            return TOUCHED
        free = _safe(m, w, z, gap, rate, rigid + leaning)
        plane = w.surface[su.TIP_FLAT] - w.seen_far[at.DEPTH]
        if plane > 0.0 and leaning > 0.0:
            free = max(free, _safe(m, w, z, plane, -w.seen_far[at.RATE], rigid))
        t += max(min(free, left), 1e-15 * w.scales[at.T_REF])
        if t >= horizon:
            return HORIZON
        coast(m, z0, t, z)
        gap, rate = clearance(m, w, z)
    return LOST
