"""How probable each explanation is: prior times evidence, and a penalty on all but the baseline."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

from scipy.special import logsumexp

from ..inference.fit import Fit
from ..rank import Ranking
from ..rules import RULES

OUTSIDE = "outside-library"
PRIORS = {"baseline": 0.5, "singles": 0.34, "pairs": 0.06, OUTSIDE: 0.1}
"""Before the comparison: as likely as not that nothing is missing; each single mechanism that
could act here shares alike, and so does each pair."""
NAMELESS_SHARE = 1.0 / 3.0
"""Of what is outside the library, the share of known physics without a name; the rest is free."""
BESIDE = (
    PRIORS["pairs"] / PRIORS["singles"] * PRIORS[OUTSIDE] / (PRIORS["singles"] + PRIORS[OUTSIDE])
)
"""Odds that something outside the library acts beside what is named: as likely as a second
mechanism is beside a first one, and outside as often as a first one is."""
WORTH_TELLING = 0.01
"""Probability of an explanation from which something may act beside it."""
SURE = 0.93
NAMED_AT = math.log(SURE / (1.0 - SURE))
"""Ln odds of something missing from which a name costs less than silence (`decide.COSTS`)."""


def shares_outside(nameless: int) -> tuple[float, float]:
    """Prior shares, among what is outside the library, of the free part and of each nameless."""
    return (1.0 - NAMELESS_SHARE, NAMELESS_SHARE / nameless) if nameless else (1.0, 0.0)


@dataclass(frozen=True)
class Odds:
    """Probabilities of the explanations.

    Parameters
    ----------
    names
        Label to the mechanisms: `baseline` and `OUTSIDE` have none.
    probability
        Label to the posterior probability, most probable first.
    beside
        Label to the part of the probability of something outside that stems from how badly that
        explanation fits.
    """

    names: Mapping[str, tuple[str, ...]]
    probability: Mapping[str, float]
    beside: Mapping[str, float] = field(default_factory=dict)

    @property
    def baseline(self) -> float:
        """Probability that nothing is missing."""
        return self.probability["baseline"]

    @property
    def outside(self) -> float:
        """Probability of something that is not in the library."""
        return self.probability[OUTSIDE]

    @property
    def inclusion(self) -> dict[str, float]:
        """Mechanism to the probability that it takes part, alone or with others."""
        found: dict[str, float] = {}
        for label, p in self.probability.items():
            for name in self.names[label]:
                found[name] = found.get(name, 0.0) + p
        return dict(sorted(found.items(), key=lambda item: -item[1]))


def odds_of(
    ranking: Ranking,
    outside: float,
    *,
    sampled: Mapping[str, float] | None = None,
    beside: Callable[[Fit], float] | None = None,
) -> Odds:
    """Return the probabilities of a ranking's explanations.

    Parameters
    ----------
    ranking
        All fits; a mechanism without a full fit counts by its screening.
    outside
        Ln evidence of something outside the library over the baseline's, less the penalty.
    sampled
        Sampled ln evidence over the baseline, of the explanations that have it.
    beside
        Ln Bayes factor of something that acts beside a fitted explanation; asked for those that
        have some probability.
    """
    base = ranking.base.log_evidence
    gained = {f.name: f.log_evidence - base for f in (*ranking.singles, *ranking.pairs)}
    for s in ranking.screened:
        gained.setdefault(s.mechanism.name, s.log_bayes)
    gained |= {k: v for k, v in (sampled or {}).items() if k in gained}
    alone = [s.mechanism.name for s in ranking.screened]
    n = max(len(alone), 1)
    log = {"baseline": math.log(PRIORS["baseline"])}
    log[OUTSIDE] = outside + math.log(PRIORS[OUTSIDE])
    names: dict[str, tuple[str, ...]] = {"baseline": (), OUTSIDE: ()}
    for label, more in gained.items():
        names[label] = tuple(label.split("+"))
        share = PRIORS["singles"] / n
        if len(names[label]) > 1:
            share = PRIORS["pairs"] / max(n * (n - 1) // 2, 1)
        log[label] = more + math.log(share) - RULES.penalty
    found = _normalised(log.items())
    likely = [f for f in (*ranking.singles, *ranking.pairs) if found[f.name] > WORTH_TELLING]
    if beside is None or not likely:
        return Odds(names, found)
    parts = {f.name: log[f.name] + math.log(BESIDE) + beside(f) for f in likely}
    log[OUTSIDE] = float(logsumexp([log[OUTSIDE], *parts.values()]))
    found = _normalised(log.items())
    return Odds(
        names, found, {k: found[OUTSIDE] * math.exp(x - log[OUTSIDE]) for k, x in parts.items()}
    )


def _normalised(logs: Iterable[tuple[str, float]]) -> dict[str, float]:
    ordered = sorted(logs, key=lambda item: -item[1])
    total = float(logsumexp([x for _, x in ordered]))
    return {name: math.exp(x - total) for name, x in ordered}
