"""What evidence sets with nothing missing give away, by simulation: it counts from there.

With nothing missing a Bayes factor above 20 may come up in at most one set of twenty, whatever the
alternative, if the comparison's own assumptions hold (A. M. Turing, I. J. Good, Probability and
the Weighing of Evidence, 1950). Where the nulls of this rig exceed that, because a mechanism can
imitate what a contact law may be off by in other ways than those assumed, the excess is taken off.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp
from scipy.stats import gamma

from ..inference.fit import Fit
from ..inference.linear import Mixture
from ..rank import Ranking
from .odds import NAMED_AT, OUTSIDE, PRIORS, shares_outside
from .thresholds import Nulls

Array = NDArray[np.float64]

ONE_IN = 20.0
"""The Bayes factor, and one over the share of nulls, at which evidence is checked."""
ALARM = 0.97
"""Share of nulls that are not to be named, all alternatives together."""
_THIN, _MOVES, _SECOND = 400, 12, 36
_LEAST_LOG_P = -700.0  # what a float holds


@dataclass(frozen=True)
class Calibration:
    """Nats that nulls give away.

    Parameters
    ----------
    offset
        Mechanism, or `OUTSIDE`, to the nats that are taken off its evidence over the baseline.
    common
        Nats taken off every alternative, so that no more than `1 - ALARM` of nulls are named.
    second
        Nats taken off pairs, for what the nulls of the leading single give a second mechanism.
    """

    offset: Mapping[str, float] = field(default_factory=dict)
    common: float = 0.0
    second: float = 0.0

    def off(self, names: tuple[str, ...]) -> float:
        """Nats that are taken off an explanation of these mechanisms."""
        if not names:
            return 0.0
        own = max(self.offset.get(n, 0.0) for n in names)
        return self.common + own + self.second * (len(names) > 1)


def calibrate(ranking: Ranking, nulls: Nulls, outside: Mixture) -> Calibration:
    """Put sets with nothing missing through the comparison.

    Parameters
    ----------
    ranking
        The baseline and the singles.
    nulls
        Null residuals.
    outside
        Likelihood of something outside the library.
    """
    base = ranking.base
    r = nulls.made_by(base)
    plain = base.mixture.log_likelihood(r)
    nameless = [n.screened for n in ranking.nameless]
    tried = [*ranking.screened, *nameless]
    names = [*(s.mechanism.name for s in tried), OUTSIDE]
    found = [base.mixture.gain(r, thinned(s.effect, _THIN)) for s in tried]
    factors = np.stack([*found, outside.log_likelihood(r) - plain], axis=1)
    offset = np.array([given_away(column) for column in factors.T])
    if ranking.singles:
        offset[-1] = max(offset[-1], _outside_beside(ranking, nulls, outside))
    each = PRIORS["singles"] / max(len(ranking.screened), 1)
    free, own = shares_outside(len(nameless))
    shares = [*(each for _ in ranking.screened), *(PRIORS[OUTSIDE] * own for _ in nameless)]
    prior = np.array([*shares, PRIORS[OUTSIDE] * free]) / PRIORS["baseline"]
    odds = logsumexp(factors - offset + np.log(prior), axis=1)
    common = max(float(np.quantile(odds, ALARM)) - NAMED_AT, 0.0)
    return Calibration(
        dict(zip(names, (float(x) for x in offset), strict=True)), common,
        _second(ranking, nulls),
    )  # fmt: skip


def given_away(factors: Array) -> float:
    """Nats by which nulls' ln Bayes factors (n,) exceed what one in twenty may."""
    return max(float(np.quantile(factors, 1.0 - 1.0 / ONE_IN)) - math.log(ONE_IN), 0.0)


def _outside_beside(ranking: Ranking, nulls: Nulls, outside: Mixture) -> float:
    """Nats that sets made by the leading single give to something outside against it."""
    lead = max(ranking.singles, key=lambda f: f.log_evidence)
    made = nulls.made_by(lead)
    own = lead.mixture.mean_likelihood(made, moves(lead, _THIN)) + lead.grid.log_volume
    # the baseline leaves of them what the mechanism does as well
    left = made + (ranking.base.residual - lead.residual)
    return given_away(outside.log_likelihood(left) - own)


def _second(ranking: Ranking, nulls: Nulls) -> float:
    """Nats that sets made by the leading single give to the best second mechanism."""
    if not ranking.singles:
        return 0.0
    lead = max(ranking.singles, key=lambda f: f.log_evidence)
    r = nulls.made_by(lead)
    own = lead.mixture.mean_likelihood(r, moves(lead, _THIN))
    few = moves(lead, _MOVES)
    best = np.full(len(r), -np.inf)
    for s in ranking.screened:
        if s.mechanism.name in lead.names:
            continue
        more = thinned(s.effect, _SECOND)
        both = (few[:, None, :] + more[None, :, :]).reshape(-1, more.shape[1])
        best = np.maximum(best, lead.mixture.mean_likelihood(r, both) - own)
    return given_away(best) if np.isfinite(best).all() else 0.0


@dataclass(frozen=True, slots=True)
class FitTest:
    """How an explanation's own sets fit it, beside the data.

    Parameters
    ----------
    p_value
        Share of them that fit no better than the data do.
    log_odds
        Ln Bayes factor of something that acts beside it, whatever that is.
    """

    p_value: float
    log_odds: float


def fit_test(fitted: Fit, nulls: Nulls) -> FitTest:
    """Compare the fit of an explanation with its fits to data sets that it makes itself.

    A set is the explanation's prediction with the null residuals; the mechanism's parameters are
    fitted to each. Beyond the last of the sets their chi2, a sum of squares, is taken for a gamma
    variable of the same mean and variance (F. Satterthwaite, Biometrics Bull. 2 (1946) 110).
    """
    residual = nulls.made_by(fitted)
    if fitted.mechanisms:
        effects = moves(fitted, _THIN)
        e = fitted.linear.white(effects)
        ratio = 2.0 * fitted.linear.white(residual) @ e.T - np.sum(e**2, axis=1)
        best = np.argmax(ratio, axis=1)
        moved = ratio[np.arange(len(best)), best] > 0.0
        residual = np.where(moved[:, None], residual - effects[best], residual)
    chi2 = np.sum(fitted.linear.white(residual) ** 2, axis=1)
    p = (int(np.sum(chi2 >= fitted.chi2)) + 1) / (len(chi2) + 1)
    mean, variance = float(np.mean(chi2)), float(np.var(chi2))
    if not variance > 0.0:
        return FitTest(p, 0.0)
    log_p = float(gamma.logsf(fitted.chi2, mean**2 / variance, scale=variance / mean))
    return FitTest(p, _something_else(max(log_p, _LEAST_LOG_P)))


def _something_else(log_p: float) -> float:
    """Ln Bayes factor of p values that crowd at 0 as xi p^(xi - 1), xi even in (0, 1).

    T. Sellke, M. J. Bayarri, J. O. Berger, Am. Stat. 55 (2001) 62, for the family.
    """
    if log_p > -1e-3:
        return -math.log(2.0)
    return math.log(math.exp(log_p) * (log_p - 1.0) + 1.0) - log_p - 2.0 * math.log(-log_p)


def moves(fitted: Fit, most: int) -> Array:
    """Effect of other parameter values than the best, (k, m), no more than about `most`."""
    return thinned(fitted.residual - fitted.residuals, most)


def thinned(effect: Array, most: int) -> Array:
    """Return every so many rows, about `most`."""
    return effect[:: max(len(effect) // most, 1)]
