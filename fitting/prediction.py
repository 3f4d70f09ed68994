"""The closed forms on the rows of a campaign, and their errors there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core.arrays import Array
from ..models.closed_form import (
    Coefficients,
    PairNumbers,
    contact,
    force_at,
    of_pair,
    share_at,
    spread_at,
)
from .rules import RULES
from .table import ResidualTable, Table

# limit: step of a difference over what it is of, at least one [-]: the root of round-off
_STEP = 1.5e-8


@dataclass(frozen=True)
class Errors:
    """(mean, largest) error beyond first yield.

    - `force`, `radius`, `hardness`: relative.
    - `share`: absolute.
    - `left_sphere`, `left_flat`: residual depth of the body over Delta_m, absolute, all turning
      points.
    - `left`: whole residual depth, relative, turning points beyond five critical depths.
    - `exponent`: of the unloading curve, absolute.
    - `given_back`: elastic energy of the unloading at equal peak force, relative, turning points
      beyond five critical depths.
    """

    force: tuple[float, float]
    radius: tuple[float, float]
    hardness: tuple[float, float]
    share: tuple[float, float]
    left_sphere: tuple[float, float]
    left_flat: tuple[float, float]
    left: tuple[float, float]
    exponent: tuple[float, float]
    given_back: tuple[float, float]


@dataclass(frozen=True)
class Prediction:
    """A closed form on the rows of both tables; arrays as in `Table` and `ResidualTable`."""

    force: Any
    radius: Any
    share: Any
    total: Any
    sphere: Any
    exponent: Any

    def mix(self, other: Prediction, rows: Any, turns: Any) -> Prediction:
        """Return this with the rows and turning points of the masks taken from `other`."""
        masks = (rows, rows, rows, turns, turns, turns)
        mine, theirs = vars(self).values(), vars(other).values()
        return Prediction(*map(np.where, masks, theirs, mine))


def predict(values: Any, table: Table, turns: ResidualTable) -> Prediction:
    """Evaluate the compact law on every row."""
    return predict_by(of_pair(table.bodies, Coefficients(*values)), table, turns)


def predict_by(numbers: PairNumbers, table: Table, turns: ResidualTable) -> Prediction:
    """Draw every case's curves from its numbers, fields of shape (n_cases,) or single numbers."""
    pressed, released = (
        PairNumbers(*(x[rows.case] if np.ndim(x) else x for x in numbers))
        for rows in (table, turns)
    )
    y, phi, a = spread_at(table.D, pressed)
    F = force_at(table.D, a, pressed)
    share = share_at(table.D, y, F, a, phi, pressed)
    at = contact(turns.D, released)
    return Prediction(F, a, share, at.left, at.phi * at.left, at.N)


def given_back(p: Prediction, turns: ResidualTable) -> Any:
    """Elastic energy of the unloadings over the data's, at equal peak force; nan where unknown.

    A power law of exponent N gives back F_m (Delta_m - Delta_r)/(N + 1).
    """
    recovered = (1.0 - p.total) / (1.0 - turns.total)
    return recovered * (turns.exponent + 1.0) / (p.exponent + 1.0)


def misfit(p: Prediction, table: Table, turns: ResidualTable) -> tuple[list[Any], list[Any]]:
    """Law minus data, on loading and on unloading; 0 where the data do not know.

    Of ln F, ln a and the share; of the residual depth, the sphere's, the exponent and ln of the
    energy given back.
    """
    seen, known = table.edge_seen, np.isfinite(turns.exponent)
    loading = [
        np.where(seen, np.log(p.force / table.force), 0.0),
        np.where(seen, np.log(p.radius / table.radius), 0.0),
        p.share - table.share,
    ]
    unloading = [
        p.total - turns.total,
        p.sphere - turns.sphere_part * turns.total,
        np.where(known, p.exponent - turns.exponent, 0.0),
        np.where(known, np.log(given_back(p, turns)), 0.0),
    ]
    return loading, unloading


def slopes_of(function: Callable[[Array], Array], x: Array) -> Array:
    """Derivatives of a function's values, shape (n,), by `x`, shape (k,), as (n, k)."""
    here, columns = function(x), []
    for k, h in enumerate(_STEP * np.maximum(np.abs(x), 1.0)):
        columns.append((function(x + np.where(np.arange(len(x)) == k, h, 0.0)) - here) / h)
    return np.stack(columns, axis=1)


def errors_of(p: Prediction, table: Table, turns: ResidualTable) -> Errors:
    """Mean and largest error beyond first yield."""
    yielding = table.w >= 1.0
    seen = yielding & table.edge_seen
    F, a = p.force / table.force, p.radius / table.radius
    deep = turns.w >= RULES.relative_from
    known = np.isfinite(turns.exponent)
    sphere = p.sphere - turns.sphere_part * turns.total
    return Errors(
        force=size_of((F - 1.0)[seen]),
        radius=size_of((a - 1.0)[seen]),
        hardness=size_of((F / a**2 - 1.0)[seen]),
        share=size_of((p.share - table.share)[yielding]),
        left_sphere=size_of(sphere),
        left_flat=size_of(p.total - turns.total - sphere),
        left=size_of((p.total / turns.total - 1.0)[deep]),
        exponent=size_of((p.exponent - turns.exponent)[known]),
        given_back=size_of((given_back(p, turns) - 1.0)[known & deep]),
    )


def size_of(part: Array) -> tuple[float, float]:
    """Mean and largest size of errors."""
    part = np.abs(part)
    return (float(part.mean()), float(part.max())) if part.size else (0.0, 0.0)
