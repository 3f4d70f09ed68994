"""Zhao, Maietta and Chang 2000: an asperity that goes over from Hertz to full plasticity.

Elastic up to w_1 = (3 pi k H/(4 E'))^2 R, where Hertz's mean pressure is k H; fully plastic from
w_2 = 54 w_1 on, with F = H 2 pi R w. Between them the pressure is H - H (1 - k)(ln w_2 - ln w)/
(ln w_2 - ln w_1) on the area pi R w (1 - 2 x^3 + 3 x^2), x = (w - w_1)/(w_2 - w_1): force, area and
their slopes join at both ends. H = 2.8 S; k = 0.4 is Tabor's first yield, a largest pressure of
0.6 H. The recovery is ours: the crater keeps its contact radius.
"""

from __future__ import annotations

import math

from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import Common, R, hertz_force, kernel
from .residual import YIELD, bounded_crater, recover

_HARDNESS, _FIRST, _SPAN = 2.8, 0.4, 54.0  # H/S, k, w_2/w_1
_PRESSURE = YIELD + 1


def _numbers(common: Common) -> tuple[float, float]:
    hardness = _HARDNESS * common.S
    slope = 0.75 * math.pi * _FIRST * hardness / common.E
    return common.R * slope * slope, hardness


@kernel
def _spread(par, depth):
    """Area over pi R depth: 1 to 2."""
    x = min((depth / par[YIELD] - 1.0) / (_SPAN - 1.0), 1.0)
    return 1.0 + x * x * (3.0 - 2.0 * x)


@kernel
def _loading(par, depth):
    if depth <= par[YIELD]:
        return hertz_force(par, depth)
    full = math.log(_SPAN)
    below = max(full - math.log(depth / par[YIELD]), 0.0) / full
    pressure = par[_PRESSURE] * (1.0 - (1.0 - _FIRST) * below)
    return math.pi * par[R] * depth * _spread(par, depth) * pressure


@kernel
def _radius(par, depth, peak):
    if depth <= par[YIELD]:
        return math.sqrt(par[R] * depth)
    return math.sqrt(par[R] * depth * _spread(par, depth))


@kernel
def _residual(par, peak):
    return bounded_crater(_loading, _radius, par, peak)


@kernel
def _unloading(par, depth, peak):
    return recover(_loading, _residual, par, depth, peak)


ZHAO_MAIETTA_CHANG = PublishedLaw(
    name="zhao-maietta-chang",
    title="Zhao, Maietta and Chang 2000",
    source="J. Tribol. 122 (2000) 86",
    equations="none in the thesis",
    standing=Standing.PARTLY,
    domain=Domain(note="one asperity, flattening; H = 2.8 S and k = 0.4"),
    regime="flattening",
    read="w_1, w_2, pressure and area in a public MATLAB function ZMC for rough surfaces, where k "
    "is the caller's; the recovery is ours",
    own=Kernels(_loading, _radius, _unloading, _residual),
    numbers=_numbers,
)
