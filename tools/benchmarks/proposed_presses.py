"""Presses that `next_experiment` proposes, made: what becomes of the entropy on open sets.

    python tools/benchmarks/proposed_presses.py build/proposed --count 20

Concealed sets as `power_of_presses.py` draws them, until so many leave the choice open and offer
presses. Made are the presses that are offered, by the generator without its rate, and beside them
the best trial that is offered; each set is then diagnosed anew. One file a set, so that it may be
stopped.
"""

import argparse
import csv
import json
import math
import shutil
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from dentscope.discrepancy import diagnose
from dentscope.recordings import read
from dentscope.studies.proof.generators import parameters as at
from dentscope.studies.proof.generators.folder import write_set
from dentscope.studies.proof.generators.simulate import results_of
from dentscope.studies.proof.generators.truth import Truth
from power_of_presses import KINDS, SEED, mark_of, static_rows, truth_of, write_presses

LEAST = 0.2  # nats of entropy below which there is nothing to tell apart
LOADS = 4  # of a series that is offered
SPEEDS = np.geomspace(0.02, 40.0, 60)  # m/s, of the impacts that presses are read from
_TRIALS = 3


class Trial(NamedTuple):
    """A striker's name, its normal speed [m/s] and angle [degrees]."""

    striker: str
    speed: float
    angle: float


def entropy(verdict: dict[str, Any]) -> float:
    """Entropy of a verdict's probabilities [nats]."""
    p = np.array([float(x) for x in verdict["probabilities"].values()])
    p = p[p > 0.0] / p.sum()
    return float(-np.sum(p * np.log(p)))


def with_trials(truth: Truth, folder: Path, trial: Trial, out: Path) -> Path:
    """Copy a set and add trials of its truth to it."""
    rig = truth.rig
    which = [s.name for s in rig.strikers].index(trial.striker)
    angle, speed = np.full(_TRIALS, math.radians(trial.angle)), np.full(_TRIALS, trial.speed)
    slides = np.any(rig.tangential)
    more = replace(
        rig, which=np.full(_TRIALS, which, dtype=np.intp), angle=angle, speed=speed,
        tangential=-speed / np.tan(angle) if slides else np.zeros(_TRIALS),
        temperature=rig.temperature[:_TRIALS],
    )  # fmt: skip
    instrument = replace(truth.instrument, seed=truth.instrument.seed + 7)
    shutil.copytree(folder, out)
    with tempfile.TemporaryDirectory() as place:
        added = Path(place) / "set"
        write_set(replace(truth, rig=more, instrument=instrument), added, name=folder.name)
        head, *rows = _rows(added)
    before = _rows(out)
    assert before[0] == head
    for k, row in enumerate(rows, start=len(before)):
        row[head.index("trial")], row[head.index("order")] = f"t{k:03d}", str(k)
    with (out / "trials.csv").open("w", newline="", encoding="utf-8") as stream:
        csv.writer(stream, lineterminator="\n").writerows([*before, *rows])
    return out


def _rows(folder: Path) -> list[list[str]]:
    with (folder / "trials.csv").open(newline="", encoding="utf-8") as stream:
        return list(csv.reader(stream))


def offered(found: dict[str, Any], kind: str) -> dict[str, Any] | None:
    """The best proposal of a kind."""
    first = found["next_experiment"]
    every = [first, *first["others"]]
    return next((p for p in every if p.get("kind") == kind), None)


def pressed(truth: Truth, folder: Path, out: Path, told: dict[str, Any], number: int) -> Path:
    """Copy a set and add the presses that are offered."""
    shutil.copytree(folder, out)
    names = [s.name for s in truth.rig.strikers]
    own = int(np.flatnonzero(truth.rig.which == names.index(told["striker"]))[0])
    table = np.repeat(static_rows(truth)[own : own + 1], len(SPEEDS), axis=0)
    table[:, at.NORMAL_SPEED] = SPEEDS
    seen = [mark_of(row, x) for row, x in zip(table, results_of(table), strict=True)]
    force = np.log([m["load_N"] for m in seen])
    marks = []
    for load in np.geomspace(told["least_load_N"], told["load_N"], LOADS):
        mark = {
            name: float(np.exp(np.interp(np.log(load), force, np.log([m[name] for m in seen]))))
            for name in seen[0]
        }
        marks.append(mark)
    write_presses(out, told["striker"], marks, np.random.default_rng([SEED, 98, number]))
    return out


def measure(kind: str, number: int, out: Path) -> dict[str, Any]:
    """Diagnose one concealed case; where it is open and presses are offered, make them."""
    truth, folder = truth_of(kind, number), out / f"{kind}-{number:02d}"
    write_set(truth, folder, name=folder.name)
    found = diagnose(read(folder), seed=0).to_dict()
    press, trial = offered(found, "press"), offered(found, "trial")
    record: dict[str, Any] = {
        "kind": kind, "verdict": found["verdict"], "before": entropy(found),
        "first": found["next_experiment"].get("kind"), "open": False,
    }  # fmt: skip
    is_open = found["verdict"] in ("undetermined", "indistinguishable")
    if not is_open or record["before"] < LEAST or press is None:
        return record
    again = pressed(truth, folder, out / f"{folder.name}-pressed", press["trial"], number)
    record |= {"open": True, "expected": press["information_nats"],
               "pressed": entropy(diagnose(read(again), seed=0).to_dict())}  # fmt: skip
    if trial is not None:
        t = trial["trial"]
        struck = with_trials(
            truth, folder, Trial(t["striker"], t["speed_m_s"], t["angle_deg"]),
            out / f"{folder.name}-struck",
        )  # fmt: skip
        record |= {"expected_of_trial": trial["information_nats"],
                   "struck": entropy(diagnose(read(struck), seed=0).to_dict())}  # fmt: skip
    return record


def told(records: list[dict[str, Any]]) -> str:
    """The table."""
    asked = [r for r in records if r["open"]]
    both = [r for r in asked if "struck" in r]

    def mean(name: str, of: list[dict[str, Any]]) -> float:
        return float(np.mean([r[name] for r in of])) if of else float("nan")

    first = [r for r in asked if r["first"] == "press"]
    return "\n".join([
        f"{len(records)} sets, {len(asked)} open with presses offered, {len(first)} as first",
        f"entropy {mean('before', asked):.2f} before, {mean('pressed', asked):.2f} with them; "
        f"expected to fall by {mean('expected', asked):.2f}",
        f"where they came first: {mean('before', first):.2f}, {mean('pressed', first):.2f}, by "
        f"{mean('expected', first):.2f}",
        f"beside the best trial, {len(both)} sets: {mean('before', both):.2f} before, "
        f"{mean('pressed', both):.2f} with presses, {mean('struck', both):.2f} with three trials "
        f"(expected to fall by {mean('expected_of_trial', both):.2f}); presses lower in "
        f"{sum(r['pressed'] < r['struck'] for r in both)}",
    ])  # fmt: skip


def main() -> None:
    """Go on with the sets, then print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--count", type=int, default=20)
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    records: list[dict[str, Any]] = []
    job = 0
    while sum(r["open"] for r in records) < given.count:
        kind, number = list(KINDS)[job % len(KINDS)], job // len(KINDS)
        path = given.out / f"{kind}-{number:02d}.json"
        if not path.exists():
            path.write_text(json.dumps(measure(kind, number, given.out)) + "\n", encoding="utf-8")
        records.append(json.loads(path.read_text(encoding="utf-8")))
        print(f"{kind} {number}: {records[-1]}", flush=True)
        job += 1
    print(told(records))


if __name__ == "__main__":
    main()
