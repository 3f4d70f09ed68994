"""From fits and nulls to probabilities and the verdict that costs least."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from scipy.special import logsumexp

from ..inference.fit import Fit
from ..rank import Nameless, Ranking
from .calibration import Calibration, FitTest, calibrate, fit_test
from .decide import Choice, decide
from .odds import OUTSIDE, PRIORS, Odds, odds_of, shares_outside
from .outside import odd_repeats, outside_of
from .thresholds import Nulls

_ALIKE = 0.5
"""Share of what is outside the library from which one that has no name is said to be like it."""


@dataclass(frozen=True)
class Judge:
    """What nulls of a set give away, and what speaks for something outside.

    Parameters
    ----------
    calibration
        Nats taken off each alternative.
    outside
        Ln evidence of something outside the library over the baseline's.
    nameless
        Physics without a name to its share of that evidence.
    nulls
        Sets with nothing missing, from which each explanation's own sets are made.
    """

    calibration: Calibration
    outside: float
    nameless: Mapping[str, float]
    nulls: Nulls
    _tests: dict[str, FitTest] = field(default_factory=dict)

    @classmethod
    def of(cls, ranking: Ranking, nulls: Nulls) -> Judge:
        """Put sets with nothing missing through the comparison."""
        free = outside_of(ranking.problem, ranking.base)
        calibration = calibrate(ranking, nulls, free)
        gained = float(free.log_likelihood(ranking.base.residual)) - ranking.base.log_evidence
        known_to_none, own = shares_outside(len(ranking.nameless))
        parts = {
            n.screened.mechanism.name: n.log_bayes + math.log(own)
            - calibration.offset[n.screened.mechanism.name]
            for n in ranking.nameless
        }  # fmt: skip
        parts[OUTSIDE] = gained + math.log(known_to_none) - calibration.offset[OUTSIDE]
        parts["repeats"] = odd_repeats(ranking.problem)
        whole = float(logsumexp(list(parts.values())))
        share = {k: math.exp(v - whole) for k, v in parts.items() if k not in (OUTSIDE, "repeats")}
        return cls(calibration, whole, share, nulls)

    def odds(self, ranking: Ranking, sampled: Mapping[str, float] | None = None) -> Odds:
        """Return the probabilities of the explanations of a ranking."""
        return odds_of(
            ranking, self.calibration, self.outside, sampled=sampled,
            beside=lambda fitted: self.test(fitted).log_odds,
        )  # fmt: skip

    def test(self, fitted: Fit) -> FitTest:
        """Return how an explanation fits, beside the sets that it makes itself."""
        if fitted.name not in self._tests:
            self._tests[fitted.name] = fit_test(fitted, self.nulls)
        return self._tests[fitted.name]

    def decided(self, ranking: Ranking, sampled: Mapping[str, float]) -> Choice:
        """Return the verdict of least expected cost."""
        odds = self.odds(ranking, sampled)
        choice = decide(ranking, odds, drifts=ranking.problem.drifts)
        if choice.verdict != OUTSIDE:
            return choice
        near = [f for f in ranking.fits if odds.beside.get(f.name, 0.0) > _ALIKE * odds.outside]
        free = 1.0 - sum(odds.beside.values()) / odds.outside
        share = {n: free * self.nameless[n.screened.mechanism.name] for n in ranking.nameless}
        alike = [n for n in ranking.nameless if share[n] > _ALIKE]
        told = [*(self._nearest(f) for f in near), *(_behaves(n, share[n]) for n in alike)]
        titles = tuple(n.screened.mechanism.title for n in alike)
        return replace(choice, reasons=(*choice.reasons, *told), alike=titles)

    def _nearest(self, fitted: Fit) -> str:
        worse = 100.0 * (1.0 - self.test(fitted).p_value)
        return (
            f"{fitted.name} comes nearest of what has a name, but fits worse than {worse:.3g} % of "
            "the sets that it makes itself"
        )

    def log_prior(self, ranking: Ranking) -> dict[str, float]:
        """Name to ln of the prior probability, less what nulls give away, of every fit."""
        n = max(len(ranking.screened), 1)
        share = {0: PRIORS["baseline"], 1: PRIORS["singles"] / n}
        share[2] = PRIORS["pairs"] / max(n * (n - 1) // 2, 1)
        return {
            f.name: math.log(share[len(f.mechanisms)]) - self.calibration.off(f.names)
            for f in ranking.fits
        }


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
