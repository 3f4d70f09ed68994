"""The report of a fit: what a reviewer needs to check it, as one page of tables and pictures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from ..core.output import write_file
from .fit import Fit
from .prediction import Errors, Prediction, errors_of
from .ripple import ripple_of, without_ripple
from .select import Choice
from .table import ResidualTable, Table

MARKS: dict[str, tuple[str, float, tuple[float, float] | None]] = {
    "force": ("F [%]", 100.0, (1.0, 3.0)),
    "radius": ("a [%]", 100.0, (1.0, 3.0)),
    "hardness": ("H [%]", 100.0, (1.5, 4.0)),
    "share": ("delta_s*", 1.0, (0.01, 0.03)),
    "left": ("residual depth, delta_m >= 5 delta_c [%]", 100.0, (2.0, 5.0)),
    "left_sphere": ("sphere's residual depth / Delta_m", 1.0, None),
    "left_flat": ("flat's residual depth / Delta_m", 1.0, None),
    "exponent": ("exponent of the unloading", 1.0, None),
    "given_back": ("energy given back, delta_m >= 5 delta_c [%]", 100.0, None),
}
"""Each quantity's name in tables, its scale, and the mean and largest error that we aim at."""


def error_rows(columns: Sequence[tuple[str, Errors | None]]) -> list[list[str]]:
    """Rows of the table of errors, its head first: mean and largest of each column."""
    used = [(title, errors) for title, errors in columns if errors is not None]
    rows = [["beyond first yield", *(f"{title}: mean, largest" for title, _ in used), "aim"]]
    for field in fields(Errors):
        name, scale, aim = MARKS[field.name]
        cells = [
            ", ".join(f"{scale * x:.3g}" for x in getattr(errors, field.name)) for _, errors in used
        ]
        rows.append([name, *cells, ", ".join(f"{x:g}" for x in aim) if aim else ""])
    return rows


def coefficient_rows(content: dict[str, Any]) -> list[list[str]]:
    """Rows of the table of coefficients, its head first."""
    rows = [["coefficient", "value", "standard error"]]
    for name, entry in content["coefficients"].items():
        rows.append([name, f"{entry['value']:.5g}", f"{entry['standard_error']:.2g}"])
    return rows


def domain_rows(content: dict[str, Any], title: str) -> list[list[str]]:
    """Rows of the table of the domain, its head with `title` first."""
    limits = content["domain"]["limits"].items()
    return [[title, "from", "to"], *([key, f"{a:.4g}", f"{b:.4g}"] for key, (a, b) in limits)]


def choice_rows(choices: Sequence[Choice]) -> list[list[str]]:
    """Rows of the table of simpler forms, its head first."""
    head = ["form", "coefficients", "rms fitted", "rms left out", "F, a [%], delta_s* left out"]
    rows = []
    for c in choices:
        F, a, share = (mean for mean, _ in (c.errors.force, c.errors.radius, c.errors.share))
        means = f"{100 * F:.2f}, {100 * a:.2f}, {share:.4f}"
        rows.append([c.name, str(c.free), f"{c.fitted:.3f}", f"{c.left_out:.3f}", means])
    return [head, *rows]


def markdown(rows: Sequence[Sequence[str]]) -> str:
    """Return rows, the head first, as a markdown table."""
    head, *rest = rows
    lines = [head, ["---"] * len(head), *rest]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def worst_rows(p: Prediction, table: Table, *, most: int = 12) -> list[list[str]]:
    """Rows of the table of the combinations with the largest errors of F, its head first."""
    seen = (table.w >= 1.0) & table.edge_seen
    force = 100.0 * np.abs(p.force / table.force - 1.0)
    radius = 100.0 * np.abs(p.radius / table.radius - 1.0)
    share = np.abs(p.share - table.share)
    lines = []
    for number, (name, pair) in enumerate(zip(table.names, table.pairs, strict=True)):
        m = seen & (table.case == number)
        if not m.any():
            continue
        who = [name, f"{pair.Sy_ratio:.3g}", f"{pair.E_reduced / pair.Sy_min:.0f}"]
        sizes = [
            f"{error[m].mean():.{digits}f}, {error[m].max():.{digits}f}"
            for error, digits in ((force, 2), (radius, 2), (share, 3))
        ]
        lines.append((float(force[m].mean()), [*who, f"{pair.elastic_share:.2f}", *sizes]))
    lines.sort(key=lambda line: -line[0])
    head = ["combination", "Sy*", "E'/Sy_min", "x_s", "F [%]", "a [%]", "delta_s*"]
    return [head, *(cells for _, cells in lines[:most])]


def write_report(
    fit: Fit,
    content: dict[str, Any],
    table: Table,
    turns: ResidualTable,
    folder: Path,
    *,
    validation: Errors | None = None,
    choices: Sequence[Choice] = (),
    thesis: str = "",
) -> Path:
    """Write the page and its pictures into `folder`.

    Parameters
    ----------
    fit, content, table, turns
        The fit, the coefficients file's content, and the rows.
    folder
        Where the report goes.
    validation
        Errors on cases that no fit reads, if the campaign holds any.
    choices
        Candidates of `compare_forms`.
    thesis
        Section on the thesis's own forms, markdown.
    """
    from . import pictures

    shown = fit.predicted
    assert shown is not None
    pictures.draw_errors(shown, table, turns, folder / "errors.png")
    pictures.draw_maps(shown, table, folder / "maps.png")
    pictures.draw_curves(shown, table, folder / "curves.png")
    columns = [
        ("fitted", fit.errors),
        ("left out", fit.held_out),
        ("left out, ripple smoothed", errors_of(shown, without_ripple(table), turns)),
        ("validation", validation),
    ]
    parts = [
        "# The fitted law\n",
        _about_data(fit, content, table, turns),
        "## Errors\n",
        markdown(error_rows(columns)),
        "![errors](errors.png)\n\n![maps](maps.png)\n\n![curves](curves.png)\n",
        "## Combinations that fit worst\n\nMean and largest.\n",
        markdown(worst_rows(shown, table)),
        "## Domain\n",
        markdown(domain_rows(content, "quantity")),
        "## Coefficients\n",
        markdown(coefficient_rows(content)),
    ]
    if choices:
        pictures.draw_choice(choices, folder / "choice.png")
        parts += [
            "## What each term is worth\n\nRms of the misfit in units of 1 % (F, a) and 0.01 "
            "(shares).\n",
            markdown(choice_rows(choices)),
            "![choice](choice.png)\n",
        ]
    if thesis:
        parts.append(thesis)
    return write_file(folder / "report.md", "\n".join(parts))


def _about_data(fit: Fit, content: dict[str, Any], table: Table, turns: ResidualTable) -> str:
    """How many rows there are, how fine the finite elements, and how much their curves ripple."""
    levels = "; ".join(", ".join(c["accuracy"]) for c in content["provenance"]["campaigns"])
    ripple_F, ripple_a = (100.0 * float(np.median(r)) for r in ripple_of(table))
    return (
        f"{len(table.pairs)} combinations, {len(table.D)} depths, {len(turns.D)} unloadings; "
        f"{len(fit.values)} coefficients. Left out: each combination predicted by a fit that did "
        f"not see it.\n\nAccuracy of the data: {levels}. F and a of a mesh ripple with the period "
        f"of a surface element; no smooth law can follow: here {ripple_F:.2g} % and "
        f"{ripple_a:.2g} % (median over the cases of the rms deviation from a local cubic).\n"
    )
