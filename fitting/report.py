"""The report of a fit: what a reviewer needs to check it, as one page of tables and pictures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..core.errors import InputError
from .fit import Errors, Fit, Prediction, errors_of
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


def markdown(rows: Sequence[Sequence[str]]) -> str:
    """Return rows, the head first, as a markdown table."""
    head, *rest = rows
    lines = [head, ["---"] * len(head), *rest]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def worst_rows(p: Prediction, table: Table, *, most: int = 12) -> list[list[str]]:
    """Rows of the table of the combinations with the largest errors of F, its head first."""
    seen = (table.w >= 1.0) & table.edge_seen
    force = np.abs(p.force / table.force - 1.0)
    radius = np.abs(p.radius / table.radius - 1.0)
    share = np.abs(p.share - table.share)
    lines = []
    for number, (name, pair) in enumerate(zip(table.names, table.pairs, strict=True)):
        m = seen & (table.case == number)
        if m.any():
            lines.append(
                (
                    float(force[m].mean()),
                    [
                        name,
                        f"{pair.Sy_ratio:.3g}",
                        f"{pair.E_reduced / pair.Sy_min:.0f}",
                        f"{pair.elastic_share:.2f}",
                        *(
                            f"{100 * x[m].mean():.2f}, {100 * x[m].max():.2f}"
                            for x in (force, radius)
                        ),
                        f"{share[m].mean():.3f}, {share[m].max():.3f}",
                    ],
                )
            )
    lines.sort(key=lambda line: -line[0])
    head = ["combination", "Sy*", "E'/Sy_min", "x_s", "F [%]", "a [%]", "delta_s*"]
    return [head, *(cells for _, cells in lines[:most])]


def _pair(error: npt.NDArray[np.float64], pattern: str) -> str:
    return pattern % (error.mean(), error.max())


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
    from .pictures import draw_choice, draw_curves, draw_errors, draw_maps

    folder.mkdir(parents=True, exist_ok=True)
    shown = fit.predicted
    assert shown is not None
    draw_errors(shown, table, turns, folder / "errors.png")
    draw_maps(shown, table, folder / "maps.png")
    draw_curves(shown, table, folder / "curves.png")
    limits = content["domain"]["limits"].items()
    columns = [
        ("fitted", fit.errors),
        ("left out", fit.held_out),
        ("left out, ripple smoothed", errors_of(shown, without_ripple(table), turns)),
        ("validation", validation),
    ]
    ripple_F, ripple_a = (100.0 * float(np.median(r)) for r in ripple_of(table))
    parts = [
        "# The fitted law\n",
        f"{len(table.pairs)} combinations, {len(table.D)} depths, {len(turns.D)} unloadings; "
        f"{len(fit.values)} coefficients. Left out: each combination predicted by a fit that did "
        "not see it.\n",
        "Accuracy of the data: "
        + "; ".join(", ".join(c["accuracy"]) for c in content["provenance"]["campaigns"])
        + ". F and a of a mesh ripple with the period of a surface element; no smooth law can "
        f"follow: here {ripple_F:.2g} % and {ripple_a:.2g} % (median over the cases of the rms "
        "deviation from a local cubic).\n",
        "## Errors\n",
        markdown(error_rows(columns)),
        "![errors](errors.png)\n\n![maps](maps.png)\n\n![curves](curves.png)\n",
        "## Combinations that fit worst\n\nMean and largest.\n",
        markdown(worst_rows(shown, table)),
        "## Domain\n",
        markdown(
            [
                ["quantity", "from", "to"],
                *([k, f"{a:.4g}", f"{b:.4g}"] for k, (a, b) in limits),
            ]
        ),
        "## Coefficients\n",
        markdown(coefficient_rows(content)),
    ]
    if choices:
        draw_choice(choices, folder / "choice.png")
        head = ["form", "coefficients", "rms fitted", "rms left out", "F, a [%], delta_s* left out"]
        rows = [
            [
                c.name,
                str(c.free),
                f"{c.fitted:.3f}",
                f"{c.left_out:.3f}",
                f"{100 * c.errors.force[0]:.2f}, {100 * c.errors.radius[0]:.2f}, "
                f"{c.errors.share[0]:.4f}",
            ]
            for c in choices
        ]
        parts += [
            "## What each term is worth\n\nRms of the misfit in units of 1 % (F, a) and 0.01 "
            "(shares).\n",
            markdown([head, *rows]),
            "![choice](choice.png)\n",
        ]
    if thesis:
        parts.append(thesis)
    page = folder / "report.md"
    page.write_text("\n".join(parts), encoding="utf-8")
    return page


BEGIN = "<!-- coefficients: begin, written by dentscope fit --publish -->"
END = "<!-- coefficients: end -->"
JUDGED_BEGIN = "<!-- judged: begin, written by dentscope fit --judge data/challenge --publish -->"
JUDGED_END = "<!-- judged: end -->"


def published_section(content: dict[str, Any]) -> str:
    """Return the part of docs/closed-form.md that follows from a coefficients file."""
    errors = content["errors"]
    rows = [["beyond first yield", "fitted: mean, largest", "left out: mean, largest"]]
    for name, (title, scale, _) in MARKS.items():
        cells = [
            ", ".join(f"{scale * x:.3g}" for x in errors[kind][name])
            for kind in ("fitted", "left_out")
        ]
        rows.append([title, *cells])
    levels = sorted({x for c in content["provenance"]["campaigns"] for x in c["accuracy"]})
    domain = [
        [key, *(f"{x:.4g}" for x in bounds)] for key, bounds in content["domain"]["limits"].items()
    ]
    return "\n".join(
        [
            BEGIN,
            f"{content['domain']['combinations']} combinations; accuracy of the finite elements: "
            f"{', '.join(levels)}.\n",
            markdown(coefficient_rows(content)),
            markdown(rows),
            markdown([["domain", "from", "to"], *domain]) + END,
        ]
    )


def judged_section(errors: Errors, names: Sequence[str], digest: str) -> str:
    """Return the part of docs/closed-form.md on pairs that no fit has read.

    Parameters
    ----------
    errors
        Of the law in use on them.
    names
        Of the cases; those of a challenge carry the beginning of the checksum that drew them.
    digest
        Checksum of the coefficients in use.
    """
    drawn = sorted({name.split("-")[1] for name in names if name.startswith("challenge-")})
    about = f"{len(names)} pairs, drawn from {', '.join(drawn) or 'a seed of their own'}"
    if drawn == [digest[:12]]:
        about += ": the checksum of the coefficients above"
    elif drawn:
        about += f": earlier coefficients; those above have {digest[:12]}"
    rows = error_rows([("pairs drawn afterwards", errors)])
    return f"{JUDGED_BEGIN}\n{about}.\n\n{markdown(rows)}{JUDGED_END}"


def update_page(page: Path, section: str) -> None:
    """Put a section into the page in place of the one that has its marks."""
    begin, end = section.splitlines()[0], section.splitlines()[-1]
    text = page.read_text(encoding="utf-8")
    before, found, rest = text.partition(begin)
    if not found:
        raise InputError("has no place for this section", source=str(page), allowed=begin)
    _, _, after = rest.partition(end)
    page.write_text(before + section + after, encoding="utf-8")
