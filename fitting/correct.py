"""Regression of what the fitted law adds to the compact one.

The weights of the bumps are found by Gauss and Newton's steps on all curves at once, held back by a
prior that says: no shift unless the data ask for one. Number and reach of the bumps and the prior
were chosen by what they give for combinations left out.
"""

from __future__ import annotations

import itertools
import math
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from ..core.arrays import Array
from ..models.closed_form import Coefficients, PairNumbers, of_pair
from ..models.correction import CHANNELS, PairCorrection, bumps, coordinates, moved
from .prediction import Prediction, misfit, predict_by, slopes_of
from .rules import RULES
from .table import ResidualTable, Table

# limit: most steps of the regression [-]
_REGRESSION_STEPS = 25

REACHES = np.array([0.9, 2.2, 1.2, 3.0, 4.0])


def corrected_prediction(
    values: Array, correction: PairCorrection, table: Table, turns: ResidualTable
) -> Prediction:
    """Every row by the compact law of these values with a correction."""
    return predict_by(correction.of(table.bodies, compact_numbers(values, table)), table, turns)


def compact_numbers(values: Array, table: Table) -> PairNumbers:
    """The compact law's numbers of every case, each of shape (n_cases,)."""
    numbers = of_pair(table.bodies, Coefficients(*values))
    return PairNumbers(*(np.broadcast_to(x, len(table.pairs)) for x in numbers))


def correct(values: Array, table: Table, turns: ResidualTable, ripple: Array) -> PairCorrection:
    """Find the correction to the compact law for the cases that have rows.

    Of `table` every fourth depth is looked at. `ripple` is that of ln F and ln a of each row's
    case, shape (2, n); a case whose mesh ripples says less.
    """
    thin = np.arange(len(table.D)) % RULES.every_depth == 0
    numbers = compact_numbers(values, table)
    units = np.hypot(RULES.unit, ripple)
    groups = coordinates(table.bodies, numbers)
    centres = _spread_out(groups[np.unique(table.case)])
    alike = bumps(centres, centres, REACHES) + 1e-4 * np.eye(len(centres))
    white = np.linalg.inv(np.linalg.cholesky(alike)).T
    rows = _Rows(numbers, table.rows(thin), turns, *units[:, thin])
    basis = bumps(groups, centres, REACHES) @ white
    return PairCorrection(centres, REACHES, white @ _descend(rows, basis))


def _spread_out(groups: Array) -> Array:
    """Return a subset of `groups` as far from each other as may be, shape (m, n_groups)."""
    scaled = groups / REACHES
    chosen = [int(np.argmin(np.sum((scaled - scaled.mean(axis=0)) ** 2, axis=1)))]
    nearest = np.full(len(scaled), np.inf)
    while len(chosen) < max(len(scaled) / RULES.pairs_a_bump, 1.0):
        away = np.sum((scaled - scaled[chosen[-1]]) ** 2, axis=1)
        nearest = np.minimum(nearest, away)
        chosen.append(int(np.argmax(nearest)))
    return np.asarray(groups[chosen])


class _Rows(NamedTuple):
    """The curves of all cases as functions of the cases' shifts."""

    numbers: PairNumbers
    table: Table
    turns: ResidualTable
    unit_F: Array
    unit_a: Array

    def misfit(self, shifts: Any) -> tuple[Any, Any]:
        """Misfits in their units of loading, shape (3, n), and of unloading, shape (4, n)."""
        p = predict_by(moved(self.numbers, shifts), self.table, self.turns)
        (F, a, share), (total, sphere, exponent, back) = misfit(p, self.table, self.turns)
        unit_left = RULES.unit_left[0] + RULES.unit_left[1] * self.turns.total
        return (
            np.stack([F / self.unit_F, a / self.unit_a, share / RULES.unit]),
            np.stack([
                total / unit_left, sphere / (10.0 * RULES.unit_left[0]),
                exponent / RULES.unit_exponent, back / RULES.unit_back,
            ]),
        )  # fmt: skip

    def cost(self, shifts: Array) -> float:
        """Sum of the squares, of outliers less; infinite where a curve can't be drawn."""
        with np.errstate(all="ignore"):
            parts = self.misfit(shifts)
            total = sum(float(np.sum(np.sqrt(1.0 + (r / RULES.outlier) ** 2) - 1.0)) for r in parts)
        return RULES.outlier**2 * total if np.isfinite(total) else math.inf

    def normal(self, shifts: Array) -> tuple[Array, Array]:
        """Each case's normal matrix, shape (n_cases, k, k), and gradient, shape (n_cases, k)."""
        cases, k = shifts.shape
        here = self.misfit(shifts)

        def moved_by(each: Array) -> Array:
            return np.concatenate([part.ravel() for part in self.misfit(shifts + each)])

        both = np.split(slopes_of(moved_by, np.zeros(k)), [here[0].size])
        matrix, gradient = np.zeros((cases, k, k)), np.zeros((cases, k))
        cases_of = (self.table.case, self.turns.case)
        for off, slope, number in zip(here, both, cases_of, strict=True):
            order = np.argsort(number, kind="stable")
            slope = slope.reshape(*off.shape, k)[:, order]  # (quantities, rows, k)
            weight = 1.0 / np.sqrt(1.0 + (off / RULES.outlier) ** 2)
            weight, off = weight[:, order], off[:, order]
            ends = np.searchsorted(number[order], np.arange(cases + 1))
            for case, (first, last) in enumerate(itertools.pairwise(ends)):
                J = slope[:, first:last].reshape(-1, k)
                w = weight[:, first:last].ravel()
                matrix[case] += (J.T * w) @ J
                gradient[case] += (J.T * w) @ off[:, first:last].ravel()
        return matrix, gradient


def _normal_of(basis: Array, matrix: Array) -> Array:
    """Normal matrix of the weights, channel by channel, of those of the cases, (n, k, k)."""
    m, k = basis.shape[1], matrix.shape[1]
    whole = np.empty((k, m, k, m))
    for i in range(k):
        for j in range(i + 1):
            whole[i, :, j] = whole[j, :, i] = basis.T @ (matrix[:, i, j, None] * basis)
    return whole.reshape(k * m, k * m)


def _descend(rows: _Rows, basis: Array) -> Array:
    """Weights of the basis, shape (m, k), by damped steps of Gauss and Newton from none."""
    m, k = basis.shape[1], len(CHANNELS)
    weights, damping = np.zeros((m, k)), 1e-2

    def objective(at: Array) -> float:
        return rows.cost(basis @ at) + 0.5 * RULES.shift_prior * float(np.sum(at**2))

    best = objective(weights)
    for _ in range(_REGRESSION_STEPS):
        matrix, gradient = rows.normal(basis @ weights)
        whole = _normal_of(basis, matrix)
        slope = (gradient.T @ basis + RULES.shift_prior * weights.T).ravel()
        before = best
        for _ in range(8):
            damped = whole + RULES.shift_prior * (1.0 + damping) * np.eye(m * k)
            step = -cho_solve(cho_factor(damped), slope).reshape(k, m).T
            step *= min(1.0, RULES.farthest_shift / float(np.abs(basis @ step).max()))
            value = objective(weights + step)
            if value < best:
                weights, best, damping = weights + step, value, damping / 4.0
                break
            damping = max(5.0 * damping, 1.0)
        if before - best < RULES.regression_settled * before:
            break
    return weights
