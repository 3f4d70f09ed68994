"""What the proposed experiment brings, against a random one that the rig could do as well.

`python -m dentscope.studies.proof.follow RUN --most 20`, once verdicts are sealed and opened: three
more trials of the concealed truth are added to a set, once as proposed, once at a striker, speed
and angle drawn from those of the rig; both sets are diagnosed, and the entropy of the probabilities
is compared with that of the sealed verdict. Results go to RUN/follow.jsonl, a line each.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import shutil
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .apart import answer
from .case import Case, open_run
from .generators.folder import write_set
from .generators.truth import Truth
from .lists import LISTS, Entry, shuffled
from .run import draw_entry
from .score import next_of
from .seal import Ledger

_TRIALS = 3
_LEAST = 0.2  # nats of entropy below which there is nothing to tell apart
_APART = ("balls-heated",)  # what a trial there would need is more than strikers, speeds and angles


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


def open_questions(cases: list[Case]) -> list[Case]:
    """Cases with something to tell apart, whose proposal is a trial with the rig's own bodies.

    Where the verdict is that nothing is missing, or one name, rivals have a few per cent each, and
    no three trials take them away: asked are the sets that leave the choice open.
    """
    return [
        c
        for c in cases
        if c.verdict
        and c.said in ("undetermined", "indistinguishable")
        and next_of(c).get("kind") == "trial"
        and c.truth["bench"] not in _APART
        and "mass_factor" not in c.truth
        and entropy(c.verdict) > _LEAST
    ]


def proposed(case: Case) -> Trial:
    """Trial that a verdict proposes."""
    told = next_of(case)["trial"]
    return Trial(str(told["striker"]), float(told["speed_m_s"]), float(told["angle_deg"]))


def at_random(case: Case) -> Trial:
    """Trial drawn from the rig's strikers, speeds and angles; the same for the same set."""
    rng = np.random.default_rng([int(case.name.split("-")[1]), 1])
    low, high = case.truth["speeds"]
    flat, steep = (math.degrees(a) for a in case.truth["angles"])
    return Trial(
        str(rng.choice(case.truth["strikers"])), float(np.exp(rng.uniform(*np.log([low, high])))),
        float(rng.uniform(flat, steep)),
    )  # fmt: skip


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


def follow(run: Path, *, most: int, limit_s: float = 900.0) -> Iterator[dict[str, Any]]:
    """Yield what proposed and random trials bring, for up to `most` sets of a run.

    Parameters
    ----------
    run
        Folder of a run.
    most
        Number of sets, in the order of the run: a part is a fair sample.
    limit_s
        Longest time of a diagnosis [s].
    """
    begin = Ledger(run / "ledger.jsonl").of("begin")[""]
    entries: dict[str, Entry] = {e.name: e for e in shuffled(LISTS[begin["list"]](), begin["tree"])}
    order = {name: k for k, name in enumerate(entries)}
    asked = sorted(open_questions(open_run(run)), key=lambda c: order[c.name])
    for case in asked[:most]:
        truth = draw_entry(begin["tree"], entries[case.name])
        found: dict[str, Any] = {"set": case.name, "before": entropy(case.verdict)}
        for kind, trial in (("proposed", proposed(case)), ("random", at_random(case))):
            with tempfile.TemporaryDirectory() as place:
                folder = with_trials(
                    truth, run / "sets" / case.name, trial, Path(place) / case.name
                )
                told = answer(folder, Path(place) / "out", limit_s)
                path = Path(place) / "out" / "verdict.json"
                found[kind] = entropy(json.loads(path.read_text())) if told.code == 0 else None
        yield found


def brought(lines: list[dict[str, Any]]) -> dict[str, float]:
    """Return by how much entropy falls on the mean, proposed and at random, and their ratio."""
    done = [x for x in lines if x["proposed"] is not None and x["random"] is not None]
    fall = {
        kind: float(np.mean([x["before"] - x[kind] for x in done])) if done else math.nan
        for kind in ("proposed", "random")
    }
    ratio = fall["proposed"] / fall["random"] if done and fall["random"] > 0.0 else math.nan
    return {"sets": float(len(done)), **fall, "ratio": ratio}


def read_lines(run: Path) -> list[dict[str, Any]]:
    """Return what `follow` found for a run; empty where it was not made."""
    path = run / "follow.jsonl"
    return [json.loads(x) for x in path.read_text().splitlines()] if path.exists() else []


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", type=Path)
    parser.add_argument("--most", type=int, default=20)
    given = parser.parse_args()
    with (given.run / "follow.jsonl").open("a", encoding="utf-8") as stream:
        for found in follow(given.run, most=given.most):
            stream.write(json.dumps(found) + "\n")
            stream.flush()


if __name__ == "__main__":
    main()
