"""Single values that no explanation can hold: found one by one, and given no weight.

Repeats guard themselves by their median; a value without repeats is compared with what all other
cells predict for it under the best explanation of a first pass. A value more than four standard
deviations off is an outlier, the worst one first, up to one cell in sixteen: a mismatch that takes
more cells than that is not a matter of single values.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .fit import Fit
from .problem import Problem

Array = NDArray[np.float64]

LIMIT, SHARE, WIDER = 4.0, 1.0 / 16.0, 30.0


def outlying(base: Fit, residual: Array) -> NDArray[np.bool_]:
    """Return the mask (m,) of outliers in a residual at the prior mean.

    Parameters
    ----------
    base
        Fit whose algebra is used.
    residual
        (m,) data minus prediction at the prior mean.
    """
    total = base.linear.noise + base.linear.J @ base.linear.J.T
    found = np.zeros(len(residual), dtype=bool)
    own = np.diag(base.linear.noise)
    for _ in range(max(int(SHARE * len(residual)), 1)):
        inverse = np.linalg.inv(total + np.diag(np.where(found, WIDER**2 * own, 0.0)))
        score = np.abs(inverse @ residual) / np.sqrt(np.diag(inverse))
        worst = int(np.argmax(np.where(found, 0.0, score)))
        if score[worst] < LIMIT or found[worst]:
            break
        found[worst] = True
    return found


def without_weight(problem: Problem, outliers: NDArray[np.bool_]) -> Problem:
    """Return the problem with the outliers' standard errors made so large that they say nothing."""
    cells = problem.cells
    std = np.where(outliers, WIDER * cells.std, cells.std)
    places = []
    for i in np.flatnonzero(outliers):
        c = problem.conditions[cells.condition[i]]
        places.append(f"{cells.observable[i]} of {c.striker} at {c.speed:.3g} m/s")
    note = f"given no weight, because far off what everything else says: {'; '.join(places)}"
    return replace(problem, cells=replace(cells, std=std), notes=(*problem.notes, note))


__all__ = ["outlying", "without_weight"]
