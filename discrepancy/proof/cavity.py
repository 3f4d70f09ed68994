"""Base law one: an expanding-cavity dent with pile-up, and power-law recovery.

A smooth minimum joins Hertz's force and the force of a plastic dent H pi a^2; a^2 = spread R depth
grows from Hertz's to a piled-up dent. What is recovered on unloading follows from the elastic
stiffness 2 E' a at the peak. With W = (depth/R) (E'/Sy)^2:

    x = (W/w2)^s,  a^2/(R d) = 1 + (k - 1) x/(1 + x)
    F = (F_H^-p + F_P^-p)^(-1/p),  F_P = pi a^2 Sy h (1 - g a/R)
    residual = d - m F/(2 E' a),   m = 3/2 - (3/2 - m_inf) W/(W + w3)

The coefficients were fitted to quasi-static finite-element curves of a hard sphere on a softer flat
(eight pairs, E'/Sy from 170 to 2200, depth up to 0.06 R): force within 3 % rms, residual depth
within 5 % of the depth. For the cavity picture: K. L. Johnson, Contact Mechanics (1985), 6.3.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

COEFFICIENTS = np.array([2.732, 572.3, 0.8267, 2.919, 0.1285, 3.702, 1.2186, 33.94, 1.41])
"""k, w2, s, h, g, p, m_inf, w3, exponent of the recovery."""


@njit(cache=True)
def dent(depth, E, R, Y, flat, c):
    """Force [N], contact radius [m] and residual depth [m] of a dent loaded to `depth`.

    Parameters
    ----------
    depth
        Depth from first touch [m], above 0.
    E, R, Y
        Reduced modulus [Pa], tip radius [m], strength of the flat [Pa]; `inf` for an elastic one.
    flat
        Radius of a flat on the tip [m]: the contact starts with that area.
    c
        Coefficients.
    """
    hertz = 4.0 / 3.0 * E * math.sqrt(R * depth) * depth
    if flat > 0.0:
        # a rounded edge: the punch takes over from the sphere where its force is the lesser
        ring = flat * flat / (R * depth)
        hertz *= (1.0 + (1.5 * math.sqrt(ring)) ** 1.6) ** (1.0 / 1.6)
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
    m = 1.0 - (1.0 - c[6] / 1.5) * W / (W + c[7])
    if flat > 0.0:
        round_edge = ((R * depth) ** 1.5 + flat**3) ** (1.0 / 3.0)
        m *= 2.0 * E * round_edge * depth / hertz
    else:
        m *= 1.5
    return force, a, max(depth - m * force / (2.0 * E * a), 0.0)
