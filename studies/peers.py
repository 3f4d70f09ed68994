"""Simple rules on the very problem that a diagnosis has: what its own decision must beat.

The forward model, the grids of the mechanisms, the cells and the stated numbers are the
diagnosis's; what is left out are its errors of law and form, nulls, pairs and priors. Each rule is
declared in `RULES` before it is run. Truths lie beside the sets: sets/NAME and truths/NAME.toml,
whose key `mechanisms` is empty where nothing is missing, or NAME.json as `proof sample` writes it.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.stats import chi2

from ..core.arrays import Array
from ..core.inputs.toml_input import read_toml
from ..core.processes.threads import in_one_thread
from ..discrepancy import diagnose
from ..discrepancy.choice.odds import OUTSIDE
from ..discrepancy.comparison.forward import Simulator
from ..discrepancy.comparison.problem import Problem, problem_of
from ..discrepancy.inference.fit import Fit, baseline_situations, fit
from ..discrepancy.rank import screen
from ..discrepancy.unknowns.lawerror import NO_ERROR
from ..impact.mechanisms import MECHANISMS, Mechanism
from ..recordings import RecordingSet, read

FLOOR = 0.03
"""Share of every number that a simple rule takes the model to be off by, independently."""


class Tried(NamedTuple):
    """One explanation, and the least chi2 over its grid with ln det of the covariance.

    By the noise alone, and with the floor.
    """

    name: str
    parameters: int
    noise: tuple[float, float]
    floor: tuple[float, float]


class Said(NamedTuple):
    """What a rule says of a set: a verdict's word, and the mechanism that it names."""

    verdict: str
    name: str = ""


@dataclass(frozen=True)
class Rule:
    """A rule in the words of `RULES`.

    Parameters
    ----------
    floor
        Whether the floor is part of the covariance.
    per_parameter
        What a parameter costs, from the number of cells.
    margin
        By how much a name must win over the baseline.
    outside
        Share of chi2 below which the winner does not fit; 0 for never.
    """

    floor: bool
    per_parameter: Callable[[int], float]
    margin: float
    outside: float

    def says(self, tried: Sequence[Tried], cells: int) -> Said:
        """Return the verdict over all explanations, the baseline first."""
        fits = {t.name: t.floor if self.floor else t.noise for t in tried}
        cost = {t.name: sum(fits[t.name]) + t.parameters * self.per_parameter(cells) for t in tried}
        base = tried[0].name
        best = min(tried, key=lambda t: cost[t.name])
        if cost[best.name] >= cost[base] - self.margin:
            best = tried[0]
        free = max(cells - best.parameters, 1)
        if chi2.sf(fits[best.name][0], free) < self.outside:
            return Said(OUTSIDE)
        return Said("adequate") if best.name == base else Said("missing-physics", best.name)


RULES: Mapping[str, Rule] = {
    "BIC, 3 % floor": Rule(floor=True, per_parameter=math.log, margin=10.0, outside=0.01),
    "BIC, 3 % floor, margin 4": Rule(floor=True, per_parameter=math.log, margin=4.0, outside=0.01),
    "BIC on noise": Rule(floor=False, per_parameter=math.log, margin=10.0, outside=0.01),
    "AIC on noise": Rule(floor=False, per_parameter=lambda _: 2.0, margin=0.0, outside=0.01),
}
"""Declared before they are run."""


@in_one_thread
def tried_of(recordings: RecordingSet) -> tuple[list[Tried], int]:
    """Return every explanation of a set under the floor, the baseline first, and the cells."""
    problem = problem_of(recordings)
    cells = problem.cells
    floor = FLOOR * np.where(cells.is_log, 1.0, np.abs(cells.value))
    floored = replace(
        problem, error=replace(NO_ERROR, spreads=problem.error.spreads),
        cells=replace(cells, std=np.hypot(cells.std, floor)),
    )  # fmt: skip
    simulator = Simulator(floored)
    base = fit(simulator, ())
    found = [_least(base, floor)]
    for mechanism in _acting(floored):
        first = screen(simulator, base, mechanism)
        fitted = fit(
            simulator, (mechanism,), start=base, place=first.place, rounds=3, effect=first.effect
        )
        found.append(_least(fitted, floor))
    return found, len(cells)


def _acting(problem: Problem) -> Iterator[Mechanism]:
    """The mechanisms that arithmetic leaves, without errors of their forms."""
    situations = baseline_situations(problem)
    exact = {"form": 0.0, "scale_error": 0.0, "jumps": False, "law_error": 1.0}
    for m in MECHANISMS:
        rests = any(problem.without_modulus[body] for body in m.rests_on)
        if not rests and not m.ruled_out(situations):
            yield type(type(m).__name__, (type(m),), exact)()


def _least(fitted: Fit, floor: Array) -> Tried:
    linear = fitted.linear
    both = []
    for noise in (linear.noise - np.diag(floor**2), linear.noise):
        lower = np.linalg.cholesky(noise + linear.J @ linear.J.T)
        white = np.linalg.solve(lower, fitted.residuals.T)
        log_det = 2.0 * float(np.sum(np.log(np.diag(lower))))
        both.append((float(np.min(np.sum(white**2, axis=0))), log_det))
    return Tried(fitted.name, len(fitted.grid.axes), both[0], both[1])


class Row(NamedTuple):
    """One set: its truth, what each decider says, and the processor seconds of each."""

    name: str
    truth: tuple[str, ...]
    said: Mapping[str, tuple[str, tuple[str, ...]]]
    seconds: Mapping[str, float]


def compared(folder: Path) -> Iterator[Row]:
    """Diagnose every set of a folder, by the diagnosis and by each rule."""
    for place in sorted((folder / "sets").iterdir()):
        truth = _truth(folder / "truths", place.name)
        recordings = read(place)
        begun = time.process_time()
        verdict = diagnose(recordings)
        between = time.process_time()
        tried, cells = tried_of(recordings)
        done = time.process_time()
        said = {"diagnosis": (verdict.verdict, tuple(f.name for f in verdict.choice.members))}
        for name, rule in RULES.items():
            one = rule.says(tried, cells)
            said[name] = (one.verdict, (one.name,) if one.name else ())
        yield Row(
            place.name, truth, said,
            {"diagnosis": between - begun, "rules": done - between},
        )  # fmt: skip


def _truth(folder: Path, name: str) -> tuple[str, ...]:
    written = folder / f"{name}.json"
    if not written.exists():
        return tuple(sorted(read_toml(folder / f"{name}.toml")["mechanisms"]))
    record = json.loads(written.read_text(encoding="utf-8"))
    return (OUTSIDE,) if record["kind"] == "outside" else tuple(sorted(record["mechanisms"]))


class Score(NamedTuple):
    """Sets that are right exactly, right or in the set of names; nulls named; outside forced."""

    exact: int
    in_set: int
    false: int
    forced: int


def scored(rows: Sequence[Row], decider: str) -> Score:
    """Count what one decider says against the truths."""
    exact = in_set = false = forced = 0
    for row in rows:
        verdict, names = row.said[decider]
        sets = [tuple(sorted(n.split("+"))) for n in names]
        if not row.truth:
            right = verdict == "adequate"
            false += verdict in ("missing-physics", "indistinguishable", OUTSIDE)
        elif row.truth == (OUTSIDE,):
            right = verdict == OUTSIDE
            forced += verdict == "missing-physics"
        else:
            right = verdict == "missing-physics" and sets == [row.truth]
        exact += right
        in_set += right or row.truth in sets
    return Score(exact, in_set, false, forced)
