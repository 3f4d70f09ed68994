"""The report of a fit: what a reviewer needs to check it, as one page of tables and pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from ..core.output import write_file
from ..core.tables import markdown
from .laws import FittedLaws
from .prediction import Errors, Prediction, errors_of
from .ripple import ripple_of, without_ripple
from .table import ResidualTable, Table

Within = Mapping[str, Sequence[float]]

Mark = tuple[str, float, tuple[float, float] | None]
"""A quantity's name in tables, its scale, and the mean and largest error that we aim at."""

MARKS: dict[str, Mark] = {
    "force": ("F [%]", 100.0, (0.4, 3.0)),
    "radius": ("a [%]", 100.0, (0.25, 3.0)),
    "hardness": ("H [%]", 100.0, (0.7, 5.0)),
    "share": ("delta_s*", 1.0, (0.005, 0.06)),
    "left": ("residual depth, delta_m >= 5 delta_c [%]", 100.0, (0.5, 4.0)),
    "left_sphere": ("sphere's residual depth / Delta_m", 1.0, None),
    "left_flat": ("flat's residual depth / Delta_m", 1.0, None),
    "exponent": ("exponent of the unloading", 1.0, None),
    "given_back": ("energy given back, delta_m >= 5 delta_c [%]", 100.0, (0.5, 3.0)),
}


def stated_within(content: dict[str, Any]) -> dict[str, Within]:
    """What a coefficients file says of its own standard deviations, by law and quantity."""
    return {law: entry["within"] for law, entry in content["uncertainty"].items()}


def error_rows(columns: Sequence[tuple[str, Errors]]) -> list[list[str]]:
    """Rows of the table of errors, its head first: mean and largest of each column."""
    marks = {field.name: MARKS[field.name] for field in fields(Errors)}
    return _size_rows("beyond first yield", {title: vars(e) for title, e in columns}, marks)


def _size_rows(
    head: str, columns: Mapping[str, Mapping[str, Sequence[float]]], marks: Mapping[str, Mark]
) -> list[list[str]]:
    """Rows of mean and largest errors by quantity."""
    rows = [[head, *(f"{title}: mean, largest" for title in columns), "aim"]]
    for key, (name, scale, aim) in marks.items():
        cells = [", ".join(f"{scale * x:.3g}" for x in errors[key]) for errors in columns.values()]
        rows.append([name, *cells, ", ".join(f"{x:g}" for x in aim or ())])
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


def worst_rows(p: Prediction, table: Table) -> list[list[str]]:
    """Rows of the table of the dozen combinations with the largest errors of F, its head first."""
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
    return [head, *(cells for _, cells in lines[:12])]


def uncertainty_rows(within: Mapping[str, Within]) -> list[list[str]]:
    """Rows of the table of standard deviations, its head first.

    `within` has shares of errors within one and two of them, by law and quantity.
    """
    names = {
        "force": "F", "radius": "a", "share": "delta_s*", "dent": "residual depth",
        "given_back": "energy given back",
    }  # fmt: skip
    rows = [["within one, two standard deviations", *within]]
    for key, name in names.items():
        shares = [of_law[key] for of_law in within.values()]
        rows.append([name, *(f"{100 * one:.1f} %, {100 * two:.1f} %" for one, two in shares)])
    return rows


def hardening_rows(columns: Mapping[str, Mapping[str, Sequence[float]]]) -> list[list[str]]:
    """Rows of the table of errors on metals that harden, its head first.

    `columns` has mean and largest error by title and by the names of `Uncertainty`.
    """
    marks: dict[str, Mark] = {
        "force": ("F [%]", 100.0, (1.0, 5.0)),
        "radius": ("a [%]", 100.0, (0.6, 3.0)),
        "share": ("delta_s*", 1.0, (0.015, 0.12)),
        "dent": ("residual depth, delta_m >= 5 delta_c [%]", 100.0, None),
        "given_back": ("energy given back, delta_m >= 5 delta_c [%]", 100.0, None),
    }
    return _size_rows("metals that harden", columns, marks)


def write_report(
    laws: FittedLaws,
    content: dict[str, Any],
    table: Table,
    turns: ResidualTable,
    folder: Path,
    *,
    validation: Sequence[tuple[str, Errors]] = (),
) -> Path:
    """Write the page and its pictures into `folder`.

    `validation` are names of laws and their errors on cases that no fit reads, if the campaign
    holds any.
    """
    from . import pictures

    shown = laws.fitted.predicted
    pictures.draw_errors(shown, table, turns, folder / "errors.png")
    pictures.draw_maps(shown, table, folder / "maps.png")
    pictures.draw_maps(laws.compact.predicted, table, folder / "compact-maps.png")
    pictures.draw_curves(shown, table, folder / "curves.png")
    columns = [
        ("compact, left out", laws.compact.held_out),
        ("fitted", laws.fitted.errors),
        ("fitted, left out", laws.fitted.held_out),
        ("left out, ripple smoothed", errors_of(shown, without_ripple(table), turns)),
        *((f"{name}, validation", errors) for name, errors in validation),
    ]
    parts = [
        "# The closed forms\n",
        _about_data(laws, content, table, turns),
        "## Errors\n",
        markdown(error_rows(columns)),
        "![errors](errors.png)\n\n![maps](maps.png)\n\n![curves](curves.png)\n",
        "The compact law:\n\n![maps](compact-maps.png)\n",
        "## Uncertainty, on combinations left out\n",
        markdown(uncertainty_rows(stated_within(content))),
        "## Metals that harden\n",
        *about_hardening(content),
        "## Combinations that fit worst\n\nMean and largest, fitted law, left out.\n",
        markdown(worst_rows(shown, table)),
        "## Domain\n",
        markdown(domain_rows(content, "quantity")),
        "## Coefficients\n",
        markdown(coefficient_rows(content)),
    ]
    return write_file(folder / "report.md", "\n".join(parts))


def about_hardening(content: dict[str, Any]) -> list[str]:
    """Tables of the errors on metals that harden; none where the file knows none."""
    found = content.get("hardening")
    if found is None:
        return []
    judged = found["judged"]
    columns = {f"{found['combinations']} pairs, left out": found["left_out"]}
    columns |= {f"{one['combinations']} of {name}": one["errors"] for name, one in judged.items()}
    within = {name: one["within"] for name, one in judged.items()}
    return [markdown(hardening_rows(columns)), markdown(uncertainty_rows(within))]


def _about_data(
    laws: FittedLaws, content: dict[str, Any], table: Table, turns: ResidualTable
) -> str:
    """How many rows there are, how fine the finite elements, and how much their curves ripple."""
    levels = "; ".join(", ".join(c["accuracy"]) for c in content["provenance"]["campaigns"])
    ripple_F, ripple_a = (100.0 * float(np.median(r)) for r in ripple_of(table))
    return (
        f"{len(table.pairs)} combinations, {len(table.D)} depths, {len(turns.D)} unloadings; "
        f"{len(laws.fit.values)} coefficients, {laws.correction.weights.size} weights of the "
        "correction. Left out: each combination predicted by a fit that did not see it.\n\n"
        f"Accuracy of the data: {levels}. F and a of a mesh ripple with the period of a surface "
        f"element; no smooth law can follow: here {ripple_F:.2g} % and {ripple_a:.2g} % (median "
        "over the cases of the rms deviation from a local cubic).\n"
    )
