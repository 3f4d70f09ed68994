"""The thesis's own forms, fitted again to our finite elements.

Each form is judged by itself: it gets from the finite elements what the thesis's model takes from
the forms before it. So an error here is the form's own, not handed down.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from ...core.arrays import Array
from ...fitting.fit import covariance_of
from ...fitting.report import markdown
from ...fitting.table import ResidualTable, Table
from ...models import yield_constant
from .forms import BORDER, LOADING_FORMS, UNLOADING_FORM, Rows, ThesisForm


@dataclass(frozen=True)
class Refit:
    """A form's printed and refitted coefficients and their errors (mean, largest)."""

    form: ThesisForm
    values: dict[str, float]
    standard_errors: dict[str, float]
    printed_error: tuple[float, float]
    refitted_error: tuple[float, float]
    worst: str
    rows: int


def refit_all(table: Table, turns: ResidualTable) -> list[Refit]:
    """Refit every form that the data reach; the others are left out."""
    loading, unloading = _rows(table), _turning_points(turns)
    found = [_refit(form, loading) for form in LOADING_FORMS]
    return [r for r in (*found, _refit(UNLOADING_FORM, unloading)) if r is not None]


def _refit(form: ThesisForm, rows: Rows) -> Refit | None:
    rows = rows.of(form.applies(rows))
    names = list(form.printed)
    first = np.array([float(form.printed[name]) for name in names])
    if len(rows.D) <= 3 * len(names):
        return None
    target = getattr(rows, form.target)
    scale = target if form.relative else np.ones_like(target)

    def misfit(x: Array) -> Any:
        with np.errstate(all="ignore"):
            off = (form.value(rows, dict(zip(names, x, strict=True))) - target) / scale
        return np.clip(np.nan_to_num(off, nan=10.0), -10.0, 10.0) / 0.01

    solved = least_squares(misfit, first, x_scale="jac", loss="soft_l1", max_nfev=300)
    better = solved.x if solved.cost < 0.5 * float(np.sum(misfit(first) ** 2)) else first
    error = np.abs(misfit(better)) * 0.01
    covariance = covariance_of(np.asarray(solved.jac), misfit(better), rows.case)
    k = int(np.argmax(error))
    return Refit(
        form=form,
        values=dict(zip(names, better.tolist(), strict=True)),
        standard_errors=dict(
            zip(names, np.sqrt(np.maximum(np.diag(covariance), 0.0)).tolist(), strict=True)
        ),
        printed_error=_size(np.abs(misfit(first)) * 0.01),
        refitted_error=_size(error),
        worst=f"Sy* {rows.ratio[k]:.3g}, E'/Sy_min {rows.q[k]:.0f}, Delta/R {rows.D[k]:.2g}",
        rows=len(rows.D),
    )


def _size(error: Array) -> tuple[float, float]:
    return float(error.mean()), float(error.max())


def _rows(table: Table) -> Rows:
    t = table.rows(table.edge_seen)
    return _assemble(t, share=t.share, radius=t.radius, force=t.force, total=np.zeros_like(t.D))


def _turning_points(turns: ResidualTable) -> Rows:
    none = np.zeros_like(turns.D)
    return _assemble(turns, share=none, radius=none, force=none, total=turns.total)


def _assemble(
    t: Table | ResidualTable, *, share: Array, radius: Array, force: Array, total: Array
) -> Rows:
    q, ratio, stiff, slope = np.array(
        [
            (
                p.E_reduced / p.Sy_min,
                p.Sy_ratio,
                p.weaker.plane_strain_modulus / p.E_reduced,
                0.5 * np.pi * yield_constant(p.weaker.nu) * p.Sy_min / p.E_reduced,
            )
            for p in t.pairs
        ]
    ).T[:, t.case]
    weak = np.where(ratio <= BORDER, share, 1.0 - share)
    other = 1.0 - weak
    updated = 1.0 + other - t.D * other
    delta = weak * t.D
    return Rows(
        case=t.case, D=t.D, w=t.w, q=q, ratio=ratio, share=share, radius=radius, force=force,
        stiff=stiff, n=delta / (slope**2 * updated), delta=delta, updated=updated, total=total,
    )  # fmt: skip


def thesis_section(refits: Sequence[Refit]) -> str:
    """The report's section on the thesis's forms, markdown."""
    rows = [["form", "rows", "printed: mean, largest", "refitted: mean, largest", "worst at"]]
    for r in refits:
        unit, scale = ("%", 100.0) if r.form.relative else ("", 1.0)
        rows.append(
            [
                r.form.title,
                str(r.rows),
                *(
                    f"{scale * a:.3g}{unit}, {scale * b:.3g}{unit}"
                    for a, b in (r.printed_error, r.refitted_error)
                ),
                r.worst,
            ]
        )
    lines = [["form", "coefficient", "printed", "refitted", "95 % interval"]]
    for r in refits:
        for name, printed in r.form.printed.items():
            value, error = r.values[name], 1.96 * r.standard_errors[name]
            lines.append(
                [
                    r.form.title.split(",")[0],
                    name,
                    f"{float(printed):.5g}",
                    f"{value:.5g}",
                    f"{value - error:.4g} to {value + error:.4g}",
                ]
            )
    return "\n".join(
        [
            "## The thesis's own forms, refitted\n",
            "Corrected reading; each form gets its inputs from the finite elements. Errors of "
            "F, a and residual depth are relative, of delta_s* absolute.\n",
            markdown(rows),
            "Coefficients in the order in which they stand in the equation; an interval wider "
            "than its value says that the data do not fix that coefficient.\n",
            markdown(lines),
        ]
    )
