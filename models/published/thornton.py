"""Thornton 1997 and Thornton and Ning 1998: the pressure is cut off at p_y.

Beyond delta_y = (pi p_y/(2 E'))^2 R the force grows linearly, F = F_y + pi R p_y (delta - delta_y),
with a^2 = R delta; the recovery is Hertz's with the radius R_p = (4 E'/(3 F_m)) ((2 F_m + F_y)/(2
pi p_y))^(3/2), which keeps the contact radius. The two papers differ in adhesion, which is left out
here, and in the meaning of p_y: first yield, 1.6 S, or the limiting pressure, 2.84 S. The latter
comes closer to figure 3.11.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import Common, hertz_force, kernel
from .hertz import hertz_radius
from .residual import YIELD, crater, recover

_FORCE, _SLOPE = YIELD + 1, YIELD + 2


def _numbers_at(pressure_over_S: float, common: Common) -> tuple[float, float, float]:
    p = pressure_over_S * common.S
    depth = common.R * (math.pi * p / (2.0 * common.E)) ** 2
    return depth, common.k_hertz * depth * math.sqrt(depth), math.pi * common.R * p


@kernel
def _loading(par, depth):
    if depth <= par[YIELD]:
        return hertz_force(par, depth)
    return par[_FORCE] + par[_SLOPE] * (depth - par[YIELD])


@kernel
def _residual(par, peak):
    return crater(_loading, hertz_radius, par, peak)


@kernel
def _unloading(par, depth, peak):
    return recover(_loading, _residual, par, depth, peak)


THORNTON = PublishedLaw(
    name="thornton",
    title="Thornton 1997",
    source="J. Appl. Mech. 64 (1997) 383",
    equations="thesis 1.4, 3.3 and 4.2 (in words)",
    standing=Standing.SECOND_HAND,
    domain=Domain(note="impact of spheres; p_y = 1.6 S, the pressure at first yield"),
    read="equations 1-5 of arXiv:2104.00344 and the closed-form restitution, equation 2 of "
    "Jackson, Green and Marghitu, Nonlinear Dyn. 60 (2010) 217, both as the public code "
    "ranssist/chiton-helmet-sim restates them; force, recovery and closed form agree to 4 digits",
    own=Kernels(_loading, hertz_radius, _unloading, _residual),
    numbers=partial(_numbers_at, 1.6),
)

THORNTON_NING = replace(
    THORNTON,
    name="thornton-ning",
    title="Thornton and Ning 1998, without adhesion",
    source="Powder Technol. 99 (1998) 154",
    domain=Domain(note="impact of spheres; p_y = 2.84 S, a limiting pressure, is our choice"),
    read="yield radius (equation 65), linear force, R_p = 4 E' a^3/(3 F_m) and V_y = "
    "1.56 (p_y^5/(E'^4 rho))^(1/2) in the public code PyGran, class ThorntonNing, where p_y is the "
    "user's; its adhesion is left out",
    numbers=partial(_numbers_at, 2.84),
)
