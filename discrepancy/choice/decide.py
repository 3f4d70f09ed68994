"""Decide: the verdict whose expected cost is least, by the probabilities of the explanations.

No rule names what the probabilities deny; numbers too few to say anything are the one check
beside them.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import NamedTuple

import numpy as np

from ...core.observables import OBSERVABLES
from ..comparison.cells import Scatter
from ..inference.fit import Fit
from ..rank import Ranking
from ..rules import RULES
from ..unknowns.drift import Drift
from ..unknowns.followed import Followed
from .odds import OUTSIDE, SURE, Odds


class Costs(NamedTuple):
    """What a wrong verdict costs, in units of something missing that is not seen.

    Parameters
    ----------
    miss
        `adequate` where something is missing.
    false_alarm
        A name, or `outside-library`, where nothing is missing.
    wrong
        A name, or `outside-library`, where something else is missing.
    half
        A name where a part of it acts, or more than it.
    more
        Each further explanation that a reader must keep in mind: 0.03 of a wrong name, so that
        what is true is among those named in 97 of a hundred.
    silence
        `undetermined`: a name is said from a probability of 0.55 on where nothing else is like it.
    """

    miss: float = 1.0
    false_alarm: float = 10.0
    wrong: float = 2.0
    half: float = 0.5
    more: float = 0.06
    silence: float = 0.9


COSTS = Costs()
WORTH_NAMING = COSTS.more / COSTS.wrong
"""Probability from which a further name saves more than it costs."""


@dataclass(frozen=True, eq=False)
class Choice:
    """A verdict, the explanations that it holds (best first), and why.

    `alike` says, as clauses, what something outside the library behaves like, where that is known.
    """

    verdict: str
    members: tuple[Fit, ...]
    reasons: tuple[str, ...]
    alike: tuple[str, ...] = ()


def decide(ranking: Ranking, odds: Odds, *, drifts: Sequence[Drift] = ()) -> Choice:
    """Return the verdict of least expected cost.

    Parameters
    ----------
    ranking
        All fits.
    odds
        Their probabilities.
    drifts
        Changes over the order of testing, which are said beside any verdict.
    """
    cells, conditions = ranking.problem.cells, len(set(ranking.problem.cells.condition))
    first = [*map(_follows, ranking.problem.followed), *map(_scattered, ranking.problem.scatters)]
    last = [*map(_drifted, drifts)]
    readings = int(np.sum(cells.count))
    if readings < RULES.fewest_readings:
        text = f"too few: only {readings} readings to compare, {RULES.fewest_readings} are needed"
        return Choice("undetermined", (), (*first, text, *_nevertheless(odds), *last))
    if conditions < RULES.fewest_conditions:
        text = "too few: all numbers are of one condition; nothing can follow from what varies"
        return Choice("undetermined", (), (*first, text, *_nevertheless(odds), *last))
    choice = _cheapest(ranking.fits[1:], odds)
    return replace(choice, reasons=(*first, *_odds_told(odds), *choice.reasons, *last))


def _cheapest(fits: Sequence[Fit], odds: Odds) -> Choice:
    by_name = {f.name: f for f in fits}
    named = _named(tuple(by_name), odds)
    options = {
        "undetermined": COSTS.silence,
        OUTSIDE: (
            COSTS.false_alarm * odds.baseline
            + COSTS.wrong * (1.0 - odds.baseline - odds.outside)
        ),
    }  # fmt: skip
    if odds.baseline >= RULES.adequate:
        options["adequate"] = COSTS.miss * (1.0 - odds.baseline)
    # a name is said where it leads: several that together outweigh what does are no finding
    if max(odds.probability, key=lambda k: odds.probability[k]) in named:
        options["named"] = cost_of_naming(named, odds)
    verdict = min(options, key=lambda k: options[k])
    if verdict == "undetermined":
        return Choice(verdict, (), (_unclear(odds),))
    if verdict != "named":
        return Choice(verdict, (), ())
    members = tuple(by_name[name] for name in named)
    if len(members) == 1:
        return Choice("missing-physics", members, ())
    text = f"{len(members)} explanations share the probability: {' or '.join(named)}"
    return Choice("indistinguishable", members, (text,))


def _named(labels: Sequence[str], odds: Odds) -> tuple[str, ...]:
    """Labels of the set, at most `RULES.alike`, whose naming costs least; the most probable first.

    What is too improbable to be worth a place by itself is not named: a pair would else stand for
    two singles, half of each.
    """
    worth = [label for label in labels if odds.probability[label] > WORTH_NAMING]
    sets = (s for n in range(1, RULES.alike + 1) for s in combinations(worth, n))
    chosen = min(sets, key=lambda s: cost_of_naming(s, odds), default=())
    return tuple(sorted(chosen, key=lambda label: -odds.probability[label]))


def cost_of_naming(labels: Sequence[str], odds: Odds) -> float:
    """Return the expected cost of naming some explanations."""
    named = [frozenset(odds.names[label]) for label in labels]
    cost = COSTS.more * (len(labels) - 1) + COSTS.false_alarm * odds.baseline
    for label, p in odds.probability.items():
        true = frozenset(odds.names[label])
        if label == "baseline" or true in named:
            continue
        near = any(true & one for one in named)
        cost += p * (COSTS.half if near else COSTS.wrong)
    return cost


def _nevertheless(odds: Odds) -> Iterable[str]:
    """What few numbers say all the same: that something is missing, not what."""
    if 1.0 - odds.baseline > SURE:
        yield (
            f"something is missing with a probability of {_percent(1.0 - odds.baseline)}; the "
            "numbers are too few to say what"
        )


def _odds_told(odds: Odds) -> Iterable[str]:
    yield (
        f"something is missing with a probability of {_percent(1.0 - odds.baseline)}; something "
        f"that is not in the library with {_percent(odds.outside)}"
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
