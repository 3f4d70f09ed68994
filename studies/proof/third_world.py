"""Sets of the third world: drawn and sealed, diagnosed, compared with the peers, published.

`python -m dentscope.studies.proof.third_world run` goes on with the run of this tree;
`dentscope proof peers FOLDER` adds what the peers say, and `score` publishes. `sample` writes sets
of another seed, with their truths, to look at.
"""

from __future__ import annotations

import argparse
import hashlib
import json
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...core.output import write_file
from ..third_world.draw import NULLS, PAIRS, Truth, draw
from ..third_world.effects import EFFECTS, OUTSIDE
from ..third_world.sheet import write
from .case import open_run
from .rivals import read_lines
from .run import ROOT, alone, conceal, diagnose, local_workers
from .seal import Ledger, digest_of, tree_hash
from .third_world_page import FOUND, kept

PLAN = ROOT / "data" / "proof" / "third-world-plan.md"
"""What is drawn and what counts, written before the run."""


class Entry(NamedTuple):
    """One set of the list."""

    number: int
    kind: str
    effect: str

    @property
    def name(self) -> str:
        """Says nothing of what the set conceals."""
        return f"set-{self.number:03d}"


def entries() -> list[Entry]:
    """50 nulls, 110 singles, 16 pairs, 24 outside."""
    wanted = [("null", NULLS[k % len(NULLS)]) for k in range(50)]
    singles = [name for _ in range(6) for name in EFFECTS]
    wanted += [("single", name) for name in singles[:110]]
    wanted += [("pair", f"{a}+{b}") for _ in range(2) for _, a, b in PAIRS]
    wanted += [("outside", name) for _ in range(6) for name in OUTSIDE]
    return [Entry(k, *one) for k, one in enumerate(wanted)]


def drawn(seed: str, entry: Entry) -> Truth:
    """The concealed set of one entry."""
    text = hashlib.sha256(f"{seed}/third-world/{entry.number}".encode())
    return draw(np.random.default_rng(int.from_bytes(text.digest()[:16], "little")), *entry[1:])


def _conceal(run: Path, seed: str, entry: Entry) -> dict[str, Any]:
    truth = drawn(seed, entry)
    return conceal(run, entry.name, truth.record(), partial(write, truth))


def carry_on(run: Path, *, limit_s: float = 900.0) -> Iterator[tuple[str, dict[str, Any]]]:
    """Go on with a run: draw and seal a set, diagnose it, seal the verdict, in random order."""
    with alone(run):
        yield from _carry_on(run, limit_s)


def _carry_on(run: Path, limit_s: float) -> Iterator[tuple[str, dict[str, Any]]]:
    ledger = Ledger(run / "ledger.jsonl")
    plan, tree = digest_of(PLAN), tree_hash(ROOT)
    begun = ledger.of("begin").get("")
    if begun is None:
        ledger.add(event="plan", set="", plan=plan)
        ledger.add(event="begin", set="", tree=tree, plan=plan)
    elif (begun["tree"], begun["plan"]) != (tree, plan):
        raise ValueError("the tree or the plan is not the one that the run began with")
    done, sealed = ledger.of("verdict"), set(ledger.of("truth"))
    listed = entries()
    order = np.random.default_rng(int(plan[:16], 16)).permutation(len(listed))
    with local_workers(1) as workers:
        for entry in (listed[i] for i in order if listed[i].name not in done):
            if entry.name not in sealed:
                ledger.add(**_conceal(run, f"{plan}/{tree}", entry))
            event = workers.submit(diagnose, run, entry.name, limit_s).result()
            ledger.add(**event)
            yield entry.name, event


def sample(out: Path, seed: str, numbers: list[int]) -> None:
    """Write sets of another seed with their truths."""
    for entry in (e for e in entries() if e.number in numbers):
        _conceal(out, seed, entry)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=("run", "score", "sample"))
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "proof" / "third-world")
    parser.add_argument("--seed", default="trial")
    parser.add_argument("--numbers", type=int, nargs="*", default=[])
    given = parser.parse_args()
    if given.what == "sample":
        sample(given.out, given.seed, given.numbers)
        return
    if given.what == "score":
        begun = Ledger(given.out / "ledger.jsonl").of("begin")[""]
        lines = read_lines(given.out)
        whole = {"plan": begun["plan"], "tree": begun["tree"], "total": len(entries())}
        found = kept(open_run(given.out), lines, **whole)
        write_file(FOUND, json.dumps(found, indent=1) + "\n")
        return
    for name, event in carry_on(given.out):
        state = "sealed" if event["verdict"] else f"no verdict: {event['message']}"
        print(f"{name}  {state}  {event['cpu_s']:.1f} s", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
