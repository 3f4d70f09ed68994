"""`dentscope challenge`: made-up recordings for a method of one's own, and its scores."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from ...cli.shared.groups import group
from ...cli.shared.places import writable_folder
from ...cli.shared.terminal import new_console, say, show_table
from ...core.errors import InputError

# limit: how long an answer takes at least [s]: the slowest simulation of ten trials
_ANSWER_S = 4.0

app = group("Bring your own method: get concealed impacts, score what it says of them.")


@app.command()
def get(
    folder: Annotated[Path, typer.Argument(help="New folder for the sets.")],
    first: Annotated[bool, typer.Option("--first", help="Those of the first edition.")] = False,
) -> None:
    """Write the sets that ship: some with their truths, more whose truths are sealed."""
    from ..challenge.archive import get as unpack

    for part, count in unpack(writable_folder(folder, key="FOLDER"), first=first).items():
        typer.echo(f"{folder / part}: {count} sets")


Judge = Annotated[
    Path | None,
    typer.Option(help="Folder of the judge's secret; default: FOLDER-judge beside FOLDER."),
]


def _judge(folder: Path, judge: Path | None) -> Path:
    return judge or folder.with_name(f"{folder.name}-judge")


@app.command()
def ask(
    folder: Annotated[Path, typer.Argument(help="Of the sets; made if there is none.")],
    name: Annotated[str, typer.Argument(metavar="[SET]", help="Which is asked.")] = "",
    rows: Annotated[
        Path | None, typer.Argument(metavar="[ROWS]", help="CSV: striker, impact_speed_m_s, ...")
    ] = None,
    sets: Annotated[int, typer.Option(min=1, max=999, help="How many are made.")] = 10,
    judge: Judge = None,
) -> None:
    """Make sealed sets that answer; with SET and ROWS, buy trials of one."""
    from ..challenge.ask import BOUGHT, deal
    from ..challenge.ask import ask as asked

    began, aside = time.monotonic(), _judge(folder, judge)
    if not name:
        names = deal(writable_folder(folder, key="FOLDER"), aside, sets)
        typer.echo(f"{folder}: {len(names)} sets, {BOUGHT} trials of each; their secret: {aside}")
        return
    if rows is None:
        raise InputError("no ROWS", source="command line", key="ROWS", allowed="a table of trials")
    try:
        table, left = asked(folder, aside, name, rows)
    finally:
        # no set answers faster than another
        time.sleep(max(_ANSWER_S - (time.monotonic() - began), 0.0))
    for row in table:
        typer.echo(",".join(row))
    typer.echo(f"{name}: {left} trials are left", err=True)


@app.command()
def seal(
    folder: Annotated[Path, typer.Argument(help="Of your sets: FOLDER/sets/NAME.")],
    acts: Annotated[Path, typer.Argument(help="Table: set, name of what acts, 1.")],
    truths: Annotated[
        Path | None, typer.Option(help="New file for the truths; default: FOLDER-truths.json.")
    ] = None,
) -> None:
    """Fix what you did to sets of your own before anybody answers them."""
    from ..challenge.archive import SEALS
    from ..challenge.sealing import seal as fix
    from ..proof.seal import digest_of

    kept = truths or folder.with_name(f"{folder.name}-truths.json")
    names = fix(folder, acts, kept)
    digest = digest_of(folder / SEALS)
    typer.echo(f"{folder / SEALS}: {len(names)} sets, SHA-256 {digest}: publish it with them")
    typer.echo(f"{kept}: the truths: keep them until all answers are in")


@app.command()
def score(
    folder: Annotated[Path, typer.Argument(help="FOLDER/open or FOLDER/sealed.")],
    answers: Annotated[Path, typer.Argument(help="Table: set, name, probability.")],
    truths: Annotated[
        Path | None, typer.Option(help="Truths of the sealed sets, once they are published.")
    ] = None,
    judge: Judge = None,
    before: Annotated[
        Path | None, typer.Option(help="Answers before any trial was bought.")
    ] = None,
) -> None:
    """Score answers against the truths, each held to its seal; 95 % intervals by bootstrap."""
    from ..challenge import ask as bought
    from ..challenge.answers import read_answers
    from ..challenge.archive import sets_of, truths_of
    from ..challenge.score import scores
    from ..proof.seal import digest_of

    sets = sets_of(folder)
    said = read_answers(answers, sets)
    aside = _judge(folder, judge)
    dealt = judge is not None or aside.is_dir()
    true = bought.truths(aside) if dealt else truths_of(folder, sets, truths)
    if not true:
        say(f"{answers}: {len(sets)} sets answered, SHA-256 {digest_of(answers)}")
        say("their truths are sealed: keep the file, and score it with --truths once they are out")
        return
    found = scores(said, true)
    if dealt:
        first = read_answers(before, sets) if before else None
        found += bought.bought_scores(aside, said, first)
    rows = [(r.name, f"{r.value:.3f}", f"{r.low:.3f} to {r.high:.3f}") for r in found]
    show_table(new_console(), (f"{len(sets)} sets", "value", "95 % interval"), rows)
