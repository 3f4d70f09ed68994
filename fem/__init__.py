"""Stage fem: mesh and finite-strain contact solve of a sphere and a flat."""

from __future__ import annotations

from .problem import (
    NUMERICS_VERSION,
    Accuracy,
    ContactProblem,
    critical_depth,
    geometric_depths,
)
from .solution import Counters, Curve, Profile, Snapshot, Solution, Unloading
from .solve import solve
from .uncertainty import Uncertainty, coarser, discretisation_uncertainty

__all__ = [
    "NUMERICS_VERSION",
    "Accuracy",
    "ContactProblem",
    "Counters",
    "Curve",
    "Profile",
    "Snapshot",
    "Solution",
    "Uncertainty",
    "Unloading",
    "coarser",
    "critical_depth",
    "discretisation_uncertainty",
    "geometric_depths",
    "solve",
]
