"""Open the truths of a run whose verdicts are sealed, and count."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .calibrated import calibration_error
from .case import Case, covered, interval, state_of
from .generators.truth import PLANTED

DETECTABLE, LARGE = 10.0, 20.0
"""Sizes above which detection is scored, and above which the gain on held-out trials is."""

_ALARMS = ("missing-physics", "indistinguishable", "outside-library")


@dataclass(frozen=True)
class Score:
    """A share with its interval, or a number, beside its mark.

    - `hits`, `of`: counts; `of` is 0 for a plain number.
    - `value`: share or number.
    - `low`, `high`: 95 % interval (Clopper and Pearson); NaN for a plain number.
    - `state`: `met`, `missed`, `not shown` or `no cases`.
    """

    name: str
    hits: int
    of: int
    value: float
    low: float
    high: float
    mark: str
    state: str


def share(
    name: str, cases: Iterable[Case], test: Callable[[Case], bool], *, least: float = 0.0,
    most: float = 1.0,
) -> Score:  # fmt: skip
    """Share of cases that pass a test, judged by its interval against a range of marks."""
    return _counted(name, [test(case) for case in cases], least=least, most=most)


def _counted(name: str, passed: list[bool], *, least: float, most: float) -> Score:
    hits, of = sum(passed), len(passed)
    mark = f"at least {least:.0%}" if most == 1.0 else f"at most {most:.0%}"
    if least > 0.0 and most < 1.0:
        mark = f"{least:.0%} to {most:.0%}"
    if of == 0:
        return Score(name, 0, 0, math.nan, math.nan, math.nan, mark, "no cases")
    low, high = interval(hits, of)
    state = state_of(low, high, least=least, most=most)
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
    """Held-out rms of the baseline over that of the extended model."""
    table = case.verdict.get("improvement") or {}
    base, more = table.get("held_out_baseline"), table.get("held_out_extended")
    return float(base) / float(more) if base and more else math.nan


def _flagged_mass(case: Case) -> bool:
    return any("mass" in str(item.get("check", "")) for item in case.verdict.get("audit", ()))


def _alarmed(case: Case) -> bool:
    """Whether anything is said to be missing, or a number of the sheet wrong."""
    return case.said in (*_ALARMS, "wrong-input")


def _strength_only(case: Case) -> bool:
    """Whether the strength is said to be wrong, or beyond its tolerance with nothing missing."""
    if case.said == "wrong-input":
        return all("Sy" in key for key in case.wrong)
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
    hits = [hit for c in single for hit in covered(c)]
    law_right = [c for c in null if not c.off]
    law_off = [c for c in null if c.off]
    return [
        share("false alarms on nulls, metal as the law", law_right,
              _alarmed, most=0.03),
        share("false alarms on nulls, metal 3 to 8 % off", law_off,
              _alarmed, most=0.05),
        share("detected, size above 10", seen, lambda c: c.said in _ALARMS, least=0.90),
        share("right name first, of those named", named, lambda c: c.best == c.true, least=0.95),
        share(
            "one explanation named, size above 10", seen,
            lambda c: c.said == "missing-physics" and c.named, least=0.70,
        ),
        share("undetermined or failed", plain, lambda c: c.said == "undetermined", most=0.05),
        share("truth in the reported set", named, lambda c: c.true in c.reported, least=0.97),
        _number("mean size of the set", sizes, np.mean, "at most 1.5", lambda v: v <= 1.5),
        _number("largest set", sizes, np.max, "at most 3", lambda v: v <= 3.0),
        share("forced name, outside the library", outside, lambda c: c.named, most=0.05),
        _counted("90 % intervals cover", hits, least=0.85, most=0.95),
        _number(
            "rms of left-out trials falls by, median above size 20",
            [gain(c) for c in single if c.size > LARGE and c.named], np.median, "at least 2",
            lambda v: v >= 2.0,
        ),
        share("a name with worse held-out trials", [c for c in plain if c.named],
              lambda c: c.worse, most=0.0),
        share("first place of the mismatch right, size above 10", located(seen), _placed,
              least=0.80),
        share("the same, where the truth shows it above 3 deviations",
              [c for c in located(seen)
               if max(float(score) for *_, score in c.truth["places"]) > STANDS_OUT], _placed,
              least=0.80),
        share("next experiment can be done", [c for c in plain if next_of(c)], feasible,
              least=1.0),
        share(
            "strain rate named or in the set, size above 10",
            [c for c in seen if c.true == {"strain-rate-hardening"}],
            lambda c: c.true in c.reported, least=0.80,
        ),
        _number("expected calibration error of the inclusion", [calibration_error(plain)],
                np.mean, "at most 0.05", lambda v: v <= 0.05),
        share("both of a pair named", pair, lambda c: c.best == c.true, least=0.60),
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


def next_of(case: Case) -> dict[str, Any]:
    """The next experiment that a verdict proposes; empty without one."""
    found = case.verdict.get("next_experiment") or {}
    return found if found.get("change") else {}


def feasible(case: Case) -> bool:
    """Whether the next experiment lies within the rig, or says what to build and is that."""
    found = next_of(case)
    trial = found.get("trial") or {}
    if found.get("kind") == "press":
        low, high = BENCH_PRESS
        return (
            low <= float(trial["load_N"]) <= high
            and str(trial["striker"]) in case.truth["strikers"]
        )
    if found.get("kind") not in ("trial", "build"):
        return found.get("kind") in (
            "noise", "observable", "none", "hardness", "weigh", "calliper"
        )  # fmt: skip
    low, high = case.truth["speeds"]
    flat, steep = (math.degrees(a) for a in case.truth["angles"])
    within = 0.9 * low < float(trial["speed_m_s"]) < 1.1 * high
    within = within and flat - 2.0 < float(trial["angle_deg"]) < steep + 2.0
    if found["kind"] == "build":
        return within and str(found["change"]).startswith("build")
    return within and str(trial["striker"]) in case.truth["strikers"]


BENCH_PRESS = (10.0, 10e3)
"""Loads of hardness testers and small testing machines [N]."""


NEARLY = 0.8
"""Part of the largest true score from which a place counts as the first."""


STANDS_OUT = 3.0
"""True score of a place, in standard deviations of noise and of all that is unsure, from which a
reader of the recordings could find it at all."""


def located(cases: Iterable[Case]) -> list[Case]:
    """Cases whose truth says where the effect shows."""
    return [c for c in cases if c.truth.get("places")]


def _placed(case: Case) -> bool:
    """Whether the first place of the mismatch is that where the truth shows most, or nearly."""
    said = case.verdict.get("located") or []
    if any(effect["name"] == "drift-with-order" for effect in case.truth["effects"]):
        # it lies along no condition
        return bool(said) and said[0]["covariate"] == "order of testing"
    true = {(o, c): float(score) for o, c, score in case.truth["places"]}
    if not said:
        return False
    first = true.get((said[0]["observable"], said[0]["covariate"]), 0.0)
    return first >= NEARLY * max(true.values())
