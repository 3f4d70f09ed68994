"""Something outside the library, as an explanation with a likelihood of its own.

Half of it is a contact law that is free: 16 % in force, 50 % in recovery, over the depth. The
other half knows nothing of contacts: each observable departs from the baseline by 3, 10 or 30 %,
smoothly over what varies in the set, or from condition to condition. It may act unseen
beside whatever explains the rest, and what repeats say of themselves speaks for that: a drift over
the order of testing, a column `x_NAME` that they follow, and scatter beyond any noise that a
laboratory misjudges. Beside all that stands physics that a verdict has no name for
(`mechanisms.NAMELESS`).
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy.stats import norm

from ..comparison.cells import Scatter
from ..comparison.problem import Problem
from ..correction import widened
from ..inference.fit import Fit
from ..inference.linear import Mixture
from ..rules import RULES
from ..unknowns.covariates import nearness, same_observable


def outside_of(problem: Problem, base: Fit) -> Mixture:
    """Return the likelihood of the baseline's residuals if something outside acts."""
    parts, weights = [widened(problem, base)], [0.5]
    cells = problem.cells
    plain = replace(base.mixture.parts[len(base.mixture.parts) // 2], form=np.zeros((0, 0)))
    scale = np.ones(len(cells))
    for name in set(cells.observable):
        here = np.array([o == name for o in cells.observable]) & ~cells.is_log
        scale[here] = np.sqrt(np.mean(cells.value[here] ** 2)) if here.any() else 1.0
    alike = same_observable(problem) * nearness(problem, RULES.smooth)
    for shape in (alike, np.eye(len(cells))):
        for amplitude in RULES.amplitudes:
            more = amplitude**2 * np.outer(scale, scale) * shape
            parts.append(replace(plain, noise=plain.noise + more))
            weights.append(0.5 / (2 * len(RULES.amplitudes)))
    return Mixture(tuple(parts), np.log(weights))


def odd_repeats(problem: Problem) -> float:
    """Ln odds, by the repeats alone, that something is outside which no simulation knows; from 0.

    Where they say nothing, something may act unseen.
    """
    found = [_worth(d.log_p) for d in problem.drifts]
    found += [_worth(f.log_p) for f in problem.followed]
    # in another unit than their noise, repeats scatter as they would
    found += [_of_scatter(s) for s in problem.scatters if s.observable not in problem.misread]
    return max([0.0, *found])


def _worth(log_p: float) -> float:
    """Ln of the most that a p value can be worth, 1/(-e p ln p).

    T. Sellke, M. J. Bayarri, J. O. Berger, Am. Stat. 55 (2001) 62.
    """
    return -1.0 - log_p - math.log(-log_p)


def _of_scatter(scatter: Scatter) -> float:
    """Ln odds of a scatter that was varied, up to `RULES.widest`, against a noise misjudged."""
    times = math.log(scatter.ratio)
    return -math.log(RULES.widest) - float(norm.logpdf(times, 0.0, RULES.misjudged))
