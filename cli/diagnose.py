"""`dentscope diagnose`: what physics is missing in a recording set."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from shutil import get_terminal_size
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from ..core.output import write_file
from .shared.places import folder_option, misused, writable_folder
from .shared.terminal import say, tell_first_use

if TYPE_CHECKING:
    from ..discrepancy import Verdict

_OUT = Path("build/diagnose")


def diagnose(
    folder: Annotated[
        Path | None,
        typer.Argument(help="Recording set: a folder with set.toml, or a shipped name."),
    ] = None,
    out: Annotated[Path | None, folder_option("Folder for verdict.json and report.html.")] = None,
    seed: Annotated[int, typer.Option(min=0, help="Same seed, same answer.")] = 0,
    law: Annotated[Literal["fitted", "table"] | None, typer.Option(
        help="Fitted, or the own pair solved; else solved if it has a flow curve. No other: "
        "how far off it is, is not known.",
    )] = None,
    cautious: Annotated[
        bool, typer.Option("--cautious", help="Say only what has four fifths of the probability.")
    ] = False,
    assume: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="A mechanism that acts, as published; may be repeated."),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="No progress line.")] = False,
    report: Annotated[
        bool, typer.Option("--report/--no-report", help="Write report.html, or verdict.json alone.")
    ] = True,
    solve: Annotated[
        bool, typer.Option("--solve", help="A named hardening or rate by finite elements too.")
    ] = False,
) -> None:  # fmt: skip
    """Compare recordings with the simulation and say what physics is missing, if any.

    Writes verdict.json (for programs) and report.html (for people) into OUT, by default
    build/diagnose/SET, and prints the finding.
    """
    from ..recordings.shipped import set_folder, shipped_sets

    if folder is None:
        known = f"a folder, or a shipped set: {', '.join(shipped_sets())}"
        raise misused("no recording set", key="FOLDER", allowed=known)
    from ..recordings import read

    place = set_folder(folder)
    recordings = read(place)
    out = out or writable_folder(report_folder(place), key="--out")
    from ..discrepancy import diagnose as run
    from ..discrepancy.report import lines, write_report

    show = _progress(quiet=quiet)
    if not quiet:
        tell_first_use()
    verdict = run(
        recordings, seed=seed, law=law, cautious=cautious, assume=assume or (), progress=show
    )
    show("")
    text = json.dumps(verdict.to_dict(), indent=1, allow_nan=False)
    written = [write_file(out / "verdict.json", text + "\n")]
    written += write_report(verdict, out / "report.html") if report else ()
    for line in lines(verdict):
        say(line)
    if solve:
        written += _solved(verdict, out, show)
    typer.echo(f"\nwritten: {', '.join(map(str, written))}")


def report_folder(place: Path) -> Path:
    """Return a folder for the set of this place alone, so that no other's report is lost."""
    from ..recordings.shipped import FOLDER

    place, here = place.resolve(), Path.cwd()
    if place.parent == FOLDER or place == here:
        return _OUT / place.name
    if place.is_relative_to(here):
        return _OUT / place.relative_to(here)
    return _OUT / "elsewhere" / place.relative_to(place.anchor)


def _progress(*, quiet: bool) -> Callable[[str], None]:
    """Return what tells a step: one line that changes on a terminal, a line a step in a file."""
    live = sys.stderr.isatty()

    def show(step: str) -> None:
        told = f"{step} ..." if step else ""
        if live and not quiet:
            # a line that wraps could not be taken back
            room = get_terminal_size().columns - 1
            typer.echo(f"\r\x1b[K{told[:room]}", nl=False, err=True)
        elif told and not quiet:
            typer.echo(told, err=True)

    return show


def _solved(verdict: Verdict, out: Path, show: Callable[[str], None]) -> list[Path]:
    """Take what the verdict names to the finite elements, and tell what they say."""
    from ..start.closing import close, closed_lines, write_closed

    closed = close(verdict, progress=show)
    show("")
    for line in closed_lines(closed):
        say(line)
    return list(write_closed(closed, out))
