"""Scaling of a campaign from one to two workers, and 16 and 200 cores.

Run it on a machine with two free cores: other work shows up as lost scaling. The projection lays
the cases of the design `full` on the workers in their order, each with the time that the finished
cases of build/campaign foresee for it (without them, the times of docs/performance.md).
"""

import heapq
import os
import sys
import tempfile
import time
from pathlib import Path

from dentscope import fem
from dentscope.campaigns import (
    DESIGNS,
    Design,
    Forecast,
    Store,
    distinct_cases,
    run_design,
    standard_case,
)
from dentscope.campaigns.cases.pairs import pair_of
from dentscope.campaigns.executor import LocalExecutor

CASES = 8
DEPTH = 0.02
PUT_S = 0.1  # of the coordinator, by bench_scale.py
OWN = Path("build/campaign")


def made():
    return tuple(
        standard_case(
            f"bench-{k}",
            pair_of(E_s=200.0, E_f=200.0, Sy_min=300.0 + k, ratio=1.5),
            deepest=DEPTH,
            n_depths=20,
            accuracy=fem.Accuracy.smoke(),
        )
        for k in range(CASES)
    )


def measured(workers, folder):
    """Wall time from the start, from the end of the first round of cases, and the run's folder."""
    path, design, ends = Path(folder) / f"{workers}", Design("bench", "", made), []
    started = time.perf_counter()
    status = run_design(
        design,
        path,
        executor=LocalExecutor(workers=workers),
        time_limit_s=600.0,
        report=lambda step: ends.append(time.perf_counter() - started),
    )
    assert status.done == CASES
    # between the first and the last end of a worker's rounds no worker starts and none is idle
    steady = (ends[-1] - ends[workers - 1]) / (CASES - workers)
    return ends[-1], steady, path


def laid_out(costs, workers):
    """Wall time of costs on workers, in order; the one coordinator stores them one by one."""
    free, stored = [0.0] * workers, 0.0
    for cost in costs:
        end = heapq.heappop(free) + cost
        stored = max(stored, end) + PUT_S
        heapq.heappush(free, end)
    return max(stored, *free)


def projection():
    cases = list(distinct_cases(DESIGNS["full"]).values())
    known = Store(OWN).summaries() if OWN.exists() else []
    ended = [(s.case, s.cpu_s) for s in known if s.status == "done" and not s.stale]
    alike = [pair for pair in ended if pair[0].accuracy.level == cases[0].accuracy.level]
    forecast = Forecast(cases, workers=1, ended=alike)
    costs = [forecast.cost_s(case) for case in cases]
    print(
        f"full: {len(cases)} cases, {sum(costs) / 3600:.1f} processor hours from {len(alike)} "
        f"finished cases; the longest {max(costs) / 60:.1f} min"
    )
    for workers in (2, 16, 200):
        wall = laid_out(costs, workers)
        best = sum(costs) / workers
        print(f"{workers:4} cores: {wall / 3600:.2f} h, {best / wall:.0%} of the ideal")


def main():
    if "--projection" in sys.argv:
        projection()
        return
    with tempfile.TemporaryDirectory() as folder:
        measured(2, Path(folder) / "warm")  # compiled code is on disk from here on
        one, one_steady, path = measured(1, folder)
        two, two_steady, _ = measured(2, folder)
        cpu = sum(r.counters["cpu_s"] for r in Store(path).read_all()) / CASES
        print(f"{CASES} cases of {cpu:.1f} processor s on {os.cpu_count()} cores")
        print(f"{one:.1f} s with 1 worker, {two:.1f} s with 2: {one / two:.2f}, starting included")
        print(f"scaling 1 -> 2 workers once they run: {one_steady / two_steady:.2f} (mark: 1.8)")
    projection()


if __name__ == "__main__":
    main()
