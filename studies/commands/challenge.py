"""`dentscope challenge`: made-up recordings for a method of one's own, and its scores."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Annotated

import typer

from ...cli.shared.groups import group
from ...cli.shared.places import writable_folder
from ...cli.shared.terminal import console, say, show_table

app = group("Bring your own method: get concealed impacts, score what it says of them.")


@app.command()
def get(folder: Annotated[Path, typer.Argument(help="New folder for the sets.")]) -> None:
    """Write the sets that ship: some with their truths, more whose truths are sealed."""
    from ..challenge.archive import get as unpack

    for part, count in unpack(writable_folder(folder, key="FOLDER")).items():
        typer.echo(f"{folder / part}: {count} sets")


@app.command()
def score(
    folder: Annotated[Path, typer.Argument(help="FOLDER/open or FOLDER/sealed.")],
    answers: Annotated[Path, typer.Argument(help="Table: set, name, probability.")],
    truths: Annotated[
        Path | None, typer.Option(help="Truths of the sealed sets, once they are published.")
    ] = None,
) -> None:
    """Score answers against the truths, each held to its seal; 95 % intervals by bootstrap."""
    from ..challenge.answers import read_answers
    from ..challenge.archive import sets_of, truths_of
    from ..challenge.score import scores

    sets = sets_of(folder)
    said = read_answers(answers, sets)
    true = truths_of(folder, sets, truths)
    if not true:
        digest = hashlib.sha256(answers.read_bytes()).hexdigest()
        say(f"{answers}: {len(sets)} sets answered, SHA-256 {digest}")
        say("their truths are sealed: keep the file, and score it with --truths once they are out")
        return
    rows = [(r.name, f"{r.value:.3f}", f"{r.low:.3f} to {r.high:.3f}") for r in scores(said, true)]
    show_table(console(), (f"{len(sets)} sets", "value", "95 % interval"), rows)
