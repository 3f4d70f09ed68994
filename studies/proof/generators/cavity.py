"""Base law one: an expanding-cavity dent with pile-up, and power-law recovery.

A smooth minimum joins Hertz's force and the force of a plastic dent H pi a^2; a^2 = spread R depth
grows from Hertz's to a piled-up dent. What is recovered on unloading follows from the elastic
stiffness 2 E' a at the peak. With W = (depth/R) (E'/Sy)^2:

    x = (W/w2)^s,  a^2/(R d) = 1 + (k - 1) x/(1 + x)
    F = (F_H^-p + F_P^-p)^(-1/p),  F_P = pi a^2 Sy h (1 - g a/R)
    residual = d - m F/(2 E' a),   m = 3/2 - (3/2 - m_inf) y/(1 + y),  y = (W/w3)^q

A flat on the tip joins the sphere to the rigid punch, whose m is 1 and which recovers linearly.

The coefficients for all pairs alike (`base_laws` has those of each pair) were fitted to quasi-
static finite-element curves of a hard sphere on a softer flat: 82 pairs of data/campaign, E'/Sy
from 60 to 2500, depth up to 0.1 R. Rms of what is left: force 1 % below W = 30, 2 to 4.5 % above;
elastic energy given back 4 to 6.5 %; residual depth 0.5 to 5 % above W = 100, 12 % down to W = 30,
20 % below, where little is left. For the cavity picture: K. L. Johnson, Contact Mechanics (1985),
6.3.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

COEFFICIENTS = np.array([2.384, 572.0, 0.8483, 3.271, 0.1454, 3.512, 1.1986, 28.94, 1.390, 2.552])
"""k, w2, s, h, g, p, m_inf, w3, exponent of the recovery, q."""

_JOIN = 1.6  # exponent that joins the sphere's force and the punch's


@njit(cache=True)
def _punch(ring):
    """The punch's force over the sphere's, to the power `_JOIN`; `ring` is flat^2/(R depth)."""
    return (1.5 * math.sqrt(ring)) ** _JOIN if ring > 0.0 else 0.0


@njit(cache=True)
def exponent(W, ring, c):
    """Exponent of the recovery from a dent of plasticity index W; 1 where a flat is large."""
    n = 1.5 - (1.5 - c[8]) * W / (W + 10.0)
    return 1.0 + (n - 1.0) / (1.0 + _punch(ring))


@njit(cache=True)
def dent(depth, E, R, Y, flat, c):
    """Force [N], contact radius [m] and residual depth [m] of a dent loaded to `depth`.

    - `depth`: depth from first touch [m], above 0.
    - `E`, `R`, `Y`: reduced modulus [Pa], tip radius [m], strength of the flat [Pa]; `inf` for an
      elastic one.
    - `flat`: radius of a flat on the tip [m]: the contact starts with that area.
    - `c`: coefficients.
    """
    hertz = 4.0 / 3.0 * E * math.sqrt(R * depth) * depth
    if flat > 0.0:
        # a rounded edge: the punch takes over from the sphere where its force is the lesser
        hertz *= (1.0 + _punch(flat * flat / (R * depth))) ** (1.0 / _JOIN)
    if math.isinf(Y):
        return hertz, math.sqrt(R * depth + flat * flat), 0.0
    W = depth / R * (E / Y) ** 2
    x = (W / c[1]) ** c[2]
    a2 = (1.0 + (c[0] - 1.0) * x / (1.0 + x)) * R * depth
    if flat > 0.0:
        a2 = (a2**1.5 + flat**3) ** (2.0 / 3.0)
    a = math.sqrt(a2)
    plastic = math.pi * a2 * Y * c[3] * max(1.0 - c[4] * a / R, 0.2)
    force = hertz * (1.0 + (hertz / plastic) ** c[5]) ** (-1.0 / c[5])
    y = (W / c[7]) ** c[9]
    m = 1.5
    if flat > 0.0:
        round_edge = ((R * depth) ** 1.5 + flat**3) ** (1.0 / 3.0)
        m = 2.0 * E * round_edge * depth / hertz
    # a dent's bottom recovers less than a sphere's, but under a punch it stays flat
    m -= (1.5 - c[6]) * (2.0 * m - 2.0) * y / (1.0 + y)
    return force, a, max(depth - m * force / (2.0 * E * a), 0.0)
