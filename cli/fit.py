"""`dentscope fit`: coefficients of the closed form from a campaign, and the law as source."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import EXIT_NOT_CONVERGED, InputError
from ..core.inputs.input_file import checked_file
from ..core.output import write_file
from . import studies
from .campaign_data import PUBLISHED
from .shared.places import folder_option, one_of, refuse_beside
from .shared.terminal import new_console, show_table

if TYPE_CHECKING:
    from rich.console import Console

_OWN = Path("build/campaign")
_ROOT = Path(__file__).resolve().parents[1]
_HEADS = (b"dentscope-sealed", b"\x89HDF\r\n\x1a\n")  # a sealed file's; HDF5's, of the first format
_PAGE = _ROOT / "docs" / "closed-form.md"


def fit(
    context: typer.Context,
    campaigns: Annotated[list[Path] | None, typer.Argument(
        help="Folders of runs or of parts; the published data set if there is one, else "
        "build/campaign.",
    )] = None,
    out: Annotated[Path, folder_option("Folder for the report.")] = Path("build/fit"),
    publish: Annotated[bool, typer.Option(
        "--publish", help="Also replace the coefficients that the laws use; a checkout.",
    )] = False,
    only: Annotated[str, typer.Option(
        help="`hardening`: fit the law of metals that harden anew and leave the other "
        "coefficients in use as they are.",
    )] = "",
    judge: Annotated[Path | None, typer.Option(
        help="Only judge the law in use on the cases of this folder of parts that no fit "
        "reads; with --publish also in docs/closed-form.md.",
    )] = None,
) -> int:  # fmt: skip
    """Fit the closed form; write coefficients with standard errors, and a report with pictures."""
    console = new_console()
    if publish:
        studies.needed_for("`dentscope fit --publish`")
    if judge is not None:
        refuse_beside(context, "beside --judge", "campaigns", "out", "only")
        return _judge(judge, console, publish=publish)
    if one_of(only, ("", "hardening"), key="--only"):
        return _refit_hardening(_files(campaigns), out, console, publish=publish)
    return _refit(_files(campaigns), out, console, publish=publish)


def _refit(files: list[Path], out: Path, console: Console, *, publish: bool) -> int:
    """Fit, show what came out, and write coefficients and report."""
    from ..fitting import report
    from ..fitting.coefficients import write_coefficients
    from ..fitting.refit import refit

    found = refit(files, progress=console.print)
    result, content = found.laws, found.content
    write_coefficients(content, out / "fitted.json")
    _show(console, report.coefficient_rows(content))
    columns = [
        ("compact, left out", result.compact.held_out),
        ("fitted, left out", result.fitted.held_out),
        *((f"{name}, validation", errors) for name, errors in found.validation),
    ]
    _show(console, report.error_rows(columns))
    _show(console, report.uncertainty_rows(report.stated_within(content)))
    if found.hardens:
        _show_hardening(console, content)
    page = report.write_report(
        result, content, found.table, found.turns, out, validation=found.validation
    )
    console.print(f"coefficients: {out / 'fitted.json'}; report: {page}")
    if publish:
        _publish(content, out)
        console.print("the closed forms now use these coefficients")
    if not result.fit.outcome.completed:
        console.print(str(result.fit.outcome))
        return EXIT_NOT_CONVERGED
    return 0


def _refit_hardening(files: list[Path], out: Path, console: Console, *, publish: bool) -> int:
    """Fit the law of metals that harden to the other coefficients in use."""
    from ..fitting.coefficients import write_coefficients
    from ..fitting.refit import refit_hardening
    from ..fitting.table import read_sources
    from ..models.coefficients import drawn_from, read_coefficients

    content = read_coefficients()
    if content is None:
        raise InputError("none in use", key="coefficients", allowed="`dentscope fit` first")
    content["drawn_from"] = drawn_from()
    if not refit_hardening(content, read_sources(files), progress=console.print):
        raise InputError("no metals that harden", key="campaigns", allowed="design hardening")
    _show_hardening(console, content)
    console.print(f"coefficients: {write_coefficients(content, out / 'fitted.json')}")
    if publish:
        _publish(content, None)
        console.print("the law of metals that harden now uses these coefficients")
    return 0


def _show_hardening(console: Console, content: dict[str, Any]) -> None:
    from ..fitting.report import hardening_rows, uncertainty_rows

    found = content["hardening"]
    columns = {"left out": found["left_out"]}
    columns |= {name: one["errors"] for name, one in found["judged"].items()}
    _show(console, hardening_rows(columns))
    _show(console, uncertainty_rows({k: one["within"] for k, one in found["judged"].items()}))


def _publish(content: dict[str, Any], drawn: Path | None) -> None:
    """Put coefficients where laws read them; tables, and what was `drawn`, into their page."""
    from ..fitting.coefficients import write_coefficients
    from ..models.coefficients import COEFFICIENTS_FILE
    from ..studies.closed_form.page import published_section, update_page

    write_coefficients(content, COEFFICIENTS_FILE)
    update_page(_PAGE, published_section(content))
    for name in ("errors", "maps"):
        if drawn is not None:
            picture = _PAGE.parent / "pictures" / f"fitted-{name}.png"
            write_file(picture, (drawn / f"{name}.png").read_bytes())


def _files(campaigns: Sequence[Path] | None) -> list[Path]:
    if not campaigns:
        return sorted(PUBLISHED.glob("*.h5")) or [_OWN]
    files: list[Path] = []
    for path in campaigns:
        parts = sorted(path.glob("*.h5")) if path.is_dir() else []
        files += parts or [path]
    for path in files:
        _check_kind(path)
    return files


def _check_kind(path: Path) -> None:
    """Refuse what is no campaign at all, before the seconds that the reader takes to load."""
    allowed = "the folder of a run, or a part that `dentscope campaign publish` wrote"
    if path.is_dir():
        if not (path / "cases").is_dir():
            raise InputError("no cases in it", source=str(path), allowed=allowed)
        return
    checked_file(path, most=2**63, allowed=allowed)  # its reader says how large it may be
    with path.open("rb") as stream:
        if not stream.read(16).startswith(_HEADS):
            raise InputError("not a campaign file", source=str(path), allowed=allowed)


def _show(console: Console, rows: Sequence[Sequence[str]]) -> None:
    show_table(console, rows[0], rows[1:])


def _judge(folder: Path, console: Console, *, publish: bool) -> int:
    """Show the errors of the laws in use on cases that no fit reads."""
    files = _files([folder])
    from ..fitting.hardening import hardening_records, judge_hardening
    from ..fitting.refit import judged
    from ..fitting.report import error_rows, hardening_rows, uncertainty_rows
    from ..fitting.table import read_sources
    from ..models import law_named
    from ..models.coefficients import drawn_from

    sources = read_sources(files)
    laws: list[Any] = [law_named("compact"), law_named("fitted")]
    found = judged(sources, laws)
    count = len(found.names)
    _show(console, error_rows([(f"{name}, {count} pairs", e) for name, e in found.errors]))
    _show(console, uncertainty_rows(found.within))
    hard = hardening_records(sources, held_out=True)
    if hard:
        law: Any = law_named("hardening")
        errors, within = judge_hardening(law, hard)
        _show(console, hardening_rows({f"{len(hard)} pairs that harden": errors}))
        _show(console, uncertainty_rows({"hardening": within}))
    if publish:
        from ..studies.closed_form.page import judged_section, update_page

        section = judged_section(found.errors, found.names, drawn_from(), within=found.within)
        update_page(_PAGE, section)
    return 0
