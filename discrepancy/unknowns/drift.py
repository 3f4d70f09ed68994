"""Whether repeats change with the order of testing: something that no condition explains.

Repeats of one condition, at different places in the order, are compared with each other, so that no
simulation takes part. A slope over the order that all conditions share is a drift: of the bodies
(wear, hardening, heating of the place) or of the instrument.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student

from ...core.arrays import Array
from ..rules import RULES


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
