"""What each term of the compact law is worth on combinations that it did not see.

Each candidate holds some coefficients at a value that takes their term away. It is judged by the
misfit of combinations left out, never by single points and never on the validation design.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from ...core.output import write_figure
from ...fitting.fit import ENOUGH, fit_tables
from ...fitting.laws import left_out
from ...fitting.prediction import Errors, Prediction, errors_of, given_back, predict
from ...fitting.report import markdown
from ...fitting.table import ResidualTable, Table
from ...models.closed_form import COEFFICIENTS


def _without(*names: str, **values: float) -> dict[str, float]:
    """Hold the named coefficients at zero and the others at what is given."""
    return {**dict.fromkeys(names, 0.0), **values}


CANDIDATES: dict[str, Mapping[str, float]] = {
    "compact law": {},
    "radius without finite deformation": _without("c_s", "c_f"),
    "radius without its early rise": _without("z"),
    "radius blind to the elastic body": _without("b1", "b3"),
    "radius blind to Poisson's ratio": _without("b4"),
    "pressure blind to the elastic body": _without("k1", "m1"),
    "pressure blind to Poisson's ratio": _without("k2"),
    "full pressure at every radius": _without("B_s", "B_f", "B_e"),
    "flattened sphere without collapse": _without("B_e"),
    "share of constant sharpness": _without("g2"),
    "sphere never takes over": _without("s3", "p1", s0=1e6, s2=1.0, p0=3.0),
    "share blind to the contact radius before": _without("g4"),
    "taking over of one sharpness": _without("p1"),
    "recovery along the curve of an elastic body": _without("u2", "u4"),
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

    def of(held: Mapping[str, float], rest: Any, rest_turns: Any) -> Prediction:
        fit = fit_tables(
            table.rows(rest), turns.rows(rest_turns), held=held, start=start, change=ENOUGH
        )
        return predict(fit.values, table, turns)

    choices = []
    for name, held in CANDIDATES.items():
        every = np.ones(len(table.D), dtype=bool), np.ones(len(turns.D), dtype=bool)
        (unseen,) = left_out(
            lambda rest, rest_turns, held=held: [of(held, rest, rest_turns)], table, turns,
            folds=folds,
        )  # fmt: skip
        choices.append(
            Choice(
                name=name,
                free=len(COEFFICIENTS) - len(held),
                fitted=_rms(of(held, *every), table, turns),
                left_out=_rms(unseen, table, turns),
                errors=errors_of(unseen, table, turns),
            )
        )
    return choices


def terms_section(choices: Sequence[Choice], folder: Path) -> str:
    """Return the report's section, markdown; its picture goes into `folder`."""
    head = ["form", "coefficients", "rms fitted", "rms left out", "F, a [%], delta_s* left out"]
    rows = []
    for c in choices:
        F, a, share = (mean for mean, _ in (c.errors.force, c.errors.radius, c.errors.share))
        means = f"{100 * F:.2f}, {100 * a:.2f}, {share:.4f}"
        rows.append([c.name, str(c.free), f"{c.fitted:.3f}", f"{c.left_out:.3f}", means])
    _draw(choices, folder / "terms.png")
    return (
        "## What each term of the compact law is worth\n\nRms of the misfit in units of 1 % (F, a) "
        f"and 0.01 (shares).\n\n{markdown([head, *rows])}\n![terms](terms.png)\n"
    )


def _draw(choices: Sequence[Choice], path: Path) -> None:
    """Draw the misfit of every candidate, the whole law first, with its number of coefficients."""
    figure = Figure(figsize=(9, 4.5), layout="constrained")
    axis = figure.subplots()
    places = np.arange(len(choices))
    axis.barh(places, [c.left_out for c in choices], color="tab:blue", label="left out")
    axis.barh(places, [c.fitted for c in choices], color="lightgrey", height=0.4, label="fitted")
    axis.set_yticks(places, [f"{c.name} ({c.free})" for c in choices], fontsize=8)
    axis.axvline(choices[0].left_out, color="black", lw=0.8, ls="--")
    axis.invert_yaxis()
    axis.set_xlabel("rms of the weighted misfit (1: 1 % of F and a, 0.01 of a share)")
    axis.set_title("what each term is worth; number of coefficients in brackets", fontsize=10)
    axis.legend(fontsize=8)
    write_figure(figure, path, dpi=110)


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
