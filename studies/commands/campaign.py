"""`dentscope campaign reproduction`: what a sweep shows, beside the thesis."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ...cli.campaign_data import PUBLISHED
from ...cli.shared.places import file_option

_Data = Annotated[
    Path | None,
    typer.Option(help="A run or a folder of parts. Default: published, else own run."),
]


def reproduction(
    data: _Data = None,
    to: Annotated[Path, file_option("Report to write.")] = Path("docs/thesis/claims.md"),
) -> None:
    """Check the trends that chapter 2 of the thesis tells, one by one."""
    from ..campaign.reproduction import write

    for trend in write(_data(data), to):
        typer.echo(f"{trend.verdict:>14}  {trend.claim}")
    typer.echo(f"written: {to}")


def _data(given: Path | None) -> Path:
    """What to read: what was named, or the published data, or the own run."""
    from ...campaigns.parts import CHECKSUMS

    if given is not None:
        return given
    return PUBLISHED if (PUBLISHED / CHECKSUMS).exists() else Path("build/campaign")
