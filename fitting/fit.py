"""Regression of our closed form on a campaign, with honest errors.

Rows of one material combination are not independent: the standard errors allow for that (clustered
by combination), and the error that a user should expect is that of combinations left out of the fit
(cross-validation over whole combinations).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares

from ..core.errors import COMPLETED, Ending, Outcome
from ..models import Domain
from ..models.fitted import ENDS, NAMES, Fitted, fitted_law
from .table import ResidualTable, Table

Floats = npt.NDArray[np.float64]

_START_BLENDED = {"w1": 4.0, "q": 0.35, "h": 0.5}
_START_SINGLE = {
    "n": 6.0, "p": 1.2, "w2": 4.0, "s": 1.5, "t": 0.15, "k1": 0.11, "k2": 5.0, "r1": 0.15,
    "r2": 5.0, "g0": 8.0, "g1": 1.0, "g2": 1.0, "g3": 0.1,
}  # fmt: skip
START: dict[str, float] = {
    **{f"{name}_{end}": value for name, value in _START_BLENDED.items() for end in ENDS},
    **_START_SINGLE,
}
"""Where the regression starts: the same for flattening, equal strengths and indentation."""

_BOUNDS: dict[str, tuple[float, float]] = {
    "w1": (0.5, 50.0), "p": (0.4, 4.0), "q": (0.05, 0.8), "h": (-3.0, 6.0), "w2": (0.5, 50.0),
    "s": (0.4, 12.0), "t": (0.02, 0.6), "n": (1.0, 30.0), "k1": (0.0, 0.4), "k2": (0.1, 200.0),
    "r1": (0.0, 0.4), "r2": (0.1, 200.0), "g0": (1.0, 60.0), "g1": (-20.0, 60.0), "g2": (-1.0, 4.0),
    "g3": (1e-3, 5.0),
}  # fmt: skip
_UNIT = 0.01  # a residual of one: 1 % in F and a, 0.01 in the shares


@dataclass(frozen=True)
class Errors:
    """Mean and largest error of each quantity; F and a relative, the others absolute."""

    force: tuple[float, float]
    radius: tuple[float, float]
    share: tuple[float, float]
    residual: tuple[float, float]


@dataclass(frozen=True)
class Fit:
    """Result of the regression.

    Parameters
    ----------
    values, standard_errors
        By the order of `models.fitted.NAMES`, shape (n,).
    covariance
        Allowing for rows of one combination that move together, shape (n, n).
    errors, held_out
        Errors on the fitted rows, and on combinations left out one by one.
    outcome
        How the regression ended.
    """

    values: Floats
    standard_errors: Floats
    covariance: Floats
    errors: Errors
    held_out: Errors
    outcome: Outcome

    @property
    def law(self) -> Fitted:
        """The law with these coefficients."""
        return _law(self.values)


def fit_tables(table: Table, residuals: ResidualTable) -> Fit:
    """Fit the closed form to a campaign.

    Parameters
    ----------
    table, residuals
        Rows of the campaign, from `read_tables`.
    """
    values, jacobian, misfit, ok = _regress(table, residuals)
    clusters = np.concatenate([np.tile(table.case, 3), np.tile(residuals.case, 2)])
    covariance = _covariance(jacobian, misfit, clusters)
    outcome = (
        COMPLETED
        if ok
        else Outcome(Ending.NOT_CONVERGED, "the regression ran out of steps.", "Look at the data.")
    )
    return Fit(
        values=values,
        standard_errors=np.sqrt(np.maximum(np.diag(covariance), 0.0)),
        covariance=covariance,
        errors=_errors(_misfit(values, table, residuals), table, residuals),
        held_out=_cross_validate(table, residuals, values),
        outcome=outcome,
    )


def _law(values: Floats) -> Fitted:
    return fitted_law(dict(zip(NAMES, values.tolist(), strict=True)), domain=Domain())


def _bounds() -> tuple[list[float], list[float]]:
    pairs = [_BOUNDS[name.split("_")[0]] for name in NAMES]
    return [low for low, _ in pairs], [high for _, high in pairs]


def _regress(
    table: Table, residuals: ResidualTable, start: Floats | None = None
) -> tuple[Floats, Floats, Floats, bool]:
    x0 = np.array([START[name] for name in NAMES]) if start is None else start
    found = least_squares(
        lambda x: _misfit(x, table, residuals) / _UNIT,
        x0,
        bounds=_bounds(),
        x_scale="jac",
        loss="soft_l1",
        max_nfev=200,
    )
    plain = _misfit(found.x, table, residuals) / _UNIT
    return found.x, np.asarray(found.jac), plain, bool(found.success)


def _misfit(values: Floats, table: Table, residuals: ResidualTable) -> Floats:
    """Ln F, ln a, share, residual depth, sphere's residual: law minus data."""
    law = _law(values)
    force, radius, share = (np.empty(len(table.D)) for _ in range(3))
    total, sphere = np.empty(len(residuals.D)), np.empty(len(residuals.D))
    for number, pair in enumerate(table.pairs):
        m = table.case == number
        if m.any():
            depth = table.D[m] * pair.R
            force[m] = law.loading(pair, depth) / (pair.E_reduced * pair.R**2)
            radius[m] = law.contact_radius(pair, depth) / pair.R
            share[m] = law.share(pair, depth)
        k = residuals.case == number
        if k.any():
            peak = residuals.D[k] * pair.R
            s, f = law.residual(pair, peak)
            total[k], sphere[k] = (s + f) / peak, s / peak
    return np.concatenate(
        [
            np.where(table.edge_seen, np.log(force / table.force), 0.0),
            np.where(table.edge_seen, np.log(radius / table.radius), 0.0),
            share - table.share,
            total - residuals.total,
            sphere - residuals.sphere_part * residuals.total,
        ]
    )


def _covariance(jacobian: Floats, misfit: Floats, clusters: npt.NDArray[np.int64]) -> Floats:
    """Covariance with the larger of two standard errors for each coefficient.

    The sandwich clustered by combination allows for rows that move together, but is too small when
    combinations are few; the plain one is the opposite. Correlations are those of the plain one.
    """
    bread = np.linalg.pinv(jacobian.T @ jacobian)
    rows, n = jacobian.shape
    plain = bread * float(misfit @ misfit) / max(rows - n, 1)
    groups = np.unique(clusters)
    meat = np.zeros_like(bread)
    for group in groups:
        score = jacobian[clusters == group].T @ misfit[clusters == group]
        meat += np.outer(score, score)
    robust = bread @ meat @ bread * (len(groups) / max(len(groups) - 1, 1))
    ratio = np.diag(robust) / np.maximum(np.diag(plain), 1e-300)
    scale = np.sqrt(np.maximum(ratio, 1.0))
    return np.asarray(plain * np.outer(scale, scale))


def _cross_validate(table: Table, residuals: ResidualTable, start: Floats) -> Errors:
    n, k = len(table.D), len(residuals.D)
    collected = np.zeros(3 * n + 2 * k)
    for number in range(len(table.pairs)):
        out, out_r = table.case == number, residuals.case == number
        values, _, _, _ = _regress(table.rows(~out), _without(residuals, ~out_r), start)
        misfit = _misfit(values, table, residuals)
        mask = np.concatenate([np.tile(out, 3), np.tile(out_r, 2)])
        collected[mask] = misfit[mask]
    return _errors(collected, table, residuals)


def _without(residuals: ResidualTable, mask: npt.NDArray[np.bool_]) -> ResidualTable:
    names = ("case", "ratio", "modulus", "D", "w", "total", "sphere_part")
    return ResidualTable(*(getattr(residuals, name)[mask] for name in names))


def _errors(misfit: Floats, table: Table, residuals: ResidualTable) -> Errors:
    n, k = len(table.D), len(residuals.D)
    yielding = table.w >= 1.0
    seen = yielding & table.edge_seen

    def of(part: Floats) -> tuple[float, float]:
        part = np.abs(part)
        return float(part.mean()), float(part.max())

    return Errors(
        force=of(np.expm1(misfit[:n][seen])),
        radius=of(np.expm1(misfit[n : 2 * n][seen])),
        share=of(misfit[2 * n : 3 * n][yielding]),
        residual=of(misfit[3 * n : 3 * n + k]) if k else (0.0, 0.0),
    )
