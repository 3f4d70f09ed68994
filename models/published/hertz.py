"""Hertz: F = (4/3) E' sqrt(R) delta^(3/2), a = sqrt(R delta); nothing is left (Eqs. 1.2-1.6)."""

from __future__ import annotations

import math

from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import R, hertz_force, kernel


@kernel
def hertz_radius(par, depth, peak):
    """Contact radius, sqrt(R delta)."""
    return math.sqrt(par[R] * depth)


@kernel
def _unloading(par, depth, peak):
    return hertz_force(par, depth)


@kernel
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
    own=Kernels(hertz_force, hertz_radius, _unloading, _residual),
)
