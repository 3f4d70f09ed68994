"""How well an explanation predicts conditions that were left out of its fit.

Whole groups are left out: all trials of a speed or load, a striker, an angle. Given the other
cells, the left-out ones follow from the joint Gaussian of the linear algebra, for every value of
the mechanism's parameters, weighted by how well these explain the cells that were kept.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from ..core.arrays import Array, Mask
from .comparison.problem import Problem
from .inference.fit import Fit
from .inference.left_out import Whole


@dataclass(frozen=True, slots=True)
class HeldOut:
    """Scores of one explanation on left-out conditions.

    - `rms`: of (prediction - mean)/standard error: 1 is what the noise alone leaves.
    - `log_density`: mean of the ln predictive density of a number in units of its standard error
      [nat]: -1.42 is what the noise alone leaves.
    - `trials`: readings behind it, each as often as a group leaves it out.
    """

    rms: float
    log_density: float
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
    squares, log_density, count = [], 0.0, 0
    whole = Whole.of(fitted.linear, fitted.residuals)
    noise = np.sqrt(np.diag(fitted.linear.noise))
    for test in (t for t in groups_of(problem) if t.any() and not t.all()):
        miss, told = _missed(whole, test)
        squares.append((miss / noise[test]) ** 2)
        log_density += told + float(np.sum(np.log(noise[test])))
        count += int(np.sum(problem.cells.count[test]))
    if not squares:
        return HeldOut(math.nan, math.nan, 0)
    every = np.concatenate(squares)
    return HeldOut(math.sqrt(float(np.mean(every))), log_density / len(every), count)


def _missed(whole: Whole, test: Mask) -> tuple[Array, float]:
    """Data minus prediction of the left-out cells, and their ln density.

    Over the parameters, weighted by how well these explain the cells that were kept.
    """
    miss, kept, log_density = whole.missed(test)
    log_weight = -0.5 * kept
    log_weight -= logsumexp(log_weight)
    return np.asarray(np.exp(log_weight) @ miss), float(logsumexp(log_weight + log_density))
