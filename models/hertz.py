"""Hertz: the elastic contact of a sphere and a flat (Eqs. 1.2-1.6)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .base import (
    ContactLaw,
    Domain,
    Kernels,
    R,
    branch_kernel,
    hertz_force,
    residual_kernel,
)


@branch_kernel
def _radius(par, depth, peak):
    return math.sqrt(par[R] * depth)


@branch_kernel
def _unloading(par, depth, peak):
    return hertz_force(par, depth)


@residual_kernel
def _residual(par, peak):
    return 0.0, 0.0


_KERNELS = Kernels(hertz_force, _radius, _unloading, _residual)


@dataclass(frozen=True)
class Hertz(ContactLaw):
    """F = (4/3) E' sqrt(R) delta^(3/2), a = sqrt(R delta); nothing is left behind."""

    @property
    def kernels(self) -> Kernels:
        """The compiled functions."""
        return _KERNELS


HERTZ = Hertz(
    name="hertz",
    title="Hertz 1882",
    source="Johnson, Contact Mechanics (1985), chapter 4",
    equations="1.2-1.6",
    verified=True,
    domain=Domain(note="elastic, a/R below about 0.1"),
)
