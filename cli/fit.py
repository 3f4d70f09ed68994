"""`dentscope fit`: the coefficients of the closed form from a campaign."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..core.errors import EXIT_NOT_CONVERGED


def fit(
    campaign: Annotated[Path, typer.Argument(help="Campaign file.")] = Path(
        "build/campaign/campaign.h5"
    ),
    out: Annotated[Path, typer.Option(help="Folder for the report.")] = Path("build/fit"),
    publish: Annotated[
        bool, typer.Option("--publish", help="Also replace the coefficients that the law uses.")
    ] = False,
) -> int:
    """Fit the closed form; write coefficients with standard errors, and a picture of the errors."""
    from rich.console import Console
    from rich.table import Table as RichTable

    from ..fitting import coefficients_content, fit_tables, read_tables, write_coefficients
    from ..fitting.report import draw_fit

    console = Console()
    table, residuals = read_tables(campaign)
    console.print(
        f"{campaign}: {len(table.pairs)} combinations, {len(table.D)} depths, "
        f"{len(residuals.D)} unloadings; fitting, then leaving each combination out once ..."
    )
    result = fit_tables(table, residuals)
    content = coefficients_content(result, table, campaign)
    write_coefficients(content, out / "fitted.json")
    shown = RichTable("coefficient", "value", "standard error")
    for name, entry in content["coefficients"].items():
        shown.add_row(name, f"{entry['value']:.4f}", f"{entry['standard_error']:.4f}")
    console.print(shown)
    errors = RichTable(
        "beyond first yield", "mean", "largest", "mean, left out", "largest, left out"
    )
    for name, unit in (("force", "%"), ("radius", "%"), ("share", ""), ("residual", "")):
        scale = 100.0 if unit else 1.0
        a, b = getattr(result.errors, name), getattr(result.held_out, name)
        errors.add_row(name, *(f"{scale * x:.3g}{unit}" for x in (*a, *b)))
    console.print(errors)
    console.print(f"domain: {content['domain']['note']}")
    console.print(f"coefficients: {out / 'fitted.json'}; picture: {draw_fit(result, table, out)}")
    if publish:
        place = Path(__file__).resolve().parents[1] / "data" / "coefficients" / "fitted.json"
        write_coefficients(content, place)
        console.print("the fitted law now uses these coefficients")
    if not result.outcome.completed:
        console.print(str(result.outcome))
        return EXIT_NOT_CONVERGED
    return 0
