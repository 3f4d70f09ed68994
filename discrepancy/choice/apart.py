"""The law's error in a second form: as large as stated, but apart in every number.

The error inside the law (`unknowns.lawerror`) is smooth over the depth and shared by all that a
contact shows, so that it can follow what a missing strength or loss does; apart, it can follow
nothing, and what is smooth stands out. Which of the two a metal is nearer to is not known. The
fits' own residuals and derivatives serve for both: nothing is simulated again.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.special import logsumexp
from scipy.stats import chi2

from ...core.arrays import Array
from ..comparison.problem import Problem
from ..inference.fit import Fit
from ..inference.linear import Linear
from ..rank import Ranking


class Weighed(NamedTuple):
    """One explanation under the error apart.

    Parameters
    ----------
    log_evidence
        ln of the mean likelihood over its prior.
    log_p
        ln of the share of sets that fit no better at the best place, by the chi2 distribution.
    """

    log_evidence: float
    log_p: float


def apart(linear: Linear, base: Fit, problem: Problem) -> Linear:
    """Return an algebra whose law error is the baseline's in size, and apart in every number."""
    n = problem.n_nuisances
    size = np.sum(base.linear.J[:, n:] ** 2, axis=1)
    return replace(
        linear, noise=linear.noise + np.diag(size), J=linear.J[:, :n],
        form=np.zeros((0, 0)), prior=np.zeros(0),
    )  # fmt: skip


def weighed(ranking: Ranking) -> dict[str, Weighed]:
    """Return every explanation of a ranking by its name; without a full fit, by its screening."""
    base, problem = ranking.base, ranking.problem
    found = {
        s.mechanism.name: _of(apart(base.linear, base, problem), base.residual - s.effect,
                              len(s.grid.axes))
        for s in ranking.screened
    }  # fmt: skip
    for f in ranking.fits:
        one = _of(apart(f.linear, base, problem), f.residuals, len(f.grid.axes))
        found[f.name] = one._replace(log_evidence=one.log_evidence + f.grid.log_volume)
    return found


def _of(linear: Linear, residuals: Array, parameters: int) -> Weighed:
    """Weigh residuals over a grid, (k, m)."""
    squares = np.sum(linear.white(residuals) ** 2, axis=1)
    mean = float(logsumexp(-0.5 * squares)) - math.log(len(squares)) - 0.5 * linear.log_det
    free = max(residuals.shape[1] - parameters, 1)
    return Weighed(mean, float(chi2.logsf(float(np.min(squares)), free)))


__all__ = ["Weighed", "apart", "weighed"]
