"""Choice of form: what each term of the closed form is worth on combinations that it did not see.

Each candidate holds some coefficients at a value that takes their term away. It is judged by the
misfit of combinations left out, never by single points and never on the validation design.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..models.closed_form import COEFFICIENTS
from .fit import ENOUGH, Errors, Prediction, fit_tables, given_back, predict
from .table import ResidualTable, Table

CANDIDATES: dict[str, Mapping[str, float]] = {
    "full form": {},
    "radius without finite deformation": {"c_s": 0.0, "c_f": 0.0, "t": 3.0, "y1": 50.0},
    "radius without its early rise": {"z": 0.0},
    "radius blind to the elastic body": {"b1": 0.0, "b3": 0.0},
    "radius blind to Poisson's ratio": {"b4": 0.0},
    "pressure blind to the elastic body": {"k1": 0.0},
    "pressure blind to Poisson's ratio": {"k2": 0.0, "m1": 0.0},
    "full pressure at every radius": {
        "B_s": 0.0,
        "B_d": 0.0,
        "B_f": 0.0,
        "B_e": 0.0,
        "B_q": 0.0,
        "r": 1.4,
    },
    "pressure of a sphere falls alike at every radius": {"B_d": 0.0},
    "flattened sphere without collapse": {"B_e": 0.0},
    "bodies that yield together hold no more": {"B_q": 0.0},
    "full pressure reached alike at every radius": {"k3": 0.0},
    "no finite elastic strain": {"e0": 0.0, "e1": 0.0, "e2": 0.0},
    "finite elastic strain alike in both bodies": {"e1": 0.0, "e2": 0.0},
    "radius without finite elastic strain": {"e2": 0.0},
    "share of constant sharpness": {"g2": 0.0, "g1": 1000.0},
    "sphere never takes over": {
        "s0": 1e6,
        "s1": 1.0,
        "s2": 1.0,
        "s3": 0.0,
        "s4": 0.0,
        "s5": 0.0,
        "s6": 0.0,
        "p0": 3.0,
        "p1": 0.0,
        "p2": 0.0,
        "p3": 0.0,
        "c_m": 0.0,
    },
    "share blind to the contact radius before": {"g4": 0.0},
    "taking over of unequal bodies blind to E'/S": {"s6": 0.0},
    "taking over blind to the elastic sphere": {"s5": 0.0, "p3": 0.0},
    "taking over leaves the radius alone": {"c_m": 0.0},
    "elastic displacements blind to the elastic body": {"d1": 0.0, "d2": 0.0},
    "recovery blind to which body flows": {"l3": 0.0, "l4": 100.0},
    "Hertz's recovery": {"u1": 0.0, "u2": 1.0, "u3": 100.0, "u4": 0.0, "u5": 0.0},
    "recovery blind to the contact radius": {"u5": 0.0},
}
"""What is compared: name of the candidate and the coefficients that it holds."""

_EVERY = 3  # depths; neighbours say nearly the same, and a term's worth needs no more


@dataclass(frozen=True)
class Choice:
    """One candidate.

    Parameters
    ----------
    name
        Key of `CANDIDATES`.
    free
        Number of coefficients that it fits.
    fitted, left_out
        Rms of the weighted misfit (1 is 1 % of F or a, 0.01 of a share) on the fitted rows and on
        combinations left out.
    errors
        Of combinations left out.
    """

    name: str
    free: int
    fitted: float
    left_out: float
    errors: Errors


def compare_forms(
    table: Table, turns: ResidualTable, *, start: Mapping[str, float], folds: int = 4
) -> list[Choice]:
    """Fit every candidate to every third depth, with whole combinations left out in turn."""
    table = table.rows(np.arange(len(table.D)) % _EVERY == 0)
    choices = []
    for name, held in CANDIDATES.items():
        fit = fit_tables(table, turns, held=held, start=start, folds=folds, change=ENOUGH)
        assert fit.predicted is not None
        assert fit.held_out is not None
        choices.append(
            Choice(
                name=name,
                free=len(COEFFICIENTS) - len(held),
                fitted=_rms(predict(fit.values, table, turns), table, turns),
                left_out=_rms(fit.predicted, table, turns),
                errors=fit.held_out,
            )
        )
    return choices


def _rms(p: Prediction, table: Table, turns: ResidualTable) -> float:
    seen = table.edge_seen
    known = np.isfinite(turns.exponent)
    parts = (
        100.0 * np.log(p.force / table.force)[seen],
        100.0 * np.log(p.radius / table.radius)[seen],
        100.0 * (p.share - table.share),
        100.0 * (p.total - turns.total),
        100.0 * (p.sphere - turns.sphere_part * turns.total),
        100.0 / 3.0 * (p.exponent - turns.exponent)[known],
        100.0 / 2.0 * np.log(given_back(p, turns))[known],
    )
    return float(np.sqrt(np.mean(np.concatenate(parts) ** 2)))
