"""How well an explanation predicts conditions that were left out of its fit.

Whole groups are left out: all trials of a speed or load, a striker, an angle. Given the other
cells, the left-out ones follow from the joint Gaussian of the linear algebra, for every value of
the mechanism's parameters, weighted by how well these explain the cells that were kept.

With Q = Sigma^-1 and g = Q r, the cells t miss what the others foretell by Q_tt^-1 g_t, with the
covariance Q_tt^-1, so that the others' r^T Sigma^-1 r is r^T g less g_t^T Q_tt^-1 g_t: no group
needs a factorisation of its own.

References
----------
C. E. Rasmussen, C. K. I. Williams, Gaussian Processes for Machine Learning (MIT Press 2006), 5.4.2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from ..core.arrays import Array, Mask
from .comparison.problem import Problem
from .inference.fit import Fit


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
    white = fitted.linear.whitening
    precision = white @ white.T
    solved = fitted.residuals @ precision
    whole = np.sum(fitted.residuals * solved, axis=1)
    noise = np.sqrt(np.diag(fitted.linear.noise))
    for test in (t for t in groups_of(problem) if t.any() and not t.all()):
        miss, kept, told = missed(whole, solved[:, test], precision[np.ix_(test, test)])
        log_weight = -0.5 * kept
        log_weight -= logsumexp(log_weight)
        squares.append((np.exp(log_weight) @ miss / noise[test]) ** 2)
        log_density += float(logsumexp(log_weight + told)) + float(np.sum(np.log(noise[test])))
        count += int(np.sum(problem.cells.count[test]))
    if not squares:
        return HeldOut(math.nan, math.nan, 0)
    every = np.concatenate(squares)
    return HeldOut(math.sqrt(float(np.mean(every))), log_density / len(every), count)


def missed(whole: Array, g: Array, precision: Array) -> tuple[Array, Array, Array]:
    """Return data minus prediction of the left-out cells t by the others, (k, t).

    And r^T Sigma^-1 r of the others, and the left-out cells' ln density given them, (k,).

    `whole`, `g`, `precision`: r^T Q r (k,), g_t (k, t) and Q_tt (t, t).
    """
    miss = np.linalg.solve(precision, g.T).T
    squares = np.sum(g * miss, axis=1)
    flat = np.linalg.slogdet(precision)[1] - len(precision) * math.log(2.0 * math.pi)
    return np.asarray(miss), np.asarray(whole - squares), 0.5 * (flat - squares)
