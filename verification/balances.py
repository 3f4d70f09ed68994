"""Energy, force and unloading of the cases whose convergence is measured."""

from __future__ import annotations

import numpy as np

from .bench import Bench
from .convergence import case_of, ordered_cases, plan_of
from .result import Cell, Measurement, Result, Table

_CASES = 3


def run(bench: Bench) -> Result:
    """Read the balances of the first cases of Table 2.1 at the level of their convergence."""
    plan = plan_of(bench.effort)
    rows: list[tuple[Cell, ...]] = []
    energy, force, steps, left = 0.0, 0.0, 0, 0.0
    complete = True
    for number, ratio in ordered_cases()[:_CASES]:
        s = bench.solve(case_of(number, ratio, plan=plan, accuracy=plan.base))
        depth = s["delta"] / s.pair.R
        deep = depth >= 1e-3
        e = float(np.abs(s["energy_defect"]).max())
        f, floor = (float(np.abs(s["force_defect"][w]).max()) for w in (deep, ~deep))
        energy, force = max(energy, e), max(force, f)
        ends = []
        for u in s.unloadings:
            steps = max(steps, u.steps)
            remaining = float(u.curve["force"][-1] / u.curve["force"][0])
            left = max(left, remaining)
            complete &= u.completed
            ends.append(f"{u.depth:g}: {u.steps}")
        rows.append(
            (f"{number}, {ratio:g}", f"{100.0 * e:.3f}", f"{f:.1e}", f"{floor:.1e}",
             ", ".join(ends), "" if s.completed else s.message)
        )  # fmt: skip
    return Result(
        name="balances",
        title="Energy, force, unloading",
        about=(
            f"The first {_CASES} cases of the section on mesh and step, level "
            f"`{plan.base.level}`, to Delta/R = {plan.deepest:g}: external work against stored "
            "plus dissipated energy, contact force against the reaction at the driven face, steps "
            "of the unloadings."
        ),
        measurements=(
            Measurement("largest energy defect over external work", 100.0 * energy, "%", None, 0.5,
                        "first law"),
            Measurement("contact force against reaction, Delta/R >= 1e-3", force, "", None, 1e-6,
                        "equilibrium"),
            Measurement("steps of an unloading to zero force, largest", float(steps), "", None,
                        40.0, "requirement"),
            Measurement("force left at the last loaded state over the peak", left, "", None, 0.005,
                        "requirement; the force-free state follows from it by lifting"),
        ),
        tables=(
            Table("Balances", ("case, Sy*", "energy defect [%]", "force defect, Delta/R >= 1e-3",
                               "below", "unloading from Delta/R: steps", "ended"), tuple(rows)),
        ),
        notes=() if complete else ("An unloading did not reach its end.",),
    )  # fmt: skip
