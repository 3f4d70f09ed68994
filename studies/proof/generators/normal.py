"""The normal force of a step: both base laws with memory, then layers and dissipation on top.

The metal may differ from elastic-perfect plasticity: by the unloading law of I. Etsion, Y.
Kligerman, Y. Kadin, Int. J. Solids Struct. 42 (2005) 3716, for a part of it (`OTHER_UNLOADING`), by
a modulus of unloading that falls with strain, or by a flow curve (`flow`).
"""

from __future__ import annotations

import math

from numba import njit

from . import cavity, flow, foundation
from . import parameters as at

# places in the memory of a contact: static peak depth, its force, its residual depth, its radius,
# the last depth and force, largest layer closure, layer closure now, radius now, depth when freed,
# edge of the row, rise of the flow stress where the metal flowed last
(
    PEAK, PEAK_F, REST, RADIUS, LAST, LAST_F, LAYER_MOST, LAYER, RADIUS_NOW, FREED, EDGE, RISE,
) = range(12)  # fmt: skip
N_MEMORY = 12


@njit(cache=True)
def _first_yield(p):
    """Depth of first yield of a hard sphere on a flat: pressure of 1.6 yield strengths."""
    return p[at.TIP] * (0.5 * math.pi * 1.6 * p[at.STRENGTH] / p[at.MODULUS]) ** 2


@njit(cache=True)
def _left(p, depth):
    """Residual over largest depth by Etsion, Kligerman and Kadin (2005)."""
    x = max(depth / _first_yield(p), 1.0)
    return (1.0 - x**-0.28) * (1.0 - x**-0.69)


_SLOWEST = 0.2  # of the approach speed: the strength at this rate stays where the striker turns


@njit(cache=True)
def _fallen(p, memory, depth, speed):
    """Fall of the strength at the present rate: a metal that is weaker the faster it flows.

    It flows on at the strength of the rate just before the turning point; one that vanished with
    the speed would turn the effect on the restitution round.
    """
    a = memory[RADIUS] if memory[RADIUS] > 0.0 else math.sqrt(2.0 * p[at.TIP] * depth)
    return flow.factor(p, 0.4 * max(speed, _SLOWEST * p[at.NORMAL_SPEED]) / a) - 1.0


@njit(cache=True)
def _dent(p, depth, rise):
    force, a, left = _perfect(p, depth, rise)
    recovered = (depth - left) * (1.0 + flow.softer(p, depth))
    if p[at.OTHER_UNLOADING] != 0.0:
        other = depth * (1.0 - _left(p, depth))
        recovered += p[at.OTHER_UNLOADING] * (other - recovered)
    return force, a, max(depth - recovered, 0.0)


@njit(cache=True)
def _perfect(p, depth, rise):
    return cavity.dent(
        depth,
        p[at.MODULUS],
        p[at.TIP],
        flow.strength(p, depth) * (1.0 + rise),
        p[at.FLAT],
        p[at.CAVITY_LAW : at.ROW_LAW],
    )


@njit(cache=True)
def _recovered(p, memory, depth):
    """Force on the recovery curve of the static peak in memory (also continued beyond it)."""
    rest = memory[REST]
    if depth <= rest:
        return 0.0
    W = memory[PEAK] / p[at.TIP] * (p[at.MODULUS] / p[at.STRENGTH]) ** 2
    ring = p[at.FLAT] ** 2 / (p[at.TIP] * memory[PEAK])
    n = cavity.exponent(W, ring, p[at.CAVITY_LAW : at.ROW_LAW])
    if p[at.OTHER_UNLOADING] != 0.0:
        # the same source
        other = 1.5 * max(memory[PEAK] / _first_yield(p), 1.0) ** -0.0331
        n += p[at.OTHER_UNLOADING] * (other - n)
    return memory[PEAK_F] * ((depth - rest) / (memory[PEAK] - rest)) ** n


@njit(cache=True)
def _remember(p, memory, peak):
    memory[PEAK] = peak
    memory[PEAK_F], memory[RADIUS], memory[REST] = _dent(p, peak, memory[RISE])


@njit(cache=True)
def _flow_on(p, memory, depth, dt):
    """Let the dent flow by overstress during `dt`: backward Euler by bisection."""
    old = memory[PEAK]
    low, high = max(old, 1e-3 * depth), depth
    for _ in range(30):
        middle = 0.5 * (low + high)
        _remember(p, memory, middle)
        excess = _recovered(p, memory, depth) / memory[PEAK_F] - 1.0
        speed = memory[RADIUS] / 0.4 * flow.rate_at(p, excess)
        if (middle - old) > speed * dt:
            high = middle
        else:
            low = middle
        if high - low < 1e-7 * depth:
            break
    _remember(p, memory, 0.5 * (low + high))


@njit(cache=True)
def _cavity_force(p, memory, depth, speed, dt):
    if depth <= 0.0:
        memory[RADIUS_NOW] = 0.0
        return 0.0
    if depth > memory[PEAK]:
        kind = p[at.RATE_KIND]
        if kind == 0.0 or kind == flow.FALLING:
            if kind == flow.FALLING:
                memory[RISE] = _fallen(p, memory, depth, speed)
            _remember(p, memory, depth)
        else:
            _flow_on(p, memory, depth, dt)
    force = _recovered(p, memory, depth)
    span = memory[PEAK] - memory[REST]
    share = min(max((depth - memory[REST]) / span, 0.0), 1.0) if span > 0.0 else 0.0
    memory[RADIUS_NOW] = memory[RADIUS] * math.sqrt(share)
    return force


@njit(cache=True)
def _row_force(p, memory, depth, speed, dt, plastic):
    """Force of the row of springs, `foundation.press` with strain rate and a flat on the tip."""
    if depth <= 0.0 and memory[PEAK] <= 0.0:
        return 0.0
    E, R = p[at.MODULUS], p[at.TIP]
    growing = depth >= memory[PEAK]
    rate = p[at.RATE_KIND] > 0.0 and p[at.RATE_KIND] != flow.FALLING
    peak = max(depth, memory[PEAK])
    Y = flow.strength(p, peak)
    falling = p[at.RATE_KIND] == flow.FALLING
    if growing and falling:
        memory[RISE] = _fallen(p, memory, depth, speed)
    # how plastic the contact is follows from the strength that the metal shows at its rate: pile-up
    # and pressure limit are those of a harder metal
    firm = Y * (1.0 + memory[RISE])
    if falling:
        Y = firm
    W = 0.0 if math.isinf(Y) else peak / R * (E / firm) ** 2
    law = p[at.ROW_LAW : at.N_PARAMETERS]
    wide = foundation.spread(W, law) * R
    flat = p[at.FLAT]
    a2_peak = wide * peak + flat * flat
    h = math.inf if math.isinf(Y) else foundation.limit(W, math.sqrt(a2_peak) / R, law) * Y
    # stress above the static limit goes on relaxing behind the peak
    a2 = wide * (peak if rate else max(depth, 0.0)) + flat * flat
    total, half = 0.0, 0.0
    flowing, static = 0.0, 0.0
    n = len(plastic)
    edge = memory[EDGE]
    soft = 1.0 + flow.softer(p, peak)
    for i in range(n):
        root = (i + 0.5) / n
        x = foundation.PLACE[i] * edge
        profile = x * x / wide
        if flat > 0.0:
            # image of a paraboloid with a cut tip: x sqrt(x^2 - b^2) / R
            profile = x * math.sqrt(x * x - flat * flat) / wide if x > flat else 0.0
        u = depth - profile
        # a spring that has yielded gives back more than it took elastically
        q = E * u if plastic[i] == 0.0 else E / soft * (u - plastic[i])
        if q <= 0.0:
            continue
        b2 = a2 - x * x
        cap = 2.0 * h * math.sqrt(b2) if b2 > 0.0 else 0.0
        if (growing or rate) and q > cap:
            if not rate:
                plastic[i] = u - soft * cap / E
                q = cap
            else:
                low, high = cap, q
                scale = 0.4 / (E * math.sqrt(a2) * dt)
                for _ in range(14):
                    middle = 0.5 * (low + high)
                    if cap * flow.factor(p, (q - middle) * scale) > middle:
                        low = middle
                    else:
                        high = middle
                q = 0.5 * (low + high)
                plastic[i] = u - soft * q / E
                flowing += q * root
                static += cap * root
        total += q * 2.0 * root / n * edge
        half = x
    if growing and static > 0.0:
        memory[RISE] = flowing / static - 1.0
    memory[PEAK] = peak
    memory[RADIUS] = math.sqrt(a2_peak)
    memory[RADIUS_NOW] = min(half, math.sqrt(a2)) if half > 0.0 else 0.0
    return 2.0 * total


@njit(cache=True)
def _close_layer(p, memory, approach):
    """Rough layer in series, following its rest value within a few steps.

    Closure sigma ln(1 + F/F0), or that of asperities of finite height, at most 3 sigma.
    """
    sigma = p[at.ROUGH]
    load = max(memory[LAST_F], 0.0) / p[at.ROUGH_FORCE]
    rest = sigma * math.log1p(load)
    if p[at.ROUGH_KIND] == 1.0:
        rest = 3.0 * sigma * (1.0 - 1.0 / math.sqrt(1.0 + 2.0 / 3.0 * load))
    rest = max(rest, p[at.ROUGH_LOSS] * memory[LAYER_MOST])
    memory[LAYER] += 0.1 * (rest - memory[LAYER])
    memory[LAYER] = min(memory[LAYER], max(approach, 0.0))
    memory[LAYER_MOST] = max(memory[LAYER_MOST], memory[LAYER])
    return approach - memory[LAYER]


@njit(cache=True)
def _dissipation(p, memory, depth, speed, force):
    a = memory[RADIUS_NOW]
    extra = 0.0
    kind = p[at.DAMP_KIND]
    if kind == 1.0:
        extra += p[at.DAMP] * force * speed
    elif kind == 2.0:
        extra += p[at.DAMP] * 2.0 * p[at.MODULUS] * a * speed
    elif kind == 3.0:
        extra += p[at.DAMP] * speed * min(depth / (1e-3 * p[at.TIP]), 1.0)
    if p[at.RADIATION] > 0.0 and depth != memory[LAST]:
        slope = (force - memory[LAST_F]) / (depth - memory[LAST])
        slope = min(max(slope, 0.0), 3.0 * p[at.MODULUS] * a)
        extra += p[at.RADIATION] * slope * slope * speed
    return max(extra, -force)


@njit(cache=True)
def _between(p, memory, depth, speed, force):
    """What acts before touch and after it: film and adhesion."""
    if p[at.FILM_VISCOSITY] > 0.0 and force <= 0.0 and -depth < p[at.FILM_THICKNESS]:
        gap = max(memory[FREED] - depth if memory[PEAK] > 0.0 else -depth, 0.0)
        drag = 6.0 * math.pi * p[at.FILM_VISCOSITY] * p[at.TIP] ** 2
        way = 1.0 if speed > 0.0 else p[at.FILM_EXIT]
        return drag * speed * way / (gap + p[at.FILM_CLOSED])
    if p[at.ADHESION] > 0.0 and force <= 0.0 and memory[PEAK] > 0.0 and speed < 0.0:
        away = (memory[FREED] - depth) / p[at.ADHESION_RANGE]
        if away < 1.0:
            return -p[at.ADHESION] * (1.0 - max(away, 0.0))
    return force


@njit(cache=True)
def normal_force(p, memory, approach, speed, dt, plastic):
    """Normal force [N] of one step; memory and springs are written.

    - `p`: parameters of the impact (`parameters`).
    - `memory`: (N_MEMORY,) of the contact.
    - `approach`, `speed`: how far and how fast the tip has come below first touch [m, m/s].
    - `dt`: time step [s].
    - `plastic`: (n,) plastic shortening of the springs [m].
    """
    depth = approach
    if p[at.ROUGH] > 0.0 and approach > 0.0:
        depth = _close_layer(p, memory, approach)
    if p[at.LAW] == at.FOUNDATION:
        force = _row_force(p, memory, depth, speed, dt, plastic)
    else:
        force = _cavity_force(p, memory, depth, speed, dt)
    static = force
    if force > 0.0:
        force += _dissipation(p, memory, depth, speed, force)
        memory[FREED] = depth
    else:
        force = _between(p, memory, depth, speed, force)
    memory[LAST] = depth
    memory[LAST_F] = static
    return force
