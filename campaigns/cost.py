"""How long a sweep will take: what each case costs, learned from the cases that have ended.

The model is ln(seconds) = c + k1 ln(E'/(300 Sy_min)) + k2 min(s, 1) for s > 0, + k3 min(-s, 1) for
s < 0, with s = ln Sy*: a soft pair needs more steps, near-equal strengths most. It starts from
what was measured and bends towards the cases that end (ridge regression on their wall times, which
hold the speed of the machine and what else runs on it).
"""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np

from ..core.arrays import Array
from .case import Case

# limit: weight of what was measured before against finished cases [cases], for the level,
# E'/Sy_min and Sy* above and below 1; on the published cases' times the whole is told within 36 %
# from the first line on (0.05 for the level: twice too much after one case)
_PRIOR = (0.2, 0.1, 0.1, 0.1)

# limit: part of its foreseen time that a case under way still takes, however long it has [-]; by
# the same sweeps
_STILL_TO_GO = 0.15

# limit: processor time [s] of a deep case with E'/Sy_min = 300 and Sy* = 1, by accuracy, for a
# forecast; 842 published cases (scatter 30 %), times what three of them take less today
_BASE_S = {"smoke": 5.8, "quick": 10.0, "production": 38.0}

# limit: what the benchmark takes where they took that [s]
_REFERENCE_S = 0.023

# limit: powers of E'/Sy_min, and of Sy* above and below 1, in a forecast [-]: the same cases
_SLOPES = (0.34, -0.72, -0.8)

# limit: depth up to which a forecast of time grows [R]
_DEPTH = 0.1


class Forecast:
    """What is left of a sweep.

    `todo` in the order of computing; `ended` cases with their processor seconds; `pace` is the
    seconds that one measured processor second takes here.
    """

    def __init__(
        self,
        todo: Sequence[Case],
        *,
        workers: int,
        ended: Sequence[tuple[Case, float]] = (),
        pace: float = 1.0,
    ) -> None:
        self._workers = max(1, workers)
        self._waiting = {case.id: case for case in todo}
        self._begun: dict[str, tuple[Case, float]] = {}
        level = {case.accuracy.level for case in todo}
        self._seen = [(c, s) for c, s in ended if s > 0.0 and c.accuracy.level in level]
        # processor seconds of this machine leave only what else runs on it to the benchmark
        self._pace = max(1.0, pace) if self._seen else pace
        self._seen = [(case, s * self._pace) for case, s in self._seen]
        self._fit()
        self._begin(0.0)

    def end(self, case: Case, gone_s: float) -> None:
        """Take note that a case ended, `gone_s` seconds after the start."""
        self._waiting.pop(case.id, None)
        if case.id in self._begun:
            _, since = self._begun.pop(case.id)
            # a worker's first case compiles on a new machine, which says nothing of the others
            if since > 0.0:
                self._seen.append((case, max(gone_s - since, 1e-3)))
                self._fit()
        self._begin(gone_s)

    def left_s(self, gone_s: float = 0.0) -> float:
        """Wall time left, `gone_s` seconds after the start [s]."""
        foreseen = [(self.cost_s(case), gone_s - since) for case, since in self._begun.values()]
        under_way = [max(whole - gone, _STILL_TO_GO * whole) for whole, gone in foreseen]
        waiting = [self.cost_s(case) for case in self._waiting.values()]
        both = [*under_way, *waiting]
        return max(sum(both) / self._workers, *both) if both else 0.0

    def _begin(self, gone_s: float) -> None:
        """Cases begin in their order, as soon as a worker is free."""
        for key in list(self._waiting)[: self._workers - len(self._begun)]:
            self._begun[key] = (self._waiting.pop(key), gone_s)

    def cost_s(self, case: Case) -> float:
        """Foreseen seconds of one case: the mean, which lies above the scatter's middle."""
        middle = _measured(case) + float(_features(case) @ self._bend)
        return self._pace * float(np.exp(middle + 0.5 * self._scatter**2))

    def _fit(self) -> None:
        """Bend the measured model towards the cases seen."""
        self._bend, self._scatter = np.zeros(4), 0.0
        if not self._seen:
            return
        A = np.array([_features(case) for case, _ in self._seen])
        y = np.log([s / self._pace for _, s in self._seen])
        y = y - [_measured(case) for case, _ in self._seen]
        self._bend = np.linalg.solve(A.T @ A + np.diag(_PRIOR), A.T @ y)
        self._scatter = min(float((y - A @ self._bend).std()), 0.5)


def pace_of_this_machine() -> float:
    """Seconds that one processor second of the measured costs takes here, from a short benchmark.

    It factorises a sparse matrix of the size of a case's, which is half of a case's work.
    """
    from scipy import sparse
    from scipy.sparse.linalg import splu

    line = sparse.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(120, 120))
    matrix, times = sparse.csc_array(sparse.kronsum(line, line)), []
    for _ in range(5):
        started = time.perf_counter()
        splu(matrix, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
        times.append(time.perf_counter() - started)
    return float(np.median(times)) / _REFERENCE_S


def _measured(case: Case) -> float:
    """Logarithm of the processor seconds measured before, by resolution, depth and pair."""
    deep = float(np.sqrt(min(case.depths[-1] / _DEPTH, 1.0)))
    base = _BASE_S.get(case.accuracy.level.split(",")[0], _BASE_S["production"])
    return float(np.log(base * deep) + _features(case)[1:] @ _SLOPES)


def _features(case: Case) -> Array:
    pair = case.pair
    soft = np.log(pair.E_reduced / pair.Sy_min / 300.0) if np.isfinite(pair.Sy_min) else 0.0
    s = np.log(np.clip(pair.Sy_ratio, 1e-3, 1e3)) if np.isfinite(pair.Sy_ratio) else 0.0
    return np.array([1.0, soft, np.clip(s, 0.0, 1.0), np.clip(-s, 0.0, 1.0)])
