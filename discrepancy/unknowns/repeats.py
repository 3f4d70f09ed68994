"""What repeats say of themselves: something that no condition explains. No simulation takes part.

A slope over the order of testing that all conditions share is a drift: of the bodies (wear,
hardening, heating of the place) or of the instrument. Trials that the simulation cannot tell apart,
but whose entries in a column `x_NAME` differ, are compared with each other: the variance between
entries over that within them, or over the stated noise where that is larger (Fisher's F).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.stats import f as fisher
from scipy.stats import t as student

from ...core.arrays import Array
from ..rules import RULES

_SURE_OF = 10**6  # degrees of freedom of a stated noise where entries have no repeats of their own


@dataclass(frozen=True, slots=True)
class Drift:
    """Change of one observable over the order of testing.

    - `change`: from the first trial to the last; logarithmic where cells are, else in the cells'
      unit.
    - `z`: the change over its standard error.
    - `log_p`: Ln of the chance that noise alone changes one of the observables tested by as much.
    """

    observable: str
    change: float
    z: float
    log_p: float


def drift_of(
    observable: str, repeats: Sequence[tuple[Array, Array, Array]], *, observables: int
) -> Drift | None:
    """Return the drift of one observable, or none that chance would not give.

    `repeats`: for each condition: order of testing from 0 to 1, value, standard deviation, each
    (n,); `observables`: how many are tested.
    """
    x, y, s = [], [], []
    for order, value, std in repeats:
        if len(order) < 2 or not np.isfinite(order).all():
            continue
        weight = std**-2.0
        x.append(order - np.average(order, weights=weight))
        y.append(value - np.average(value, weights=weight))
        s.append(std)
    free = sum(len(one) - 1 for one in x) - 1
    if free < RULES.drift_freedom:
        return None
    place, change, std = np.concatenate(x), np.concatenate(y), np.concatenate(s)
    spread = float(np.sum((place / std) ** 2))
    if spread == 0.0:
        return None
    slope = float(np.sum(place * change / std**2)) / spread
    scatter = float(np.sum(((change - slope * place) / std) ** 2)) / free
    z = slope * math.sqrt(spread / max(scatter, 1.0))
    log_p = math.log(2.0 * observables) + float(student.logsf(abs(z), free))
    return Drift(observable, slope, z, log_p) if log_p < math.log(RULES.false_alarms) else None


@dataclass(frozen=True, slots=True)
class Followed:
    """A column that an observable follows.

    - `span`: largest difference between entries at one condition; logarithmic where cells are.
    - `log_p`: Ln of the chance that noise alone differs by as much in one of all that were tested.
    """

    column: str
    observable: str
    span: float
    log_p: float


class Entries(NamedTuple):
    """Repeats of one observable at one condition, (n,) each: the column's entry, value, noise."""

    entry: tuple[str, ...]
    value: Array
    std: Array


def followed_of(
    column: str, observable: str, repeats: Sequence[Entries], *, tested: int
) -> Followed | None:
    """Return how an observable follows a column, or none where chance would do the same.

    `repeats`: one for each condition; `tested`: how many columns and observables are tested.
    """
    between = within = span = 0.0
    free, left = 0, 0
    for one in repeats:
        names = list(dict.fromkeys(one.entry))
        if len(names) < 2:
            continue
        number = np.array([names.index(e) for e in one.entry])
        weight = one.std**-2.0
        total = np.bincount(number, weight)
        means = np.bincount(number, weight * one.value) / total
        middle = np.average(one.value, weights=weight)
        between += float(np.sum(total * (means - middle) ** 2))
        within += float(np.sum(weight * (one.value - means[number]) ** 2))
        free, left = free + len(names) - 1, left + len(number) - len(names)
        span = max(span, float(np.ptp(means)))
    if free == 0:
        return None
    noise = max(within / left, 1.0) if left else 1.0
    alone = float(fisher.logsf(between / free / noise, free, left or _SURE_OF))
    log_p = max(alone + math.log(tested), -700.0)
    sure = log_p < math.log(RULES.false_alarms)
    return Followed(column, observable, span, log_p) if sure else None
