"""Unloading to zero force and loading again."""

from __future__ import annotations

from .... import fem
from ....campaigns.cases.pairs import pair_of
from ..bench import Bench
from ..result import Cell, Measurement, Result, Table

_DEPTHS = (0.0005, 0.005)


def run(bench: Bench) -> Result:
    """Unload three pairs from two depths, lift them apart and load them again."""
    rows: list[tuple[Cell, ...]] = []
    steps, off, left = 0, 0.0, 0.0
    notes = []
    for ratio in (0.1, 1.0, 10.0):
        pair = pair_of(E_s=200.0, E_f=200.0, Sy_min=503.0, ratio=ratio)
        problem = fem.ContactProblem(pair, _DEPTHS, unload_from=_DEPTHS, reload=True)
        solution = fem.solve(problem, accuracy=fem.Accuracy.smoke())
        if not solution.outcome.completed:
            notes.append(f"Sy* = {ratio:g}: {solution.outcome}")
        for u in solution.unloadings:
            peak, again = float(u.curve.force[0]), u.reload
            if not u.outcome.completed or again is None:
                notes.append(f"Sy* = {ratio:g}, Delta/R = {u.depth:g}: {u.outcome}")
                off = float("nan")
                continue
            back = float(again.force[-1]) / peak - 1.0
            remaining = float(u.curve.force[-1]) / peak
            steps, off, left = max(steps, u.steps), max(off, abs(back)), max(left, remaining)
            rows.append(
                (f"{ratio:g}", f"{u.depth:g}", u.steps, f"{100.0 * remaining:.3f}",
                 f"{100.0 * back:+.4f}", f"{u.residual / (u.depth * pair.R):.4f}")
            )  # fmt: skip
    return Result(
        name="unloading",
        title="Unloading and reload",
        about=(
            "E = 200 GPa, weaker body 503 MPa, level `smoke`: unloaded from two depths until the "
            "bodies are apart, and loaded again."
        ),
        measurements=(
            Measurement("steps to zero force, largest", float(steps), "", None, 40.0,
                        "requirement"),
            Measurement("force at the end of the reload against the loading curve, largest "
                        "difference", 100.0 * off, "%", None, 0.5, "requirement"),
            Measurement("force of the last state in contact over the peak", 100.0 * left, "%",
                        None, 0.5, "the bodies are then lifted apart, at zero force exactly"),
        ),
        tables=(
            Table("Unloading", ("Sy*", "from Delta/R", "steps", "last force [%]",
                                "reload against loading [%]", "residual over largest approach"),
                  tuple(rows)),
        ),
        notes=tuple(notes),
    )  # fmt: skip
