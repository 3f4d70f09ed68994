"""The gallery: every figure that our numbers can redraw, with a line under each."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from pathlib import Path

from ..campaigns import read_curves, read_published
from ..campaigns.store import CaseRecord
from ..core.errors import InputError
from ..models import DomainWarning
from . import chapter1, chapter2, chapter3, chapter45, errata, outside
from .plot import Picture

CHAPTERS: dict[str, Callable[[Sequence[CaseRecord]], list[Picture]]] = {
    "1": chapter1.pictures,
    "2": chapter2.pictures,
    "3": chapter3.pictures,
    "4 and 5": chapter45.pictures,
    "outside": outside.pictures,
}
"""Chapters in reading order; the last compares with another program's law."""

_HEAD = """# Gallery

Made by `dentscope figures`; the lines under the pictures are computed with them. A law's name is
that of `dentscope laws list`. Finite elements: {rests}.
"""

NOT_REDRAWN = {
    "1.1, 1.4, 4.1-4.3, 5.1, 5.2": "sketches",
    "2.1-2.4, 3.7": "meshes and stress fields: `dentscope case CASE.toml --picture` draws them",
    "2.9-2.13": "steps of the thesis's fit; 2.5-2.8 and 2.16-2.21 show its result",
    "3.1-3.6": "photographs, videos and scans of the experiments, which are not published",
    "5.4-5.6": "measured scars, which are not published; 5.7 is the predicted path",
}
"""Figures of the thesis that are left out, with the reason."""


def stored_cases(root: Path) -> list[CaseRecord]:
    """Completed cases of the published campaign, or else of a run in build/campaign."""
    records = read_published(root / "data" / "campaign")
    own = root / "build" / "campaign" / "campaign.h5"
    if not records and own.exists():
        try:
            records = read_curves(own)
        except InputError:
            return []
    return records


def build(folder: Path, *, chapters: Sequence[str], root: Path) -> list[Picture]:
    """Draw the figures of `chapters` into `folder` and write its README.md and the errata.

    Raises
    ------
    InputError
        A chapter that there is none of.
    """
    for chapter in chapters:
        if chapter not in CHAPTERS:
            raise InputError(f"{chapter!r}", key="chapter", allowed=", ".join(CHAPTERS))
    records = stored_cases(root)
    parts = []
    drawn: list[Picture] = []
    for chapter in chapters:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DomainWarning)  # the figures leave domains on purpose
            pictures = CHAPTERS[chapter](records)
        parts.append(_section(chapter, pictures))
        for picture in pictures:
            picture.save(folder)
        drawn += pictures
    rests = f"{len(records)} stored cases" if records else "none found beside it"
    left = "\n".join(f"- {number}: {reason}" for number, reason in NOT_REDRAWN.items())
    text = "\n".join([_HEAD.format(rests=rests), *parts, "## Not redrawn\n", left, ""])
    (folder / "README.md").write_text(text, encoding="utf-8")
    if tuple(chapters) == tuple(CHAPTERS):
        errata.write(root / "docs" / "errata.md")
    return drawn


def _section(chapter: str, pictures: Sequence[Picture]) -> str:
    head = "## Beside another program\n" if chapter == "outside" else f"## Chapter {chapter}\n"
    lines = [head]
    for one in pictures:
        name = f"Figure {one.number}" if one.number[0].isdigit() else one.number.capitalize()
        lines.append(f"### {name}: {one.title}\n\n![{one.title}]({one.file})\n\n{one.note}\n")
    return "\n".join(lines)
