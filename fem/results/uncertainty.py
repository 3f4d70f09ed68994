"""Discretisation uncertainty of a loading curve, from a table that was measured once.

`dentscope verify --only levels` solves nineteen pairs at every level of accuracy, and with elements
and steps half as large as those of the finest. How far each level was off, against the depth over
that of first yield, lies in the table, for bodies nearly as strong as each other and for the
others; a solve states it and needs no second one. The table is of metals without hardening; the
same check says how far two that harden are off it.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.material import Pair
from ..problem import Accuracy, ContactProblem
from ..solution import Curve

MESH_ERRORS_FILE = (
    Path(__file__).resolve().parents[2] / "data" / "coefficients" / "mesh_errors.json"
)
"""Where the table lies."""

MESH_ERRORS_FORMAT = "dentscope-mesh-errors/2"

# limit: Sy* between which both bodies yield at once [-]
_NEAR_EQUAL = (0.7, 1.5)


@dataclass(frozen=True)
class CurveUncertainty:
    """Standard uncertainty of a loading curve's columns, each of shape (n,).

    `force`: [N]; `radius`, `radius_last_node`: [m]; `sphere_share`: [-]; `hardness`: [Pa].
    """

    force: Array
    radius: Array
    radius_last_node: Array
    sphere_share: Array
    hardness: Array


@cache
def _mesh_errors() -> dict[str, Any]:
    return dict(json.loads(MESH_ERRORS_FILE.read_text(encoding="utf-8")))


def strengths_of(pair: Pair) -> str:
    """Return the row of the table that a pair's strengths ask for: `near-equal` or `unlike`."""
    low, high = _NEAR_EQUAL
    return "near-equal" if low <= pair.Sy_ratio <= high else "unlike"


def discretisation_uncertainty(
    curve: Curve, problem: ContactProblem, accuracy: Accuracy
) -> CurveUncertainty:
    """Uncertainty that mesh and step bring to a loading curve at one of the three levels.

    ValueError for settings that were never measured.
    """
    content = _mesh_errors()
    if accuracy.level not in content["levels"]:
        raise ValueError(f"{accuracy.level!r}: measured are {', '.join(content['levels'])}")
    onset = problem.pair.first_yield * problem.pair.R
    # a pair that never yields is below first yield at any depth
    x = np.log(curve.delta / onset) if math.isfinite(onset) else np.full(len(curve.delta), -np.inf)
    knots = np.log(content["depth_over_first_yield"])
    rows = content["levels"][accuracy.level][strengths_of(problem.pair)]
    at = {name: np.interp(x, knots, row) for name, row in rows.items()}
    # the last node that touches lies anywhere in the last ring
    ring = accuracy.fine / math.sqrt(3.0)
    return CurveUncertainty(
        force=at["force"] * curve.force,
        radius=at["radius"] * curve.radius,
        radius_last_node=np.hypot(at["radius"], ring) * curve.radius_last_node,
        sphere_share=at["sphere_share"],
        hardness=at["hardness"] * curve.hardness,
    )
