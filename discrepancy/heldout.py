"""How well an explanation predicts conditions that were left out of its fit.

Whole groups are left out: all trials of a speed or load, a striker, an angle. Given the other
cells, the left-out ones follow from the joint Gaussian of the linear algebra, for every value of
the mechanism's parameters, weighted by how well these explain the cells that were kept.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from .comparison.problem import Problem
from .inference.fit import Fit
from .inference.left_out import Whole

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_FLOOR = 0.1
_GRID = 400  # parameter values that stand for all


@dataclass(frozen=True, slots=True)
class HeldOut:
    """Scores of one explanation on left-out conditions.

    Parameters
    ----------
    score
        rms of (prediction - mean)/standard error with the noise's own variance taken out, at
        least 0.1.
    raw
        The rms itself.
    trials
        Trials behind it.
    """

    score: float
    raw: float
    trials: int


def groups_of(problem: Problem) -> list[Mask]:
    """Return masks (m,) of the cells of each group; a single group is split by conditions."""
    conditions = problem.conditions
    keys: list[list[object]] = [
        [c.striker for c in conditions],
        [(c.press is not None, round(math.log(c.speed) / 0.15)) for c in conditions],
        [round(math.degrees(c.incidence) / 2.0) for c in conditions],
    ]
    masks = []
    for key in keys:
        distinct = list(dict.fromkeys(key))
        if len(distinct) < 2:
            continue
        for value in distinct:
            rows = np.array([k == value for k in key])
            masks.append(rows[problem.cells.condition])
    if not masks:
        masks = [problem.cells.condition == k for k in range(len(conditions))]
    return masks


def held_out(problem: Problem, fitted: Fit) -> HeldOut:
    """Score an explanation with each group left out in turn."""
    return _scored(problem, [(fitted, test) for test in _folds(problem)])


class Repeated(NamedTuple):
    """The whole choice made again on what was kept, group by group.

    Parameters
    ----------
    score
        Of the explanation that each group's rest would choose, on that group.
    same
        Share of the groups whose rest chooses as the whole set does.
    """

    score: HeldOut
    same: float


def repeated_choice(
    problem: Problem, fits: Sequence[Fit], log_prior: Mapping[str, float], chosen: str
) -> Repeated:
    """Leave out each group in turn, choose by what was kept, and predict the group by that.

    Parameters
    ----------
    problem
        What was compared.
    fits
        All explanations, the baseline included.
    log_prior
        Name to ln of the prior probability less what nulls give away.
    chosen
        Name of the whole set's choice.
    """
    kept = [_Kept.of(f) for f in fits]
    used = []
    for test in _folds(problem):
        evidence = {k.fitted.name: k.evidence(test) + log_prior[k.fitted.name] for k in kept}
        best = max(fits, key=lambda f: evidence[f.name])
        used.append((best, test))
    same = np.mean([f.name == chosen for f, _ in used]) if used else math.nan
    return Repeated(_scored(problem, used), float(same))


class _Kept(NamedTuple):
    """Some places of an explanation's grid, with the model's error of every size."""

    fitted: Fit
    parts: tuple[Whole, ...]

    @classmethod
    def of(cls, fitted: Fit) -> _Kept:
        few = fitted.residuals[:: max(len(fitted.residuals) // _GRID, 1)]
        return cls(fitted, tuple(Whole.of(part, few) for part in fitted.mixture.parts))

    def evidence(self, out: Mask) -> float:
        """Ln evidence of the explanation by the cells that were kept."""
        each = [
            weight + part.kept_log_likelihood(out)
            for weight, part in zip(self.fitted.mixture.log_weight, self.parts, strict=True)
        ]
        found = logsumexp(np.stack(each), axis=0)
        return float(logsumexp(found)) - math.log(len(found)) + self.fitted.grid.log_volume


def _folds(problem: Problem) -> list[Mask]:
    return [test for test in groups_of(problem) if test.any() and not test.all()]


def _scored(problem: Problem, used: Sequence[tuple[Fit, Mask]]) -> HeldOut:
    """Score predictions of groups of cells by the explanation that goes with each."""
    squares, count = [], 0
    known: dict[str, Whole] = {}
    for fitted, test in used:
        if fitted.name not in known:
            known[fitted.name] = Whole.of(fitted.linear, fitted.residuals)
        miss = _missed(known[fitted.name], test)
        noise = np.sqrt(np.diag(fitted.linear.noise))
        squares.append((miss / noise[test]) ** 2)
        count += int(np.sum(problem.cells.count[test]))
    if not squares:
        return HeldOut(math.nan, math.nan, 0)
    mean = float(np.mean(np.concatenate(squares)))
    return HeldOut(math.sqrt(max(mean - 1.0, _FLOOR**2)), math.sqrt(mean), count)


def _missed(whole: Whole, test: Mask) -> Array:
    """Data minus prediction of the left-out cells, over the parameters that explain the others."""
    miss, kept = whole.missed(test)
    log_weight = -0.5 * kept
    return np.asarray(np.exp(log_weight - logsumexp(log_weight)) @ miss)
