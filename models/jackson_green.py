"""Jackson and Green 2005: elastic-plastic contact of a sphere and a flat.

Loading by Eqs. 1.16-1.22 (4.9-4.11 in the corrected form), residual depth by Eq. 4.12, recovery by
Eqs. 4.13-4.14. The hardness falls with the contact radius (Eq. 1.14).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .base import (
    C,
    ContactLaw,
    Domain,
    E,
    Kernels,
    R,
    S,
    branch_kernel,
    hertz_force,
    hertz_recovery,
    loading_kernel,
    onset,
    residual_kernel,
    to_weaker,
)
from .hardness import jackson_green as hardness

_PLASTIC = 1.9  # w below which the contact is taken as elastic


@branch_kernel
def _radius(par, depth, peak):
    w = depth / onset(par, 0.0)
    if w <= _PLASTIC:
        return math.sqrt(par[R] * depth)
    B = 0.14 * math.exp(23.0 * par[S] / par[E])
    return math.sqrt(par[R] * depth * (w / _PLASTIC) ** B)


@loading_kernel
def _loading(par, depth):
    w = depth / onset(par, 0.0)
    if w <= _PLASTIC:
        return hertz_force(par, depth)
    H = hardness(_radius(par, depth, depth) / par[R])
    critical = hertz_force(par, onset(par, 0.0))
    elastic = math.exp(-0.25 * w ** (5.0 / 12.0)) * w * math.sqrt(w)
    plastic = 4.0 * H / par[C] * (1.0 - math.exp(-0.04 * w ** (5.0 / 9.0))) * w
    return critical * (elastic + plastic)


@residual_kernel
def _residual(par, peak):
    w = peak / onset(par, 0.0)
    if w <= 1.0:
        return 0.0, 0.0
    left = 1.02 * (1.0 - ((w + 5.9) / 6.9) ** -0.54)
    # the fit passes 1 beyond w = 10017; nothing can be left that was not pressed in
    return to_weaker(par, min(left, 0.999) * peak)


@branch_kernel
def _unloading(par, depth, peak):
    s, f = _residual(par, peak)
    return hertz_recovery(_loading(par, peak), depth, peak, s + f)


_KERNELS = Kernels(_loading, _radius, _unloading, _residual)


@dataclass(frozen=True)
class JacksonGreen(ContactLaw):
    """F = F_c [exp(-w^(5/12)/4) w^(3/2) + 4 H/(C S) (1 - exp(-w^(5/9)/25)) w] beyond w = 1.9."""

    @property
    def kernels(self) -> Kernels:
        """The compiled functions."""
        return _KERNELS


JACKSON_GREEN = JacksonGreen(
    name="jackson-green",
    title="Jackson and Green 2005",
    source="J. Tribol. 127 (2005) 343; residual depth: Jackson, Chusoipin, Green, "
    "J. Tribol. 127 (2005) 484",
    equations="1.14, 1.16-1.22, 4.9-4.14",
    verified=False,
    domain=Domain(a_over_R_max=0.41, note="flattening of the sphere, a/R up to 0.41"),
    breaks=(("jump of the force at w = 1.9", 0.5),),
)
