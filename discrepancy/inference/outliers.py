"""Single values that no explanation can hold: found one by one, and given no weight.

Repeats guard themselves by their median; a value without repeats is compared with what all other
cells predict for it under the best explanation of a first pass. A value more than four standard
deviations off is an outlier, the worst one first, up to one cell in sixteen, unless the same
observable of the same striker is off to the same side at a neighbouring condition: what neighbours
share is a finding, not an outlier.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...core.arrays import Array, Indices, Mask
from ..comparison.problem import Problem
from ..rules import RULES
from .fit import Fit


def outlying(problem: Problem, judge: Fit) -> Mask:
    """Return the mask (m,) of the values that an explanation cannot hold one by one.

    `judge`: fit of the explanation.
    """
    residual, total = judge.residual, judge.linear.total
    found = np.zeros(len(residual), dtype=bool)
    backed = np.isin(problem.cells.observable, list(problem.misread))
    own = np.diag(judge.linear.noise)
    near = _neighbours(problem)
    most = max(int(RULES.outlier_share * len(residual)), 1)

    def inverse_without(some: Mask) -> Array:
        return np.linalg.inv(total + np.diag(np.where(some, RULES.outlier_wider**2 * own, 0.0)))

    while found.sum() < most:
        inverse = inverse_without(found)
        score = inverse @ residual / np.sqrt(np.diag(inverse))
        worst = int(np.argmax(np.where(found | backed, 0.0, np.abs(score))))
        if abs(score[worst]) < RULES.outlier or found[worst] or backed[worst]:
            break
        # without this value: do its neighbours lean the same way?
        without = inverse_without(found | (np.arange(len(found)) == worst))
        others = without @ residual / np.sqrt(np.diag(without)) * np.sign(score[worst])
        if np.any(others[near[worst]] > RULES.alone):
            backed[worst] = True
        else:
            found[worst] = True
    return found


def _neighbours(problem: Problem) -> list[Indices]:
    """For each cell the two of the same observable and striker that are nearest in condition."""
    cells, conditions = problem.cells, problem.conditions
    place = np.array([
        [
            np.log(c.speed), 2.0 * c.angle, c.tangential / c.speed,
            RULES.press_apart * (c.press is not None),
        ]
        for c in conditions
    ])  # fmt: skip
    found = []
    for i, k in enumerate(cells.condition):
        same = np.array([
            j != i and o == cells.observable[i]
            and conditions[cells.condition[j]].striker == conditions[k].striker
            for j, o in enumerate(cells.observable)
        ])  # fmt: skip
        rows = np.flatnonzero(same)
        away = np.linalg.norm(place[cells.condition[rows]] - place[k], axis=1)
        found.append(rows[np.argsort(away)[:2]])
    return found


def without_weight(problem: Problem, outliers: Mask) -> Problem:
    """Return the problem with the outliers' standard errors made so large that they say nothing."""
    cells = problem.cells
    std = np.where(outliers, RULES.outlier_wider * cells.std, cells.std)
    places = []
    for i in np.flatnonzero(outliers):
        c = problem.conditions[cells.condition[i]]
        places.append(f"{cells.observable[i]} of {c.striker} {c.told}")
    note = f"given no weight, because far off what everything else says: {'; '.join(places)}"
    return replace(
        problem, cells=replace(cells, std=std), notes=(*problem.notes, note),
        weightless=frozenset(np.flatnonzero(outliers).tolist()),
    )  # fmt: skip
