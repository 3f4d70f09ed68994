"""Brake 2012 and 2015: elastic, mixed and fully plastic contact, joined smoothly.

Both begin to yield at delta_y = (R/F(nu)^2)(pi S/(2 E'))^2, F being the largest von Mises stress on
the axis of Hertz's contact over p_0 (4.28, corrected), and end in F = p_0 pi a^2 with a^2 = 2 R
delta. The 2012 law puts a cubic with both slopes in between (the thesis describes it in words; that
it ends at E' a/(R S) = 40, Johnson's border of full plasticity, is our reading). The 2015 law fades
from one to the other by hyperbolic secants (4.29), with Meyer's exponent n and a hardness p_0 of
its own (4.30, corrected); its recovery is 4.31, corrected.
"""

from __future__ import annotations

import functools
import math

from ...core.errors import InputError
from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import Common, R, cubic, hertz_force, kernel
from .johnson import HARDNESS
from .residual import YIELD, bounded, brake, crater, recover, to_weaker

_FULL_PLASTICITY = 40.0  # E' a/(R S) where the 2012 law is fully plastic
_FULL, _SLOPE, _FORCE = range(YIELD + 1, YIELD + 4)
_MEYER = _FORCE  # n - 2; the later law needs no force at yield


@functools.lru_cache(maxsize=256)
def stress_factor(nu: float) -> float:
    """Largest von Mises stress on the axis of Hertz's contact over its peak pressure, F(nu).

    F = max over z of |-(1 + nu)[1 - (z/a) atan(a/z)] + 1.5/(1 + z^2/a^2)| (4.28, corrected).

    Examples
    --------
    >>> round(1.0 / stress_factor(0.3), 4)
    1.6128
    """
    from scipy.optimize import minimize_scalar

    def stress(z: float) -> float:
        return -abs(-(1.0 + nu) * (1.0 - z * math.atan(1.0 / z)) + 1.5 / (1.0 + z * z))

    best = minimize_scalar(stress, bounds=(0.05, 2.0), method="bounded", options={"xatol": 1e-12})
    return float(-best.fun)


def yield_depth(common: Common) -> float:
    """delta_y = (R/F^2)(pi S/(2 E'))^2 [m] (4.28, corrected)."""
    slope = math.pi * common.S / (2.0 * common.E * stress_factor(float(common.nu_weak)))
    return float(common.R * slope * slope)


def effective_hardness(common: Common) -> float:
    """p_0 of the pair from 2.8 S of each body, (1/H_s + 1/H_f)^-1 [Pa] (4.30, corrected)."""
    ratio = float(common.ratio)
    stronger = 1.0 if math.isnan(ratio) else max(ratio, 1.0 / ratio if ratio > 0.0 else math.inf)
    return float(HARDNESS * common.S / (1.0 + 1.0 / stronger))


def _numbers_2012(common: Common) -> tuple[float, ...]:
    depth = yield_depth(common)
    full = 0.5 * common.R * (_FULL_PLASTICITY * common.S / common.E) ** 2
    slope = 2.0 * math.pi * common.R * HARDNESS * common.S
    return depth, full, slope, common.k_hertz * depth * math.sqrt(depth)


@kernel
def _loading_2012(par, depth):
    if depth <= par[YIELD]:
        return hertz_force(par, depth)
    if depth >= par[_FULL]:
        return par[_SLOPE] * depth
    width = par[_FULL] - par[YIELD]
    t = (depth - par[YIELD]) / width
    steep = 1.5 * par[_FORCE] / par[YIELD] * width
    return cubic(t, par[_FORCE], par[_SLOPE] * par[_FULL], steep, par[_SLOPE] * width)


@kernel
def _radius_2012(par, depth, peak):
    if depth <= par[YIELD]:
        return math.sqrt(par[R] * depth)
    if depth >= par[_FULL]:
        return math.sqrt(2.0 * par[R] * depth)
    width = par[_FULL] - par[YIELD]
    t = (depth - par[YIELD]) / width
    return math.sqrt(par[R] * cubic(t, par[YIELD], 2.0 * par[_FULL], width, 2.0 * width))


@kernel
def _residual_2012(par, peak):
    return crater(_loading_2012, _radius_2012, par, peak)


@kernel
def _unloading_2012(par, depth, peak):
    return recover(_loading_2012, _residual_2012, par, depth, peak)


def _numbers_2015(common: Common, meyer: float, hardness: float | None) -> tuple[float, ...]:
    pressure = effective_hardness(common) if hardness is None else hardness
    x = 3.0 * math.pi * pressure / (2.0 * common.E)
    depth, full = yield_depth(common), float(common.R * x * x)
    if full <= depth < math.inf:
        least = 2.0 * common.E / (3.0 * math.pi) * math.sqrt(depth / common.R)
        raise InputError(
            f"{pressure:g} Pa is below the pressure at first yield",
            key="hardness",
            allowed=f"above {least:.3g} Pa for this pair",
        )
    # p_0 pi a^n / a_p^(n - 2) with a^2 = 2 R delta is p_0 2 pi R delta (delta/delta_p)^(n/2 - 1)
    return depth, full, 2.0 * math.pi * common.R * pressure, meyer - 2.0


@kernel
def _fade(par, depth):
    """Argument (delta - delta_y)/(delta_p - delta_y) of both secants."""
    return (depth - par[YIELD]) / (par[_FULL] - par[YIELD])


@kernel
def _loading_2015(par, depth):
    if depth <= par[YIELD]:
        return hertz_force(par, depth)
    x = _fade(par, depth)
    meyer = par[_MEYER]
    plastic = par[_SLOPE] * depth
    if meyer != 0.0:
        plastic *= (depth / par[_FULL]) ** (0.5 * meyer)
    elastic = hertz_force(par, depth) / math.cosh((1.0 + meyer) * x)
    return elastic + (1.0 - 1.0 / math.cosh((1.0 - meyer) * x)) * plastic


@kernel
def _radius_2015(par, depth, peak):
    if depth <= par[YIELD]:
        return math.sqrt(par[R] * depth)
    return math.sqrt(par[R] * depth * (2.0 - 1.0 / math.cosh(_fade(par, depth))))


@kernel
def _residual_2015(par, peak):
    if peak <= par[YIELD]:
        return 0.0, 0.0
    left = brake(par, _loading_2015(par, peak), peak)
    return to_weaker(par, bounded(_loading_2015, par, par[YIELD], peak, 1.5, left) * peak)


@kernel
def _unloading_2015(par, depth, peak):
    return recover(_loading_2015, _residual_2015, par, depth, peak)


BRAKE_2012 = PublishedLaw(
    name="brake-2012",
    title="Brake 2012",
    source="Int. J. Solids Struct. 49 (2012) 3129",
    equations="thesis 1.3.1 (in words), 4.28",
    standing=Standing.OUR_READING,
    domain=Domain(
        note="normal impact of round bodies; where full plasticity begins is our reading"
    ),
    read="the thesis's words and the abstract; the constants are not those of the paper",
    own=Kernels(_loading_2012, _radius_2012, _unloading_2012, _residual_2012),
    numbers=_numbers_2012,
)


def brake_2015(*, meyer: float = 2.0, hardness: float | None = None) -> PublishedLaw:
    """Return the law of 2015 with a hardness and a Meyer exponent of one's own.

    `meyer`: exponent n of F ~ a^n in full plasticity, 2 without hardening, at most 3; `hardness`:
    p_0 [Pa]; by default from 2.8 S of both bodies by 4.30 (corrected).

    Raises `InputError`: a number outside its range.
    """
    if not 2.0 <= meyer < 3.0:
        raise InputError(f"{meyer:g}", key="meyer", allowed="2 <= n < 3")
    if hardness is not None and not 0.0 < hardness < math.inf:
        raise InputError(f"{hardness:g}", key="hardness", allowed="a number above 0 [Pa]")
    return PublishedLaw(
        name="brake-2015",
        title="Brake 2015",
        source="Int. J. Solids Struct. 62 (2015) 104",
        equations="4.28-4.31",
        standing=Standing.PARTLY,
        domain=Domain(note="normal impact; wants the pair's own hardness and Meyer exponent"),
        read="residual depth and recovery in tmd-lab/microslip-rough-contact, named there after "
        "the paper; the loading 4.29-4.30 in the thesis only",
        own=Kernels(_loading_2015, _radius_2015, _unloading_2015, _residual_2015),
        numbers=functools.partial(_numbers_2015, meyer=meyer, hardness=hardness),
    )


BRAKE_2015 = brake_2015()
