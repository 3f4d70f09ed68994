"""`dentscope fit`: coefficients of the closed form from a campaign, and the law as source."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import EXIT_NOT_CONVERGED, InputError
from ..core.output import write_file
from . import studies
from .campaign_data import PUBLISHED
from .places import folder_option
from .terminal import console as new_console
from .terminal import show_table

if TYPE_CHECKING:
    from rich.console import Console

    from ..fitting import Errors, Fit, ResidualTable, Table
    from ..fitting.select import Choice
    from ..models.fitted import Fitted

_OWN = Path("build/campaign/campaign.h5")
_ROOT = Path(__file__).resolve().parents[1]
_PAGE = _ROOT / "docs" / "closed-form.md"


def fit(
    campaigns: Annotated[
        list[Path] | None,
        typer.Argument(
            help="Campaign files or folders of parts; the published data set if there is one, "
            "else build/campaign/campaign.h5."
        ),
    ] = None,
    out: Annotated[Path, folder_option("Folder for the report.")] = Path("build/fit"),
    publish: Annotated[
        bool, typer.Option("--publish", help="Also replace the coefficients that the law uses.")
    ] = False,
    compare: Annotated[
        bool,
        typer.Option("--compare/--no-compare", help="Also fit simpler forms and the thesis's own."),
    ] = True,
    judge: Annotated[
        Path | None,
        typer.Option(
            help="Only judge the law in use on the cases of this folder of parts that no fit "
            "reads; with --publish also in docs/closed-form.md."
        ),
    ] = None,
    export: Annotated[
        Path | None,
        typer.Option(
            help="Only write the law that is in use into this folder, as Python, C, Fortran and "
            "MATLAB source, with a table for discrete-element codes."
        ),
    ] = None,
) -> int:
    """Fit the closed form; write coefficients with standard errors, and a report with pictures."""
    console = new_console()
    if export is not None:
        return _export(export, console)
    if judge is not None:
        return _judge(judge, console, publish=publish)
    return _refit(_files(campaigns), out, console, publish=publish, compare=compare)


def _refit(files: list[Path], out: Path, console: Console, *, publish: bool, compare: bool) -> int:
    """Fit, show what came out, and write coefficients and report."""
    from ..fitting import fit_tables, read_tables
    from ..fitting.coefficients import coefficients_content, write_coefficients
    from ..fitting.report import coefficient_rows, error_rows, write_report

    table, turns = read_tables(files)
    console.print(
        f"{', '.join(map(str, files))}: {len(table.pairs)} combinations, {len(table.D)} depths, "
        f"{len(turns.D)} unloadings; fitting, then leaving combinations out ..."
    )
    result = fit_tables(table, turns)
    content = coefficients_content(result, table, files)
    write_coefficients(content, out / "fitted.json")
    _show(console, coefficient_rows(content))
    validation = _validation(files, result)
    columns = [
        ("fitted", result.errors),
        ("left out", result.held_out),
        ("validation", validation),
    ]
    _show(console, error_rows(columns))
    choices, thesis = _compared(content, table, turns, console) if compare else ((), "")
    page = write_report(
        result, content, table, turns, out, validation=validation, choices=choices, thesis=thesis
    )
    console.print(f"coefficients: {out / 'fitted.json'}; report: {page}")
    if publish:
        _publish(content, out)
        console.print("the fitted law now uses these coefficients")
    if not result.outcome.completed:
        console.print(str(result.outcome))
        return EXIT_NOT_CONVERGED
    return 0


def _compared(
    content: dict[str, Any], table: Table, turns: ResidualTable, console: Console
) -> tuple[Sequence[Choice], str]:
    """Fits of simpler forms, and the report's section on the thesis's own where it can be made."""
    from ..fitting.select import compare_forms

    own = studies.present()
    console.print(
        "fitting simpler forms and the thesis's own ..."
        if own
        else f"fitting simpler forms; the thesis's own are left out, they need a checkout: "
        f"{studies.WHERE}"
    )
    start = {k: v["value"] for k, v in content["coefficients"].items()}
    choices = compare_forms(table, turns, start=start)
    if not own:
        return choices, ""
    from ..studies.thesis.refitted import refit_all, thesis_section

    return choices, thesis_section(refit_all(table, turns))


def _publish(content: dict[str, Any], out: Path) -> None:
    """Put the coefficients where the law reads them, and tables and pictures into its page."""
    from ..fitting.coefficients import write_coefficients
    from ..fitting.page import published_section, update_page
    from ..models.fitted import COEFFICIENTS_FILE

    write_coefficients(content, COEFFICIENTS_FILE)
    if not _PAGE.is_file():
        return
    update_page(_PAGE, published_section(content))
    folder = _PAGE.parent / "pictures"
    for name in ("errors", "maps"):
        write_file(folder / f"fitted-{name}.png", (out / f"{name}.png").read_bytes())


def _files(campaigns: Sequence[Path] | None) -> list[Path]:
    if not campaigns:
        return sorted(PUBLISHED.glob("*.h5")) or [_OWN]
    files: list[Path] = []
    for path in campaigns:
        found = sorted(path.glob("*.h5")) if path.is_dir() else [path]
        if not found:
            raise InputError("no campaign file", source=str(path), allowed="a folder of *.h5 parts")
        files += found
    return files


def _validation(files: Sequence[Path], result: Fit) -> Errors | None:
    """Errors on the cases that no fit reads; none if the campaign holds none."""
    try:
        return _judged(files, result.values)[0]
    except InputError:
        return None


def _judged(files: Sequence[Path], values: Any) -> tuple[Errors, tuple[str, ...]]:
    """Errors of the closed form on the cases that no fit reads, and the names of these."""
    from ..fitting.prediction import errors_of, predict
    from ..fitting.table import read_tables

    table, turns = read_tables(files, held_out=True)
    return errors_of(predict(values, table, turns), table, turns), table.names


def _show(console: Console, rows: Sequence[Sequence[str]]) -> None:
    show_table(console, rows[0], rows[1:])


def _judge(folder: Path, console: Console, *, publish: bool) -> int:
    """Show the errors of the law in use on cases that no fit reads."""
    from ..core.provenance import file_digest
    from ..fitting.page import judged_section, update_page
    from ..fitting.report import error_rows
    from ..models.closed_form import COEFFICIENTS
    from ..models.fitted import COEFFICIENTS_FILE

    law = _law_in_use()
    values = [law.coefficients[name] for name in COEFFICIENTS]
    errors, names = _judged(_files([folder]), values)
    _show(console, error_rows([(f"{len(names)} pairs", errors)]))
    if publish and _PAGE.is_file():
        update_page(_PAGE, judged_section(errors, names, file_digest(COEFFICIENTS_FILE)))
    return 0


def _export(folder: Path, console: Console) -> int:
    from ..models.export import write_sources

    for path in write_sources(_law_in_use(), folder):
        console.print(str(path))
    return 0


def _law_in_use() -> Fitted:
    from ..models import law_named
    from ..models.fitted import Fitted

    law = law_named("fitted")
    assert isinstance(law, Fitted)
    return law
