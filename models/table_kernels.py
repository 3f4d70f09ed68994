"""Kernels of a law that is a table: columns over ln(depth/R) behind the pair's common numbers."""

from __future__ import annotations

import math

from numba import njit

from .base import Kernels
from .kernel import K_HERTZ, N_COMMON, E, R, cubic, kernel, power_recovery

_COUNT, _FIRST, _STEP = range(N_COMMON, N_COMMON + 3)
_START = N_COMMON + 3
_FORCE, _RADIUS, _LEFT, _PART, _EXPONENT = range(5)
_COLUMNS = 5


@njit(_nrt=False, inline="always")
def _column(par, column, x):
    """A column at x = ln(depth/R): cubics between points, straight lines beyond both ends."""
    n = int(par[_COUNT])
    place = (x - par[_FIRST]) / par[_STEP]
    # nan is no index
    k = int(min(place, n - 2.0)) if place > 0.0 else 0
    at = _START + 2 * (column * n + k)
    v0, s0, v1, s1 = par[at], par[at + 1], par[at + 2], par[at + 3]
    t = place - k
    if t < 0.0:
        return v0 + s0 * t
    if t > 1.0:
        return v1 + s1 * (t - 1.0)
    return cubic(t, v0, v1, s0, s1)


@kernel
def _loading(par, depth):
    x = math.log(depth / par[R])
    if x < par[_FIRST]:
        return par[K_HERTZ] * depth * math.sqrt(depth)
    return math.exp(_column(par, _FORCE, x)) * par[E] * par[R] * par[R]


@kernel
def _radius(par, depth, _peak):
    x = math.log(depth / par[R])
    if x < par[_FIRST]:
        return math.sqrt(depth * par[R])
    return math.exp(_column(par, _RADIUS, x)) * par[R]


@kernel
def _residual(par, peak):
    x = math.log(peak / par[R])
    if x < par[_FIRST]:
        return 0.0, 0.0
    left = min(max(_column(par, _LEFT, x), 0.0), 0.999) * peak
    part = min(max(_column(par, _PART, x), 0.0), 1.0)
    return part * left, (1.0 - part) * left


@kernel
def _unloading(par, depth, peak):
    sphere, flat = _residual(par, peak)
    x = math.log(peak / par[R])
    exponent = 1.5 if x < par[_FIRST] else max(_column(par, _EXPONENT, x), 1.0)
    return power_recovery(_loading(par, peak), depth, peak, sphere + flat, exponent)


TABLE_KERNELS = Kernels(_loading, _radius, _unloading, _residual)
