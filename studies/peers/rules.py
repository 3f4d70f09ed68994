"""The rules, declared before they are run: what they say of a set, and with what probabilities."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from typing import NamedTuple

import numpy as np
from scipy.special import logsumexp
from scipy.stats import chi2

from ...core.arrays import Array
from ...discrepancy.choice.odds import OUTSIDE
from .fitted import Fitted, Tried

ANOTHER_PAIR = "another pair"
"""All pairs that a rule does not fit, alike."""

PRIORS = {"baseline": 0.5, "singles": 0.34, "pairs": 0.06, OUTSIDE: 0.1}
"""Of the plan: what each rule gives before the comparison."""

_MISFIT = 0.01
"""Share of chi2 below which what a rule says does not fit."""

_KEPT = 0.2
"""What is inside the library keeps so much of its probability where the leader does not fit: the
factor of the diagnosis."""


class Said(NamedTuple):
    """What a rule says of a set: a verdict's word, and the mechanism that it names."""

    verdict: str
    name: str = ""


class Cost(NamedTuple):
    """What a rule makes of an explanation, -2 ln of its weight; its chi2, its free numbers."""

    total: float
    chi2: float
    parameters: int


Costs = Callable[[Fitted], Mapping[str, Cost]]
"""A rule's cost of each explanation, `baseline` among them."""


@dataclass(frozen=True)
class Rule:
    """The explanation of least cost, each mechanism for a margin, unless it does not fit.

    `costs`: of every explanation; `margin`: by how much a name must win over the baseline, and a
    second mechanism over one; `pairs`: whether it fits pairs.
    """

    costs: Costs
    margin: float = 10.0
    pairs: bool = False

    def says(self, fitted: Fitted) -> Said:
        """Return the verdict."""
        cost = self.costs(fitted)
        said = "baseline"
        for others in (0, 1):
            step = [k for k in cost if k != "baseline" and k.count("+") == others]
            best = min(step, key=lambda k: cost[k].total, default=said)
            if cost[best].total < cost[said].total - self.margin:
                said = best
        return _told(said, cost[said], fitted)

    def odds(self, fitted: Fitted) -> dict[str, float]:
        """Return the probability of every explanation."""
        cost = self.costs(fitted)
        logs = {k: -0.5 * c.total for k, c in cost.items()}
        every = logsumexp(list(logs.values()))
        lead = min(cost, key=lambda k: cost[k].total)
        weights = {k: math.exp(x - every) for k, x in logs.items()}
        return _shared(weights, fits(cost[lead], fitted.cells), pairs=self.pairs)


class LeftOut:
    """Conditions left out one by one and predicted from the rest, over each explanation's grid.

    Probabilities are the weights whose mixture predicts best (stacking; Yao and others, Bayesian
    Analysis 13 (2018) 917). A name needs 4 nats and two standard errors over the baseline (Sivula
    and others, arXiv:2008.10296).
    """

    @staticmethod
    def says(fitted: Fitted) -> Said:
        """Return the verdict."""
        base = fitted.tried[0]
        best = max(fitted.tried, key=lambda t: float(np.sum(t.left_out)))
        gain = best.left_out - base.left_out
        error = math.sqrt(len(gain)) * float(np.std(gain, ddof=1)) if len(gain) > 1 else math.inf
        if not float(np.sum(gain)) > max(4.0, 2.0 * error):
            best = base
        return _told(best.name, _of(best, best.floor, 0.0), fitted)

    @staticmethod
    def odds(fitted: Fitted) -> dict[str, float]:
        """Return the probability of every explanation."""
        logs = np.stack([t.left_out for t in fitted.tried])
        weight = stacked(logs)
        best = fitted.tried[int(np.argmax(weight))]
        found = {t.name: float(w) for t, w in zip(fitted.tried, weight, strict=True)}
        return _shared(found, fits(_of(best, best.floor, 0.0), fitted.cells))


def stacked(logs: Array, *, rounds: int = 500) -> Array:
    """Return the weights (n,) whose mixture gives left-out conditions the most, from ln p (n, g).

    By expectation and maximisation: the sum of logarithms is concave in the weights.
    """
    p = np.exp(logs - logs.max(axis=0))
    weight = np.full(len(p), 1.0 / len(p))
    for _ in range(rounds):
        weight = weight * np.mean(p / (weight @ p), axis=1)
    return np.asarray(weight)


def _told(name: str, cost: Cost, fitted: Fitted) -> Said:
    if not fits(cost, fitted.cells):
        return Said(OUTSIDE)
    return Said("adequate") if name == "baseline" else Said("missing-physics", name)


def fits(cost: Cost, cells: int) -> bool:
    """Whether an explanation's chi2 is no larger than one in a hundred would have it."""
    return bool(chi2.sf(cost.chi2, max(cells - cost.parameters, 1)) >= _MISFIT)


def _shared(weights: Mapping[str, float], fit: bool, *, pairs: bool = False) -> dict[str, float]:
    """Leave to pairs, where none was fitted, and to what is outside, their prior shares."""
    left = 0.0 if pairs else PRIORS["pairs"]
    inside = 1.0 - PRIORS[OUTSIDE] - left
    kept = 1.0 if fit else _KEPT
    found = {k: kept * inside * w for k, w in weights.items()} | {ANOTHER_PAIR: kept * left}
    return found | {OUTSIDE: 1.0 - sum(found.values())}


def _of(t: Tried, found: tuple[float, float], price: float) -> Cost:
    return Cost(sum(found) + t.parameters * price, found[0], t.parameters)


def _bic(fitted: Fitted) -> dict[str, Cost]:
    return {t.name: _of(t, t.floor, math.log(fitted.cells)) for t in fitted.tried}


def _bic_on_noise(fitted: Fitted) -> dict[str, Cost]:
    return {t.name: _of(t, t.noise, math.log(fitted.cells)) for t in fitted.tried}


def _aic_on_noise(fitted: Fitted) -> dict[str, Cost]:
    return {t.name: _of(t, t.noise, 2.0) for t in fitted.tried}


def _bic_with_pairs(fitted: Fitted) -> dict[str, Cost]:
    more = {t.name: _of(t, t.floor, math.log(fitted.cells)) for t in fitted.pairs}
    return _bic(fitted) | more


def _integrated(fitted: Fitted) -> dict[str, Cost]:
    """Prior times mean likelihood over the grid; the priors are those of the plan."""
    n = max(fitted.acting, 1)
    share = (PRIORS["baseline"], PRIORS["singles"] / n, PRIORS["pairs"] / max(n * (n - 1) / 2, 1))
    prior = [share[0], *[share[1]] * fitted.acting, *[share[2]] * len(fitted.pairs)]
    return {
        t.name: Cost(-2.0 * (t.evidence + math.log(p)), t.floor[0], t.parameters)
        for t, p in zip((*fitted.tried, *fitted.pairs), prior, strict=True)
    }


def _lasso(fitted: Fitted) -> dict[str, Cost]:
    """BIC along the path of positive shares of the effects, of unit length, two at most."""
    from sklearn.linear_model import lars_path

    free = {t.name: t.parameters for t in fitted.tried}
    columns = {k: c / np.linalg.norm(c) for k, c in fitted.columns.items() if np.any(c)}
    white, names = fitted.white, np.array(list(columns))
    least = float(white @ white)
    found = {"baseline": Cost(least, least, 0)}
    if not columns:
        return found
    X = np.stack(list(columns.values()), axis=1)
    for share in lars_path(X, white, method="lasso", positive=True)[2].T:
        chosen = names[share > 0.0]
        square, k = float(np.sum((white - X @ share) ** 2)), sum(free[n] for n in chosen)
        cost = Cost(square + k * math.log(fitted.cells), square, k)
        if 0 < len(chosen) <= 2:
            found["+".join(chosen)] = min(cost, found.get("+".join(chosen), cost))
    return found


_DECLARED: dict[str, Rule | LeftOut] = {
    "BIC on noise": Rule(_bic_on_noise),
    "AIC on noise": Rule(_aic_on_noise, margin=0.0),
    "BIC, 3 % floor": Rule(_bic),
    "BIC, 3 % floor, margin 4": Rule(_bic, margin=4.0),
    "BIC, 3 % floor, pairs": Rule(_bic_with_pairs, pairs=True),
    # odds of 20: strong (Kass and Raftery, J. Am. Stat. Assoc. 90 (1995) 773)
    "Bayes factors": Rule(_integrated, margin=6.0, pairs=True),
    "leave one condition out": LeftOut(),
    "lasso, BIC": Rule(_lasso, margin=0.0, pairs=True),
}

RULES: Mapping[str, Rule | LeftOut] = {
    name: rule for name, rule in _DECLARED.items() if name != "lasso, BIC" or find_spec("sklearn")
}
"""Declared before they are run. The lasso needs scikit-learn, which comes with the extra `bayes`;
Gaussian processes with attribution, Pareto-smoothed leave-one-out (the exact one is at hand) and
emdcmp were not run."""
