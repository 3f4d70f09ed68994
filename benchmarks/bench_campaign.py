"""Scaling of a campaign from one to two workers, and what the store costs a case.

Run it on a machine with two free cores: other work shows up as lost scaling.
"""

import tempfile
import time
from pathlib import Path

from dentscope import fem
from dentscope.campaigns import Design, Store, run_design, standard_case
from dentscope.campaigns.designs import pair_of
from dentscope.campaigns.executor import LocalExecutor

CASES = 6


def made():
    return tuple(
        standard_case(
            f"bench-{k}",
            pair_of(E_s=200.0, E_f=200.0, Sy_min=300.0 + k, ratio=1.5),
            deepest=0.004,
            n_depths=12,
            accuracy=fem.Accuracy.smoke(),
        )
        for k in range(CASES)
    )


def wall(workers, folder):
    path, design = Path(folder) / f"{workers}.h5", Design("bench", "", made)
    started = time.perf_counter()
    status = run_design(design, path, executor=LocalExecutor(workers=workers), time_limit_s=600.0)
    assert status.done == CASES
    return time.perf_counter() - started, path


def main():
    with tempfile.TemporaryDirectory() as folder:
        wall(2, Path(folder) / "warm")  # compiled code is on disk from here on
        one, path = wall(1, folder)
        two, _ = wall(2, folder)
        records = Store(path).read_all()
        cpu = sum(r.counters["cpu_s"] for r in records) / CASES
        started = time.perf_counter()
        Store(path).read_all()
        read = (time.perf_counter() - started) / CASES
        print(
            f"{CASES} cases of {cpu:.1f} processor s: {one:.1f} s with 1 worker, {two:.1f} with 2"
        )
        print(f"scaling 1 -> 2 workers: {one / two:.2f}; of it, starting the workers is included")
        print(f"file: {path.stat().st_size / CASES / 1e3:.0f} kB and {read * 1e3:.1f} ms a case")


if __name__ == "__main__":
    main()
