"""The headers of a laboratory's sheet, in one to three rows below its titles, and its columns."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from ....core.errors import InputError
from ....recordings.columns import CONDITIONS
from ...shared.units import quantity_of
from ..heading import in_short, is_unit
from . import kinds
from .kinds import kind_of, unit_of
from .words import (
    APPROACHES,
    BALL,
    CORRECTED,
    DENTS,
    DIAMETER,
    FROM_NORMAL,
    REBOUND_ANGLE,
    REBOUND_SPEED,
    UNDERSTOOD,
    SheetKind,
    bare,
    has,
)  # fmt: skip

NOT_UNDERSTOOD = "left out: not understood"
ABOVE = "row {}, left out: above the headers"
_NUMBER = re.compile(
    r"(ca\.?|[~≈Ø])?\s*[+-]?\s*\d[\d.,' ]*([eE][+-]?\d+)?([^\d(\[]{0,6}|(±|\+/?-).*)"
)
_OWN_UNIT = re.compile(r"[+-]?[\d.,]+\s*([^\W\d]\S{0,5})")
_STD_OF = re.compile(r"^(u|s|sd|std|σ)\s*[(\[]([^)\]]*)[)\]]")
_PAIR = re.compile(rf"(d|({DIAMETER})\w*)\.?[ _]?[12xy]")
"""Two diameters of one round, as a dent is read: d1, d2."""
_NORMAL = re.compile(r"norm|\bv[ _]?n\b|_n_")
"""Of a speed along the normal of the flat."""
_ORDINAL = re.compile(r"\d\.?(st|nd|rd|th|e|er|re|ere|eme|o|a|回目?|次)\.?")
"""Such as 2nd, 2ème, 2º, as `bare` has them."""
_NAME = re.compile(r"[^\W\d_]\S{0,9}\d+")
"""Such as A1, K-17: letters and a number."""
_SAID_OF = re.compile(r"\w\s*[:=]\s*(\w|$)")
"""A line such as Operator: Jane."""
# limit: rows above the numbers in which headers are looked for [-]: a page
_ROWS = 40
# limit: rows of one table's headers [-]: titles, names, numbers of readings, units
_DEPTH = 4


@dataclass
class SheetColumn:
    """A column that is understood: its place from 0, its header as the sheet has it, what it is.

    `unit` is None where the header names none, `spread` whether it holds the standard deviations of
    another column, `taken` how many cells were read, `unitless` whether one asked for the unit,
    `decimals` signs before its decimals where the sheet has two, `sign` -1 where a speed or force
    is counted along an axis that points the other way.
    """

    place: int
    header: str
    kind: SheetKind
    unit: str | None
    spread: bool = False
    taken: int = 0
    unitless: bool = False
    decimals: str = ""
    sign: float = 1.0

    @property
    def no_unit(self) -> str:
        """What is wrong with the header's unit."""
        said = kinds.said_unit(self.header)
        other = f"{said!r} is no unit of {self.kind.quantity} that is known"
        return other if said else "the header names no unit"


@dataclass(frozen=True)
class Head:
    """Headers of a sheet, in rows `first` to `end`, the last excluded.

    One a column as the sheet has it, and the same, or what the user says that it is.
    """

    first: int = 0
    end: int = 0
    headers: Sequence[str] = ()
    says: Sequence[str] = ()

    @property
    def known(self) -> tuple[int, int, int, int]:
        """How much is understood: quantities, columns, units, texts."""
        said = [(kind, text) for text in self.says if (kind := kind_of(text)) is not None]
        # a title in merged cells says one thing in all of them
        numbers = {(kind.name, text) for kind, text in said if kind.quantity != "text"}
        texts = sum(kind.quantity == "text" for kind, _ in said)
        units = sum(unit_of(text, kind) is not None for kind, text in said)
        several = len({(name, kinds.is_spread(text)) for name, text in numbers})
        return several, len(numbers), units, texts

    @property
    def understood(self) -> int:
        """How many columns are understood."""
        return self.known[1] + self.known[3]


def head_of(rows: Sequence[Sequence[str]], given: Mapping[str, str]) -> Head:
    """Return the headers that are understood best, `given` as the user says them.

    Of those alike the fewest rows, with words below them.
    """
    found = Head()
    for first in range(len(rows[:_ROWS])):
        here = Head()
        for end in range(first + 1, min(first + _DEPTH, len(rows)) + 1):
            headers = _headers(rows[first:end])
            if not headers and not all(map(_is_units, rows[first:end])):  # above the names
                break
            units = [_is_units(row) for row in rows[first : end + 1]]
            if headers and (any(units[:-1]) or not units[-1] or end == len(rows)):  # or they miss
                page = rows[end : end + _ROWS] or [[""] * len(headers)]
                says = _of_dents(
                    [
                        _with_unit_below(_as_given(header, given), cells)
                        for header, cells in zip(headers, zip(*page, strict=True), strict=True)
                    ]
                )
                here = max(Head(first, end, headers, says), here, key=lambda head: head.known)
        found = max(found, here, key=lambda head: (head.known, head.first - head.end))
    return found


def _as_given(header: str, given: Mapping[str, str]) -> str:
    """What the user says of a header, with its own unit where that has none."""
    said = given.get(bare(header)) or given.get(bare(kinds.without_unit(header)))
    if said is None:
        return _STD_OF.sub(lambda m: f"± ({m[2]})" if is_unit(m[2]) else f"{m[2]} ±", header)
    kind = kind_of(said)
    if kind is None or unit_of(said, kind) is not None:
        return said
    return f"{said} ({kinds.said_unit(header)})"


def _with_unit_below(says: str, cells: Sequence[str]) -> str:
    """A header with the one unit of its cells where it needs that: Rebound, 7.2 in, 14.1 in."""
    found = [_OWN_UNIT.fullmatch(cell) for cell in cells if cell]
    units = {in_short(one[1]) for one in found if one}
    if not (says and all(found) and len(units) == 1 and is_unit(*units)):
        return says
    with_unit = f"{says} ({units.pop()})"
    (alone, whole) = (kind and kind.quantity for kind in (kind_of(says), kind_of(with_unit)))
    return with_unit if alone in (None, "text") and whole not in (None, "text") else says


def _headers(block: Sequence[Sequence[str]]) -> list[str]:
    """One header a column, of rows of titles, names and units; none where a row is of others."""
    units = [row for row in block if _is_units(row)]
    names = [row for row in block if row not in units]
    *above, lowest = names or [[]]
    titles = all(_is_title(row, 0) for row in above)
    sound = titles and (_is_title(lowest, 0 if above else 0.5) or _counts(lowest, above[-1:]))
    if not sound or len(units) > 1:
        return []
    below = [*names[1:], *units]
    columns: list[list[tuple[str, bool]]] = [[] for _ in block[0]]
    for k, row in enumerate(names):
        title = ""
        for place, own in enumerate(row):
            title = own or title
            # a title that spans several columns stands over the first of them alone
            if own or (title and any(lower[place] for lower in below[k:])):
                columns[place].append((title, bool(own)))
    unit = units[0] if units else [""] * len(columns)
    return [_one(parts, unit[place].strip("()[] ")) for place, parts in enumerate(columns)]


def _one(parts: Sequence[tuple[str, bool]], unit: str) -> str:
    """The header of a column: its titles and its own name, as far as they belong together."""
    tail = f" ({unit})" if unit else ""
    texts = [text for k, (text, _) in enumerate(parts) if text not in [t for t, _ in parts[:k]]]
    own = " ".join(text for text in texts if (text, True) in parts)
    whole, title = " ".join(texts), " ".join(text for text in texts if (text, True) not in parts)
    alone, both = kind_of(own + tail), kind_of(whole + tail)
    if (title and alone and both in (None, kind_of(title + tail))) or both is None:
        whole = own or whole
        if kind_of(whole + tail) is None and texts and kind_of(texts[-1] + tail):
            whole = texts[-1]
    return (whole + tail).strip()


def _is_units(row: Sequence[str]) -> bool:
    filled = [cell for cell in row if cell]
    return bool(filled) and all(
        is_unit(cell) or cell.strip("()[] ") in ("-", "–", "") for cell in filled
    )


def _is_title(row: Sequence[str], most: float = 0.5) -> bool:
    """Whether a row holds names or titles: few numbers, no remark, no line of its own.

    Above other names no number, Kugeldurchmesser [mm];8,0 speaks of all rows; nor below: a first
    drop beside words, A1;Kim;50;18;ok.
    """
    filled = [cell for cell in row if cell]
    if not filled or (len(set(filled)) < 2 and row[0]):
        return False
    numbers = sum(map(_is_number, filled))
    lines = sum(_SAID_OF.search(cell) is not None for cell in filled)
    comment = row[0].startswith("#") and row[0].strip("# ")
    return not comment and 2 * lines < len(filled) and numbers <= most * len(filled)


def _is_number(cell: str) -> bool:
    return bool(_NUMBER.fullmatch(cell)) and not _ORDINAL.fullmatch(bare(cell))


def _counts(row: Sequence[str], above: Sequence[Sequence[str]]) -> bool:
    """Whether a row numbers the readings below a title, 1, 2, 3, and has no other number."""
    places = [k for k, cell in enumerate(row) if _is_number(cell)]
    numbers = [row[k] for k in places]
    if not above or len(places) < 2 or not all(n.isdecimal() and len(n) == 1 for n in numbers):
        return False
    ones = [k for k, n in zip(places, numbers, strict=True) if n == "1"]
    steps = all(int(b) == int(a) + 1 or b == "1" for a, b in pairwise(numbers))
    bare_above = (above[0][k] in ("", above[0][k - 1]) for k in places if k not in ones)
    return numbers[0] == "1" and steps and all(bare_above)


def columns_of(
    rows: Sequence[Sequence[str]], head: Head, source: str
) -> tuple[list[SheetColumn], list[tuple[str, str]]]:
    """Return the columns that are understood, and what is told of the others.

    Refuses headers of which none is, and two columns of the approach of one row.
    """
    if head.understood < 2:
        asked = [kinds.nearest(header) for header in head.headers if kind_of(header) is None]
        usual = (
            "columns such as drop height (cm), rebound height (mm), dent diameter (mm), or "
            "--column 'HEADER=rebound height mm'"
        )
        across = head_of([*map(list, zip(*rows, strict=True))], {}).known[1] > 1
        raise InputError(
            "headers stand in a column, not a row" if across else "no row of headers is understood",
            source=source, allowed="; ".join([usual, *filter(None, asked)][:4]),
        )  # fmt: skip
    told = [
        (" ".join(dict.fromkeys(filter(None, row))), ABOVE.format(k))
        for k, row in enumerate(rows[: head.first], start=1) if any(row)
    ]  # fmt: skip
    columns: list[SheetColumn] = []
    quantities = {kind_of(text) for text in head.says if not kinds.is_spread(text)}
    for place, (header, says) in enumerate(zip(head.headers, head.says, strict=True)):
        _check_angle(says, header, source)
        spread = kinds.is_spread(says)
        kind = kind_of(says) or (_beside(columns, place, says) if spread else None)
        cells = [row[place] for row in rows[head.end :] if row[place]]
        names = sum(_NAME.fullmatch(cell) is not None for cell in cells)
        if kind is None and not columns and header and 2 * names > len(cells):
            kind = kind_of("trial")
        if kind is not None and (kind.quantity == "text" or not spread or kind in quantities):
            spread = spread and kind.quantity != "text"
            columns.append(SheetColumn(place, header, kind, unit_of(says, kind), spread))
        elif header or cells:
            why = NOT_UNDERSTOOD if header else "left out: no header"
            like = header and kinds.nearest(header)
            told.append((header or f"column {place + 1}", f"{why}: {like}" if like else why))
    kept = []
    for column in columns:
        own = column.unit or quantity_of(kinds.said_unit(column.header))
        if column.spread and not own:
            column.unit = next(c.unit for c in columns if c.kind == column.kind and not c.spread)
        if why := _left_out(column, columns, source):
            told.append((column.header, f"left out: {why}"))
        else:
            kept.append(column)
    return kept, told


def _beside(columns: Sequence[SheetColumn], place: int, says: str) -> SheetKind | None:
    """What a spread is of: the number left of it, texts between, in its unit, that it names."""
    for k, column in enumerate(reversed(columns), start=1):
        if column.place == place - k and column.kind.quantity != "text":
            if kinds.named(says) not in kinds.named(column.header):
                return None
            same = quantity_of(kinds.said_unit(says)) in ("", column.kind.quantity)
            return column.kind if same else None
    return None


def _left_out(column: SheetColumn, columns: Sequence[SheetColumn], source: str) -> str:
    """Why a column is not taken beside the others; empty where it is."""
    name = column.kind.name
    if column.kind.quantity == "text":
        return ""
    if name == REBOUND_ANGLE:
        beside = {c.kind.name: bare(c.header) for c in columns}
        speeds = [beside.get(k, "v_n") for k in ("impact_speed_m_s", REBOUND_SPEED)]
        if "angle_deg" not in beside or any(map(_NORMAL.search, speeds)):
            return "not beside an angle and speeds along the path"
    same = [c for c in columns if c.kind == column.kind and not c.spread]
    ends = [c for c in same if kinds.END.search(bare(kinds.without_unit(c.header)))]
    if len(ends) < len(same) and any(kinds.LEAST.search(bare(c.header)) for c in ends):
        if column in ends:
            return "sums up its neighbours"
        same = [c for c in same if c not in ends]
    if column.spread:
        alone = sum(c.kind == column.kind and c.spread for c in columns) < len(same)
        return "sums up its neighbours" if alone else ""
    alike = all(has(what, bare(same[0].header)) == has(what, bare(column.header))
                for what in (CORRECTED, *([BALL] if name in DENTS else [])))  # fmt: skip
    if same[0] is not column and (name in APPROACHES or not alike):
        raise InputError(
            f"{name} stands in {same[0].header!r} already", source=source, key=column.header,
            allowed=f"one such column, --column {f'{column.header}=note'!r} for the other; a table "
            "beside another in a file of its own",
        )  # fmt: skip
    if same[0] is not column and name in CONDITIONS:
        return f"{name} stands in {same[0].header!r} already"
    means = [c for c in same if kinds.MEAN.search(bare(c.header))]
    return "sums up its neighbours" if column in means and len(means) < len(same) else ""


def _of_dents(says: list[str]) -> list[str]:
    """What headers say, d1 and d2 of a dent where no other speaks of one."""
    pair = [_PAIR.fullmatch(kinds.named(text)) is not None for text in says]
    if sum(pair) != 2 or any(kind and kind.name == DENTS[0] for kind in map(kind_of, says)):
        return says
    return [f"dent {text}" if one else text for text, one in zip(says, pair, strict=True)]


def _check_angle(says: str, header: str, source: str) -> None:
    """Refuse an angle that is none from the flat."""
    kind = kind_of(says)
    if kind and kind.name in ("angle_deg", REBOUND_ANGLE) and has(FROM_NORMAL, bare(says)):
        raise InputError(
            "an angle from the normal", source=source, key=header,
            allowed="that between velocity and flat, or axis and flat: 90 for a normal impact",
        )  # fmt: skip


def given_columns(columns: Sequence[str]) -> dict[str, str]:
    """Return what a user says of headers, `HEADER=quantity unit` each, by `bare` header."""
    given = {}
    for text in filter(None, columns):
        header, _, says = text.rpartition("=")
        if not header or kind_of(says.strip()) is None:
            raise InputError(
                repr(text), source="command line", key="column",
                allowed=f"HEADER=quantity unit; of {UNDERSTOOD}",
            )  # fmt: skip
        given[bare(header)] = says.strip()
    return given
