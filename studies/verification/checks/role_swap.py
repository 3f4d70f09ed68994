"""Exchange of the two bodies where the problem is symmetric: small contacts."""

from __future__ import annotations

import numpy as np

from .... import fem
from ....campaigns.case import Case
from ....campaigns.cases.pairs import pair_of
from ....core.material import Material, Pair
from ..bench import Bench, Effort, Solved
from ..curves import inner, smoothed
from ..pairs import R
from ..result import Cell, Measurement, Result, Table


def run(bench: Bench) -> Result:
    """Swap unlike elastic bodies, and strengths, in contacts of a/R below 0.01 and 0.02."""
    soft, stiff = Material(E=71.7e9, nu=0.33), Material(E=200e9, nu=0.3)
    depths = fem.geometric_depths(2e-6, 5e-5, 8)
    smoke = fem.Accuracy.smoke()
    level = smoke if bench.effort is Effort.QUICK else fem.Accuracy.quick()
    elastic = [
        bench.solve(Case("swap-elastic", fem.ContactProblem(Pair(s, f, R), depths), level))
        for s, f in ((soft, stiff), (stiff, soft))
    ]
    # E'/Sy = 1100: first yield at Delta/R = 5e-6
    last = 60.0 * pair_of(E_s=200.0, E_f=200.0, Sy_min=100.0, ratio=1.0).first_yield
    plastic = []
    for ratio in (0.1, 10.0):
        pair = pair_of(E_s=200.0, E_f=200.0, Sy_min=100.0, ratio=ratio)
        path = fem.geometric_depths(0.3 * pair.first_yield, last, 50)
        plastic.append(
            bench.solve(Case(f"swap-Sy*-{ratio:g}", fem.ContactProblem(pair, path), level))
        )
    measurements = []
    rows: list[tuple[Cell, ...]] = []
    for name, marks, pairs in (
        ("elastic", (0.5, 0.5, 0.002), elastic),
        ("plastic", (1.0, 1.0, 0.005), plastic),
    ):
        off = _differences(*pairs)
        for what, unit, mark, value in zip(
            ("F", "a", "delta_s* and its complement"), ("%", "%", ""), marks,
            (np.abs(off[0]).max(), np.abs(off[1]).max(), np.abs(off[2]).max()), strict=True,
        ):  # fmt: skip
            measurements.append(
                Measurement(f"{name}: {what}, largest difference", float(value), unit, None, mark,
                            "symmetry of the half-spaces")
            )  # fmt: skip
        depth = pairs[0]["delta"] / R
        if len(off[0]) < len(depth):
            depth = depth[inner(depth)]
        for k in range(0, len(depth), max(1, len(depth) // 5)):
            rows.append(
                (name, f"{depth[k]:.2e}", f"{off[0][k]:+.3f}", f"{off[1][k]:+.3f}",
                 f"{off[2][k]:+.5f}")
            )  # fmt: skip
    return Result(
        title="Exchange of the bodies",
        about=(
            "At small a/R the bodies may change places: F and a stay, delta_s* turns into 1 - "
            "delta_s*. Elastic: 71.7 and 200 GPa. Plastic: strengths 100 and 1000 MPa, E = 200 "
            f"GPa, to 60 times the depth of first yield (Delta/R = {last:.1e}), level "
            f"`{level.level}`, ripple smoothed out."
        ),
        measurements=tuple(measurements),
        tables=(
            Table("Sphere the weaker (softer) body over flat the weaker one",
                  ("bodies", "Delta/R", "F [%]", "a [%]", "delta_s* + its mirror - 1"),
                  tuple(rows)),
        ),
        notes=(
            "The bodies are not the same in the discretisation: the sphere's surface carries the "
            "pressures and ends in a hemisphere, the flat's is smoothed and goes on to 200 R.",
        ),
    )  # fmt: skip


def _differences(one: Solved, other: Solved) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    delta = one["delta"]
    plain = len(delta) < 20  # too few points for a local fit, and no ripple to remove
    curves = []
    for solved in (one, other):
        parts = [np.log(solved["force"]), np.log(solved["radius"]), solved.share]
        curves.append(parts if plain else [smoothed(delta, p) for p in parts])
    (f1, a1, s1), (f2, a2, s2) = curves
    kept = slice(None) if plain else inner(delta)
    return 100.0 * (f1 - f2)[kept], 100.0 * (a1 - a2)[kept], (s1 + s2 - 1.0)[kept]
