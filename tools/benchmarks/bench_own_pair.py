"""A set's own pair by finite elements: processor time.

A hard ball on a mild steel with a yield plateau, solved as a diagnosis solves it. Minutes:
python tools/benchmarks/bench_own_pair.py
"""

from __future__ import annotations

import time

from dentscope import fem
from dentscope.campaigns.cases.plateau import ASTM_1016, measured
from dentscope.core import Material, Pair
from dentscope.core.flow import Flow
from dentscope.discrepancy.baseline.solve import solved_table

LOW, HIGH = 0.003, 0.01  # Delta/R of the impacts
BALL = Material(E=210e9, nu=0.29, Sy=2e9)
CURVE = measured(ASTM_1016)
STEEL = Material(E=203e9, nu=0.29, Sy=CURVE.strength, flow=Flow(CURVE))


def main() -> None:
    pair = Pair(BALL, STEEL, 1e-3)
    fem.solve(fem.ContactProblem(pair, depths=(1e-5, 1e-4)), accuracy=fem.Accuracy.smoke())
    start = time.process_time()  # all is compiled
    solved_table(pair, LOW, HIGH)
    print(f"{time.process_time() - start:.1f} processor s")


if __name__ == "__main__":
    main()
