"""Sinclair and Follansbee: Hertz up to p = 1.1 S, full plasticity from a E'/(R S) = 50 (1.3.1).

The thesis gives the two ends and the pressure of 2.8 S in words only. Between them the pressure
grows with the logarithm of a E'/(R S), the variable of Johnson's expanding cavity; the radius
follows a^2 = R (2 delta - delta_e), which goes over from Hertz to no pile-up. Both are our reading.
"""

from __future__ import annotations

import math

from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import Common, R, S, hertz_force, kernel
from .ceb import constant_volume_radius
from .residual import YIELD, bounded_crater, recover

_FIRST, _FULL = 1.1, 2.8  # mean pressure at the elastic limit and in full plasticity, over S
_X_FULL = 50.0  # a E'/(R S) of full plasticity
_X_FIRST = 0.75 * math.pi * _FIRST  # the same at the elastic limit, by Hertz
_RATE = (_FULL - _FIRST) / math.log(_X_FULL / _X_FIRST)

_STRAIN = YIELD + 1


def _numbers(common: Common) -> tuple[float, float]:
    x = _X_FIRST * common.S / common.E
    return common.R * x * x, common.E / (common.R * common.S)


@kernel
def _loading(par, depth):
    if depth <= par[YIELD]:
        return hertz_force(par, depth)
    square = par[R] * (2.0 * depth - par[YIELD])
    pressure = _FIRST + _RATE * math.log(math.sqrt(square) * par[_STRAIN] / _X_FIRST)
    return math.pi * square * min(pressure, _FULL) * par[S]


@kernel
def _residual(par, peak):
    return bounded_crater(_loading, constant_volume_radius, par, peak)


@kernel
def _unloading(par, depth, peak):
    return recover(_loading, _residual, par, depth, peak)


SINCLAIR_FOLLANSBEE = PublishedLaw(
    name="sinclair-follansbee",
    title="Sinclair and Follansbee 1984-85",
    source="J. Appl. Mech. 52 (1985) 815; Int. J. Solids Struct. 20 (1984) 81",
    equations="thesis 1.3.1 (in words)",
    standing=Standing.OUR_READING,
    domain=Domain(note="indentation; the law between the two stated ends is our reading"),
    regime="indentation",
    read="the thesis's words only",
    own=Kernels(_loading, constant_volume_radius, _unloading, _residual),
    numbers=_numbers,
)
