"""Speed of the fitted law: a ratio within one run.

    .venv/bin/python tools/benchmarks/bench_fitted_law.py

Times are processor seconds on one core, the best of several runs; the ratio to Jackson and Green's
formula in the same run is what can be compared between machines.
"""

from __future__ import annotations

import time
import timeit

import numpy as np
from dentscope.core import Material, Pair
from dentscope.models import LAWS

COUNT = 1_000_000
PAIR = Pair(Material(E=71.7e9, nu=0.33, Sy=300e6), Material(E=200e9, nu=0.3, Sy=360e6), 1e-3)


def seconds(call) -> float:
    return min(timeit.repeat(call, timer=time.process_time, number=1, repeat=7))


def speed() -> None:
    d = np.geomspace(1e-8, 1e-4, COUNT)
    times = {name: seconds(lambda law=LAWS[name]: law.loading(PAIR, d)) for name in
             ("hertz", "jackson-green", "ghaednia", "fitted")}  # fmt: skip
    base = times["jackson-green"]
    print(f"{COUNT:,} forces of one pair")
    for name, value in times.items():
        print(f"  {name:14s} {value:6.3f} s  {value / base:5.2f} of Jackson-Green")


if __name__ == "__main__":
    speed()
