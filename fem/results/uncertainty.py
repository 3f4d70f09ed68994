"""Discretisation uncertainty of a loading curve, from a table that was measured once.

`dentscope verify --only levels` solves fifteen pairs at every level of accuracy, and at the finest
with larger elements and longer steps besides. How far each level was off, against the depth over
that of first yield, lies in the table; a solve states it and needs no second one. The table is of
metals without hardening; the same check says how far two that harden are off it.
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

MESH_ERRORS_FORMAT = "dentscope-mesh-errors/1"


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


def largest_force_error(level: str, pair: Pair, depth: float) -> float:
    """Largest relative uncertainty of the force up to Delta/R = depth at a level of accuracy."""
    content = _mesh_errors()
    knots = np.array(content["depth_over_first_yield"])
    last = max(depth / pair.first_yield, knots[0])
    row = np.array(content["levels"][level]["force"])
    reached = np.append(row[knots <= last], np.interp(math.log(last), np.log(knots), row))
    return float(reached.max())


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
    at = {name: np.interp(x, knots, row) for name, row in content["levels"][accuracy.level].items()}
    # the last node that touches lies anywhere in the last ring
    ring = accuracy.fine / math.sqrt(3.0)
    return CurveUncertainty(
        force=at["force"] * curve.force,
        radius=at["radius"] * curve.radius,
        radius_last_node=np.hypot(at["radius"], ring) * curve.radius_last_node,
        sphere_share=at["sphere_share"],
        hardness=at["hardness"] * curve.hardness,
    )
