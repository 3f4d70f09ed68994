"""One step of DOP853 (Hairer, Norsett and Wanner) over the equations of motion."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit
from scipy.integrate import DOP853

from . import layout as at
from .layout import PLAIN
from .motion import derivative

# fmt: off
STAGES = int(DOP853.n_stages)
# Row i gives the state of stage i; the last row is the step's own result.
_A = np.vstack([DOP853.A[:STAGES, :STAGES], DOP853.B])
_C = np.ascontiguousarray(np.append(DOP853.C[:STAGES], 1.0))
_E3 = DOP853.E3[: STAGES + 1]
_E5 = DOP853.E5[: STAGES + 1]


def _by_fours(rows: Any) -> tuple[Any, Any]:
    """Places and values of the coefficients that are not zero, four at a time: (rows, n, 4).

    What is added four stages at a time is loaded and stored a quarter as often. A row is filled up
    with the first stage, times nothing.
    """
    places = [np.flatnonzero(row) for row in rows]
    fours = -(-max(len(p) for p in places) // 4)
    which, value = np.zeros((len(rows), fours, 4), np.int64), np.zeros((len(rows), fours, 4))
    for i, place in enumerate(places):
        which[i].flat[: len(place)] = place
        value[i].flat[: len(place)] = rows[i, place]
    return which, value


_STAGE, _WEIGHT = _by_fours(_A)
_FOURS = np.array([-(-np.count_nonzero(row) // 4) for row in _A])
_WRONG = np.flatnonzero(_E5)


@njit(cache=True, **PLAIN)
def step(m, w, h):
    """Take one DOP853 step of h from `w.z` into `w.z_new`; return the error in tolerances.

    The first row of `w.stages` holds the derivative at the start, the last one that at the new
    state, `w.seen_new` what is seen there.
    """
    z, z_new, stages, scale = w.z, w.z_new, w.stages, w.scale
    variable, place = int(w.now[at.VARIABLE]), w.now[at.AT]
    size = len(z)
    for i in range(1, STAGES + 1):
        for g in range(_FOURS[i]):
            s0, s1 = stages[_STAGE[i, g, 0]], stages[_STAGE[i, g, 1]]
            s2, s3 = stages[_STAGE[i, g, 2]], stages[_STAGE[i, g, 3]]
            a0, a1 = h * _WEIGHT[i, g, 0], h * _WEIGHT[i, g, 1]
            a2, a3 = h * _WEIGHT[i, g, 2], h * _WEIGHT[i, g, 3]
            if g == 0:
                for j in range(size):
                    z_new[j] = z[j] + ((a0 * s0[j] + a1 * s1[j]) + (a2 * s2[j] + a3 * s3[j]))
            else:
                for j in range(size):
                    z_new[j] += (a0 * s0[j] + a1 * s1[j]) + (a2 * s2[j] + a3 * s3[j])
        derivative(m, w, variable, place + _C[i] * h, z_new, stages[i], w.seen_new)
    # Row by row, so that the inner loops run over the state without a chain of sums.
    fifth, third = w.moved, w.spare
    for j in range(size):
        fifth[j] = 0.0
        third[j] = 0.0
    for k in _WRONG:
        e5, e3 = _E5[k], _E3[k]
        for j in range(size):
            fifth[j] += e5 * stages[k, j]
            third[j] += e3 * stages[k, j]
    five, three = 0.0, 0.0
    for j in range(size):
        five += (fifth[j] / scale[j]) ** 2
        three += (third[j] / scale[j]) ** 2
    w.tally[at.EVALUATIONS] += STAGES
    if five == 0.0 and three == 0.0:
        return 0.0
    return abs(h) * five / math.sqrt((five + 0.01 * three) * m.sums[at.SIZE])
