"""The row of headers of a laboratory's sheet, below its titles, and the columns under it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from ....core.errors import InputError
from ....recordings.columns import CONDITIONS
from ..heading import is_unit
from .kinds import (
    APPROACHES,
    CELSIUS,
    MEAN,
    REBOUNDS,
    SheetKind,
    bare,
    is_spread,
    kind_of,
    named,
    said_unit,
    unit_of,
)

NOT_UNDERSTOOD = "left out: not understood"
_NUMBER = re.compile(r"[+-]?\s*\d[\d.,' ]*\D{0,6}")
_LATER = re.compile(
    r"\b([2-9](nd|rd|th)|second[oa]?|third|fourth|zweite\w*|dritte\w*|deuxieme|troisieme|terz[oa]|"
    r"segund[oa]|tercer\w*)\b"
)
_NORMAL = re.compile(r"(from|to)( the)? (normal|vertical)|\blot\b|senkrecht")


@dataclass
class SheetColumn:
    """A column that is understood.

    Parameters
    ----------
    place
        In the row, from 0.
    header
        As the sheet has it.
    kind
        What it is.
    unit
        Of its numbers; None where the header names none.
    spread
        Whether it holds the standard deviations of a column to its left.
    taken
        Cells that were read.
    unitless
        Whether a cell asked for the unit.
    across
        Whether it holds the second of two diameters of one dent.
    """

    place: int
    header: str
    kind: SheetKind
    unit: str | None
    spread: bool = False
    taken: int = 0
    unitless: bool = False
    across: bool = False

    @property
    def no_unit(self) -> str:
        """What is wrong with the header's unit."""
        said = said_unit(self.header)
        return f"{said!r} is no unit of {self.kind.quantity} that is known" if said else (
            "the header names no unit"
        )  # fmt: skip


def understood(rows: Sequence[Sequence[str]]) -> list[int]:
    """Return how many headers are understood in each of the first rows, below their titles."""
    heads = (_under_titles(rows, k) for k in range(len(rows[:40])))
    return [sum(kind_of(cell) is not None for cell in head) for head in heads]


def headers_of(
    rows: Sequence[Sequence[str]], source: str
) -> tuple[int, list[SheetColumn], list[tuple[str, str]]]:
    """Return the first row below the headers, the columns that are understood, and the others.

    Raises
    ------
    InputError
        No row of headers is understood, or two columns hold the approach of one row.
    """
    known = understood(rows)
    best = max(range(len(known)), key=lambda k: known[k], default=0)
    if not known or known[best] < 2:
        raise InputError(
            "no row of headers is understood", source=source,
            allowed="columns such as drop height (cm), rebound height (mm), dent diameter (mm)",
        )  # fmt: skip
    head, top = _under_titles(rows, best), best + 1
    below = list(rows[top]) if top < len(rows) else []
    filled = [cell for cell in below if cell]
    if filled and all(is_unit(cell) or cell.strip("()[] ") in CELSIUS for cell in filled):
        pairs = zip(head, [*below, *[""] * len(head)], strict=False)
        head, top = [f"{h} ({u.strip('()[] ')})" if u else h for h, u in pairs], top + 1
    told = [
        (" ".join(filter(None, row)), f"row {k}, left out: above the headers")
        for k, row in enumerate(rows[:best], start=1)
        if any(row) and (k < best or head == list(rows[best]))
    ]
    columns: list[SheetColumn] = []
    for place, header in enumerate(head):
        spread = is_spread(header)
        kind = columns[-1].kind if spread and columns and not named(header) else kind_of(header)
        if kind is not None and (kind.quantity == "text" or not spread):
            columns.append(SheetColumn(place, header, kind, unit_of(header, kind)))
            columns[-1].across = _is_across(columns)
        elif kind is not None and any(c.kind == kind for c in columns):
            left = next(c for c in reversed(columns) if c.kind == kind)
            unit = unit_of(header, kind)
            columns.append(SheetColumn(place, header, kind, unit or left.unit, spread=True))
        elif header or any(place < len(row) and row[place] for row in rows[top:]):
            why = NOT_UNDERSTOOD if header else "left out: no header"
            told.append((header or f"column {place + 1}", why))
    kept = []
    for column in columns:
        if why := _left_out(column, columns, source):
            told.append((column.header, f"left out: {why}"))
        else:
            kept.append(column)
    return top, kept, told


def _is_across(columns: Sequence[SheetColumn]) -> bool:
    """Whether the last column is d2 of a dent whose d1 stands before it."""
    *before, last = columns
    firsts = (c for c in before if c.kind == last.kind and _ends_in_d(c, "1"))
    return _ends_in_d(last, "2") and any(firsts)


def _ends_in_d(column: SheetColumn, number: str) -> bool:
    return re.search(rf"\bd ?{number}$", named(column.header)) is not None


def _left_out(column: SheetColumn, columns: Sequence[SheetColumn], source: str) -> str:
    """Why a column is not taken beside the others; empty where it is."""
    words, name = bare(column.header), column.kind.name
    if name == "angle_deg" and _NORMAL.search(words):
        raise InputError(
            "an angle from the normal", source=source, key=column.header,
            allowed="that between velocity and flat, or axis and flat: 90 for a normal impact",
        )  # fmt: skip
    if column.kind.quantity == "text":
        return ""
    if name in REBOUNDS and _LATER.search(words):
        return "of a later bounce"
    same = [c for c in columns if c.kind == column.kind and not c.spread]
    if column.spread:
        alone = sum(c.kind == column.kind and c.spread for c in columns) < len(same)
        return "sums up its neighbours" if alone else ""
    if same[0] is not column and name in APPROACHES:
        raise InputError(
            f"{name} stands in {same[0].header!r} already", source=source, key=column.header,
            allowed="one such column; a table beside another in a file of its own",
        )  # fmt: skip
    if same[0] is not column and name in CONDITIONS:
        return f"{name} stands in {same[0].header!r} already"
    means = [c for c in same if MEAN.search(bare(c.header))]
    return "sums up its neighbours" if column in means and len(means) < len(same) else ""


def _under_titles(rows: Sequence[Sequence[str]], best: int) -> list[str]:
    """The row of headers, each below the title of its columns where the row above holds titles."""
    head = list(rows[best])
    filled = [cell for cell in head if cell]
    if 2 * sum(_NUMBER.fullmatch(cell) is not None for cell in filled) > len(filled):
        return []  # of numbers
    above = list(rows[best - 1])[: len(head)] if best else []
    if above and above[0].startswith("#") and above[0].strip("# "):
        return head  # a comment
    if sum(map(bool, above)) < 2 or any(map(is_unit, filter(None, above))):
        return head
    title = ""
    for k, own in enumerate([*above, *[""] * (len(head) - len(above))]):
        title = own or title
        joined = f"{title} {head[k]}"
        # a title that spans several columns stands over the first of them alone
        alone = not own and kind_of(head[k]) is not None
        if head[k] and title and not alone and kind_of(joined) is not None:
            head[k] = joined
    return head
