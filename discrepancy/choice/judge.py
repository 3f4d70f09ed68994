"""From fits and nulls to probabilities and the verdict that costs least."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from scipy.special import logsumexp

from ..rank import Nameless, Ranking
from .calibration import Calibration, calibrate
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
    """

    calibration: Calibration
    outside: float
    nameless: Mapping[str, float] = field(default_factory=dict)

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
        return cls(calibration, whole, share)

    def odds(self, ranking: Ranking, sampled: Mapping[str, float] | None = None) -> Odds:
        """Return the probabilities of the explanations of a ranking."""
        return odds_of(ranking, self.calibration, self.outside, sampled=sampled)

    def decided(self, ranking: Ranking, sampled: Mapping[str, float]) -> Choice:
        """Return the verdict of least expected cost."""
        choice = decide(ranking, self.odds(ranking, sampled), drifts=ranking.problem.drifts)
        alike = [n for n in ranking.nameless if self._share(n) > _ALIKE]
        if choice.verdict != OUTSIDE or not alike:
            return choice
        told = (_behaves(n, self._share(n)) for n in alike)
        titles = tuple(n.screened.mechanism.title for n in alike)
        return replace(choice, reasons=(*choice.reasons, *told), alike=titles)

    def _share(self, nameless: Nameless) -> float:
        return self.nameless[nameless.screened.mechanism.name]

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
