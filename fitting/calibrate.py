"""Regression of how far the laws are off, on combinations that their fits had not seen."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, minimize

from ..core.arrays import Array, Mask
from ..models.closed_form import PairNumbers
from ..models.uncertainty import FEATURES, Calibration, Uncertainty, deviation, features_of
from .prediction import Prediction, given_back
from .rules import RULES
from .table import ResidualTable, Table

SIGMAS = (0.724, 0.950)
"""Shares within one and two standard deviations of Student's t with seven degrees of freedom.

The errors have longer ends than a normal distribution, of which a deviation has to speak too.
"""


class Misses(NamedTuple):
    """Errors of one quantity and the features of where they were made."""

    features: Array  # shape (n, n_features)
    off: Array  # shape (n,)


def misses(
    p: Prediction,
    numbers: PairNumbers,
    table: Table,
    turns: ResidualTable,
    *,
    alone: Mask | None = None,
) -> dict[str, Misses]:
    """Errors of every quantity of `Uncertainty` beyond first yield, by name.

    - `p`: predictions, of combinations left out.
    - `numbers`: the law's numbers of every case, fields of shape (n_cases,).
    - `table`, `turns`: the rows.
    - `alone`: the cases that count, shape (n_cases,); all if not given.
    """
    count = np.ones(len(table.pairs), dtype=bool) if alone is None else alone

    def at(rows: Table | ResidualTable) -> Array:
        return features_of(PairNumbers(*(x[rows.case] for x in numbers)), rows.D)

    loaded, turned = at(table), at(turns)
    yielding, turned_so = count[table.case] & (table.w >= 1.0), count[turns.case]
    seen = yielding & table.edge_seen
    known = np.isfinite(turns.exponent) & turned_so
    off = {
        "force": (loaded, seen, np.log(p.force / table.force)),
        "radius": (loaded, seen, np.log(p.radius / table.radius)),
        "share": (loaded, yielding, p.share - table.share),
        "dent": (turned, turned_so & (turns.w >= 1.0), p.total / turns.total - 1.0),
        "given_back": (turned, known, given_back(p, turns) - 1.0),
    }
    return {name: Misses(x[m], error[m]) for name, (x, m, error) in off.items()}


def calibrate(found: dict[str, Misses]) -> Calibration:
    """Find the weights of the features: most likely, then scaled."""
    rows = []
    for name in Uncertainty._fields:
        features, off = found[name]
        size = np.maximum(np.abs(off), 1e-6)

        def surprise(weights: Array, features: Array = features, size: Array = size) -> float:
            # of a distribution with long ends: some combinations are worse than any rule says
            spread = deviation(features, weights, least=RULES.element_noise)
            loss = np.log(spread) + 2.5 * np.log1p((size / spread) ** 2 / 4.0)
            return float(np.mean(loss)) + RULES.feature_ridge * float(
                np.sum(weights[1:] ** 2)
            ) / len(FEATURES)

        first = np.zeros(len(FEATURES))
        first[0] = np.log(np.mean(size) + 1e-4)
        first[1] = 1.0
        bounds: list[tuple[float | None, float | None]] = [(None, None)] * len(FEATURES)
        if name != "dent":
            bounds[1] = RULES.before_yield
        weights = minimize(surprise, first, method="L-BFGS-B", bounds=bounds).x
        rows.append(_scaled(weights, features, size))
    return Calibration(np.array(rows))


def _scaled(weights: Array, features: Array, size: Array) -> Array:
    """Return the weights with the shares above; what one of them lacks the other has too much."""
    constant = np.eye(len(weights))[0]

    def beyond(scale: float) -> float:
        spread = deviation(features, weights + scale * constant, least=RULES.element_noise)
        one, two = (float(np.mean(size <= k * spread)) for k in (1.0, 2.0))
        return (one - SIGMAS[0]) + (two - SIGMAS[1])

    if beyond(-3.0) >= 0.0:
        return weights
    return np.asarray(weights + brentq(beyond, -3.0, 3.0) * constant)


def within(calibration: Calibration, found: dict[str, Misses]) -> dict[str, tuple[float, float]]:
    """Shares of the errors within one and two standard deviations, by quantity."""
    result = {}
    for weights, name in zip(calibration.weights, Uncertainty._fields, strict=True):
        stated = deviation(found[name].features, weights, least=RULES.element_noise)
        result[name] = shares_within(found[name].off, stated)
    return result


def shares_within(off: Array, stated: Array) -> tuple[float, float]:
    """Shares of errors within one and two of their stated deviations."""
    ratio = np.abs(off) / stated
    return float(np.mean(ratio <= 1.0)), float(np.mean(ratio <= 2.0))
