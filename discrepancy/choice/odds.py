"""How probable each explanation is: prior times evidence, and a penalty on all but the baseline."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

from scipy.special import logsumexp

from ..inference.fit import Fit
from ..rank import Ranking
from ..rules import RULES
from .apart import weighed

OUTSIDE = "outside-library"
PRIORS = dict(RULES.priors)
"""Before the comparison: as likely as not that nothing is missing; each single mechanism that
could act here shares alike, and so does each pair."""
BESIDE = (
    PRIORS["pairs"] / PRIORS["singles"] * PRIORS[OUTSIDE] / (PRIORS["singles"] + PRIORS[OUTSIDE])
)
"""Odds that something outside the library acts beside what is named: as likely as a second
mechanism is beside a first one, and outside as often as a first one is."""
ALONE = PRIORS[OUTSIDE] / PRIORS["baseline"]
"""The same beside nothing: odds of something outside where no mechanism is named."""
SURE = RULES.sure
NAMED_AT = math.log(SURE / (1.0 - SURE))
"""Ln odds of something missing from which a name costs less than silence (`decide.COSTS`)."""


def shares_outside(nameless: int, scaled: int) -> tuple[float, float, float]:
    """Prior shares, among what is outside the library: free, each nameless, each scaled."""
    own = RULES.nameless / nameless if nameless else 0.0
    factor = RULES.scaled_share / scaled if scaled else 0.0
    return 1.0 - own * nameless - factor * scaled, own, factor


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
    gained = {s.mechanism.name: s.log_bayes for s in ranking.screened}
    gained |= {f.name: f.log_evidence - base for f in ranking.fits}
    gained |= {k: v for k, v in (sampled or {}).items() if k in gained}
    log, names = _weights(ranking, gained)
    log[OUTSIDE] = outside + math.log(PRIORS[OUTSIDE])
    found = _normalised(log.items())
    likely = [f for f in ranking.fits if found[f.name] > RULES.beside]
    if beside is None or not likely:
        return Odds(names, found)
    parts = {
        f.name: log[f.name] + math.log(BESIDE if f.mechanisms else ALONE) + beside(f)
        for f in likely
    }
    log[OUTSIDE] = float(logsumexp([log[OUTSIDE], *parts.values()]))
    found = _normalised(log.items())
    return Odds(
        names, found, {k: found[OUTSIDE] * math.exp(x - log[OUTSIDE]) for k, x in parts.items()}
    )


def odds_apart(ranking: Ranking) -> Odds:
    """Return the same with the law's error apart in every number (`apart`).

    Something outside has its prior, and most where what leads does not fit.
    """
    each = weighed(ranking)
    base = each["baseline"].log_evidence
    log, names = _weights(ranking, {k: w.log_evidence - base for k, w in each.items()})
    found = _normalised(log.items())
    inside = 1.0 - PRIORS[OUTSIDE]
    if each[next(iter(found))].log_p < math.log(RULES.misfit):
        inside *= RULES.kept
    found = {k: inside * p for k, p in found.items()} | {OUTSIDE: 1.0 - inside}
    return Odds(names, found)


def pooled(one: Odds, other: Odds) -> Odds:
    """Return the mean of two, which are as likely to be right."""
    mean = {k: 0.5 * (p + other.probability[k]) for k, p in one.probability.items()}
    mean = _supported(dict(sorted(mean.items(), key=lambda item: -item[1])))
    return Odds(one.names, mean, {k: 0.5 * p for k, p in one.beside.items()})


def _supported(found: dict[str, float]) -> dict[str, float]:
    """Return probabilities of which the baseline's is no surer than the sets drawn can support."""
    nothing = found["baseline"]
    told = min(max(nothing, RULES.supported), 1.0 - RULES.supported)
    rest = (1.0 - told) / (1.0 - nothing)
    return {k: told if k == "baseline" else rest * p for k, p in found.items()}


def _weights(
    ranking: Ranking, gained: Mapping[str, float]
) -> tuple[dict[str, float], dict[str, tuple[str, ...]]]:
    """Ln of prior times evidence, less the penalty, and the mechanisms of each label."""
    n = max(len(ranking.screened), 1)
    log = {"baseline": math.log(PRIORS["baseline"])}
    names: dict[str, tuple[str, ...]] = {"baseline": (), OUTSIDE: ()}
    for label, more in gained.items():
        if label == "baseline":
            continue
        names[label] = tuple(label.split("+"))
        share = PRIORS["singles"] / n
        if len(names[label]) > 1:
            share = PRIORS["pairs"] / max(n * (n - 1) // 2, 1)
        log[label] = more + math.log(share) - RULES.penalty
    return log, names


def _normalised(logs: Iterable[tuple[str, float]]) -> dict[str, float]:
    ordered = sorted(logs, key=lambda item: -item[1])
    total = float(logsumexp([x for _, x in ordered]))
    return {name: math.exp(x - total) for name, x in ordered}
