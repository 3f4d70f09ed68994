"""A set's own pair by finite elements: processor time, and how far the closed form carries it.

A hard ball on a mild steel with a yield plateau is solved as a diagnosis solves it; then the same
with the steel 10 % stronger, and 5 % less stiff. The law that is anchored at the first solve is
compared with the other two. Minutes: python tools/benchmarks/bench_own_pair.py
"""

from __future__ import annotations

import time

import numpy as np
from dentscope import fem
from dentscope.campaigns.cases.plateau import ASTM_1016, measured
from dentscope.core import Material, Pair
from dentscope.core.flow import Flow
from dentscope.discrepancy.baseline.solve import solved_table
from dentscope.fem import ContactProblem
from dentscope.models import LAWS
from dentscope.models.anchored import anchored
from dentscope.models.table import PairTable, table_law

R = 1e-3
LOW, HIGH = 0.003, 0.01  # Delta/R of the impacts
BALL = Material(E=210e9, nu=0.29, Sy=2e9)
CURVE = measured(ASTM_1016)
CHANGES = {"strength +10 %": (1.1, 1.0), "modulus -5 %": (1.0, 0.95)}


def pair_of(strength: float, modulus: float, *, curve: bool) -> Pair:
    """Return the ball on the steel, with its flow curve or as a data sheet has it."""
    scaled = CURVE.scaled(strength)
    flow = Flow(scaled) if curve else None
    return Pair(BALL, Material(E=modulus * 203e9, nu=0.29, Sy=scaled.strength, flow=flow), R)


def solve(words: str, strength: float, modulus: float) -> PairTable:
    """Solve a pair and say what it took."""
    pair = pair_of(strength, modulus, curve=True)
    start = time.process_time()
    table = solved_table(pair, LOW, HIGH, level="quick")
    print(f"{words}: {time.process_time() - start:.1f} processor s", flush=True)
    return table


def main() -> None:
    """Solve three pairs and compare."""
    tiny = ContactProblem(pair_of(1.0, 1.0, curve=True), depths=(1e-5, 1e-4))
    fem.solve(tiny, accuracy=fem.Accuracy.smoke())  # compiles
    base = solve("as stated", 1.0, 1.0)
    law = anchored(
        LAWS["fitted"], table_law([base], name="finite elements"), at=base.pair,
        stated=pair_of(1.0, 1.0, curve=False), deepest=float(base.curve.depth[-1]), hardens=True,
    )  # fmt: skip
    depth = np.geomspace(0.1 * HIGH, 1.2 * HIGH, 20) * R
    for words, change in CHANGES.items():
        table = solve(words, *change)
        exact, pair = table_law([table], name="second solve"), pair_of(*change, curve=False)
        for name, of in (
            ("force", lambda law, pair: law.loading(pair, depth)),
            ("radius", lambda law, pair: law.contact_radius(pair, depth)),
            ("dent", lambda law, pair: sum(law.residual(pair, depth))),
        ):
            off = 100.0 * np.abs(of(law, pair) / of(exact, table.pair) - 1.0)
            moved = 100.0 * np.mean(of(exact, table.pair) / of(law, pair_of(1.0, 1.0, curve=False)))
            print(
                f"  {name}: moves {moved - 100.0:+.2f} %, carried within {off.mean():.2f} % in the "
                f"mean, {off.max():.2f} % at most", flush=True,
            )  # fmt: skip


if __name__ == "__main__":
    main()
