"""Stronge 2000: Hertz, an expanding plastic cavity, full plasticity.

With w = delta/delta_Y and p_Y = 1.1 S the mean pressure at the elastic limit,
F/F_Y = (2 w - 1)[1 + ln(2 w - 1)/3.3] up to w = 84, where the pressure is 2.8 S, and
F/F_Y = (2 w - 1) 2.8/1.1 beyond; a^2 = R (2 delta - delta_Y). Recovery at constant contact radius.
"""

from __future__ import annotations

import math

from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import Common, hertz_force, kernel
from .ceb import constant_volume_radius
from .residual import YIELD, bounded_crater, recover

_FIRST, _FULL = 1.1, 2.8  # mean pressure at the elastic limit and in full plasticity, over S
_LAST = 84.0
_FORCE = YIELD + 1


def _numbers(common: Common) -> tuple[float, float]:
    depth = common.R * (0.75 * math.pi * _FIRST * common.S / common.E) ** 2
    return depth, common.k_hertz * depth * math.sqrt(depth)


@kernel
def _loading(par, depth):
    w = depth / par[YIELD]
    if w <= 1.0:
        return hertz_force(par, depth)
    spread = 2.0 * w - 1.0
    if w < _LAST:
        return par[_FORCE] * spread * (1.0 + math.log(spread) / (3.0 * _FIRST))
    return par[_FORCE] * spread * (_FULL / _FIRST)


@kernel
def _residual(par, peak):
    return bounded_crater(_loading, constant_volume_radius, par, peak)


@kernel
def _unloading(par, depth, peak):
    return recover(_loading, _residual, par, depth, peak)


STRONGE = PublishedLaw(
    name="stronge",
    title="Stronge 2000",
    source="Stronge, Impact Mechanics (2000), chapter 6",
    equations="thesis 1.4 and 4.2 (in words)",
    standing=Standing.OUR_READING,
    domain=Domain(note="indentation or impact of spheres"),
    breaks=(("force falls at w = 84", 0.23),),
    read="not readable; written from memory, continuous at both borders",
    own=Kernels(_loading, constant_volume_radius, _unloading, _residual),
    numbers=_numbers,
)
