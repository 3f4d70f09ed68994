"""`dentscope diagnose --solve`: a named flow of the metal taken back to the finite elements.

What the diagnosis infers of work hardening and of strain rate is a relative strength over depth, by
the strains under the contact and the rate 0.4 v/a. Here the constants become a flow law of the
metal (Ludwik's S_y (1 + K p^n); Cowper and Symonds' 1 + (r/D)^(1/q)), the pair is pressed and
unloaded by finite elements, and the impacts of the set are made again with that table. The
constants come from the slower conditions; the fastest ones judge.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .. import fem
from ..core.arrays import Array, Mask
from ..core.errors import InputError
from ..core.output import csv_text, write_file
from ..discrepancy import Verdict
from ..discrepancy.comparison.forward import Point, Simulator
from ..discrepancy.comparison.problem import Problem
from ..discrepancy.inference.fit import fit, sharpened
from ..discrepancy.rules import RULES as DIAGNOSIS
from ..dynamics.mechanisms.base import Constants
from ..fitting.case_table import pair_table
from ..models.table import PairTable, table_law
from ..models.table_file import write_table
from .metal_press import MetalPress, presses
from .pair import solved
from .rules import RULES

WHICH = ("baseline", "closed_form", "finite_elements")
"""Simulations that are set beside the recordings."""
CARRIED = ("work-hardening", "strain-rate-hardening")
"""Mechanisms that the finite elements can carry."""


class Compared(NamedTuple):
    """One recorded number beside what the simulations say, as they are compared."""

    observable: str
    striker: str
    speed_m_s: float
    kept_out: bool
    recorded: float
    std: float
    baseline: float
    closed_form: float
    finite_elements: float


@dataclass(frozen=True, eq=False)
class Closed:
    """What finite elements with the inferred constants say of the recordings."""

    constants: Constants  # by mechanism, from the conditions that were kept in
    rows: tuple[Compared, ...]  # every number of the conditions that were solved
    tables: tuple[PairTable, ...]  # the solved pairs, contact laws where no rate acts

    def miss(self, which: str, *, kept_out: bool) -> float:
        """Rms distance of a simulation from the recordings, in their standard errors."""
        found = [
            (getattr(r, which) - r.recorded) / r.std for r in self.rows if r.kept_out == kept_out
        ]
        return float(np.sqrt(np.mean(np.square(found)))) if found else math.nan


def close(
    verdict: Verdict,
    *,
    accuracy: fem.Accuracy | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Closed:
    """Solve the metal that a verdict names, and compare it with the recordings.

    `accuracy`: of the finite elements; quick by default.

    Raises `InputError`: the verdict names nothing that the finite elements carry.
    """
    best, problem = verdict.best, verdict.ranking.problem
    carried = [m for m in best.mechanisms if m.name in CARRIED]
    if not carried or not verdict.choice.members:
        raise InputError(
            f"names {' and '.join(best.names) if verdict.choice.members else 'nothing'}",
            source=verdict.name, key="--solve", allowed=" or ".join(CARRIED),
        )  # fmt: skip
    out = _kept_out(problem)
    simulator = Simulator(problem)
    slower = simulator.of(replace(problem, cells=problem.cells.take(~out)))
    base = fit(slower, (), start=verdict.ranking.base)
    refit = sharpened(slower, fit(slower, best.mechanisms, start=best, place=best.place))
    constants, z = refit.grid.values(refit.place), refit.z
    named = simulator.predict(best.mechanisms, [Point(z, constants)])[0]
    plain = simulator.predict((), [Point(base.z)])[0]
    peaks = simulator.observe(best.mechanisms, [Point(z, constants)])["peak_depth_m"][0]
    # without what a closed form may be off, and with all strikers as stated
    kept = [not n.name.startswith("strikers.") for n in problem.nuisances]
    bodies = np.where([*kept, *[False] * problem.error.count], z, 0.0)
    rest = tuple(m for m in best.mechanisms if m not in carried)
    values = {m.name: constants[m.name] for m in rest}
    found, tables = np.full(len(problem.cells), np.nan), []
    for k, press in enumerate(presses(problem, bodies, carried, constants, peaks), start=1):
        progress(f"finite elements, press {k}")
        one = solved(press.problem, accuracy or fem.Accuracy.quick())
        if not one.solution.outcome.completed:
            raise InputError(str(one.solution.outcome), source=verdict.name, key="--solve",
                             allowed="a pair that can be solved")  # fmt: skip
        table = pair_table(one.solution, one.uncertainty)
        tables.append(table)
        here = np.isin(problem.cells.condition, press.conditions)
        alone = Simulator(_alone(problem, here, press, table))
        found[here] = alone.predict(rest, [Point(bodies, values)])[0]
    return Closed(constants, tuple(_rows(problem, out, plain, named, found)), tuple(tables))


def closed_lines(closed: Closed) -> Iterator[str]:
    """Yield what a comparison shows, for people: each observable, then who predicts better."""
    yield ""
    yield "By finite elements with the inferred constants"
    for name, values in closed.constants.items():
        yield f"  {name}: " + ", ".join(f"{k} = {v:.3g}" for k, v in values.items())
    for out, words in ((False, "conditions that the constants come from"), (True, "kept out")):
        told = ", ".join(
            f"{which.replace('_', ' ')} {closed.miss(which, kept_out=out):.2g}" for which in WHICH
        )
        if any(r.kept_out == out for r in closed.rows):
            yield f"  miss in standard errors, {words}: {told}"


def write_closed(closed: Closed, out: Path) -> tuple[Path, ...]:
    """Write every number as finite_elements.csv, and a table without rate as law.json."""
    path = out / "finite_elements.csv"
    write_file(path, csv_text(closed.rows, header=Compared._fields))
    if len(closed.tables) != 1 or "strain-rate-hardening" in closed.constants:
        return (path,)
    return path, write_table(closed.tables[0], out / "law.json")


def _kept_out(problem: Problem) -> Mask:
    """Cells of the fastest conditions; none where too little would be left."""
    speed = np.array([c.speed for c in problem.conditions])
    out = (speed > RULES.kept_out * speed.max())[problem.cells.condition]
    return out if np.sum(~out) >= DIAGNOSIS.fewest_readings else np.zeros_like(out)


def _alone(problem: Problem, here: Mask, press: MetalPress, table: PairTable) -> Problem:
    """The conditions of a press, whose cells are `here`, with its table for the law."""
    number = {k: i for i, k in enumerate(press.conditions)}
    cells = problem.cells.take(here)
    place = np.array([number[k] for k in cells.condition], dtype=np.intp)
    own = [problem.conditions[k] for k in press.conditions]
    return replace(
        problem, laws=dict.fromkeys(problem.laws, table_law([table], name="finite elements")),
        cells=replace(cells, condition=place),
        conditions=tuple(replace(c, after=number.get(c.after, -1)) for c in own),
    )  # fmt: skip


def _rows(
    problem: Problem, out: Mask, plain: Array, named: Array, found: Array
) -> Iterator[Compared]:
    cells = problem.cells
    for i in np.flatnonzero(np.isfinite(found)):
        c = problem.conditions[cells.condition[i]]
        yield Compared(
            cells.observable[i], c.striker, c.speed, bool(out[i]), float(cells.value[i]),
            float(cells.std[i]), float(plain[i]), float(named[i]), float(found[i]),
        )  # fmt: skip
