"""The closed forms on the rows of a campaign, and their errors there."""

from __future__ import annotations

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
        loading = {
            k: np.where(rows, getattr(other, k), getattr(self, k))
            for k in ("force", "radius", "share")
        }
        unloading = {
            k: np.where(turns, getattr(other, k), getattr(self, k))
            for k in ("total", "sphere", "exponent")
        }
        return Prediction(**loading, **unloading)


def predict(values: Any, table: Table, turns: ResidualTable) -> Prediction:
    """Evaluate the compact law on every row; complex coefficients give complex rows."""
    return predict_by(of_pair(table.bodies, Coefficients(*values)), table, turns)


def predict_by(numbers: PairNumbers, table: Table, turns: ResidualTable) -> Prediction:
    """Draw every case's curves from its numbers, fields of shape (n_cases,) or single numbers."""
    pressed, released = (
        PairNumbers(*(_each(x, rows.case) for x in numbers)) for rows in (table, turns)
    )
    y, phi, a = spread_at(table.D, pressed)
    F = force_at(table.D, a, pressed)
    share = share_at(table.D, y, F, a, phi, pressed)
    at = contact(turns.D, released)
    return Prediction(F, a, share, at.left, at.phi * at.left, at.N)


def _each(number: Any, case: Any) -> Any:
    return number[case] if np.ndim(number) else number


def given_back(p: Prediction, turns: ResidualTable) -> Any:
    """Elastic energy of the unloadings over the data's, at equal peak force; nan where unknown.

    A power law of exponent N gives back F_m (Delta_m - Delta_r)/(N + 1).
    """
    recovered = (1.0 - p.total) / (1.0 - turns.total)
    return recovered * (turns.exponent + 1.0) / (p.exponent + 1.0)


def errors_of(p: Prediction, table: Table, turns: ResidualTable) -> Errors:
    """Mean and largest error beyond first yield."""
    yielding = table.w >= 1.0
    seen = yielding & table.edge_seen
    F, a = p.force / table.force, p.radius / table.radius
    deep = turns.w >= RULES.relative_from
    known = np.isfinite(turns.exponent)
    sphere = p.sphere - turns.sphere_part * turns.total
    return Errors(
        force=_size((F - 1.0)[seen]),
        radius=_size((a - 1.0)[seen]),
        hardness=_size((F / a**2 - 1.0)[seen]),
        share=_size((p.share - table.share)[yielding]),
        left_sphere=_size(sphere),
        left_flat=_size(p.total - turns.total - sphere),
        left=_size((p.total / turns.total - 1.0)[deep]),
        exponent=_size((p.exponent - turns.exponent)[known]),
        given_back=_size((given_back(p, turns) - 1.0)[known & deep]),
    )


def _size(part: Array) -> tuple[float, float]:
    part = np.abs(part)
    return (float(part.mean()), float(part.max())) if part.size else (0.0, 0.0)
