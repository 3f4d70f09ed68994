"""Kogut and Komvopoulos 2004: indentation of a half-space by a rigid sphere (4.20-4.22).

Depths are measured by delta/r' with r' the radius of the truncated contact. The numerator of 4.21
is the mean pressure over S and its denominator the truncated over the real area; the fit stops
where the pressure reaches the hardness of the same paper (1.9), beyond which the pressure stays.
Without the stop the force diverges at delta/r' = 1.28, 0.74 and 0.28 for E'/S = 200, 360 and 1000.
"""

from __future__ import annotations

import math

from numba import njit

from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import N_COMMON, Common, E, R, S, kernel
from .residual import kogut_komvopoulos as residual_fraction
from .residual import recover, to_weaker

ELASTIC = 1.78
"""E' delta/(S r') at the end of the elastic phase."""

SMALLEST = 0.71
"""Truncated over real contact area in full plasticity."""

_LIMIT, _PRESSURE, _RATIO, _TOP, _LEFT = range(N_COMMON, N_COMMON + 5)


def _numbers(common: Common) -> tuple[float, ...]:
    q = common.E / common.S
    if q == 0.0:  # nothing yields
        return math.inf, 0.0, 0.0, 0.0, 0.0
    log_q = math.log(q)
    top = 0.201 * log_q + 1.685
    left = residual_fraction(q)
    return ELASTIC / q, 0.839 + 0.656 * log_q, 2.192 - 0.394 * log_q, top, left


@njit(cache=True, _nrt=False, error_model="numpy")
def truncated(par, depth):
    """Square of the truncated contact's radius r' [m^2], and delta/r' (4.23)."""
    square = par[R] * par[R] if depth >= par[R] else depth * (2.0 * par[R] - depth)
    return square, depth / math.sqrt(square)


@njit(cache=True, _nrt=False, error_model="numpy")
def truncated_hertz(par, square, depth):
    """Elastic force (4/3) E' sqrt(R) delta^(3/2) with r' for the radius (4.20, 4.24)."""
    return 2.0 * math.sqrt(2.0) / 3.0 * par[E] * depth * math.sqrt(square)


@kernel
def _loading(par, depth):
    square, strain = truncated(par, depth)
    if strain <= par[_LIMIT]:
        return truncated_hertz(par, square, depth)
    log_strain = math.log(strain)
    pressure = min(par[_PRESSURE] + 0.651 * log_strain, par[_TOP])
    ratio = max(par[_RATIO] - 0.419 * log_strain, SMALLEST)
    return math.pi * square * par[S] * pressure / ratio


@kernel
def _radius(par, depth, peak):
    square, strain = truncated(par, depth)
    ratio = 2.0
    if strain > par[_LIMIT]:
        ratio = max(par[_RATIO] - 0.419 * math.log(strain), SMALLEST)
    return math.sqrt(square / ratio)


@kernel
def _residual(par, peak):
    _, strain = truncated(par, peak)
    if strain <= par[_LIMIT]:
        return 0.0, 0.0
    return to_weaker(par, par[_LEFT] * peak)


@kernel
def _unloading(par, depth, peak):
    return recover(_loading, _residual, par, depth, peak)


KOGUT_KOMVOPOULOS = PublishedLaw(
    name="kogut-komvopoulos",
    title="Kogut and Komvopoulos 2004",
    source="J. Mater. Res. 19 (2004) 3641",
    equations="1.9, 4.20-4.22",
    standing=Standing.THESIS,
    domain=Domain(note="indentation by a rigid sphere, up to p/S of 1.9"),
    breaks=(
        ("force jumps at E' delta/(S r') = 1.78", 11.6),
        ("radius falls at E' delta/(S r') = 1.78", 3.7),
        ("residual jumps at E' delta/(S r') = 1.78", 84.0),
        ("not Hertz: the truncated radius, -delta/(4 R) at D = 0.01", 0.26),
    ),
    regime="indentation",
    read="the thesis only; where the fit stops is an inference",
    own=Kernels(_loading, _radius, _unloading, _residual),
    numbers=_numbers,
)
