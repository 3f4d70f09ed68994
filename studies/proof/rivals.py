"""What simple rules and the diagnosis said of the same sets, counted against the truths and paired.

The lines are those of `studies.peers.compare`; nothing here knows how a rule works.
"""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.stats import binomtest

from ...core.arrays import Array, Indices
from .case import interval, state_of

DIAGNOSIS = "diagnosis"
PEERS = "peers.jsonl"
"""File of the lines in a run's folder."""

LEAST = 0.002
"""Least probability that a truth is taken to have."""

DRAWS = 10_000
"""Bootstrap draws of sets."""

STATED = (0.0, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 1.0)
"""Edges of the ranges of a leader's probability."""

BASELINE, OUTSIDE, ANOTHER_PAIR = "baseline", "outside-library", "another pair"
"""Explanations that are no mechanism or pair of them."""


class Mark(NamedTuple):
    """How right one decider is on one set; the fields of the plan, 0 or 1 where they are counts.

    `ln_p` and `brier` are of the truth among all explanations, `said` is the leader's probability
    and `front` whether it is the truth.
    """

    front: float
    exact: float
    in_set: float
    null_named: float
    null_alarmed: float
    forced: float
    ln_p: float
    brier: float
    said: float


def names_of(truth: dict[str, Any]) -> tuple[str, ...]:
    """Names of the true explanation of a record, in order; none for a null."""
    return (OUTSIDE,) if truth["kind"] == "outside" else tuple(sorted(truth["mechanisms"]))


def read_lines(run: Path) -> list[dict[str, Any]]:
    """Return the lines of a folder that the same rules made as the last one.

    A line that was cut short is left out.
    """
    path = run / PEERS
    found = []
    for text in path.read_text(encoding="utf-8").splitlines() if path.exists() else ():
        with suppress(ValueError):
            found.append(json.loads(text))
    return list({x["set"]: x for x in found if x["source"] == found[-1]["source"]}.values())


def mark_of(line: dict[str, Any], decider: str) -> Mark:
    """Judge what one decider said of a set."""
    said, truth = line["said"][decider], tuple(line["truth"])
    verdict, names = said["verdict"], [tuple(sorted(n)) for n in said["names"]]
    null, outside = not truth, truth == (OUTSIDE,)
    label = BASELINE if null else "+".join(truth)
    if null or outside:
        exact = verdict == ("adequate" if null else OUTSIDE)
    else:
        exact = verdict == "missing-physics" and names == [truth]
    named = bool(names)
    p, brier, said_p, front = _probabilities(said["odds"], label, int(line["acting"]))
    return Mark(
        float(front), float(exact), float(exact or truth in names), float(null and named),
        float(null and (named or verdict == OUTSIDE)), float(outside and named),
        math.log(max(p, LEAST)), brier, said_p,
    )  # fmt: skip


def _probabilities(
    odds: dict[str, float], label: str, acting: int
) -> tuple[float, float, float, bool]:
    """Probability of the truth, Brier score, the leader's probability, and whether it is true.

    `another pair` is shared by the pairs of the acting mechanisms that have none of their own.
    """
    own = {"+".join(sorted(k.split("+"))): float(p) for k, p in odds.items() if k != ANOTHER_PAIR}
    pairs = acting * (acting - 1) // 2 - sum("+" in k for k in own)
    each = float(odds.get(ANOTHER_PAIR, 0.0)) / pairs if pairs > 0 else 0.0
    p = own.get(label, each if "+" in label else 0.0)
    brier = sum(x**2 for x in own.values()) + max(pairs, 0) * each**2 + (1.0 - p) ** 2 - p**2
    lead = max(own, key=lambda k: own[k], default="")
    return p, brier, own.get(lead, 0.0), bool(own) and lead == label


def compare(lines: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return the scores of the diagnosis and of every rule, and what separates them.

    Returned: `sets`, `failed`, `nulls`, `outside` counts; `rows`, each with `name`, the sums of
    `Mark`'s counts, means of `ln_p`, `brier`, `said`, `seconds`, `ranges` of what is said, and of
    the rules `front_less`, `ln_p_less` (diagnosis less rule, 95 % interval) and `mcnemar`.
    """
    deciders = [DIAGNOSIS, *(k for k in lines[0]["said"] if k != DIAGNOSIS)] if lines else []
    marks = {d: np.array([mark_of(x, d) for x in lines]) for d in deciders}
    draws = draws_of(len(lines))
    rows = []
    for name in deciders:
        row: dict[str, Any] = {"name": name, "seconds": _seconds(lines, name)}
        for k, column in zip(Mark._fields, marks[name].T, strict=True):
            counted = k not in ("ln_p", "brier", "said")
            row[k] = int(np.sum(column)) if counted else float(np.mean(column))
        row["ranges"] = _ranges(marks[name])
        if name != DIAGNOSIS:
            away = marks[DIAGNOSIS] - marks[name]
            row["front_less"] = mean_with_interval(away[:, Mark._fields.index("front")], draws)
            row["ln_p_less"] = mean_with_interval(away[:, Mark._fields.index("ln_p")], draws)
            row["mcnemar"] = _mcnemar(away[:, Mark._fields.index("front")])
        rows.append(row)
    return {
        "sets": len(lines), "failed": sum(bool(x.get("failed")) for x in lines),
        "nulls": sum(not x["truth"] for x in lines),
        "outside": sum(x["truth"] == [OUTSIDE] for x in lines), "rows": rows,
    }  # fmt: skip


def _seconds(lines: Sequence[dict[str, Any]], name: str) -> float:
    of = DIAGNOSIS if name == DIAGNOSIS else "rules"
    return float(np.mean([x["seconds"][of] for x in lines]))


def draws_of(sets: int) -> Indices:
    """Bootstrap draws of so many sets, (draws, sets)."""
    return np.random.default_rng(0).integers(0, max(sets, 1), (DRAWS, sets))


def mean_with_interval(values: Array, draws: Indices) -> tuple[float, float, float]:
    """Mean of a score, or of what paired scores differ by, with its 95 % interval over draws."""
    means = values[draws].mean(axis=1)
    low, high = np.percentile(means, [2.5, 97.5])
    return float(np.mean(values)), float(low), float(high)


def _mcnemar(away: Array) -> float:
    """McNemar's exact p of paired successes, from their differences (-1, 0 or 1)."""
    won, lost = int(np.sum(away > 0)), int(np.sum(away < 0))
    return float(binomtest(won, won + lost, 0.5).pvalue) if won + lost else 1.0


def _ranges(marks: Array) -> list[tuple[float, float, float, int, int]]:
    """(low, high, mean said, true, sets) of each range of the leader's probability with sets."""
    said, front = (marks[:, Mark._fields.index(k)] for k in ("said", "front"))
    found = []
    for low, high in itertools.pairwise(STATED):
        here = (said >= low) & ((said < high) | (high == 1.0))
        if here.any():
            mean, hits = float(np.mean(said[here])), int(np.sum(front[here]))
            found.append((low, high, mean, hits, int(np.sum(here))))
    return found


def best_peer(found: dict[str, Any]) -> dict[str, Any]:
    """The rule with most truths in front; of several the one with the larger mean ln p."""
    peers: list[dict[str, Any]] = [r for r in found["rows"] if r["name"] != DIAGNOSIS]
    return max(peers, key=lambda r: (r["front"], r["ln_p"]))


def rival_lines(found: dict[str, Any]) -> list[str]:
    """The tables of the page."""
    if not found.get("rows"):
        return []
    n = found["sets"]
    lines = [
        "", "### Against simple rules", "",
        f"On {n} of the sets, {found['nulls']} of them nulls and {found['outside']} outside "
        "(`dentscope proof peers`). *In front*: the truth is the most probable of all. *Nulls*: "
        "named, and with those called outside. *Forced*: names of what is outside. *s*: processor "
        "seconds, of all rules together. The rules are those of the [plan](proof-plan.md); their "
        f"fits failed on {found['failed']}.", "",
        *score_rows(found),
        "", "The diagnosis less each of the two best, on the same sets, with 95 % intervals:", "",
        *less_rows(found | {"rows": best_rules(found)}), "",
        *verdict_lines(best_peer(found), found["rows"][0], n), "",
        "What leads, how often it is the truth:", "", f"| said | {DIAGNOSIS} |", "| --- | --- |",
    ]  # fmt: skip
    own = sorted(found["rows"][0]["ranges"])
    return lines + [f"| {low:g} to {high:g} | {_of_range(x)} |" for low, high, *x in own]


def best_rules(found: dict[str, Any]) -> list[dict[str, Any]]:
    """The two rules with the most truths in front."""
    rules = (r for r in found["rows"] if r["name"] != DIAGNOSIS)
    return sorted(rules, key=lambda r: -int(r["front"]))[:2]


def score_rows(found: dict[str, Any]) -> list[str]:
    """The table of what each decider scores."""
    head = "in front | exact | in the set | nulls | forced | mean ln p | Brier | said, true | s |"
    return [
        f"| | {head}", "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
        *(
            f"| {r['name']} | {r['front']} | {r['exact']} | {r['in_set']} | "
            f"{r['null_named']}, {r['null_alarmed']} | {r['forced']} | {r['ln_p']:.2f} | "
            f"{r['brier']:.3f} | {r['said']:.2f}, {r['front'] / found['sets']:.2f} | "
            f"{r['seconds']:.1f} |"
            for r in found["rows"]
        ),
    ]  # fmt: skip


def less_rows(found: dict[str, Any]) -> list[str]:
    """The table of the paired differences."""
    return [
        "| less | in front, points | McNemar p | mean ln p |", "| --- | --- | --- | --- |",
        *(
            f"| {r['name']} | {_pair(r['front_less'], 100.0, 1)} | {r['mcnemar']:.2g} | "
            f"{_pair(r['ln_p_less'], 1.0, 2)} |"
            for r in found["rows"] if r["name"] != DIAGNOSIS
        ),
    ]  # fmt: skip


def told(line: dict[str, Any]) -> str:
    """One set in a line: the truth, and what everyone says."""
    said = "; ".join(
        f"{k}: {v['verdict']} {' or '.join('+'.join(n) for n in v['names'])}".rstrip()
        for k, v in line["said"].items()
    )
    return f"{line['set']}  {'+'.join(line['truth']) or 'nothing'} | {said}"


def report(lines: Sequence[dict[str, Any]]) -> list[str]:
    """The comparison as lines of text, for a terminal."""
    if not lines:
        return ["no sets"]
    found = compare(lines)
    n = found["sets"]
    width = max(len(r["name"]) for r in found["rows"])
    head = "in front  exact  in set  nulls named  forced  mean ln p  said  true"
    text = [f"{'':<{width}}  {head}  of {n}"]
    for r in found["rows"]:
        less = ""
        if "front_less" in r:
            less = f"  diagnosis {_pair(r['front_less'], 100.0, 1)} points in front"
        text.append(
            f"{r['name']:<{width}}  {r['front']:>8}  {r['exact']:>5}  {r['in_set']:>6}  "
            f"{r['null_named']:>11}  {r['forced']:>6}  {r['ln_p']:>9.2f}  {r['said']:.2f}  "
            f"{r['front'] / n:.2f}{less}"
        )
    rules = found["rows"][1]["seconds"]
    text.append(
        f"{found['rows'][0]['seconds']:.1f} processor seconds a diagnosis, {rules:.1f} all rules"
    )
    return text


def verdict_lines(best: dict[str, Any], own: dict[str, Any], sets: int) -> list[str]:
    """What the plan's marks came to, by the rule of all other marks."""
    told = []
    for what, key, least in (("4 points in front", "front_less", 0.04),
                             ("0.2 in mean ln p", "ln_p_less", 0.2)):  # fmt: skip
        _, low, high = best[key]
        told.append(f"{what}: {state_of(low, high, least=least)}")
    away = abs(own["said"] - own["front"] / sets)
    return [f"Best rule: {best['name']}. Primary mark, {told[0]}. {told[1]}. What is said of the "
            f"leader and how often it is true: {away:.2f} apart (mark: at most 0.05)."]  # fmt: skip


def _pair(found: Sequence[float], times: float, digits: int) -> str:
    mean, low, high = (f"{times * x:.{digits}f}" for x in found)
    return f"{mean} ({low} to {high})"


def _of_range(found: Sequence[Any]) -> str:
    mean, hits, n = found
    low, high = interval(hits, n)
    return f"{mean:.2f}: {hits / n:.2f} ({hits} of {n}; {low:.2f} to {high:.2f})"
