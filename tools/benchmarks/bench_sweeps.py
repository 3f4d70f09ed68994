"""Processor seconds and memory of a sweep, over bodies, supports and angles, by the default laws.

python tools/benchmarks/bench_sweeps.py

Each combination of tests/physics/test_impact_sweeps_end.py in a process of its own; what takes more
than 20 s of processor or 600 MB, or does not end as it should, is marked.
"""

from __future__ import annotations

import os
import runpy
import sys
from pathlib import Path

SECONDS, BYTES = 20.0, 600e6

_ROOT = Path(__file__).parents[2]
# what it draws imports as the tests do
sys.path.insert(0, str(_ROOT / "tests/faults"))
SWEEPS = runpy.run_path(str(_ROOT / "tests/physics/test_impact_sweeps_end.py"))


def took(case: tuple[str, str, float]) -> tuple[bool, float, float]:
    """Return whether the sweep ended as it should, its processor seconds and its memory [B]."""
    child = os.fork()
    if child == 0:
        try:
            SWEEPS["assert_swept"](*case)
        except BaseException as error:
            sys.stdout.write(f"{case}: {error!r}"[:300] + "\n")
            sys.stdout.flush()
            os._exit(1)
        os._exit(0)
    _, status, used = os.wait4(child, 0)
    return status == 0, used.ru_utime + used.ru_stime, used.ru_maxrss * 1024.0


worst_s, worst_B, failed = 0.0, 0.0, 0
for case in SWEEPS["CASES"]:
    good, seconds, memory = took(case)
    good = good and seconds < SECONDS and memory < BYTES
    failed += not good
    worst_s, worst_B = max(worst_s, seconds), max(worst_B, memory)
    mark = "" if good else "  FAILED"
    sys.stdout.write(f"{case}: {seconds:.1f} s, {memory / 1e6:.0f} MB{mark}\n")
    sys.stdout.flush()
all_ = f"{len(SWEEPS['CASES'])} sweeps, {failed} failed"
sys.stdout.write(f"{all_}: at most {worst_s:.1f} s, {worst_B / 1e6:.0f} MB\n")
sys.exit(failed > 0)
