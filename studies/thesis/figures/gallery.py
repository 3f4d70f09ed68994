"""docs/thesis: every figure that our numbers can redraw, with a line under each."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path

from ....campaigns import CaseRecord, read_curves, read_published
from ....core.errors import InputError
from ....core.output import write_file
from ....core.tables import markdown
from ....models.base import unwarned
from ...plot import Entry, Picture, Table
from . import chapter1, chapter2, chapter3, chapter45
from .names import CHAPTERS

_PICTURES: dict[str, Callable[[Sequence[CaseRecord]], Sequence[Entry]]] = dict(
    zip(
        CHAPTERS,
        (chapter1.pictures, chapter2.pictures, chapter3.pictures, chapter45.pictures),
        strict=True,
    )
)  # fmt: skip

_HEAD = """# The thesis again

This work begins with the contact model of H. Ghaednia's PhD thesis, *Analytical and experimental
analysis of the permanent deformation after collisions*. Here its figures and tables are made again
from our own numbers, its statements are checked and its misprints listed.

| page | what it holds |
| --- | --- |
"""
_ALSO = """\
| [Claims](claims.md) | what chapter 2 says, checked on our finite elements |
| [Errata](errata.md) | misprints and contradictions |

The line under each figure says whether it agrees, by how much it differs, and why; it is computed
with the picture. A law's name is that of `dentscope laws`; in every figure it keeps its colour
(table 4.2). `make figures` draws all of it again, `dentscope figures --chapter 2` one chapter.

## Not drawn

"""

NOT_REDRAWN = {
    "1.1, 1.4, 3.1, 4.1-4.3, 5.1, 5.2": "sketches, not drawn again",
    "3.2-3.6": "photographs, films and scans, which are not published",
    "5.4-5.7": "scars and path, whose measured ones are not published; see tables 5.2-5.4",
}
"""Figures of the thesis that are not drawn, with the reason."""


def stored_cases(root: Path) -> list[CaseRecord]:
    """Completed cases of the published campaign, or else of a run in build/campaign."""
    records = read_published(root / "data" / "campaign")
    own = root / "build" / "campaign"
    if not records and own.exists():
        try:
            records = read_curves(own)
        except InputError:
            return []
    # the thesis's metals do not harden
    return [record for record in records if record.case.pair.perfectly_plastic]


def build(folder: Path, *, chapters: Sequence[str], root: Path) -> list[Entry]:
    """Draw `chapters` into `folder`, a page each, and write its README.md.

    Raises `InputError`: a chapter that there is none of.
    """
    for chapter in chapters:
        if chapter not in CHAPTERS:
            raise InputError(f"{chapter!r}", key="chapter", allowed=", ".join(CHAPTERS))
    records = stored_cases(root)
    rests = f"{len(records)} stored cases" if records else "none found beside it"
    drawn: list[Entry] = []
    for chapter in chapters:
        with unwarned():
            entries = sorted(_PICTURES[chapter](records), key=_order)
        for entry in entries:
            if isinstance(entry, Picture):
                entry.save(folder)
        write_file(folder / page_of(chapter), _page(chapter, entries, rests))
        drawn += entries
    write_file(folder / "README.md", _index(folder))
    return drawn


def page_of(chapter: str) -> str:
    """File name of a chapter's page."""
    return f"chapter-{chapter.replace(' and ', '-')}.md"


def _order(entry: Entry) -> tuple[int, int, bool]:
    """By chapter and number, figures before tables of the same number."""
    first, second = entry.number.split(".")
    return (int(first), int(second), isinstance(entry, Table))


def _name(entry: Entry) -> str:
    return f"{'Table' if isinstance(entry, Table) else 'Figure'} {entry.number}"


def _page(chapter: str, entries: Sequence[Entry], rests: str) -> str:
    lines = [f"# Chapter {chapter}\n\nFinite elements: {rests}.\n"]
    for one in entries:
        name = _name(one)
        if isinstance(one, Table):
            shown = markdown([one.header, *one.rows])
        else:
            shown = f"![{name}]({one.file})\n"
        lines.append(f"## {name}: {one.title}\n\n{shown}\n{one.note}\n")
    return "\n".join(lines)


def _index(folder: Path) -> str:
    """Contents of all pages that there are, and what is not drawn."""
    parts = [_HEAD]
    for chapter in CHAPTERS:
        page = folder / page_of(chapter)
        if not page.exists():
            continue
        names = re.findall(r"^## (\w+ ?[\d.]*)", page.read_text("utf-8"), re.MULTILINE)
        count = len([name for name in names if name.startswith("Figure")])
        tables = [name.split()[1] for name in names if name.startswith("Table")]
        told = f", tables {', '.join(tables)}" if len(tables) > 1 else ""
        parts.append(f"| [Chapter {chapter}]({page.name}) | {count} figures{told} |\n")
    left = "\n".join(f"- {number}: {reason}" for number, reason in NOT_REDRAWN.items())
    return "".join([*parts, _ALSO, left, "\n"])
