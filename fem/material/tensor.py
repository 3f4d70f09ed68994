"""Axisymmetric tensors at a material point: products, principal axes, logarithm and exponential.

Components are ordered (rr, rz, zr, zz, tt) for a deformation gradient and (rr, zz, rz, tt) for a
symmetric tensor.
"""

from __future__ import annotations

import math

from numba import njit


@njit(cache=True)
def dot(a, b):
    """Double contraction of two symmetric tensors."""
    return a[0] * b[0] + a[1] * b[1] + a[3] * b[3] + 2.0 * a[2] * b[2]


@njit(cache=True)
def spectral(a, b, c):
    """Eigenvalues of [[a, c], [c, b]] and cosine, sine of the first eigenvector's angle."""
    mean = 0.5 * (a + b)
    half = 0.5 * (a - b)
    radius = math.sqrt(half * half + c * c)
    if radius == 0.0:
        return mean, mean, 1.0, 0.0
    # half-angle formulas, each in the form that subtracts nothing
    if half >= 0.0:
        cosine = math.sqrt(0.5 * (1.0 + half / radius))
        sine = 0.5 * c / (radius * cosine)
    else:
        sine = math.copysign(math.sqrt(0.5 * (1.0 - half / radius)), c)
        cosine = 0.5 * c / (radius * sine)
    return mean + radius, mean - radius, cosine, sine


@njit(cache=True)
def log_strain(b):
    """Deviator (rr, zz, rz, tt) and mean of 1/2 ln b."""
    l1, l2, c, s = spectral(b[0], b[1], b[2])
    e1 = 0.5 * math.log(l1)
    e2 = 0.5 * math.log(l2)
    e3 = 0.5 * math.log(b[3])
    m = (e1 + e2 + e3) / 3.0
    e1 -= m
    e2 -= m
    return (e1 * c * c + e2 * s * s, e1 * s * s + e2 * c * c, (e1 - e2) * c * s, e3 - m), m


@njit(cache=True)
def exponential(e, m):
    """Return b = exp(2 (e + m I)), components (rr, zz, rz, tt)."""
    e1, e2, c, s = spectral(e[0] + m, e[1] + m, e[2])
    b1 = math.exp(2.0 * e1)
    b2 = math.exp(2.0 * e2)
    hoop = math.exp(2.0 * (e[3] + m))
    return b1 * c * c + b2 * s * s, b1 * s * s + b2 * c * c, (b1 - b2) * c * s, hoop
