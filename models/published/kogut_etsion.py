"""Kogut and Etsion 2002: flattening of a sphere (4.15-4.17), and unloading (4.18-4.19).

Borders at w = 1, 6 and 110. Beyond 110 the fit is not continued (its pressure would grow without
end): F = 2.8 S A with A = A_c min(0.94 w^1.146, 2 w). The areas are 0.93 w^1.136 and 0.94 w^1.146
times A_c = pi R delta_c; the thesis does not print them. `kogut-etsion-continued` goes on with the
same powers, as the thesis must have done: it uses the model to w = 14676, says that most impacts
exceed 110, and finds a larger force than its finite elements, which only the powers give.
"""

from __future__ import annotations

import functools
import math
from dataclasses import replace

from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import Common, R, hertz_force, kernel
from .ceb import yield_depth
from .residual import YIELD, bounded, etsion, to_weaker

_FIRST, _SECOND, _LAST = 1.0, 6.0, 110.0
_FORCE, _FULL, _BORDER = range(YIELD + 1, YIELD + 4)


def _numbers(common: Common, last: float) -> tuple[float, ...]:
    depth = yield_depth(common)
    full = 2.8 * common.S * math.pi * common.R * depth
    return depth, common.k_hertz * depth * math.sqrt(depth), full, last


@kernel
def _area(par, w):
    """A/A_c."""
    if w <= _FIRST:
        return w
    log_w = math.log(w)
    if w <= _SECOND:
        return 0.93 * math.exp(1.136 * log_w)
    area = 0.94 * math.exp(1.146 * log_w)
    return area if w <= par[_BORDER] else min(area, 2.0 * w)


@kernel
def _loading(par, depth):
    w = depth / par[YIELD]
    if w <= _FIRST:
        return hertz_force(par, depth)
    if w <= _SECOND:
        return par[_FORCE] * 1.03 * math.exp(1.425 * math.log(w))
    if w <= par[_BORDER]:
        return par[_FORCE] * 1.40 * math.exp(1.263 * math.log(w))
    return par[_FULL] * _area(par, w)


@kernel
def _radius(par, depth, peak):
    w = depth / par[YIELD]
    if w <= _FIRST:
        return math.sqrt(par[R] * depth)
    return math.sqrt(par[R] * par[YIELD] * _area(par, w))


@kernel
def _exponent(par, peak):
    """Exponent of the recovery, 1.5 w_m^-0.0331 (4.19, corrected)."""
    w = peak / par[YIELD]
    return 1.5 * math.exp(-0.0331 * math.log(w)) if w > _FIRST else 1.5


@kernel
def _residual(par, peak):
    if peak <= par[YIELD]:
        return 0.0, 0.0
    left = etsion(peak / par[YIELD])
    n = _exponent(par, peak)
    return to_weaker(par, bounded(_loading, par, par[YIELD], peak, n, left) * peak)


@kernel
def _unloading(par, depth, peak):
    s, f = _residual(par, peak)
    x = (depth - s - f) / (peak - s - f)
    return _loading(par, peak) * x ** _exponent(par, peak) if x > 0.0 else 0.0


KOGUT_ETSION = PublishedLaw(
    name="kogut-etsion",
    title="Kogut and Etsion 2002; unloading of Etsion, Kligerman and Kadin 2005",
    source="J. Appl. Mech. 69 (2002) 657; Int. J. Solids Struct. 42 (2005) 3716",
    equations="4.15-4.19",
    standing=Standing.PARTLY,
    domain=Domain(note="flattening of the sphere, w up to 110; beyond, 2.8 S on its area"),
    breaks=(
        ("force jumps at w = 1", 3.0),
        ("force jumps at w = 6", 1.7),
        ("force falls at w = 110 for nu = 0.33, and jumps by 0.7 for 0.3", 1.45),
        ("residual jumps at w = 1", 3.0),
        ("radius falls at w = 1", 3.6),
        ("radius jumps at w = 6", 1.5),
    ),
    regime="flattening",
    read="force and area in the public code TaoYang1999/SCHC-framework, the force and K once more "
    "in a code of rough contact (function KE), both with 2 pi R delta H at once beyond w = 110, a "
    "step of +7.9 %; abstract of the 2002 paper; the unloading of 2005 in the thesis only",
    own=Kernels(_loading, _radius, _unloading, _residual),
    numbers=functools.partial(_numbers, last=_LAST),
)

KOGUT_ETSION_CONTINUED = replace(
    KOGUT_ETSION,
    name="kogut-etsion-continued",
    title="Kogut and Etsion 2002, continued beyond w = 110 as the thesis has it",
    domain=Domain(note="flattening of the sphere; its pressure passes 3 S beyond w of about 210"),
    breaks=tuple(b for b in KOGUT_ETSION.breaks if "w = 110" not in b[0]),
    read="as kogut-etsion; that the thesis goes on with the powers is our inference",
    numbers=functools.partial(_numbers, last=math.inf),
)
