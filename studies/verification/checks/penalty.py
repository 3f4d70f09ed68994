"""What must not matter: the contact's stiffness."""

from __future__ import annotations

import numpy as np

from .... import fem
from ....campaigns.case import Case
from ....campaigns.cases.pairs import pair_of
from ..bench import Bench
from ..curves import inner, smoothed
from ..result import Cell, Measurement, Result, Table

_FACTORS = (0.125, 0.25, 0.5, 1.0, 2.0)
_DEEPEST = 0.005


def run(bench: Bench) -> Result:
    """Solve the equal-strength case with five contact stiffnesses on one mesh."""
    pair = pair_of(E_s=200.0, E_f=200.0, Sy_min=503.0, ratio=1.0)
    depths = fem.geometric_depths(0.3 * pair.first_yield, _DEEPEST, 50)
    mesh, production = fem.Accuracy.smoke(), fem.Accuracy.production()
    # the same compliance of the contact as production's, whose elements are smaller
    same = production.penalty * mesh.fine / production.fine
    stiffnesses = [same * factor for factor in _FACTORS]
    curves = []
    for stiffness in stiffnesses:
        accuracy = mesh.with_(level=f"smoke, penalty {stiffness:g}", penalty=stiffness)
        s = bench.solve(Case("penalty", fem.ContactProblem(pair, depths), accuracy))
        kept = inner(s["delta"])
        curves.append(
            [smoothed(s["delta"], y)[kept] for y in (np.log(s["force"]), np.log(s["radius"]),
                                                     s.share)]
        )  # fmt: skip
    # the penetration, and with it the error, falls with 1/stiffness
    rigid = [2.0 * y - x for x, y in zip(curves[-2], curves[-1], strict=True)]
    rows: list[tuple[Cell, ...]] = []
    off: dict[float, list[float]] = {}
    for stiffness, curve in zip(stiffnesses, curves, strict=True):
        off[stiffness] = [float(np.abs(x - y).max()) for x, y in zip(curve, rigid, strict=True)]
        F, a, share = off[stiffness]
        rows.append((f"{stiffness:g}", f"{100.0 * F:.3f}", f"{100.0 * a:.3f}", f"{share:.5f}"))
    F, a, share = off[same]
    source = "limit of rigid contact"
    return Result(
        title="Contact stiffness",
        about=(
            f"Strengths 503 MPa, E = 200 GPa, level `smoke`, to Delta/R = {_DEEPEST:g}. "
            f"Production uses {production.penalty:g} E' over the edge length of its elements, "
            f"which is {same:g} on these; largest differences from the limit extrapolated from "
            "the two stiffest, ripple smoothed out."
        ),
        measurements=(
            Measurement("F, production's stiffness", 100.0 * F, "%", None, 0.25, source),
            Measurement("a, production's stiffness", 100.0 * a, "%", None, 0.5, source),
            Measurement("delta_s*, production's stiffness", share, "", None, 0.0025, source),
        ),
        tables=(
            Table("Largest difference",
                  ("stiffness [E'/h]", "F [%]", "a [%]", "delta_s*"), tuple(rows)),
        ),
    )  # fmt: skip
