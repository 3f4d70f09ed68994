"""Jackson and Green 2005: elastic-plastic contact of a sphere and a flat.

Loading by Eqs. 1.16-1.22 (4.9-4.11 in the corrected form), with the hardness of their paper (1.14)
or the later one (1.15), which the thesis uses; residual depth by Eq. 4.12, recovery by Eqs.
4.13-4.14. The hardness falls with the contact radius.

All powers of w come from its logarithm, which makes the law cheap.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numba import njit

from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import CRITICAL, N_COMMON, ONSET, C, Common, R, hertz_force, kernel
from .residual import jackson, recover, to_weaker

_PLASTIC = 1.9  # w below which the contact is taken as elastic
_LOG_PLASTIC = math.log(_PLASTIC)

# places of the pair's own numbers
_B, _LOG_ONSET = N_COMMON, N_COMMON + 1


def growth_exponent(strength: float, modulus: float) -> float:
    """B = 0.14 exp(23 S/E') (1.22, 2.22); held where the exponential would overflow."""
    return 0.14 * math.exp(min(23.0 * strength / modulus, 100.0))


def _numbers(common: Common) -> tuple[float, float]:
    with np.errstate(divide="ignore"):
        shallow = float(np.log(common.onset / common.R))
    return growth_exponent(common.S, common.E), shallow


@kernel
def _radius(par, depth, peak):
    w = depth / par[ONSET]
    if w <= _PLASTIC:
        return math.sqrt(par[R] * depth)
    return math.sqrt(par[R] * depth * math.exp(par[_B] * (math.log(w) - _LOG_PLASTIC)))


@njit(cache=True, _nrt=False, error_model="numpy")
def _logarithms(par, w):
    """Logarithms of w and (a/R)^2 beyond w = 1.9 (1.21)."""
    log_w = math.log(w)
    return log_w, log_w + par[_LOG_ONSET] + par[_B] * (log_w - _LOG_PLASTIC)


@njit(cache=True, _nrt=False, error_model="numpy")
def _force(par, w, log_w, H):
    """F of 1.20 (4.10, corrected) with the hardness H in units of the yield strength."""
    elastic = math.exp(-0.25 * math.exp(5.0 / 12.0 * log_w)) * math.sqrt(w)
    plastic = 4.0 * H / par[C] * (1.0 - math.exp(-0.04 * math.exp(5.0 / 9.0 * log_w)))
    return par[CRITICAL] * w * (elastic + plastic)


@kernel
def _loading(par, depth):
    w = depth / par[ONSET]
    if w <= _PLASTIC:
        return hertz_force(par, depth)
    log_w, log_area = _logarithms(par, w)
    return _force(par, w, log_w, 2.84 * (1.0 - math.exp(-0.82 * math.exp(-0.35 * log_area))))


@kernel
def _loading_2007(par, depth):
    w = depth / par[ONSET]
    if w <= _PLASTIC:
        return hertz_force(par, depth)
    log_w, log_area = _logarithms(par, w)
    x = min(math.exp(0.5 * log_area), 1.0)
    return _force(par, w, log_w, 2.84 - 0.92 * (1.0 - math.cos(math.pi * x)))


@kernel
def _residual(par, peak):
    return to_weaker(par, jackson(peak / par[ONSET]) * peak)


@kernel
def _unloading(par, depth, peak):
    return recover(_loading, _residual, par, depth, peak)


@kernel
def _unloading_2007(par, depth, peak):
    return recover(_loading_2007, _residual, par, depth, peak)


_RESIDUAL = (
    "residual depth and recovery of Jackson, Chusoipin and Green in the public code "
    "tmd-lab/microslip-rough-contact; the papers themselves could not be read"
)

JACKSON_GREEN = PublishedLaw(
    name="jackson-green",
    title="Jackson and Green 2005",
    source="J. Tribol. 127 (2005) 343; residual depth: Jackson, Chusoipin, Green, "
    "J. Tribol. 127 (2005) 484",
    equations="1.14, 1.16-1.22, 4.9-4.14",
    standing=Standing.SECOND_HAND,
    domain=Domain(a_over_R_max=0.41, note="flattening of the sphere, a/R up to 0.41"),
    breaks=(
        ("force jumps at w = 1.9 for nu = 0.3", 0.5),
        ("force falls at w = 1.9 for nu = 0.33", 0.17),
    ),
    regime="flattening",
    read="C, F_c, B, the exponents 5/12 and 5/9 and the hardness 1.14 in a public code of rough "
    "contact (function JG), the radius in tmd-lab/tmdsimpy; " + _RESIDUAL,
    own=Kernels(_loading, _radius, _unloading, _residual),
    numbers=_numbers,
)

JACKSON_GREEN_2007 = replace(
    JACKSON_GREEN,
    name="jackson-green-2007",
    title="Jackson and Green with the later hardness",
    source="as jackson-green, with the hardness that the thesis takes for it",
    equations="1.15-1.22, 4.9-4.14",
    domain=Domain(a_over_R_max=1.0, note="flattening of the sphere; hardness down to S at a/R = 1"),
    read="equations 3, 5, 6, 23, 24 and 27-29 of Ghaednia, Brake, Berryhill and Jackson, J. "
    "Tribol. (2019), restated in tmd-lab/microslip-rough-contact; " + _RESIDUAL,
    own=Kernels(_loading_2007, _radius, _unloading_2007, _residual),
)
