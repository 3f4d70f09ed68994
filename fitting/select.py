"""Choice of form: what each term of the closed form is worth on combinations that it did not see.

Each candidate holds some coefficients at a value that takes their term away. It is judged by the
misfit of combinations left out, never by single points and never on the validation design.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..models.closed_form import COEFFICIENTS
from .fit import ENOUGH, fit_tables
from .prediction import Errors, Prediction, given_back, predict
from .table import ResidualTable, Table


def _without(*names: str, **values: float) -> dict[str, float]:
    """Hold the named coefficients at zero and the others at what is given."""
    return {**dict.fromkeys(names, 0.0), **values}


CANDIDATES: dict[str, Mapping[str, float]] = {
    "full form": {},
    "radius without finite deformation": _without("c_s", "c_f", t=3.0, y1=50.0),
    "radius without its early rise": _without("z"),
    "radius blind to the elastic body": _without("b1", "b3"),
    "radius blind to Poisson's ratio": _without("b4"),
    "pressure blind to the elastic body": _without("k1"),
    "pressure blind to Poisson's ratio": _without("k2", "m1"),
    "full pressure at every radius": _without("B_s", "B_d", "B_f", "B_e", "B_q", r=1.4),
    "pressure of a sphere falls alike at every radius": _without("B_d"),
    "flattened sphere without collapse": _without("B_e"),
    "bodies that yield together hold no more": _without("B_q"),
    "full pressure reached alike at every radius": _without("k3"),
    "no finite elastic strain": _without("e0", "e1", "e2"),
    "finite elastic strain alike in both bodies": _without("e1", "e2"),
    "radius without finite elastic strain": _without("e2"),
    "share of constant sharpness": _without("g2", g1=1000.0),
    "sphere never takes over": _without(
        "s3", "s4", "s5", "s6", "p1", "p2", "p3", "c_m", s0=1e6, s1=1.0, s2=1.0, p0=3.0
    ),
    "share blind to the contact radius before": _without("g4"),
    "taking over of unequal bodies blind to E'/S": _without("s6"),
    "taking over blind to the elastic sphere": _without("s5", "p3"),
    "taking over leaves the radius alone": _without("c_m"),
    "elastic displacements blind to the elastic body": _without("d1", "d2"),
    "recovery blind to which body flows": _without("l3", l4=100.0),
    "recovery along the curve of an elastic body": _without("u2", "u4", "u5", u1=1e-9, u3=100.0),
    "recovery blind to the contact radius": _without("u5"),
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
