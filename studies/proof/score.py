"""Open the truths of a run whose verdicts are sealed, and count."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import beta

from .generators.truth import PLANTED
from .same_meaning import comparable
from .seal import Ledger, check

DETECTABLE, LARGE = 10.0, 20.0
"""Sizes above which detection is scored, and above which the gain on held-out trials is."""

_ALARMS = ("missing-physics", "indistinguishable", "outside-library")


@dataclass(frozen=True)
class Case:
    """One set with its truth and what was said of it; `verdict` is empty after a failure."""

    name: str
    truth: dict[str, Any]
    verdict: dict[str, Any]
    event: dict[str, Any]

    @property
    def said(self) -> str:
        """The verdict's kind; a diagnosis that failed counts as undetermined."""
        return str(self.verdict.get("verdict", "undetermined"))

    @property
    def best(self) -> frozenset[str]:
        """Names of the best explanation."""
        return frozenset(self.verdict.get("mechanisms", ()))

    @property
    def reported(self) -> list[frozenset[str]]:
        """Every explanation that is reported, the best first."""
        rest = [frozenset(names) for names in self.verdict.get("alternatives", ())]
        return ([self.best] if self.best else []) + [r for r in rest if r != self.best]

    @property
    def true(self) -> frozenset[str]:
        """Names of what is missing."""
        return frozenset(self.truth["mechanisms"])

    @property
    def named(self) -> bool:
        """Whether a mechanism is named."""
        return self.said in ("missing-physics", "indistinguishable") and bool(self.reported)

    @property
    def size(self) -> float:
        """Size of the smallest effect; NaN if it is not known."""
        return float(np.min(self.truth["sizes"])) if self.truth["sizes"] else math.nan


@dataclass(frozen=True)
class Score:
    """A share with its interval, or a number, beside its mark.

    Parameters
    ----------
    name
        In words.
    hits, of
        Counts; `of` is 0 for a plain number.
    value
        Share or number.
    low, high
        95 % interval (Clopper and Pearson); NaN for a plain number.
    mark
        In words.
    state
        `met`, `missed`, `not shown` or `no cases`.
    """

    name: str
    hits: int
    of: int
    value: float
    low: float
    high: float
    mark: str
    state: str


def open_run(run: Path) -> list[Case]:
    """Check the seals of every set that has a verdict, and read truth and verdict.

    Raises
    ------
    SealBroken
        A seal does not hold; nothing is scored then.
    """
    ledger = Ledger(run / "ledger.jsonl")
    verdicts, opened = ledger.of("verdict"), ledger.of("opened")
    cases = []
    for name in sorted(verdicts):
        check(ledger, run, name)
    for name in sorted(verdicts):
        if name not in opened:
            ledger.add(event="opened", set=name)
        event = verdicts[name]
        truth = json.loads((run / "truths" / f"{name}.json").read_text())
        path = run / "verdicts" / f"{name}.json"
        verdict = json.loads(path.read_text()) if event["verdict"] else {}
        cases.append(Case(name, truth, verdict, event))
    return cases


def interval(hits: int, of: int, *, level: float = 0.95) -> tuple[float, float]:
    """Binomial interval of Clopper and Pearson (Biometrika 26 (1934) 404).

    Examples
    --------
    >>> [round(x, 4) for x in interval(0, 10)]
    [0.0, 0.3085]
    """
    tail = 0.5 * (1.0 - level)
    low = 0.0 if hits == 0 else float(beta.ppf(tail, hits, of - hits + 1))
    high = 1.0 if hits == of else float(beta.ppf(1.0 - tail, hits + 1, of - hits))
    return low, high


def share(
    name: str, cases: Iterable[Case], test: Callable[[Case], bool], *, least: float = 0.0,
    most: float = 1.0,
) -> Score:  # fmt: skip
    """Share of cases that pass a test, judged by its interval against a range of marks."""
    chosen = list(cases)
    of = len(chosen)
    hits = sum(test(case) for case in chosen)
    mark = f"at least {least:.0%}" if most == 1.0 else f"at most {most:.0%}"
    if least > 0.0 and most < 1.0:
        mark = f"{least:.0%} to {most:.0%}"
    if of == 0:
        return Score(name, 0, 0, math.nan, math.nan, math.nan, mark, "no cases")
    low, high = interval(hits, of)
    if low >= least and high <= most:
        state = "met"
    elif high < least or low > most:
        state = "missed"
    else:
        state = "not shown"
    return Score(name, hits, of, hits / of, low, high, mark, state)


def _number(
    name: str, values: list[float], pick: Callable[..., Any], mark: str, good: Any
) -> Score:
    finite = [v for v in values if math.isfinite(v)]
    if not finite:
        return Score(name, 0, 0, math.nan, math.nan, math.nan, mark, "no cases")
    value = float(pick(finite))
    state = "met" if good(value) else "missed"
    return Score(name, 0, 0, value, math.nan, math.nan, mark, state)


def gain(case: Case) -> float:
    """Held-out score of the baseline over that of the extended model."""
    table = case.verdict.get("improvement") or {}
    base, more = table.get("held_out_baseline"), table.get("held_out_extended")
    return float(base) / float(more) if base and more else math.nan


def _covered(case: Case) -> list[bool]:
    """Whether each parameter that means the same in both lies in its 90 % interval."""
    if case.best != case.true:
        return []
    found = []
    for effect in case.truth["effects"]:
        for name, value in comparable(effect).items():
            said = (case.verdict.get("parameters") or {}).get(name)
            if said:
                found.append(float(said["low"]) <= value <= float(said["high"]))
    return found


def _flagged_mass(case: Case) -> bool:
    return any("mass" in str(item.get("check", "")) for item in case.verdict.get("audit", ()))


def _strength_only(case: Case) -> bool:
    pulls = case.verdict.get("surprise") or case.verdict.get("nuisance_pulls") or {}
    strong = [abs(float(v)) for k, v in pulls.items() if "Sy" in k or "strength" in k]
    return case.said == "adequate" and bool(strong) and max(strong) > 2.0


def scores(cases: list[Case]) -> list[Score]:
    """Every published score."""
    plain = [c for c in cases if c.truth["kind"] not in PLANTED]
    null = [c for c in plain if c.truth["kind"] == "null"]
    single = [c for c in plain if c.truth["kind"] == "single"]
    pair = [c for c in plain if c.truth["kind"] == "pair"]
    outside = [c for c in plain if c.truth["kind"] == "outside"]
    seen = [c for c in single if c.size > DETECTABLE]
    named = [c for c in single if c.named]
    sizes = [float(len(c.reported)) for c in single + pair if c.named]
    covered = [hit for c in single for hit in _covered(c)]
    low, high = interval(sum(covered), len(covered)) if covered else (math.nan, math.nan)
    coverage = share("", [], bool, least=0.85, most=0.95)
    if covered:
        value = sum(covered) / len(covered)
        state = "met" if low >= 0.85 and high <= 0.95 else "not shown"
        state = "missed" if high < 0.85 or low > 0.95 else state
        coverage = Score("", sum(covered), len(covered), value, low, high, coverage.mark, state)
    return [
        share("false alarms on nulls", null, lambda c: c.said in _ALARMS, most=0.05),
        share("detected, size above 10", seen, lambda c: c.said in _ALARMS, least=0.90),
        share("right name first, of those named", named, lambda c: c.best == c.true, least=0.90),
        share(
            "one explanation named, size above 10", seen,
            lambda c: c.said == "missing-physics" and c.named, least=0.70,
        ),
        share("undetermined or failed", plain, lambda c: c.said == "undetermined", most=0.05),
        share("truth in the reported set", named, lambda c: c.true in c.reported, least=0.95),
        _number("mean size of the set", sizes, np.mean, "at most 2", lambda v: v <= 2.0),
        _number("largest set", sizes, np.max, "at most 3", lambda v: v <= 3.0),
        share("forced name, outside the library", outside, lambda c: c.named, most=0.05),
        Score("90 % intervals cover", *list(vars(coverage).values())[1:]),
        _number(
            "held-out score falls by, median above size 20",
            [gain(c) for c in single if c.size > LARGE and c.named], np.median, "at least 2",
            lambda v: v >= 2.0,
        ),
        share("both of a pair named", pair, lambda c: c.best == c.true, least=0.50),
        share("one of a pair named", pair, lambda c: bool(c.best & c.true), least=0.90),
        share(
            "mass off by 5 % flagged", [c for c in cases if c.truth["kind"] == "mass-error"],
            _flagged_mass, least=0.95,
        ),
        share("mass flagged on clean sets", plain, _flagged_mass, most=0.05),
        share(
            "strength off by 14 % found as such",
            [c for c in cases if c.truth["kind"] == "strength-error"], _strength_only, least=0.90,
        ),
    ]  # fmt: skip


def confusion(cases: list[Case]) -> dict[str, dict[str, int]]:
    """Truth (a name, `nothing`, `outside` or `pair`) to what was said, and how often."""
    table: dict[str, dict[str, int]] = {}
    for case in cases:
        kind = case.truth["kind"]
        if kind in PLANTED:
            continue
        row = {"null": "nothing", "outside": "outside", "pair": "pair"}.get(kind, "")
        row = row or "+".join(sorted(case.true))
        column = "+".join(sorted(case.best)) if case.named else case.said
        cells = table.setdefault(row, {})
        cells[column] = cells.get(column, 0) + 1
    return table


def calibration(cases: list[Case]) -> list[tuple[float, float, int, int]]:
    """Stated probability of the best explanation against how often it was right, in bins.

    Returns
    -------
    list
        (low, high, right, cases) of each bin with cases.
    """
    edges = [0.0, 0.5, 0.7, 0.9, 0.97, 1.0]
    counts = [[0, 0] for _ in edges[1:]]
    for case in cases:
        stated = case.verdict.get("probabilities") or {}
        if not stated or case.truth["kind"] in PLANTED:
            continue
        top = max(stated, key=lambda key: float(stated[key]))
        kind = case.truth["kind"]
        true = {"null": frozenset({"baseline"}), "outside": frozenset({"outside-library"})}
        right = frozenset(top.split("+")) == true.get(kind, case.true)
        place = int(np.searchsorted(edges[1:-1], float(stated[top]), side="right"))
        counts[place][0] += right
        counts[place][1] += 1
    return [(edges[i], edges[i + 1], r, n) for i, (r, n) in enumerate(counts) if n]
