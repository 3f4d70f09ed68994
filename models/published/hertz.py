"""Hertz: F = (4/3) E' sqrt(R) delta^(3/2), a = sqrt(R delta); nothing is left (Eqs. 1.2-1.6)."""

from __future__ import annotations

import math

from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import R, branch_kernel, hertz_force, residual_kernel


@branch_kernel
def _radius(par, depth, peak):
    return math.sqrt(par[R] * depth)


@branch_kernel
def _unloading(par, depth, peak):
    return hertz_force(par, depth)


@residual_kernel
def _residual(par, peak):
    return 0.0, 0.0


HERTZ = PublishedLaw(
    name="hertz",
    title="Hertz 1882",
    source="Johnson, Contact Mechanics (1985), chapter 4",
    equations="1.2-1.6",
    standing=Standing.OWN_SOURCE,
    domain=Domain(note="elastic, a/R below about 0.1"),
    read="the exact solution: a^2 = R delta and u_z(0) = delta, checked symbolically",
    own=Kernels(hertz_force, _radius, _unloading, _residual),
)
