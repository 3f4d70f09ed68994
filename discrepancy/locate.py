"""Where the baseline misses: observable by covariate, with a family-wise threshold.

For each observable and each condition that varies, a contrast over the cells of that observable is
tested: a constant, or a slope along the condition, each cell weighted by how sure it is. Its score
is what the residual has along the contrast over the standard deviation that noise, nuisances and
the law's error give it there, by themselves: an observable that agrees has no score, though a
nuisance that would repair another one moved it too. The largest score of all is compared with that
of sets in which nothing is missing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..core.arrays import Array
from ..core.observables import OBSERVABLES
from .comparison.problem import Problem
from .inference.fit import Fit
from .rules import RULES
from .unknowns.covariates import covariates

ORDER = "order of testing"
"""Place of a drift, which lies along no condition."""


@dataclass(frozen=True, slots=True)
class Miss:
    """One place where the baseline misses.

    `observable`, `covariate`: what, along which condition; `trend`: in words: how recording over
    simulation goes; `z`: score; the family-wise threshold is in `Located`.
    """

    observable: str
    covariate: str
    trend: str
    z: float

    @property
    def phase(self) -> str:
        """Phase of the impact that shapes the observable most."""
        return OBSERVABLES[self.observable].phase


@dataclass(frozen=True, slots=True)
class Located:
    """What misses, worst first.

    - `beyond_chance`: places that fewer than one set in twenty with nothing missing has anywhere.
    - `worst`: the worst of the others, where all numbers together say that something is missing.
    - `threshold`: score that one set in twenty exceeds somewhere by chance.
    """

    beyond_chance: tuple[Miss, ...]
    worst: tuple[Miss, ...]
    threshold: float

    @property
    def misses(self) -> tuple[Miss, ...]:
        """All places that verdict.json holds."""
        return (*self.beyond_chance, *self.worst)


def locate(
    problem: Problem, base: Fit, rng: np.random.Generator, *, level: float = 0.95, least: int = 0
) -> Located:
    """Test every cell of observable by covariate.

    - `problem`: what was compared.
    - `rng`: draws sets with nothing missing, for the threshold.
    - `level`: family-wise.
    - `least`: number of places that are told in any case: 1 where all numbers together say that
      something is missing, even if no contrast alone does.
    """
    linear = base.linear
    names, contrasts = _contrasts(problem, 1.0 / np.diag(linear.total))
    size = np.sqrt(np.einsum("ij,jk,ik->i", contrasts, linear.total, contrasts))
    score = contrasts @ base.residual / size
    drawn = rng.standard_normal((RULES.nulls, len(base.residual)))
    null = np.abs(drawn @ (contrasts @ linear.lower).T / size)
    found = [
        Miss(observable, covariate, _trend(covariate, z), float(z))
        for (observable, covariate), z in zip(names, score, strict=True)
    ]
    threshold = float(np.quantile(null.max(axis=1), level))
    found.sort(key=lambda m: -abs(m.z))
    columns = [
        # the deviate that a normal variable exceeds as rarely, to first order in its logarithm
        Miss(f.observable, f.column, f"recordings differ with {f.column}",
             math.sqrt(-2.0 * f.log_p))
        for f in problem.followed
    ]  # fmt: skip
    columns += [
        Miss(d.observable, ORDER, f"recordings {'rise' if d.z > 0 else 'fall'} with the {ORDER}",
             d.z)
        for d in sorted(problem.drifts, key=lambda d: -abs(d.z))
    ]  # fmt: skip
    beyond = [m for m in found if abs(m.z) > threshold]
    return Located((*columns, *beyond), tuple(found[len(beyond) : least]), threshold)


def _contrasts(problem: Problem, sure: Array) -> tuple[list[tuple[str, str]], Array]:
    """Names and rows (contrasts, m): means and slopes by weights (m,), a slope without a mean."""
    cells = problem.cells
    names, rows = [], []
    for observable in dict.fromkeys(cells.observable):
        here = np.array([o == observable for o in cells.observable])
        weight = np.where(here, sure, 0.0)
        names.append((observable, "overall"))
        rows.append(weight)
        for covariate, value in covariates(problem).items():
            slope = value[cells.condition]
            slope = np.where(here, slope - weight @ slope / weight.sum(), 0.0)
            if np.linalg.norm(slope) > 1e-9:
                names.append((observable, covariate))
                rows.append(weight * slope)
    return names, np.stack(rows)


def _trend(covariate: str, z: float) -> str:
    if covariate == "overall":
        return "recordings lie above the simulation" if z > 0 else "recordings lie below it"
    direction = "rises" if z > 0 else "falls"
    return f"recording over simulation {direction} with {covariate}"
