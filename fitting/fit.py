"""Regression of the compact law on a campaign, with honest errors.

Rows of one material combination are not independent: the standard errors allow for that (clustered
by combination).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from ..core.arrays import Array, Integers
from ..core.errors import COMPLETED, Ending, Outcome
from ..core.processes.threads import in_one_thread
from ..models.closed_form import COEFFICIENTS
from .form import LIMITS, START
from .prediction import Errors, errors_of, misfit, predict, slopes_of
from .ripple import ripple_of
from .rules import RULES
from .table import ResidualTable, Table

ENOUGH = RULES.form_settled
"""Relative change of the misfit at which a fit of cross-validation ends."""


@dataclass(frozen=True)
class FormFit:
    """Result of the regression.

    - `values`, `standard_errors`: by the order of `COEFFICIENTS`, shape (n,).
    - `covariance`: allowing for rows of one combination that move together, shape (n, n).
    - `errors`: errors on the fitted rows.
    - `outcome`: how the regression ended.
    """

    values: Array
    standard_errors: Array
    covariance: Array
    errors: Errors
    outcome: Outcome


@in_one_thread
def fit_tables(
    table: Table,
    turns: ResidualTable,
    *,
    start: Mapping[str, float] | None = None,
    change: float = 1e-8,
    ripple: Array | None = None,
) -> FormFit:
    """Fit the compact law to the rows of a campaign, from `form.START` if nothing is given.

    The regression ends at a relative change of the misfit of `change`. `ripple`: of ln F and ln a
    of each row's case, shape (2, n); by `ripple_of` if not given.
    """
    first = np.array([{**START, **(start or {})}[name] for name in COEFFICIENTS])
    values, jacobian, misfit, ok = _regress(
        _misfit_of(table, turns, ripple_of(table) if ripple is None else ripple), first, change
    )
    clusters = np.concatenate([np.tile(table.case, 3), np.tile(turns.case, 4)])
    covariance = covariance_of(jacobian, misfit, clusters)
    return FormFit(
        values=values,
        standard_errors=np.sqrt(np.maximum(np.diag(covariance), 0.0)),
        covariance=covariance,
        errors=errors_of(predict(values, table, turns), table, turns),
        outcome=COMPLETED
        if ok
        else Outcome(Ending.NOT_CONVERGED, "the regression ran out of steps.", "Look at the data."),
    )


def _regress(
    residual: Callable[[Any], Any], first: Array, change: float
) -> tuple[Array, Array, Array, bool]:
    """Minimise until the misfit changes by less than `change`, relatively."""
    low, high = np.array([LIMITS[name] for name in COEFFICIENTS]).T
    inside = np.clip(first, low + 1e-9 * np.abs(low), high - 1e-9 * np.abs(high))
    found = least_squares(
        residual,
        inside,
        jac=lambda x: slopes_of(residual, x),
        bounds=(low, high),
        x_scale="jac",
        loss="soft_l1",
        ftol=change,
        max_nfev=300,
    )
    return found.x, slopes_of(residual, found.x), residual(found.x), bool(found.success)


def _misfit_of(table: Table, turns: ResidualTable, ripple: Iterable[Array]) -> Callable[[Any], Any]:
    """What `prediction.misfit` says, in its units, as a function of the coefficients."""
    # a case whose mesh ripples says less about the curve than one that does not
    unit_F, unit_a = (np.hypot(RULES.form_unit, one) for one in ripple)
    unit = RULES.form_unit
    units = (unit_F, unit_a, unit, unit, unit, RULES.form_unit_exponent, RULES.form_unit_back)

    def scaled(x: Any) -> Any:
        loading, unloading = misfit(predict(x, table, turns), table, turns)
        return np.concatenate(
            [off / one for off, one in zip([*loading, *unloading], units, strict=True)]
        )

    return scaled


def covariance_of(jacobian: Array, misfit: Array, clusters: Integers) -> Array:
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
