"""How probable each explanation is: prior times evidence, tempered.

Ln odds over 'nothing is missing' are ln prior plus `RULES.temper` times G ln(1 + g/G) with the gain
g in ln evidence and G `RULES.by_ratio`: evidences of a hundred numbers are surer than metals and
laboratories are, and what one adds to a gain of thousands counts by its share of it, since forms
are off by a share of what they explain. Nothing, numbers of the sheet that are wrong, mechanisms,
two at once and what no name covers compete in one sum; nothing is decided by a threshold.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.special import logsumexp

from ...dynamics.mechanisms.base import Mechanism
from ..rank import Ranking, Screened, sizes
from ..rules import RULES
from ..unknowns.wrong_number import WRONG, is_wrong
from .outside import odd_repeats, outside_of

OUTSIDE = "outside-library"
BASELINE = "baseline"
PRIORS = dict(RULES.priors)
STRENGTH = "target.Sy_Pa"
METAL = frozenset({"strain-rate-hardening", "work-hardening"})
"""What every metal does."""


@dataclass(frozen=True)
class Odds:
    """Probabilities of the explanations.

    - `names`: label to its mechanisms and wrong numbers: `baseline` and `OUTSIDE` have none.
    - `probability`: label to the posterior probability, most probable first.
    - `alike`: what has no name of its own, by its title, to its share of what is outside.
    """

    names: Mapping[str, tuple[str, ...]]
    probability: Mapping[str, float]
    alike: Mapping[str, float] = field(default_factory=dict)

    @property
    def leader(self) -> str:
        """The most probable explanation."""
        return max(self.probability, key=lambda name: self.probability[name])

    @property
    def inclusion(self) -> dict[str, float]:
        """Mechanism or wrong number to the probability that it takes part, alone or with others."""
        found: dict[str, float] = {}
        for label, p in self.probability.items():
            for name in self.names[label]:
                found[name] = found.get(name, 0.0) + p
        return dict(sorted(found.items(), key=lambda item: -item[1]))


def odds_of(ranking: Ranking) -> Odds:
    """Return the probabilities of a ranking's explanations.

    A mechanism without a full fit counts by its screening.
    """
    gained = gains(ranking)
    prior = Priors.of(ranking)
    names: dict[str, tuple[str, ...]] = {BASELINE: (), OUTSIDE: ()}
    log = {}
    for label, gain in gained.items():
        names[label] = members(label)
        log[label] = prior.log(names[label]) + tempered(gain)
    log[OUTSIDE], alike = _outside(ranking, log)
    total = float(logsumexp(list(log.values())))
    found = {k: math.exp(x - total) for k, x in sorted(log.items(), key=lambda item: -item[1])}
    return Odds(names, _supported(found), alike)


def members(label: str) -> tuple[str, ...]:
    """Return the mechanisms and wrong numbers of an explanation."""
    return () if label == BASELINE else tuple(label.split("+"))


def gains(ranking: Ranking) -> dict[str, float]:
    """Return the gain in ln evidence of every explanation, by its screening where not fitted."""
    found = {s.mechanism.name: s.log_bayes for s in ranking.screened}
    found |= ranking.unfitted
    return found | {f.name: f.log_evidence - ranking.base.log_evidence for f in ranking.fits}


def tempered(gain: float) -> float:
    """Return what a gain in ln evidence counts [nat]."""
    G = RULES.by_ratio
    return RULES.temper * (G * math.log1p(gain / G) if gain > 0.0 else gain)


@dataclass(frozen=True)
class Priors:
    """Ln prior of every explanation.

    - `share`: of each single one; mechanisms alike, wrong numbers by their kind.
    - `acting`: mechanisms that act beside whatever else does, with `RULES.acts`.
    """

    share: Mapping[str, float]
    acting: frozenset[str] = frozenset()

    @classmethod
    def of(cls, ranking: Ranking) -> Priors:
        """Return those of a ranking's explanations."""
        acting = (s.mechanism.name for s in ranking.screened if _acts(ranking, s))
        share = prior_shares([s.mechanism for s in ranking.screened])
        for key, contradicted in ranking.problem.by_density.items():
            if (name := f"{WRONG}{key}") in share:
                share[name] += math.log(RULES.contradicted) * (1.0 if contradicted else -1.0)
        return cls(share, frozenset(acting))

    def log(self, names: Collection[str]) -> float:
        """Ln prior of an explanation, by its members."""
        rest = [name for name in names if name not in self.acting]
        found = sum(math.log(RULES.acts if a in names else 1.0 - RULES.acts) for a in self.acting)
        if not rest:
            return found + math.log(PRIORS[BASELINE])
        found += sum(self.share[name] for name in rest)
        if len(rest) == 1:
            return found
        # of a pair: the first as alone, the second by its share among its own kind
        kind = PRIORS["inputs"] if rest[1].startswith(WRONG) else PRIORS["mechanisms"]
        return found - math.log(kind) + math.log(PRIORS["second"])


def _acts(ranking: Ranking, screened: Screened) -> bool:
    """Whether a mechanism surely acts, and the set would show the least of it."""
    around = [c.around for c in ranking.problem.conditions if c.press is None]
    if not (around and all(map(screened.mechanism.certain, around))):
        return False
    return bool(sizes(screened, ranking.base).min() > RULES.shows)


def prior_shares(screened: Sequence[Mechanism]) -> dict[str, float]:
    """Ln prior of each single explanation: mechanisms alike, but for what every metal does.

    Wrong numbers share by their kind: alike, but for the strength of what is struck and a plate's
    thickness, and within a kind by the bodies.
    """
    kinds: dict[str, list[str]] = {}
    named = []
    for m in screened:
        if is_wrong(m):
            kinds.setdefault(m.kind if m.key != STRENGTH else STRENGTH, []).append(m.name)
        else:
            named.append(m.name)
    found = _shared("mechanisms", {n: RULES.every_metal if n in METAL else 1.0 for n in named})
    weight = {STRENGTH: RULES.strength_wrong, "thickness": RULES.thickness_wrong}
    alike = {n: weight.get(kind, 1.0) / len(names) for kind, names in kinds.items() for n in names}
    return found | _shared("inputs", alike)


def _shared(kind: str, weight: Mapping[str, float]) -> dict[str, float]:
    """Ln of the shares of a prior."""
    return {n: math.log(PRIORS[kind] * w / sum(weight.values())) for n, w in weight.items()}


def _outside(ranking: Ranking, log: Mapping[str, float]) -> tuple[float, dict[str, float]]:
    """Ln weight of what no name covers, and what it is like, with shares of that weight.

    A free departure of the baseline, or physics without a name; and, beside whatever explains the
    rest, what repeats say of themselves.
    """
    base = ranking.base
    free = float(outside_of(ranking.problem, base).log_likelihood(base.residual))
    shared = RULES.nameless if ranking.nameless else 0.0
    parts = {"": math.log(1.0 - shared) + free - base.log_evidence}
    for title, gain in ranking.nameless.items():
        parts[title] = math.log(shared / len(ranking.nameless)) + gain
    whole = float(logsumexp(list(parts.values())))
    alike = {title: math.exp(x - whole) for title, x in parts.items() if title}
    prior = math.log(PRIORS[OUTSIDE])
    beside = float(logsumexp(list(log.values()))) + odd_repeats(ranking.problem)
    return prior + float(np.logaddexp(tempered(whole), beside)), alike


def _supported(found: dict[str, float]) -> dict[str, float]:
    """Return probabilities of which the baseline's is no surer than the sets drawn can support."""
    nothing = found[BASELINE]
    told = min(max(nothing, RULES.supported), 1.0 - RULES.supported)
    rest = (1.0 - told) / (1.0 - nothing)
    return {k: told if k == BASELINE else rest * p for k, p in found.items()}
