"""From fits and nulls to probabilities and the verdict that costs least."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from scipy.special import logsumexp

from ..inference.fit import Fit
from ..rank import Nameless, Ranking
from ..rules import RULES
from .decide import Choice, decide
from .gauge import Scaled, scaled_observables
from .odds import OUTSIDE, Odds, odds_apart, odds_of, pooled, shares_outside
from .outside import odd_repeats, outside_of
from .own_sets import FitTest, fit_test
from .thresholds import Nulls


@dataclass(frozen=True)
class Judge:
    """What speaks for something outside, and how each explanation fits its own sets.

    Parameters
    ----------
    outside
        Ln evidence of something outside the library over the baseline's, less the penalty.
    nameless
        Physics without a name, by its name, and factors, by their observable, to their share of
        that evidence.
    nulls
        Sets with nothing missing, from which each explanation's own sets are made.
    scaled
        What a factor on one observable would explain, the most first.
    """

    outside: float
    nameless: Mapping[str, float]
    nulls: Nulls
    scaled: tuple[Scaled, ...] = ()
    _tests: dict[str, FitTest] = field(default_factory=dict)

    @classmethod
    def of(cls, ranking: Ranking, nulls: Nulls) -> Judge:
        """Weigh what is outside the library."""
        free = outside_of(ranking.problem, ranking.base)
        gained = float(free.log_likelihood(ranking.base.residual)) - ranking.base.log_evidence
        scaled = scaled_observables(ranking.problem, ranking.base)
        known_to_none, own, factor = shares_outside(len(ranking.nameless), len(scaled))
        parts = {
            n.screened.mechanism.name: n.log_bayes + math.log(own) - RULES.penalty
            for n in ranking.nameless
        }
        parts |= {s.observable: s.gain + math.log(factor) - RULES.penalty for s in scaled}
        parts[OUTSIDE] = gained + math.log(known_to_none) - RULES.penalty
        # what repeats are worth is bounded already
        parts["repeats"] = odd_repeats(ranking.problem)
        whole = float(logsumexp(list(parts.values())))
        share = {k: math.exp(v - whole) for k, v in parts.items() if k not in (OUTSIDE, "repeats")}
        return cls(whole, share, nulls, scaled)

    def odds(self, ranking: Ranking, sampled: Mapping[str, float] | None = None) -> Odds:
        """Return the probabilities of the explanations of a ranking.

        The mean over two forms of the law's error: inside the law, and apart in every number.
        """
        inside = odds_of(
            ranking, self.outside, sampled=sampled,
            beside=lambda fitted: self.test(fitted).log_odds,
        )  # fmt: skip
        return pooled(inside, odds_apart(ranking))

    def test(self, fitted: Fit) -> FitTest:
        """Return how an explanation fits, beside the sets that it makes itself."""
        if fitted.name not in self._tests:
            self._tests[fitted.name] = fit_test(fitted, self.nulls)
        return self._tests[fitted.name]

    def wants_second(self, ranking: Ranking) -> bool:
        """Whether the leading single does not fit, so that a second mechanism is worth trying."""
        return any(self.test(f).p_value < RULES.refuted for f in ranking.singles[:1])

    def decided(self, ranking: Ranking, sampled: Mapping[str, float]) -> Choice:
        """Return the verdict of least expected cost."""
        odds = self.odds(ranking, sampled)
        choice = decide(ranking, odds, drifts=ranking.problem.drifts)
        if choice.verdict != OUTSIDE:
            return replace(choice, reasons=(*choice.reasons, *self.factors_told(ranking)))
        near = [
            f
            for f in ranking.fits[1:]
            if odds.beside.get(f.name, 0.0) > RULES.resembles * odds.outside
        ]
        free = 1.0 - sum(odds.beside.values()) / odds.outside
        share = {name: free * part for name, part in self.nameless.items()}
        alike = [n for n in ranking.nameless if share[n.screened.mechanism.name] > RULES.resembles]
        factors = [s for s in self.scaled if share[s.observable] > RULES.resembles]
        told = [
            *(self._nearest(f) for f in near),
            *(_behaves(n, share[n.screened.mechanism.name]) for n in alike),
            *(s.told for s in factors),
        ]
        titles = (*(n.screened.mechanism.title for n in alike), *(s.told for s in factors))
        return replace(choice, reasons=(*choice.reasons, *told), alike=titles)

    def factors_told(self, ranking: Ranking) -> tuple[str, ...]:
        """What a factor on one observable explains as well as the leading mechanism does."""
        best = max((f.log_evidence for f in ranking.fits), default=0.0)
        least = max(best - ranking.base.log_evidence, -math.log(RULES.supported))
        return tuple(s.told for s in self.scaled[:1] if s.gain >= least)

    def _nearest(self, fitted: Fit) -> str:
        worse = 100.0 * (1.0 - self.test(fitted).p_value)
        return (
            f"{fitted.name} comes nearest of what has a name, but fits worse than {worse:.3g} % of "
            "the sets that it makes itself"
        )


def _behaves(nameless: Nameless, share: float) -> str:
    fitted, mechanism = nameless.fit, nameless.screened.mechanism
    at = ""
    if fitted is not None:
        values = fitted.grid.values(fitted.place)[mechanism.name]
        at = " at " + ", ".join(f"{p.name} {values[p.name]:.2g} {p.unit}".rstrip(" -")
                                for p in mechanism.parameters)  # fmt: skip
    return (
        f"it behaves as if {mechanism.title}, {mechanism.equations}{at}: {100.0 * share:.0f} % of "
        "what is not in the library"
    )
