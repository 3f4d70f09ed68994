"""Johnson's simple plastic contact: Hertz, then a constant mean pressure of 2.8 S (1.3.1).

The plastic contact neither piles up nor sinks in, a^2 = 2 R delta, so F = 2 pi R delta H. The two
phases meet where they give the same force, at delta_p = R (3 pi H/(2 E'))^2; the radius steps up
there by sqrt(2). A crater recovers at constant contact radius (Johnson, 11.5).
"""

from __future__ import annotations

import math

from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import Common, R, hertz_force, kernel
from .residual import YIELD, crater, recover

HARDNESS = 2.8
"""Mean pressure in full plasticity over the yield strength."""

_SLOPE = YIELD + 1


def _numbers(common: Common) -> tuple[float, float]:
    x = 3.0 * math.pi * HARDNESS * common.S / (2.0 * common.E)
    return common.R * x * x, 2.0 * math.pi * common.R * HARDNESS * common.S


@kernel
def _loading(par, depth):
    if depth <= par[YIELD]:
        return hertz_force(par, depth)
    return par[_SLOPE] * depth


@kernel
def _radius(par, depth, peak):
    if depth <= par[YIELD]:
        return math.sqrt(par[R] * depth)
    return math.sqrt(2.0 * par[R] * depth)


@kernel
def _residual(par, peak):
    return crater(_loading, _radius, par, peak)


@kernel
def _unloading(par, depth, peak):
    return recover(_loading, _residual, par, depth, peak)


JOHNSON = PublishedLaw(
    name="johnson",
    title="Johnson 1985, simple plastic",
    source="Johnson, Contact Mechanics (1985), chapters 6 and 11",
    equations="thesis 1.3.1 (in words)",
    standing=Standing.OUR_READING,
    domain=Domain(note="full plasticity; too stiff between first yield and delta_p"),
    breaks=(("radius jumps at delta_p", 41.5), ("residual jumps at delta_p", 29.3)),
    read="the thesis's words; the impact relations of Johnson 11.5 as test_impact_exact uses them",
    own=Kernels(_loading, _radius, _unloading, _residual),
    numbers=_numbers,
)
