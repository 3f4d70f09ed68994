"""The contact stiffness does not matter."""

from __future__ import annotations

import numpy as np

from .. import fem
from ..campaigns.case import Case
from ..campaigns.designs import pair_of
from .bench import Bench
from .curves import inner, smoothed
from .result import Cell, Measurement, Result, Table

_STIFFNESSES = (5.0, 10.0, 20.0, 40.0, 80.0)
_DEEPEST = 0.005


def run(bench: Bench) -> Result:
    """Solve the equal-strength case with five contact stiffnesses on one mesh."""
    pair = pair_of(E_s=200.0, E_f=200.0, Sy_min=503.0, ratio=1.0)
    depths = fem.geometric_depths(0.3 * fem.critical_depth(pair), _DEEPEST, 50)
    curves = []
    for stiffness in _STIFFNESSES:
        accuracy = fem.Accuracy.smoke().with_(
            level=f"smoke, penalty {stiffness:g}", penalty=stiffness
        )
        s = bench.solve(Case("penalty", pair, depths, (), 0.0, accuracy))
        kept = inner(s["delta"])
        curves.append(
            [smoothed(s["delta"], y)[kept] for y in (np.log(s["force"]), np.log(s["radius"]),
                                                     s.share)]
        )  # fmt: skip
    stiffest = curves[-1]
    rows: list[tuple[Cell, ...]] = []
    used = {}
    for stiffness, curve in zip(_STIFFNESSES, curves, strict=True):
        off = [float(np.abs(x - y).max()) for x, y in zip(curve, stiffest, strict=True)]
        used[stiffness] = off
        rows.append((f"{stiffness:g}", f"{100 * off[0]:.3f}", f"{100 * off[1]:.3f}",
                     f"{off[2]:.5f}"))  # fmt: skip
    F, a, share = used[fem.Accuracy.production().penalty]
    source = "stiffest contact, 80 E'/h"
    return Result(
        name="penalty",
        title="Contact stiffness",
        about=(
            "Strengths 503 MPa, E = 200 GPa, mesh and steps of the `smoke` level, to Delta/R = "
            f"{_DEEPEST:g}; contact stiffness in E' over the edge length, production uses "
            f"{fem.Accuracy.production().penalty:g}. Largest differences from the stiffest, ripple "
            "smoothed out."
        ),
        measurements=(
            Measurement("F, production's stiffness", 100.0 * F, "%", None, 0.25, source),
            Measurement("a, production's stiffness", 100.0 * a, "%", None, 0.5, source),
            Measurement("delta_s*, production's stiffness", share, "", None, 0.0025, source),
        ),
        tables=(
            Table("Largest difference", ("stiffness", "F [%]", "a [%]", "delta_s*"), tuple(rows)),
        ),
        notes=(
            "At production settings the elements are four times smaller, and so is the "
            "penetration at equal stiffness over edge length.",
        ),
    )  # fmt: skip
