"""Finite-strain, logarithmic von Mises material: stress update and tangents.

The stress follows from the elastic logarithmic strain e = 1/2 ln b: tau = 2 G dev e + p J I. The
pressure belongs to the element (mean dilatation); this package holds the deviatoric part. Yield is
|dev sigma| = sqrt(2/3) Sy in the Cauchy stress, so that the radius in dev e is
sqrt(2/3) Sy J / (2 G). The strength is constant, or grows with plastic strain and rate and falls
with heat (`flow`).
"""

from __future__ import annotations

from . import return_map
from .flow import FlowLaws, laws_of, no_laws
from .return_map import EXACT, RADIAL
from .tensor import exponential, log_strain

__all__ = [
    "EXACT",
    "RADIAL",
    "FlowLaws",
    "exponential",
    "laws_of",
    "log_strain",
    "no_laws",
    "return_map",
]
