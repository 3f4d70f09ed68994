"""Chang, Etsion and Bogy 1987: Hertz, then a sphere that keeps its volume at constant pressure.

A = pi R (2 delta - delta_c) and F = K H A beyond delta_c = (pi K H/(2 E'))^2 R, with H = 2.8 S and
K = 0.454 + 0.41 nu (4.15). The force steps up by exactly one half at delta_c, where the mean
pressure goes from 2/3 of its maximum to all of it: the discontinuity that section 1.3 names.
"""

from __future__ import annotations

import math

from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import Common, R, hertz_force, kernel
from .residual import YIELD, bounded_crater, recover

_PRESSURE = YIELD + 1


def yield_pressure(common: Common) -> float:
    """Largest pressure at first yield, K H = (0.454 + 0.41 nu) 2.8 S [Pa] (4.15)."""
    return float((0.454 + 0.41 * common.nu_weak) * 2.8 * common.S)


def yield_depth(common: Common) -> float:
    """Critical approach delta_c = (pi K H/(2 E'))^2 R [m] (4.15)."""
    x = math.pi * yield_pressure(common) / (2.0 * common.E)
    return float(common.R * x * x)


def _numbers(common: Common) -> tuple[float, float]:
    return yield_depth(common), yield_pressure(common)


@kernel
def constant_volume_radius(par, depth, peak):
    """a^2 = R (2 delta - delta_y) beyond a law's own critical approach, R delta before it."""
    if depth <= par[YIELD]:
        return math.sqrt(par[R] * depth)
    return math.sqrt(par[R] * (2.0 * depth - par[YIELD]))


@kernel
def _loading(par, depth):
    if depth <= par[YIELD]:
        return hertz_force(par, depth)
    return math.pi * par[R] * (2.0 * depth - par[YIELD]) * par[_PRESSURE]


@kernel
def _residual(par, peak):
    return bounded_crater(_loading, constant_volume_radius, par, peak)


@kernel
def _unloading(par, depth, peak):
    return recover(_loading, _residual, par, depth, peak)


CEB = PublishedLaw(
    name="ceb",
    title="Chang, Etsion and Bogy 1987",
    source="J. Tribol. 109 (1987) 257",
    equations="thesis 1.3 (in words), 4.15",
    standing=Standing.OUR_READING,
    domain=Domain(note="flattening; kept for its discontinuity"),
    breaks=(("force jumps at delta_c", 50.0), ("residual jumps at delta_c", 33.4)),
    regime="flattening",
    read="the thesis's words; K = 0.454 + 0.41 nu in tmd-lab/microslip-rough-contact (CEB_MU); the "
    "area after yield is the known consequence of constant volume, read nowhere",
    own=Kernels(_loading, constant_volume_radius, _unloading, _residual),
    numbers=_numbers,
)
