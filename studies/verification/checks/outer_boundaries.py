"""Boundaries far from the contact: where the half-space ends, how the hemisphere's top is held."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .... import fem
from ....campaigns.cases.pairs import pair_of
from ....core.arrays import Array
from ....core.material import Pair
from ..bench import Bench
from ..pairs import R, elastic_pair
from ..result import Cell, Measurement, Result, Table

_RADII = (3.0, 10.0, 30.0, 100.0, 200.0, 1000.0)
_DEPTHS = (1e-4, 1e-3, 1e-2)
_AT = (0.001, 0.003, 0.01)


def truncation(bench: Bench) -> Result:
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
        name="truncation",
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


def top_face(bench: Bench) -> Result:
    """Solve an elastic and a flattening case with the top face free and held radially."""
    flattening = pair_of(E_s=200.0, E_f=200.0, Sy_min=503.0, ratio=0.1)
    rows: list[tuple[Cell, ...]] = []
    worst = {}
    for name, pair in (("elastic", elastic_pair()), ("Sy* = 0.1", flattening)):
        free, held = _both(pair)
        for x in _AT:
            F, a, s = (
                float(np.interp(x, free["delta"], held[key] - free[key]))
                for key in ("F", "a", "share")
            )
            worst[name, x] = F
            rows.append((name, f"{x:g}", f"{F:+.3f}", f"{a:+.3f}", f"{s:+.5f}"))
    return Result(
        name="top-face",
        title="The top face held radially",
        about=(
            "`fem.solve` moves the hemisphere's top face down and leaves it free radially. Here "
            "it is also held radially, level `smoke`; held minus free."
        ),
        measurements=tuple(
            Measurement(f"{name}: change of F at Delta/R = {_AT[-1]:g}", worst[name, _AT[-1]], "%")
            for name in ("elastic", "Sy* = 0.1")
        ),
        tables=(
            Table("Held minus free", ("bodies", "Delta/R", "F [%]", "a [%]", "delta_s*"),
                  tuple(rows)),
        ),
        notes=(
            "The change is that of the hemisphere's own compliance, of the order of a/R while the "
            "bodies are elastic; a real ball, loaded at its other pole, lies outside of both.",
        ),
    )  # fmt: skip


def _both(pair: Pair) -> tuple[dict[str, Array], dict[str, Array]]:
    depths = fem.geometric_depths(min(_AT) / 2.0, max(_AT), 24)
    free = fem.ContactProblem(pair, depths)
    return _curves(free), _curves(replace(free, top="held"))


def _curves(problem: fem.ContactProblem) -> dict[str, Array]:
    c = fem.solve(problem, accuracy=fem.Accuracy.smoke()).loading
    return {
        "delta": c.delta / problem.pair.R,
        "F": 100.0 * np.log(c.force),
        "a": 100.0 * np.log(c.radius),
        "share": c.sphere_share,
    }
