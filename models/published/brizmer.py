"""Brizmer, Zait, Kligerman and Etsion 2006: a sphere that sticks to the rigid flat.

F = L_c w^1.5 [1 - exp(1/(1 - w^beta))] and A = A_c w [1 + exp(1/(1 - w^alpha))] with w = delta/
delta_c, alpha = 0.25 + 0.125 nu and beta = 0.174 + 0.08 nu. Stick yields earlier than slip:
delta_c is 6.82 nu - 7.83 (nu^2 + 0.0586) and L_c is 8.88 nu - 10.13 (nu^2 + 0.089) times its value
without friction, delta_c = (pi C S/(2 E'))^2 R with C = 1.234 + 1.256 nu. Both ratios are 1 at
nu = 1/2, where a pressed half-space has no tangential motion to stick against; below nu = 0.2 they
are not fitted, and 0.2 is taken. Beyond w = 110 the pressure stays, as for Kogut and Etsion.
"""

from __future__ import annotations

import math

from numba import float64, njit

from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import Common, R, kernel
from .residual import YIELD, bounded_crater, recover

_LEAST_NU, _LAST = 0.2, 110.0
_STIFF, _ALPHA, _BETA = range(YIELD + 1, YIELD + 4)


def stick_over_slip(nu: float) -> tuple[float, float]:
    """Critical depth and critical load with stick over those without friction.

    Examples
    --------
    >>> [round(x, 2) for x in stick_over_slip(0.5)]
    [0.99, 1.01]
    """
    return 6.82 * nu - 7.83 * (nu * nu + 0.0586), 8.88 * nu - 10.13 * (nu * nu + 0.089)


def _numbers(common: Common) -> tuple[float, ...]:
    nu = max(float(common.nu_weak), _LEAST_NU)
    depth, load = stick_over_slip(nu)
    slope = math.pi * (1.234 + 1.256 * nu) * common.S / (2.0 * common.E)
    stiff = common.k_hertz * load / depth**1.5
    return depth * common.R * slope * slope, stiff, 0.25 + 0.125 * nu, 0.174 + 0.08 * nu


@njit(float64(float64, float64), cache=True, _nrt=False, error_model="numpy")
def _fade(w, exponent):
    """exp(1/(1 - w^exponent)): 0 at w = 1, towards 1 for large w."""
    power = math.exp(exponent * math.log(w))
    return math.exp(1.0 / (1.0 - power)) if power > 1.0 else 0.0


@kernel
def _area(par, depth):
    """A/(pi R)."""
    if depth <= par[YIELD]:
        return depth
    return depth * (1.0 + _fade(depth / par[YIELD], par[_ALPHA]))


@kernel
def _loading(par, depth):
    if depth <= par[YIELD]:
        return par[_STIFF] * depth * math.sqrt(depth)
    known = min(depth, _LAST * par[YIELD])
    force = par[_STIFF] * known * math.sqrt(known) * (1.0 - _fade(known / par[YIELD], par[_BETA]))
    return force if depth == known else force * _area(par, depth) / _area(par, known)


@kernel
def _radius(par, depth, peak):
    return math.sqrt(par[R] * _area(par, depth))


@kernel
def _residual(par, peak):
    return bounded_crater(_loading, _radius, par, peak)


@kernel
def _unloading(par, depth, peak):
    return recover(_loading, _residual, par, depth, peak)


BRIZMER = PublishedLaw(
    name="brizmer-stick",
    title="Brizmer, Zait, Kligerman and Etsion 2006, full stick",
    source="J. Mech. Mater. Struct. 1 (2006) 865; Int. J. Solids Struct. 43 (2006) 5736",
    equations="thesis 1.3.2 (named only)",
    standing=Standing.PARTLY,
    domain=Domain(note="flattening of a sphere that sticks to the flat, nu from 0.2, w up to 110"),
    breaks=(("not Hertz: stick is stiffer, by 2.7 for nu = 0.33", 2.7),),
    regime="flattening",
    read="force, beta, C and both ratios in a public force model for granular rough particles, "
    "where the first ratio lacks its nu: with it both are 1 at nu = 1/2; the area and alpha are "
    "quoted from memory, that A_c is pi R delta_c and the recovery are ours",
    own=Kernels(_loading, _radius, _unloading, _residual),
    numbers=_numbers,
)
