"""Finite-strain, logarithmic, perfectly plastic von Mises material: stress update and tangents.

The stress follows from the elastic logarithmic strain e = 1/2 ln b: tau = 2 G dev e + p J I. The
pressure belongs to the element (mean dilatation); this package holds the deviatoric part. Yield is
|dev sigma| = sqrt(2/3) Sy in the Cauchy stress, so that the radius in dev e is
sqrt(2/3) Sy J / (2 G).
"""

from __future__ import annotations

from .tangent import deviatoric_tangent
from .tensor import exponential, log_strain
from .update import EXACT, RADIAL, Step, deviatoric_pk1, elastic_deviator

__all__ = [
    "EXACT",
    "RADIAL",
    "Step",
    "deviatoric_pk1",
    "deviatoric_tangent",
    "elastic_deviator",
    "exponential",
    "log_strain",
]
