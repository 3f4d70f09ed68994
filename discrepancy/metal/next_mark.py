"""Which further press would narrow the flow curve most."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import Array
from ..comparison.problem import Problem
from ..experiments.feasible import at_load, by_striker
from ..rules import RULES

# limit: presses that are tried with each striker [-]; time
_LOADS = 8

# limit: plastic strains at which the stress is told [-]: of tension tests, to their usual end
TOLD = (0.02, 0.05, 0.10)
_READ = dict(RULES.press_reading)


@dataclass(frozen=True, slots=True)
class NextMark:
    """A press, and the relative error of the stresses that are told, before and after."""

    striker: str
    load: float
    before: tuple[float, ...]
    after: tuple[float, ...]


def with_marks(problem: Problem, bench: tuple[float, float]) -> Problem:
    """Return the problem with presses that could be made behind its own cells."""
    conditions, new = list(problem.conditions), []
    for (c, scene), *_ in by_striker(problem).values():
        for load in np.geomspace(*bench, _LOADS):
            one = at_load(c, scene, float(f"{load:.2g}"))
            new += [(len(conditions), name, std) for name, std in _READ.items()]
            conditions.append(one)
    return replace(problem, conditions=tuple(conditions), cells=problem.cells.and_new(new))


def next_mark(
    problem: Problem, known: int, rows: Array, covariance: Array, J: Array
) -> NextMark | None:
    """Return the press whose marks would lower the errors of the told stresses most.

    - `problem`, `known`: from `with_marks`, and how many of its cells were measured.
    - `rows`: (3, n) from the unknowns to the logarithms of the stresses that are told.
    - `covariance`, `J`: of the unknowns (n, n), and what they do to all cells (m, n).
    """
    before = np.einsum("ij,jk,ik->i", rows, covariance, rows)
    best: tuple[float, NextMark] | None = None
    numbers = problem.cells.condition[known:]
    for k in dict.fromkeys(numbers.tolist()):
        press = problem.conditions[k].press
        here = known + np.flatnonzero(numbers == k)
        if press is None or not np.isfinite(J[here]).all():
            continue
        noise = np.diag(problem.cells.std[here] ** 2)
        cross = covariance @ J[here].T
        after = covariance - cross @ np.linalg.solve(J[here] @ cross + noise, cross.T)
        left = np.einsum("ij,jk,ik->i", rows, after, rows)
        if best is None or left.sum() < best[0]:
            told = NextMark(
                problem.conditions[k].striker, press.load, tuple(map(math.sqrt, before)),
                tuple(map(math.sqrt, np.maximum(left, 0.0))),
            )  # fmt: skip
            best = float(left.sum()), told
    return best[1] if best is not None and best[0] < RULES.worth_less * before.sum() else None
