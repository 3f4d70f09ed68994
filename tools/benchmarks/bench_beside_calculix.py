"""Processor seconds of fifteen pairs at `production`, CalculiX beside the first of them.

    python tools/benchmarks/bench_beside_calculix.py build/beside --theirs 3

Table 2.1 of the thesis at three strength ratios, loaded to Delta/R = 0.1 in 48 depths, unloaded
from two, with the stated uncertainty. CalculiX (`ccx`) loads the same mesh to the same depths, one
increment or more each, and does not unload. One file a pair, so that it may be stopped.
"""

import argparse
import itertools
import json
import time
from pathlib import Path
from typing import Any

import numpy as np
from dentscope import fem
from dentscope.campaigns.cases.pairs import TABLE_2_1, table_2_1
from dentscope.core import Pair
from dentscope.core.processes.threads import in_one_thread
from dentscope.studies.verification.calculix.deck import Deck, write_deck
from dentscope.studies.verification.calculix.output import measure, solve_deck

DEEPEST, DEPTHS, TURNS = 0.1, 48, (0.03, 0.1)
FINE = fem.Accuracy.production()


def problem_of(pair: Pair, *, turns: tuple[float, ...]) -> fem.ContactProblem:
    """The case; CalculiX's has no unloading."""
    depths = fem.geometric_depths(0.3 * pair.first_yield, DEEPEST, DEPTHS)
    return fem.ContactProblem(pair, tuple(sorted({*depths, *turns})), unload_from=turns)


@in_one_thread
def ours(pair: Pair) -> dict[str, Any]:
    problem, start = problem_of(pair, turns=TURNS), time.process_time()
    found = fem.solve(problem, accuracy=FINE)
    fem.discretisation_uncertainty(found.loading, problem, FINE)
    unit = 1e6 * pair.R**2
    return {
        "ours_s": time.process_time() - start, "outcome": str(found.outcome),
        "delta": (found.loading.delta / pair.R).tolist(),
        "force": (found.loading.force / unit).tolist(),
    }  # fmt: skip


def theirs(pair: Pair) -> dict[str, Any]:
    deck = Deck(problem_of(pair, turns=()), FINE)
    printed, spent = solve_deck(write_deck(deck))
    found = measure(deck, printed)
    return {"theirs_s": spent, "their_delta": found.delta.tolist(),
            "their_force": found.force.tolist()}  # fmt: skip


def told(record: dict[str, Any]) -> str:
    text = f"{record['name']:10s} ours {record['ours_s']:6.1f} s"
    if "theirs_s" not in record:
        return text
    depth = np.array(record["their_delta"])
    off = np.interp(depth, record["delta"], record["force"]) / np.array(record["their_force"]) - 1.0
    return (
        f"{text}   CalculiX {record['theirs_s']:6.0f} s, "
        f"{record['theirs_s'] / record['ours_s']:5.1f} times, to Delta/R {depth[-1]:.3g}; "
        f"F from theirs {100.0 * off.mean():+.2f} % in the mean"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--theirs", type=int, default=15, help="pairs that CalculiX solves too")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    warm = fem.ContactProblem(table_2_1(1, 1.0), (1e-5, 1e-4), unload_from=(1e-4,))
    fem.solve(warm, accuracy=fem.Accuracy.smoke())  # compiles
    records = []
    for k, (number, ratio) in enumerate(itertools.product(TABLE_2_1, (1.0, 10.0, 0.1))):
        name = f"{number}, {ratio:g}"
        path = given.out / f"{number}-{ratio:g}.json"
        pair = table_2_1(number, ratio)
        record = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        if not record or (k < given.theirs and "theirs_s" not in record):
            # both anew: the ratio is of one run
            record = {"name": name, **ours(pair), **(theirs(pair) if k < given.theirs else {})}
            path.write_text(json.dumps(record) + "\n", encoding="utf-8")
        print(told(record), flush=True)
        records.append(record)
    spent = [r["ours_s"] for r in records]
    print(f"{len(spent)} pairs: median {np.median(spent):.1f} s, {min(spent):.1f} to "
          f"{max(spent):.1f} s")  # fmt: skip
    ratios = [r["theirs_s"] / r["ours_s"] for r in records if "theirs_s" in r]
    if ratios:
        print(f"CalculiX over ours, {len(ratios)} pairs: {min(ratios):.1f} to {max(ratios):.1f}")


if __name__ == "__main__":
    main()
