"""What following the proposals brings: sets that answer, diagnosed again after each session.

`python -m dentscope.studies.challenge.loop FOLDER` goes on where it stopped. Every set begins with
a first session; two further ones of two hours each are what the verdict proposes, more of what was
done, or random trials within the rig.
"""

from __future__ import annotations

import argparse
import json
import math
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import as_completed
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...core.arrays import Array
from ...core.output import csv_text, write_file
from ...discrepancy import diagnose
from ...discrepancy.findings import Verdict
from ...discrepancy.rules import RULES
from ...recordings import read
from ...recordings.adding import add_trials
from ..proof.rivals import draws_of, mean_with_interval
from ..proof.run import local_workers
from ..third_world.asked import Asked, answer, begun, possible
from ..third_world.benches import TOLERANCE
from ..third_world.draw import NULLS, PAIRS, Truth, draw
from ..third_world.sheet import write
from .ask import FIRST

WAYS = ("proposal", "more of the same", "random")
"""How a session is chosen."""

_SESSIONS = 2
_STRENGTHS = ("work-hardening", "hardened-layer", "size-effect", "thermal-softening")
_WRONG = (("Sy_Pa", 0.6), ("Sy_Pa", 0.75), ("Sy_Pa", 1.35), ("Sy_Pa", 1.6), ("mass_kg", 1.15),
          ("tip_radius_m", 2.0))  # fmt: skip
"""What a wrong sheet states: the flat's strength, or a striker's mass or radius, times so much."""


class Entry(NamedTuple):
    """One set: kind of the list, what is drawn, and a wrong number of its sheet."""

    number: int
    kind: str
    effect: str = ""
    wrong: tuple[str, float] | None = None

    @property
    def name(self) -> str:
        """Says nothing of what the set conceals."""
        return f"loop-{self.number:03d}"


def entries() -> list[Entry]:
    """40 rates, 20 other strengths, 20 pairs, 20 wrong numbers, 20 with nothing; a fair order."""
    deep = [n for n in NULLS if n not in ("elastic", "beads")]
    kinds: list[tuple[Any, ...]] = [("rate", "strain-rate-hardening")] * 40
    kinds += [("strength", _STRENGTHS[k % 4]) for k in range(20)]
    kinds += [("pair", "+".join(PAIRS[k % len(PAIRS)][1:])) for k in range(20)]
    kinds += [("wrong", deep[k % len(deep)], _WRONG[k % len(_WRONG)]) for k in range(20)]
    kinds += [("nothing", NULLS[k % len(NULLS)]) for k in range(20)]
    order = np.random.default_rng(0).permutation(len(kinds))
    return [Entry(int(k), *kinds[k]) for k in order]


def drawn(seed: int, entry: Entry) -> Truth:
    """The set of an entry with its first session."""
    rng = np.random.default_rng([seed, entry.number])
    known = {"nothing": "null", "wrong": "null", "pair": "pair"}
    truth = draw(rng, known.get(entry.kind, "single"), entry.effect)
    return replace(truth, rig=begun(rng, truth.rig, most=FIRST))


def key_of(truth: Truth, what: str) -> str:
    """Key of a number in set.toml: of the flat, or of the first striker."""
    striker = truth.rig.strikers[0].name
    return f"target.{what}" if what == "Sy_Pa" else f"strikers.{striker}.{what}"


def restated(text: str, key: str, new: Callable[[float, float], tuple[float, float]]) -> str:
    """Return a sheet with another value and standard deviation of a number."""
    table, word = key.rsplit(".", 1)
    lines, here = text.split("\n"), ""
    for k, line in enumerate(lines):
        here = line.strip("[]").replace('"', "") if line.startswith("[") else here
        if here == table and line.startswith(f"{word} = "):
            said = (float(x.split("=")[1]) for x in line.split("{")[1].strip(" }").split(","))
            value, std = new(*said)
            lines[k] = f"{word} = {{ value = {value:.6g}, std = {std:.3g} }}"
    return "\n".join(lines)


def right(entry: Entry, truth: Truth) -> str:
    """Name of the true explanation, as verdicts have it."""
    if entry.wrong is None:
        return "+".join(sorted(e.name for e in truth.effects)) or "baseline"
    return f"wrong-input:{key_of(truth, entry.wrong[0])}"


def proposed(verdict: Verdict, truth: Truth) -> list[Asked]:
    """Trials of the session that a verdict proposes, in the words of the rig."""
    spans = possible(truth.rig)
    warm = float(np.median(truth.rig.temperature))
    found: list[Asked] = []

    def within(what: str, value: str | float) -> float:
        return float(np.clip(float(value), *spans[what]))

    for step in verdict.session.steps:
        t = step.trial
        if step.kind == "press":
            one = Asked(str(t["striker"]), 0.0, 90.0, warm, within("load", t["load_N"]))
        elif step.kind == "trial":
            speed, angle = within("speed", t["speed_m_s"]), within("angle", t["angle_deg"])
            one = Asked(str(t["striker"]), speed, angle, warm)
        else:
            continue
        found += [one] * round(float(t["repeats"]))
    return found


def other(way: str, truth: Truth, rng: np.random.Generator) -> list[Asked]:
    """A session of trials that nobody thought about."""
    rig, spans = truth.rig, possible(truth.rig)
    struck = np.flatnonzero(rig.load == 0.0)
    count = int(RULES.session / dict(RULES.minutes)["strike"])
    found = []
    for _ in range(count):
        i = int(rng.choice(struck))
        speed, angle = float(rig.speed[i]), math.degrees(rig.angle[i])
        if way == "random":
            speed = float(np.exp(rng.uniform(*np.log(spans["speed"]))))
            angle = float(rng.uniform(*spans["angle"]))
        found.append(
            Asked(rig.strikers[rig.which[i]].name, speed, angle, float(rig.temperature[i]))
        )
    return found


def measured_again(text: str, truth: Truth, key: str, rng: np.random.Generator) -> str:
    """The sheet where a number is measured again: the mean, or the new one where they disagree."""
    table, word = key.rsplit(".", 1)
    kind, tolerance = {"Sy_Pa": ("hardness", "strength"), "mass_kg": ("weigh", "mass"),
                       "tip_radius_m": ("calliper", "tip")}[word]  # fmt: skip
    body = {s.name: s for s in truth.rig.strikers}.get(table.removeprefix("strikers."))
    metal = truth.rig.flat if body is None else body.metal
    value = getattr(body, {"mass_kg": "mass", "tip_radius_m": "tip_radius"}.get(word, ""), metal.Sy)
    # of a striker's strength the sheet says what is
    off = 0.0 if metal is not truth.rig.flat and word == "Sy_Pa" else truth.z.get(tolerance, 0.0)
    error = dict(RULES.settled)[kind]
    value *= (1.0 + TOLERANCE[tolerance] * off) * (1.0 + error * float(rng.normal()))

    def both(said: float, std: float) -> tuple[float, float]:
        if abs(said - value) > 3.0 * math.hypot(std, error * value):
            return value, error * value
        weights = np.array([std**-2, (error * value) ** -2])
        return float(weights @ [said, value] / weights.sum()), float(weights.sum() ** -0.5)

    return restated(text, key, both)


def followed(folder: Path, entry: Entry, seed: int) -> dict[str, Any]:
    """Go through the sessions of one set, each way; return what was said after each."""
    truth = drawn(seed, entry)
    first = folder / entry.name / "first"
    shutil.rmtree(folder / entry.name, ignore_errors=True)
    write(truth, first, name=entry.name)
    if entry.wrong is not None:
        what, factor = entry.wrong
        text = (first / "set.toml").read_text(encoding="utf-8")
        text = restated(text, key_of(truth, what), lambda x, std: (x * factor, std * factor))
        write_file(first / "set.toml", text)
    begin = diagnose(read(first), history=False)
    said: dict[str, list[Any]] = {}
    for way in WAYS:
        label = right(entry, truth)
        rng = np.random.default_rng([seed, entry.number, WAYS.index(way) + 1])
        place, verdict = folder / entry.name / way.replace(" ", "-"), begin
        before: list[Asked] = []
        shutil.copytree(first, place)
        said[way] = [_said(verdict, label, 0.0)]
        for _ in range(_SESSIONS):
            if way != WAYS[0]:
                asked, minutes = other(way, truth, rng), RULES.session
            elif not verdict.session.goes_on:
                break
            else:
                asked, minutes = proposed(verdict, truth), verdict.session.minutes
                text = (place / "set.toml").read_text(encoding="utf-8")
                for key in (str(s.trial["key"]) for s in verdict.session.steps if "key" in s.trial):
                    text = measured_again(text, truth, key, rng)
                    # a sheet that was put right is what it should be
                    label = "baseline" if label == f"wrong-input:{key}" else label
                write_file(place / "set.toml", text)
            if asked:
                table = answer(truth, asked, before=before)
                write_file(place / "new.csv", csv_text(table[1:], header=table[0]))
                add_trials(place, place / "new.csv")
                before += asked
            verdict = diagnose(read(place), history=False)
            said[way].append(_said(verdict, label, minutes))
    return {"set": entry.name, "kind": entry.kind, "truth": right(entry, truth),
            "sizes": list(truth.sizes), "said": said}  # fmt: skip


def _said(verdict: Verdict, label: str, minutes: float) -> dict[str, Any]:
    odds = {"+".join(sorted(k.split("+"))): p for k, p in verdict.probabilities.items()}
    lead = max(odds, key=lambda k: odds[k])
    return {
        "verdict": verdict.choice.verdict, "front": lead == label, "p": odds.get(label, 0.0),
        "minutes": round(minutes, 1),
    }  # fmt: skip


def shown(found: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """Yield what was said, a line a way of choosing and session."""
    draws = draws_of(len(found))
    kinds = sorted({str(one["kind"]) for one in found})
    fronts: dict[str, Array] = {}
    for way in WAYS:
        for k in range(_SESSIONS + 1):
            at = [one["said"][way][: k + 1] for one in found]
            front = np.array([float(x[-1]["front"]) for x in at])
            fronts[f"{way} {k}"] = front
            unclear = sum(x[-1]["verdict"] == "undetermined" for x in at)
            p = [math.log(max(x[-1]["p"], 0.002)) for x in at]
            hours = sum(x["minutes"] for one in at for x in one) / len(found) / 60.0
            own = {kind: np.array([one["kind"] == kind for one in found]) for kind in kinds}
            by = ", ".join(f"{kind} {front[own[kind]].sum():.0f}" for kind in kinds)
            yield (f"{way}, {k} sessions: {front.sum():.0f} of {len(found)} in front ({by}), "
                   f"{unclear} undetermined, ln p {np.mean(p):.2f}, {hours:.1f} h")  # fmt: skip
    for way in WAYS[1:]:
        more = fronts[f"{WAYS[0]} {_SESSIONS}"] - fronts[f"{way} {_SESSIONS}"]
        mean, low, high = mean_with_interval(more, draws)
        yield f"{WAYS[0]} over {way}: {mean:.2f} ({low:.2f} to {high:.2f}) of the sets in front"


def _each(folder: Path, todo: Sequence[Entry], seed: int) -> Iterator[dict[str, Any]]:
    with local_workers(2) as workers:
        waiting = {workers.submit(followed, folder, e, seed): e for e in todo}
        for done in as_completed(waiting):
            try:
                yield done.result()
            except Exception as e:
                yield {"set": waiting[done].name, "failed": repr(e)}


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--most", type=int, default=120)
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    path = given.folder / "rounds.jsonl"
    lines = path.read_text().splitlines() if path.exists() else []
    done = {json.loads(x)["set"] for x in lines}
    todo = [e for e in entries()[: given.most] if e.name not in done]
    for one in _each(given.folder, todo, given.seed):
        with path.open("a") as stream:
            stream.write(json.dumps(one) + "\n")
        print(one["set"], one.get("truth", one.get("failed")), flush=True)  # noqa: T201
    told = [json.loads(x) for x in path.read_text().splitlines()]
    for line in shown([one for one in told if "said" in one]):
        print(line)  # noqa: T201


if __name__ == "__main__":
    main()
