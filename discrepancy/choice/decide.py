"""Decide: what leads is said, with its probability, from one half on; one rule for all.

Below it, what takes part with `RULES.together`, whatever else does, is said; or explanations that
have as much together are said to share it; else the verdict is `undetermined`. A cautious reader
asks for more (`RULES.cautious`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ...core.observables import OBSERVABLES
from ..comparison.cells import Scatter
from ..inference.fit import Fit
from ..rank import Ranking
from ..rules import RULES
from ..unknowns.repeats import Drift, Followed
from ..unknowns.wrong_number import is_wrong
from .families import Family, family_of
from .odds import BASELINE, OUTSIDE, Odds

# limit: share of what is outside from which one without a name is said to be like it [-]; more
# likely than not
_RESEMBLES = 0.5

WRONG_INPUT = "wrong-input"


@dataclass(frozen=True, eq=False)
class Choice:
    """A verdict, the explanations that it holds (best first), and why.

    `alike` says, as clauses, what something outside the library behaves like, where that is known;
    `family` is what the leading explanations agree on, where one family leads.
    """

    verdict: str
    members: tuple[Fit, ...]
    reasons: tuple[str, ...]
    alike: tuple[str, ...] = ()
    family: Family | None = None


def decide(ranking: Ranking, odds: Odds, *, cautious: bool = False) -> Choice:
    """Return the verdict by the probabilities of the explanations.

    `cautious`: whether a name, or 'nothing is missing', needs more than one half.
    """
    problem = ranking.problem
    first = (*map(_follows, problem.followed), *map(_scattered, problem.scatters))
    last = tuple(map(_drifted, problem.drifts))
    family, few = family_of(odds), _too_few(ranking)
    if few:
        reasons = (*first, few, *_nevertheless(odds), *last)
        return Choice("undetermined", (), reasons, family=family)
    choice = _said(ranking, odds, RULES.cautious if cautious else RULES.said)
    reasons = (*first, *_odds_told(odds), *choice.reasons, *last)
    return replace(choice, reasons=reasons, family=family)


def _too_few(ranking: Ranking) -> str:
    """Why a set says nothing at all, or ""."""
    cells = ranking.problem.cells
    readings = int(np.sum(cells.count))
    if readings < RULES.fewest_readings:
        return f"too few: only {readings} readings to compare, {RULES.fewest_readings} are needed"
    if len(set(cells.condition)) < RULES.fewest_conditions:
        return "too few: all numbers are of one condition; nothing can follow from what varies"
    return ""


def _said(ranking: Ranking, odds: Odds, least: float) -> Choice:
    lead = odds.leader
    if odds.probability[lead] >= least:
        if lead == BASELINE:
            return Choice("adequate", (), ())
        if lead == OUTSIDE:
            alike = {t: share for t, share in odds.alike.items() if share > _RESEMBLES}
            told = tuple(
                f"it behaves as if {title}: {100.0 * share:.0f} % of what is not in the library"
                for title, share in alike.items()
            )
            return Choice(OUTSIDE, (), told, tuple(alike))
    members = _fits(ranking, (lead,))
    if odds.probability[lead] >= least and members:
        return _named(members)
    common = _fits(ranking, (k for k, p in odds.inclusion.items() if p >= RULES.together))
    if common:
        return _named(common[:1])
    shared = _sharing(odds)
    if not shared:
        return Choice("undetermined", (), (_unclear(odds),))
    text = f"{len(shared)} explanations share the probability: {' or '.join(shared)}"
    return Choice("indistinguishable", _fits(ranking, shared), (text,))


def _named(members: tuple[Fit, ...]) -> Choice:
    number = all(map(is_wrong, members[0].mechanisms))
    return Choice(WRONG_INPUT if number else "missing-physics", members, ())


def _sharing(odds: Odds) -> tuple[str, ...]:
    """Leading explanations, at most `RULES.alike`, that together have `RULES.together`."""
    total, found = 0.0, []
    for label, p in list(odds.probability.items())[: RULES.alike]:
        if label in (BASELINE, OUTSIDE):
            return ()
        found.append(label)
        total += p
        if total >= RULES.together:
            return tuple(found)
    return ()


def _fits(ranking: Ranking, labels: Iterable[str]) -> tuple[Fit, ...]:
    by_name = {f.name: f for f in ranking.fits}
    return tuple(by_name[label] for label in labels if label in by_name)


def _nevertheless(odds: Odds) -> Iterable[str]:
    """What few numbers say all the same: that something is missing, not what."""
    missing = 1.0 - odds.probability[BASELINE]
    if missing > RULES.sure:
        yield (
            f"something is missing with a probability of {_percent(missing)}; the numbers are too "
            "few to say what"
        )


def _odds_told(odds: Odds) -> Iterable[str]:
    missing, outside = 1.0 - odds.probability[BASELINE], odds.probability[OUTSIDE]
    yield (
        f"something is missing with a probability of {_percent(missing)}; something that is not in "
        f"the library with {_percent(outside)}"
    )
    likely = [f"{name} {_percent(p)}" for name, p in list(odds.inclusion.items())[:3] if p > 0.01]
    if likely:
        yield f"takes part, alone or with others: {', '.join(likely)}"


def _unclear(odds: Odds) -> str:
    likely = [f"{k} {_percent(p)}" for k, p in list(odds.probability.items())[:4]]
    return f"the set says too little to choose: {', '.join(likely)}"


def _scattered(s: Scatter) -> str:
    return (
        f"repeats of {OBSERVABLES[s.observable].label} differ {s.ratio:.2g} times more than their "
        "stated noise: it is too small, or something was varied and not recorded; their own "
        "scatter is used"
    )


def _follows(f: Followed) -> str:
    row = OBSERVABLES[f.observable]
    span = f"{100.0 * math.expm1(f.span):.2g} %" if row.log else f"{f.span:.2g}"
    return (
        f"unmodelled-condition: {row.label} follows {f.column}, by up to {span} between trials "
        "that are otherwise alike; no part of the simulation knows this column"
    )


def _drifted(d: Drift) -> str:
    change = f"{d.change:+.3g}"
    if OBSERVABLES[d.observable].log:
        change = f"{100.0 * math.expm1(d.change):+.1f} %"
    return (
        f"{d.observable}: repeats of one condition change by {change} from the first trial to the "
        f"last ({abs(d.z):.1f} standard errors), whatever the simulation"
    )


def _percent(p: float) -> str:
    """Return a probability, no surer than the sets that were drawn can support."""
    if p < RULES.supported:
        return f"less than {100.0 * RULES.supported:.1g} %"
    if p > 1.0 - RULES.supported:
        return f"more than {100.0 * (1.0 - RULES.supported):.1f} %"
    return f"{100.0 * p:.1f} %" if p < 0.1 or p > 0.9 else f"{100.0 * p:.0f} %"
