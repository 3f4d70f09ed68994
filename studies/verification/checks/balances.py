"""Energy and force balance of every solve that the other checks have kept."""

from __future__ import annotations

import math

import numpy as np

from ....fem import Accuracy
from ..bench import Bench, Solved
from ..result import Cell, Measurement, Result, Table


def run(bench: Bench) -> Result:
    """Read the balances of the kept solves; run it after the checks whose solves it should see."""
    rows: list[tuple[Cell, ...]] = []
    worst, published = np.zeros(3), math.nan
    for case, solved in bench.kept_solves():
        found = _defects(solved)
        worst = np.fmax(worst, found)
        if case.accuracy == Accuracy.production():
            published = np.fmax(published, found[0])
        rows.append(
            (case.name, case.accuracy.level, f"{solved['delta'][-1] / solved.pair.R:.3g}",
             f"{100.0 * found[0]:.3f}", *(f"{x:.1e}" if x > 0.0 else "" for x in found[1:]),
             solved.message)
        )  # fmt: skip
    if not rows:
        worst = np.full(3, math.nan)
    return Result(
        title="Energy and force",
        about=(
            "Every loading path of the checks: external work against stored plus dissipated "
            "energy, contact force against the reaction at the driven face."
        ),
        measurements=(
            Measurement("largest energy defect over external work", 100.0 * float(worst[0]), "%",
                        None, 0.5, "first law"),
            Measurement("the same at the settings of published results", 100.0 * float(published),
                        "%", None, 0.5, "first law"),
            Measurement("contact force against reaction, Delta/R >= 1e-3", float(worst[1]), "",
                        None, 1e-6, "equilibrium"),
            Measurement("the same below 1e-3: floor reached", float(worst[2])),
        ),
        tables=(
            Table("Largest defects", ("solve", "level", "to Delta/R", "energy [%]",
                                      "force, Delta/R >= 1e-3", "force, below", "ended"),
                  tuple(sorted(rows, key=str))),
        ),
    )  # fmt: skip


def _defects(solved: Solved) -> np.ndarray:
    """Largest defect of the energy, and of the force from Delta/R = 1e-3 on and below."""
    deep = solved["delta"] / solved.pair.R >= 1e-3
    force = np.abs(solved["force_defect"])
    return np.array(
        [np.abs(solved["energy_defect"]).max(), *(force[w].max(initial=0.0) for w in (deep, ~deep))]
    )
