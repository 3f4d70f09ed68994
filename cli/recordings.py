"""`dentscope recordings`: check, audit, begin and fetch recording sets."""

from __future__ import annotations

from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated

import typer

from ..core.tables import counted
from .shared.groups import group
from .shared.places import folder_option, misused, one_of
from .shared.terminal import new_console, say, show_table

if TYPE_CHECKING:
    from ..reduce.table.sheet import Sheet

app = group("Recording sets, measured impacts: list, check, audit, new, add, fetch.")

NewFolder = Annotated[Path, typer.Argument(metavar="SET", help="Folder of the recording set.")]
SetFolder = Annotated[
    Path, typer.Argument(metavar="SET", help="Folder of the recording set, or a shipped name.")
]

FromSheet = Annotated[
    Path | None,
    typer.Option("--from", metavar="SHEET", help="A laboratory's sheet: XLSX, ODS, CSV."),
]
OfBook = Annotated[
    str, typer.Option("--sheet", help="Name of a workbook's sheet; default: the first.")
]
Columns = Annotated[
    list[str] | None,
    typer.Option(metavar="HEADER=QUANTITY UNIT", help="What a header of the sheet means."),
]


@app.command()
def check(folder: SetFolder) -> None:
    """List every mistake of a set, or say what it holds."""
    from ..recordings import read
    from ..recordings.questions import questions_of
    from ..recordings.shipped import set_folder

    found = read(set_folder(folder))
    strikers = ", ".join(found.setup.strikers)
    typer.echo(f"{folder}: sound; {counted(len(found.trials), 'trial')} of {strikers}")
    for name in ("description", "source", "licence"):
        if text := getattr(found.setup, name):
            say(f"  {name}: {text}")
    for name in found.observed:
        noise = found.noise(name)
        count = int((found.values(name) == found.values(name)).sum())
        typer.echo(f"  {name}: {count} values, noise from {noise.origin}")
    for kind, files in (("traces", found.traces), ("profiles", found.profiles)):
        if files:
            typer.echo(f"  {kind}: {len(files)}")
    for note in (*found.notes, *questions_of(found)):
        say(f"  note: {note}")


@app.command("audit")
def audit_command(
    folder: SetFolder,
    everything: Annotated[
        bool, typer.Option("--all", help="Also print the checks that were passed.")
    ] = False,
) -> None:
    """Compare a set's numbers with each other: mass, speed, momentum, energy, forces, durations."""
    from ..recordings import Severity, audit, read
    from ..recordings.shipped import set_folder

    found = audit(read(set_folder(folder)))
    shown = (Severity.CONTRADICTION, Severity.CAUTION)
    for finding in found.findings:
        if everything or finding.severity in shown:
            say(str(finding))
    counts = ", ".join(f"{len(found.of(s))} {s.value}" for s in Severity if found.of(s))
    typer.echo(f"{found.name}: {counts or 'nothing to check'}")


@app.command()
def new(
    folder: NewFolder,
    sphere: Annotated[
        bool | None,
        typer.Option("--sphere/--rod", help="The striker; a sphere unless a sheet says."),
    ] = None,
    sheet: FromSheet = None,
    of_book: OfBook = "",
    column: Columns = None,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Only show what of the sheet would be read.")
    ] = False,
) -> None:
    """Write a set to fill in: set.toml with its open values marked, trials.csv with its header.

    From a sheet with a row a drop the rows are taken over; what became of each column is told.
    """
    from ..recordings.template import write_template

    if sheet is not None:
        _new_from(sheet, folder, column or [], of_book=of_book, sphere=sphere, dry_run=dry_run)
        return
    if column or dry_run or of_book:
        told = "--column, --dry-run and --sheet are of a sheet"
        raise misused(told, key="--from", allowed="--from SHEET beside them")
    write_template(folder, shape="rod" if sphere is False else "sphere")
    check = f"dentscope recordings check {quote(str(folder))}"
    told = "set.toml and trials.csv (delete columns that are not measured)"
    typer.echo(f"{folder}: fill in {told}, then: {check}")


def _new_from(
    sheet: Path, folder: Path, columns: list[str], *, of_book: str, sphere: bool | None,
    dry_run: bool,
) -> None:  # fmt: skip
    """Write a set with the rows of a laboratory's sheet, and tell what became of each column."""
    from ..core.inputs.names import trial_name
    from ..recordings.template import refuse_a_set
    from ..reduce.output.into_set import store
    from ..reduce.output.row import Row
    from ..reduce.table.sheet import read_balls

    refuse_a_set(folder)
    balls = read_balls(sheet, columns, sheet=of_book)
    still = list[str]()
    for ball, found in balls.items():
        shape = found.shape if sphere is None else "sphere" if sphere else "rod"
        first = f"{trial_name(sheet)}-{ball}" if ball else ""
        if not dry_run:
            options = {"shape": shape, "column": "; ".join(columns), "ball": ball}
            row = Row(striker=ball, trial=first)
            done = store(found.reduced(sheet), folder, row, kind="sheet", options=options,
                         strikers=tuple(filter(None, balls)))  # fmt: skip
            still = list(done.notes)
        typer.echo(f"{sheet}: {counted(len(found.trials), 'trial')} of {ball or f'a {shape}'}")
        _tell_columns(found)
        if dry_run:
            show_table(new_console(), *found.shown(first or trial_name(sheet)))
    if dry_run:
        return
    for line in still:
        typer.echo(f"  note: {line}")
    typer.echo(f"{folder}: fill in set.toml, then: dentscope recordings check {quote(str(folder))}")


@app.command()
def add(
    folder: NewFolder,
    rows: Annotated[
        Path | None, typer.Argument(metavar="ROWS", help="CSV with columns of trials.csv.")
    ] = None,
    sheet: FromSheet = None,
    of_book: OfBook = "",
    column: Columns = None,
    striker: Annotated[str, typer.Option(help="Of a sheet's trials, where a set has more.")] = "",
) -> None:
    """Add trials to a set, all rows of a table or sheet or none; then diagnose it again."""
    from tempfile import TemporaryDirectory

    from ..recordings.adding import add_trials

    if (rows is None) == (sheet is None):
        raise misused("one table is added", key="ROWS, --from", allowed="ROWS, or --from SHEET")
    with TemporaryDirectory() as place:
        if sheet is not None:
            rows = _rows_of(sheet, folder, Path(place), column or [], of_book, striker)
        elif column or of_book or striker:
            told = "--column, --sheet and --striker are of a sheet"
            raise misused(told, key="--from", allowed="--from SHEET beside them")
        assert rows is not None
        now, new = add_trials(folder, rows, source=f"{sheet}, as read" if sheet else "")
    in_all = counted(len(now.trials), "trial")
    typer.echo(f"{folder}: {counted(len(new), 'trial')} added, {in_all} in all")
    typer.echo(f"then: dentscope diagnose {quote(str(folder))}")


def _rows_of(
    sheet: Path, folder: Path, place: Path, columns: list[str], of_book: str, striker: str
) -> Path:
    """Write the rows of a laboratory's sheet as those of trials.csv, and tell what became of it."""
    from ..recordings import read
    from ..reduce.output.into_set import store
    from ..reduce.output.row import Row
    from ..reduce.table.sheet import read_sheet

    found = read_sheet(sheet, columns, sheet=of_book)
    strikers = read(folder).setup.strikers
    striker = striker or ("".join(strikers) if len(strikers) == 1 else "")
    one_of(striker, sorted(strikers), key="--striker")
    found.refuse_another(strikers[striker], str(sheet), key=f"{folder}: strikers.{striker}")
    told = {"shape": found.shape, "column": "; ".join(columns)}
    store(found.reduced(sheet), place, Row(striker=striker), kind="sheet", options=told)
    _tell_columns(found)
    return place / "trials.csv"


def _tell_columns(found: Sheet) -> None:
    for header, became in found.columns:
        typer.echo(f"  {header!r}: {became}")
    for line in found.left_out:
        typer.echo(f"  note: {line}")


@app.command("list")
def list_sets(
    folder: Annotated[
        Path | None, typer.Argument(help="Folder that holds sets; the shipped ones without it.")
    ] = None,
) -> None:
    """List the sets in a folder, a line each."""
    from ..core.errors import InputError
    from ..recordings import read
    from ..recordings.shipped import FOLDER

    folder = folder or FOLDER
    sets = [path.parent for path in sorted(folder.glob("*/set.toml"))]
    if not sets:
        raise InputError("no set in it", source=str(folder), allowed="a folder with sets")
    for path in sets:
        try:
            found = read(path)
        except InputError as error:
            typer.echo(f"{path.name}: {str(error).splitlines()[0]}")
            continue
        typer.echo(
            f"{path.name}: {counted(len(found.trials), 'trial')}; {', '.join(found.observed)}"
        )


@app.command()
def fetch(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="NAME...", help="Which; all without a name.")
    ] = None,
    catalogue: Annotated[
        Path | None, typer.Option(help="List of addresses and checksums, instead of the shipped.")
    ] = None,
    out: Annotated[Path, folder_option("Folder to fetch into.")] = Path("build/recordings"),
) -> None:
    """Fetch raw files that may not be shipped, by pinned address and checksum."""
    from ..recordings.fetch import fetch_sources, read_catalogue
    from ..recordings.shipped import FOLDER

    for got in fetch_sources(read_catalogue(catalogue or FOLDER / "fetch.toml"), out, names or []):
        typer.echo(f"{got.name}: {len(got.files)} files in {got.folder}")
        if got.recipe:
            typer.echo(f"  next: {got.recipe}")
