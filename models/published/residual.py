"""What is left after the load is gone, and how the force falls until then: all laws' in one place.

A fraction is the residual depth over the peak depth; w is the peak over the law's own critical
approach. The elastic recovery at constant contact radius is exact for a crater that keeps its
size: a spherical cap of radius a springs back by 3 F/(4 E' a), so that the crater's new radius of
curvature is 4 E' a^3/(3 F) (Eqs. 3.6, 4.13).
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from ..kernel import K_HERTZ, N_COMMON, RATIO, E, hertz_force, hertz_recovery

YIELD = N_COMMON
"""Place of a law's own critical approach, first of its numbers; up to it the law is Hertz's."""

# limit: part of the approach that can be left at most [-]: nothing can be left that was not
# pressed in
_MOST = 0.999
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)


@njit(_nrt=False, inline="always")
def recover(loading, residual, par, depth, peak):
    """Unloading of a law with the given kernels, by Hertz's recovery (3.5-3.6, 4.13-4.14)."""
    s, f = residual(par, peak)
    return hertz_recovery(loading(par, peak), depth, peak, s + f)


@njit(_nrt=False, inline="always")
def bounded(loading, par, onset, peak, exponent, fraction):
    """Raise a residual fraction until the recovery gives back no more than was spent.

    Laws whose force exceeds Hertz's just beyond yield, and whose sources give a recovery from the
    peak's force and radius alone, would otherwise return up to half as much again. The recovery is
    F_m x^exponent; the work of loading is Hertz's up to `onset` and a quadrature in ln(depth)
    beyond.
    """
    work = 0.4 * hertz_force(par, onset) * onset
    half = 0.5 * math.log(peak / onset)
    for k in range(16):
        depth = onset * math.exp(half * (1.0 + _NODES[k]))
        work += half * _WEIGHTS[k] * depth * loading(par, depth)
    most = (exponent + 1.0) * work / (loading(par, peak) * peak)
    return max(fraction, 1.0 - most)


@njit(_nrt=False, inline="always")
def crater(loading, radius, par, peak):
    """Residual depths by recovery at constant contact radius; for laws with a `YIELD`."""
    left = 0.0
    if peak > par[YIELD]:
        left = elastic_recovery(par, loading(par, peak), radius(par, peak, peak), peak) * peak
    return to_weaker(par, left)


@njit(_nrt=False, inline="always")
def bounded_crater(loading, radius, par, peak):
    """As `crater`, and no cycle gives back more than was spent."""
    left = 0.0
    if peak > par[YIELD]:
        left = elastic_recovery(par, loading(par, peak), radius(par, peak, peak), peak)
        left = bounded(loading, par, par[YIELD], peak, 1.5, left) * peak
    return to_weaker(par, left)


@njit(cache=True, _nrt=False)
def jackson(w):
    """Jackson, Chusoipin and Green: 1.02 [1 - ((w + 5.9)/6.9)^-0.54] (4.12), below 1."""
    if w <= 1.0:
        return 0.0
    # the fit passes 1 beyond w = 10017
    return min(1.02 * (1.0 - ((w + 5.9) / 6.9) ** -0.54), _MOST)


@njit(cache=True, _nrt=False)
def ghaednia(w):
    """Fitted to the experiments of chapter 3: 0.8 [1 - ((w + 5.5)/6.5)^-2] (3.7)."""
    if w <= 1.0:
        return 0.0
    x = 6.5 / (w + 5.5)
    return 0.8 * (1.0 - x * x)


@njit(cache=True, _nrt=False)
def etsion(w):
    """Etsion, Kligerman and Kadin: (1 - w^-0.28)(1 - w^-0.69) (4.18)."""
    if w <= 1.0:
        return 0.0
    return (1.0 - w**-0.28) * (1.0 - w**-0.69)


@njit(cache=True, _nrt=False)
def kogut_komvopoulos(modulus_ratio):
    """Kogut and Komvopoulos: 1 - 0.591 (E'/S)^-0.156, whatever the depth (4.22)."""
    return max(1.0 - 0.591 * modulus_ratio**-0.156, 0.0)


@njit(cache=True, _nrt=False)
def elastic_recovery(par, force, a, peak):
    """Recovery at constant contact radius: 1 - 3 F/(4 E' a peak); 0 for Hertz."""
    return max(1.0 - 0.75 * force / (par[E] * a * peak), 0.0)


@njit(cache=True, _nrt=False)
def brake(par, force, peak):
    """Brake 2015: 1 - F_m/F_Hertz(peak) (4.31, corrected)."""
    return max(1.0 - force / (par[K_HERTZ] * peak * math.sqrt(peak)), 0.0)


@njit(cache=True, _nrt=False)
def to_weaker(par, total):
    """Split a residual depth: the weaker body takes it, equal strengths take halves.

    For laws whose source does not say which body keeps the dent.
    """
    if par[RATIO] < 1.0:
        return total, 0.0
    if par[RATIO] > 1.0:
        return 0.0, total
    return 0.5 * total, 0.5 * total
