"""Whether repeats follow a column `x_NAME`: a condition that no part of the simulation knows.

Trials that the simulation cannot tell apart, but whose entries in such a column differ, are
compared with each other: the variance between entries over that within them, or over the stated
noise where that is larger (Fisher's F). No simulation takes part.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.stats import f as fisher

from ...core.arrays import Array
from ..rules import RULES

FALSE_ALARMS = RULES.false_alarms
"""Part of sets in which one is seen by chance, over all observables and columns."""

_SURE_OF = 10**6  # degrees of freedom of a stated noise where entries have no repeats of their own


@dataclass(frozen=True, slots=True)
class Followed:
    """A column that an observable follows.

    - `column`, `observable`: which, of which.
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
    sure = log_p < math.log(FALSE_ALARMS)
    return Followed(column, observable, span, log_p) if sure else None
