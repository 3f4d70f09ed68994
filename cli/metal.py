"""`dentscope metal`: the flow curve of a metal from its marks."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .shared.places import folder_option
from .shared.terminal import say

if TYPE_CHECKING:
    from ..recordings import RecordingSet


def metal(
    folder: Annotated[
        Path, typer.Argument(help="Recording set: a folder with set.toml, or a shipped name.")
    ],
    out: Annotated[Path, folder_option("Folder for the curve, its covariance, a picture.")] = Path(
        "build/metal"
    ),
) -> None:
    """Say how strong a metal is, by strain and rate, from the dents in it.

    Presses and dents give the flow curve of the body that yields first, impacts beside them its
    rate. Writes flow_curve.csv, which `flow_curve` in set.toml takes, and a picture into OUT.
    """
    from ..recordings import read
    from ..recordings.shipped import set_folder

    recordings = read(set_folder(folder))
    from ..discrepancy.metal import lines, metal_of, write_metal

    tell_contradictions(recordings)
    found = metal_of(recordings)
    written = write_metal(found, out)
    for line in lines(found):
        say(line)
    typer.echo(f"\nwritten: {', '.join(map(str, written))}")


def tell_contradictions(recordings: RecordingSet) -> None:
    """Say which numbers of a set exclude each other: a curve of loads in kN is none."""
    from ..recordings import Severity, audit

    for finding in audit(recordings).of(Severity.CONTRADICTION):
        say(str(finding))
