"""Where the half-space ends."""

from __future__ import annotations

import numpy as np

from .... import fem
from ..bench import Bench
from ..pairs import R, elastic_pair
from ..result import Measurement, Result, Table

_RADII = (3.0, 10.0, 30.0, 100.0, 200.0, 1000.0)
_DEPTHS = (1e-4, 1e-3, 1e-2)


def run(bench: Bench) -> Result:
    """Solve one elastic pair with far boundaries from 3 R to 1000 R."""
    force, a, unknowns = [], np.empty(0), []
    for radius in _RADII:
        accuracy = fem.Accuracy.smoke().with_(flat_radius=radius)
        solution = fem.solve(fem.ContactProblem(elastic_pair(), _DEPTHS), accuracy=accuracy)
        force.append(solution.loading.force)
        unknowns.append(solution.counters.dofs)
        a = solution.loading.radius / R
    error = 100.0 * (np.array(force) / force[-1] - 1.0)
    used = _RADII.index(fem.Accuracy.production().flat_radius)
    scale = error[1, :] / 100.0 / (a / _RADII[1])
    return Result(
        title="Truncation of the half-space",
        about=(
            "Elastic pair, far boundary at 3 R to 1000 R; F against that of the largest mesh. "
            "Every level of accuracy uses 200 R."
        ),
        measurements=(
            Measurement("error of F with 200 R, a/R = 0.1", float(error[used, -1]), "%", None, 0.05,
                        "own mesh of 1000 R"),
            Measurement("error of F over a/L, L = 10 R, a/R = 0.1", float(scale[-1])),
        ),
        tables=(
            Table(
                "Error of F [%]",
                ("L/R", *(f"a/R = {x:.3f}" for x in a), "unknowns"),
                tuple(
                    (f"{L:g}", *(f"{x:.4f}" for x in row), n)
                    for L, row, n in zip(_RADII, error, unknowns, strict=True)
                ),
            ),
        ),
    )  # fmt: skip
