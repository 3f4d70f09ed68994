"""How an explanation fits beside the data sets that it makes itself."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.stats import gamma

from ..inference.fit import Fit
from .thresholds import Nulls

# limit: places of a grid that stand for all [-]; memory
_THINNED = 400

_LEAST_LOG_P = -700.0  # what a float holds


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
        effects = fitted.residual - fitted.residuals
        effects = effects[:: max(len(effects) // _THINNED, 1)]
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
