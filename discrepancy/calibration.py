"""Thresholds of one set, from its null residuals: single, pair, fit, width of the reported set."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .correction import widened
from .inference.fit import Fit
from .problem import Problem
from .rank import Ranking
from .thresholds import Nulls, gain, null_bayes_factors

Array = NDArray[np.float64]

_THIN = 400
_VERY_STRONG = 5.0
"""Nats by which a freer force law must win to count against an explanation at all: odds of 150,
"very strong" of R. E. Kass and A. E. Raftery, J. Am. Stat. Assoc. 90 (1995) 773."""
_ALARM = 0.97
"""Share of nulls that pass no threshold; the test of fit adds at most 1 % of false alarms."""


@dataclass(frozen=True, eq=False)
class Calibration:
    """Gains of evidence that sets with nothing missing give.

    Mechanisms that can imitate an error of the contact law gain evidence from it. So the gain of a
    mechanism counts from what one null in twenty gives it, its offset.

    Parameters
    ----------
    offset
        Mechanism to the 95 % point of its ln B over the nulls, at least 0.
    single
        97 % point of the largest ln B minus offset over the library, at least 1.
    """

    offset: dict[str, float]
    single: float

    def excess(self, fitted: Fit, base: Fit) -> float:
        """Ln B of a fit over the baseline, less its mechanisms' offset."""
        return fitted.log_evidence - base.log_evidence - self._offset(fitted)

    def needed(self, fitted: Fit) -> float:
        """Return the ln B that a single mechanism must pass."""
        return self.single + self._offset(fitted)

    def _offset(self, fitted: Fit) -> float:
        return max((self.offset.get(m.name, 0.0) for m in fitted.mechanisms), default=0.0)

    def sorted(self, ranking: Ranking) -> Ranking:
        """Return the ranking with the explanations in the order of their excess."""
        order = lambda f: -self.excess(f, ranking.base)  # noqa: E731
        return replace(
            ranking,
            singles=tuple(sorted(ranking.singles, key=order)),
            pairs=tuple(sorted(ranking.pairs, key=order)),
        )


def calibrate(ranking: Ranking, nulls: Nulls) -> Calibration:
    """Put the nulls through the screening."""
    if not ranking.screened:
        return Calibration({}, 1.0)
    factors = null_bayes_factors(nulls, ranking.base, [s.effect for s in ranking.screened])
    offset = np.maximum(np.quantile(factors, 0.95, axis=0), 0.0)
    best = (factors - offset).max(axis=1)
    names = [s.mechanism.name for s in ranking.screened]
    return Calibration(
        dict(zip(names, (float(x) for x in offset), strict=True)),
        max(float(np.quantile(best, _ALARM)), 1.0),
    )


def p_fit(fitted: Fit, nulls: Nulls, problem: Problem) -> float:
    """Share of data sets made by this explanation that fit it no better than the data do.

    A set is the explanation's prediction with the null residuals; the mechanism's parameters are
    fitted to each. The smaller of two shares, doubled because there are two: by the misfit over all
    cells, and by what a contact law with a far wider error would gain, which sees a wrong force law
    whose misfit is spread over many cells.
    """
    residual = nulls.made_by(fitted)
    if fitted.mechanisms:
        moves = _moves(fitted)
        e = fitted.linear.white(moves)
        ratio = 2.0 * fitted.linear.white(residual) @ e.T - np.sum(e**2, axis=1)
        best = np.argmax(ratio, axis=1)
        moved = ratio[np.arange(len(best)), best] > 0.0
        residual = np.where(moved[:, None], residual - moves[best], residual)
    chi2 = np.sum(fitted.linear.white(residual) ** 2, axis=1)
    wide = widened(problem, fitted)
    gained = wide.log_likelihood(residual) - fitted.linear.log_likelihood(residual)
    own = wide.log_likelihood(fitted.residual) - fitted.linear.log_likelihood(fitted.residual)
    worse = int(np.sum(chi2 >= fitted.chi2))
    if own > _VERY_STRONG:
        worse = min(worse, int(np.sum(gained >= own)))
    return min(2.0 * (worse + 1) / (len(chi2) + 1), 1.0)


def extra_threshold(fitted: Fit, ranking: Ranking, nulls: Nulls, level: float = 0.99) -> float:
    """Gain of ln evidence that a second mechanism must pass, where only the fitted one acts.

    `level` of the sets that the fit itself would make give less to the best of all others.
    """
    white = fitted.linear.white(nulls.made_by(fitted))
    own = gain(white, np.zeros(len(white)), fitted.linear, _moves(fitted))
    inside = {m.name for m in fitted.mechanisms}
    most = np.full(len(white), -np.inf)
    moves = _thinned(_moves(fitted), 12)
    for s in ranking.screened:
        if s.mechanism.name in inside:
            continue
        effect = _thinned(s.effect, 36)
        both = (moves[:, None, :] + effect[None, :, :]).reshape(-1, effect.shape[1])
        most = np.maximum(most, gain(white, np.zeros(len(white)), fitted.linear, both) - own)
    return max(float(np.quantile(most, level)), 2.0) if np.isfinite(most).all() else np.inf


def set_width(fitted: Fit, ranking: Ranking, nulls: Nulls, level: float = 0.95) -> float:
    """Distance in ln evidence within which rivals of the best fit are reported beside it.

    In `level` of the sets that the fit itself would make it lies no farther behind a rival of its
    own size; kept between 2 and 5 nats.
    """
    white = fitted.linear.white(nulls.made_by(fitted))
    own = gain(white, np.zeros(len(white)), fitted.linear, _moves(fitted))
    size = len(fitted.mechanisms)
    behind = np.zeros(len(white))
    for rival in (*ranking.singles, *ranking.pairs):
        if rival.name == fitted.name or len(rival.mechanisms) != size:
            continue
        # the rival's predictions, seen from the fitted explanation's
        effect = -rival.residuals + fitted.residual
        effect = _thinned(effect, _THIN)
        theirs = gain(white, np.zeros(len(white)), fitted.linear, effect)
        behind = np.maximum(behind, theirs - own)
    return float(np.clip(np.quantile(behind, level), 2.0, 5.0))


def _moves(fitted: Fit) -> Array:
    """Effect of other parameter values than the best, (k, m)."""
    return _thinned(fitted.residual - fitted.residuals, _THIN)


def _thinned(effect: Array, most: int) -> Array:
    step = max(len(effect) // most, 1)
    return effect[::step]
