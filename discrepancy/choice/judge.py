"""From fits and nulls to probabilities and the verdict that costs least."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..rank import Ranking
from .calibration import Calibration, calibrate
from .decide import Choice, decide
from .odds import OUTSIDE, PRIORS, Odds, odds_of
from .outside import odd_repeats, outside_of
from .thresholds import Nulls


@dataclass(frozen=True)
class Judge:
    """What nulls of a set give away, and what speaks for something outside.

    Parameters
    ----------
    calibration
        Nats taken off each alternative.
    outside
        Ln evidence of something outside the library over the baseline's.
    """

    calibration: Calibration
    outside: float

    @classmethod
    def of(cls, ranking: Ranking, nulls: Nulls) -> Judge:
        """Put sets with nothing missing through the comparison."""
        free = outside_of(ranking.problem, ranking.base)
        calibration = calibrate(ranking, nulls, free)
        gained = float(free.log_likelihood(ranking.base.residual)) - ranking.base.log_evidence
        gained -= calibration.offset[OUTSIDE]
        return cls(calibration, float(np.logaddexp(gained, odd_repeats(ranking.problem))))

    def odds(self, ranking: Ranking, sampled: Mapping[str, float] | None = None) -> Odds:
        """Return the probabilities of the explanations of a ranking."""
        return odds_of(ranking, self.calibration, self.outside, sampled=sampled)

    def decided(self, ranking: Ranking, sampled: Mapping[str, float]) -> Choice:
        """Return the verdict of least expected cost."""
        return decide(ranking, self.odds(ranking, sampled), drifts=ranking.problem.drifts)

    def log_prior(self, ranking: Ranking) -> dict[str, float]:
        """Name to ln of the prior probability, less what nulls give away, of every fit."""
        n = max(len(ranking.screened), 1)
        share = {0: PRIORS["baseline"], 1: PRIORS["singles"] / n}
        share[2] = PRIORS["pairs"] / max(n * (n - 1) // 2, 1)
        return {
            f.name: math.log(share[len(f.mechanisms)]) - self.calibration.off(f.names)
            for f in ranking.fits
        }
