"""Stage fem: mesh and finite-strain contact of a sphere and a flat, loaded and unloaded."""

from __future__ import annotations

from .problem import NUMERICS_VERSION, Accuracy, ContactProblem, geometric_depths
from .results.uncertainty import (
    MESH_ERRORS_FILE,
    MESH_ERRORS_FORMAT,
    CurveUncertainty,
    discretisation_uncertainty,
    strengths_of,
)
from .solution import Counters, Curve, Profile, Snapshot, Solution, Unloading
from .solve import solve

__all__ = [
    "MESH_ERRORS_FILE",
    "MESH_ERRORS_FORMAT",
    "NUMERICS_VERSION",
    "Accuracy",
    "ContactProblem",
    "Counters",
    "Curve",
    "CurveUncertainty",
    "Profile",
    "Snapshot",
    "Solution",
    "Unloading",
    "discretisation_uncertainty",
    "geometric_depths",
    "solve",
    "strengths_of",
]
