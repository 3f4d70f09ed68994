"""What multiplies the strength of the flat: strain rate, strain, depth of the layer.

Rate laws come as a pair, factor of the rate and rate at a factor, because the dent flows by the
stress that exceeds the static one and relaxes when the striker slows (overstress; Perzyna 1966).
"""

from __future__ import annotations

import math

from numba import njit

from . import parameters as at

POWER, LOGARITHM, THERMAL, FALLING = 1.0, 2.0, 3.0, 4.0
"""Rate laws: 1 + (r/A)^(1/B); 1 + A ln(1 + r/B); 1 + A ((r/r_s)^B - 1); the inverse of the second.

The third is Zerilli and Armstrong's for a body-centred metal at one temperature (J. Appl. Phys.
61 (1987) 1816), with the static rate r_s = 1e-3 1/s; the fourth is no known mechanism of the tool.
"""

VOCE, SWIFT, SOFTENING = 1.0, 2.0, 3.0
"""Hardening: 1 + A (1 - exp(-e/B)); (1 + e/B)^A; 1 - A (1 - exp(-e/B))."""

EXPONENTIAL, PLATEAU, CRUSHED = 1.0, 2.0, 3.0
"""Layer: 1 + A exp(-z/B); 1 + A/(1 + (z/B)^4); 1 - A exp(-(z/B)^2), with z = a/2."""

STATIC_RATE = 1e-3


@njit(cache=True)
def strength(p, peak):
    """Static strength [Pa] of a dent of largest depth `peak`."""
    R = p[at.TIP]
    Y = p[at.STRENGTH]
    if peak <= 0.0:
        return Y
    a = math.sqrt(2.0 * R * peak + p[at.FLAT] ** 2)
    if p[at.CURVE] > 0.0:
        Y *= 1.0 + p[at.CURVE] * (1.0 - math.exp(-0.2 * a / R / p[at.CURVE_STRAIN]))
    kind = p[at.HARD_KIND]
    if kind > 0.0:
        e = 0.2 * a / R
        A = p[at.HARD_A]
        B = p[at.HARD_B]
        if kind == VOCE:
            Y *= 1.0 + A * (1.0 - math.exp(-e / B))
        elif kind == SWIFT:
            Y *= (1.0 + e / B) ** A
        else:
            Y *= 1.0 - A * (1.0 - math.exp(-e / B))
    kind = p[at.LAYER_KIND]
    if kind > 0.0:
        z = 0.5 * a / p[at.LAYER_B]
        A = p[at.LAYER_A]
        if kind == EXPONENTIAL:
            Y *= 1.0 + A * math.exp(-z)
        elif kind == PLATEAU:
            Y *= 1.0 + A / (1.0 + z**4)
        else:
            Y *= 1.0 - A * math.exp(-z * z)
    if p[at.WAVE_A] > 0.0:
        Y *= 1.0 + p[at.WAVE_A] * math.sin(2.0 * math.pi * a / p[at.WAVE_B])
    return Y


@njit(cache=True)
def softer(p, peak):
    """Elastic compliance of the unloading from a dent over that of the virgin metal, less 1.

    The chord modulus of unloading falls with plastic strain, E_0 - (E_0 - E_a) (1 - exp(-xi e)):
    F. Yoshida, T. Uemori, K. Fujiwara, Int. J. Plasticity 18 (2002) 633.
    """
    if p[at.CHORD] == 0.0 or peak <= 0.0 or math.isinf(p[at.STRENGTH]):
        return 0.0
    e = 0.2 * math.sqrt(2.0 * peak / p[at.TIP])
    return p[at.CHORD] * (1.0 - math.exp(-e / p[at.CHORD_STRAIN]))


@njit(cache=True)
def factor(p, rate):
    """Flow stress over the static one at a plastic strain rate [1/s]."""
    kind = p[at.RATE_KIND]
    r = max(rate, 0.0)
    if kind == POWER:
        return 1.0 + (r / p[at.RATE_A]) ** (1.0 / p[at.RATE_B])
    if kind == LOGARITHM:
        return 1.0 + p[at.RATE_A] * math.log1p(r / p[at.RATE_B])
    if kind == THERMAL:
        return 1.0 + p[at.RATE_A] * max((r / STATIC_RATE) ** p[at.RATE_B] - 1.0, 0.0)
    if kind == FALLING:
        return 1.0 / (1.0 + p[at.RATE_A] * math.log1p(r / p[at.RATE_B]))
    return 1.0


@njit(cache=True)
def rate_at(p, excess):
    """Plastic strain rate [1/s] at which the flow stress exceeds the static one by `excess`."""
    kind = p[at.RATE_KIND]
    if excess <= 0.0:
        return 0.0
    if kind == POWER:
        return p[at.RATE_A] * excess ** p[at.RATE_B]
    if kind == LOGARITHM:
        return p[at.RATE_B] * math.expm1(min(excess / p[at.RATE_A], 60.0))
    return STATIC_RATE * (1.0 + excess / p[at.RATE_A]) ** (1.0 / p[at.RATE_B])
