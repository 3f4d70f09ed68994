"""The rows of a laboratory's sheet as trials, and what became of every column and cell."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ....core.errors import InputError, InputErrors
from ....core.inputs.input_file import checked_file
from ....core.inputs.names import names_a_file
from ....core.processes.confined import confined
from ....recordings.columns import MEASURED
from ....recordings.rules import RULES as OWN
from ...bounces.options import GRAVITY
from ...measured import Measured, Trial
from ...reduced import Reduced
from ...rules import RULES
from ...shared.units import UNITS
from ..file import cells_of, decoded, is_book
from ..picture import draw_trials
from ..trials import TrialsReduction
from ..workbook import NumberCell, rows_of_sheets
from .cell import decimals_of, number_in, why_not
from .headers import NOT_UNDERSTOOD, SheetColumn, headers_of, understood
from .kinds import (
    APPROACHES,
    BALL_DIAMETER,
    BALL_MASS,
    BODY,
    REBOUND_HEIGHT,
    REBOUND_SPEED,
    REBOUNDS,
    SUMMARY,
    UNDERSTOOD,
    bare,
    kind_of,
)

_TYPED = str.maketrans({"\u2212": "-", "\u00a0": " ", "\u2009": " ", "\u202f": " "})
"""Signs of typesetters as they are typed: the minus, and blanks that do not break."""
_VARIED = ("temperature_K", "angle_deg")


@dataclass(frozen=True)
class Sheet:
    """What a sheet became.

    Parameters
    ----------
    trials
        Its rows.
    columns
        Of each column of the sheet its header and what became of it, in words.
    left_out
        Cells, rows and sheets that were not taken, a line each.
    striker
        Keys of set.toml that the sheet has of the ball.
    """

    trials: tuple[Trial, ...]
    columns: tuple[tuple[str, str], ...]
    left_out: tuple[str, ...]
    striker: Mapping[str, Measured]

    def reduced(self, path: Path) -> Reduced:
        """Return it as what every reduction hands on."""
        notes = (*(f"{header!r}: {became}" for header, became in self.columns), *self.left_out)
        seen = self.trials[0].observables
        across = next(n for n in APPROACHES if n in seen)
        up = next(n for n in seen if n in MEASURED)
        x, y = (
            np.array(
                [t.observables[n].value if n in t.observables else np.nan for t in self.trials]
            )
            for n in (across, up)
        )
        values = {"trials": Measured(float(len(self.trials)), math.nan)}
        found = TrialsReduction(values, self.trials, notes, (across, x), (up, y))
        return Reduced(
            path, values, self.trials, lambda to: draw_trials(found, to), notes, self.striker
        )


def read_sheet(path: Path) -> Sheet:
    """Read a laboratory's sheet.

    Drop and rebound height give the restitution, the root of their ratio, and one in a column of
    its own counts where they do not; where it differs from them, that is told. A drop height that
    is written once for several rows holds for the rows below; several columns of one quantity are
    repeats, each a row of its own, but for d1 and d2 of a dent. A column of trials names them where
    its entries differ; a ball's diameter and mass that are the same in all rows are the striker's.

    Parameters
    ----------
    path
        A workbook, of which the first sheet whose headers are understood is read, or a text table
        in any usual encoding.

    Raises
    ------
    InputError
        No row of headers is understood, or a column names no unit.
    """
    checked_file(path, most=RULES.table_bytes, allowed="a sheet")
    source, others, decimals = str(path), [], ""
    if is_book(path):
        sheets = {k: rows for k, rows in confined(rows_of_sheets, path, source=source).items()
                  if any(map(any, rows))}  # fmt: skip
        known = [k for k, rows in sheets.items() if max(understood(rows), default=0) > 1]
        name = next(iter([*known, *sheets]), "")
        rows = sheets.get(name, [])
        others = [
            f"sheet {k!r}: left out; to take it, save it as a file of its own"
            for k in sheets if k != name
        ]  # fmt: skip
    else:
        between, rows = _cells(decoded(path.read_bytes(), source).splitlines(keepends=True), source)
        # where commas part the cells, points part no thousands
        decimals = "." if between == "," and not any("," in c for row in rows for c in row) else ""
    rows = [
        [cell if isinstance(cell, NumberCell) else cell.translate(_TYPED) for cell in row]
        for row in rows
    ]
    top, columns, told = headers_of(rows, source)
    decimals = decimals_of(rows[top:], columns) or decimals
    return _trials(rows, top, columns, told, others, decimals, source)


def _cells(lines: Sequence[str], source: str) -> tuple[str, list[list[str]]]:
    """Separator and cells; units in the cells hide the separator from a guess by numbers."""
    split = [cells_of(lines, source, separator=one) for one in ("", ";", "\t", ",")]
    return max(split, key=lambda found: max(understood(found[1]), default=0))


def _trials(
    rows: Sequence[Sequence[str]], top: int, columns: list[SheetColumn],
    told: list[tuple[str, str]], others: list[str], decimals: str, source: str,
) -> Sheet:  # fmt: skip
    _check_columns(columns, told, source)
    trials: list[tuple[int, Trial]] = []
    last: dict[str, Measured] = {}
    body: dict[str, set[Measured]] = {}
    left, from_above, across, used = list[str](), list[str](), list[str](), set[str]()
    first_with: dict[tuple[str, ...], int] = {}
    for k, row in enumerate(rows[top:], start=top + 1):
        if not any(row):
            continue
        if aside := _aside(row, columns):
            left.append(f"row {k}{aside}")
            if aside.startswith(" and"):
                break
            continue
        found, note, unread = _read(row, k, columns, decimals, left)
        if not found and not unread:
            left.append(f"row {k}: left out: {' '.join(filter(None, row))}")
            continue
        for name in BODY:
            body.setdefault(name, set()).update(found.pop(name, []))
        last = {name: found[name][0] for name in APPROACHES if name in found} or last
        if why := _no_trial(found, unread, last):
            left.append(f"row {k}: {why}")
            continue
        if not last.keys() & found.keys():
            from_above.append(str(k))
        back, of, crossed = _restitutions(found, last)
        used.add(of)
        left += _differing(found.get("restitution", []), back, k)
        trials += ((k, t) for t in _of_row(found | {"restitution": back}, last, note))
        before = first_with.setdefault(tuple(row), k)
        if before < k and sum(map(bool, row)) > 2:
            left.append(f"row {k}: taken, though each cell is that of row {before}: copied?")
        if crossed:
            across.append(str(k))
    _check_units(columns, source)
    if not trials:
        raise InputError(
            "no row with an approach and something measured", source=source,
            allowed=f"a row a drop or a press{'; ' * bool(left)}{left[0] if left else ''}",
        )  # fmt: skip
    if from_above:
        left.append(f"row {', '.join(from_above)}: the approach is that of the row above")
    if across:
        left.append(f"row {', '.join(across)}: restitution with v^2 = 2 g h, g = {GRAVITY} m/s^2")
    names = {c.kind.name for c in columns if c.taken}
    if names >= {"angle_deg", "impact_speed_m_s"}:
        left.append("speeds beside angles are taken as those along the normal")
    if any(became == NOT_UNDERSTOOD for _, became in told):
        left.append(f"what a column may be named, with its unit: {UNDERSTOOD}")
    striker = _striker(body)
    naming = _naming(rows, [k for k, _ in trials], columns)
    called = {k: rows[k - 1][naming.place] if naming else f"{k:03d}" for k, _ in trials}
    told = [(c.header, _became(c, names, used, striker, naming)) for c in columns] + told
    named = tuple(replace(t, label=called[k] + t.label) for k, t in trials)
    return Sheet(named, tuple(told), (*left, *others), striker)


def _no_trial(
    found: Mapping[str, list[Measured]], unread: set[str], last: Mapping[str, Measured]
) -> str:
    """Why a row with numbers is no trial; empty where it is one."""
    if "angle_deg" in unread or (unread and not any(name in found for name in APPROACHES)):
        what = "angle" if "angle_deg" in unread else "drop height or speed"
        return f"left out, its {what} is not read"
    if not found.keys() - {*APPROACHES, *_VARIED}:
        return "nothing measured"
    return "" if last else "no drop height or speed"


def _striker(body: Mapping[str, set[Measured]]) -> dict[str, Measured]:
    """Keys of set.toml that a sheet has of the ball, where all rows say the same."""
    one = {name: next(iter(said)) for name, said in body.items() if len(said) == 1}
    size, mass = one.get(BALL_DIAMETER), one.get(BALL_MASS)
    found = {"tip_radius_m": size and size.scaled(0.5), "mass_kg": mass}
    return {key: value for key, value in found.items() if value and value.value > 0.0}


def _naming(
    rows: Sequence[Sequence[str]], taken: Sequence[int], columns: Sequence[SheetColumn]
) -> SheetColumn | None:
    """The column that names the rows that are taken, each otherwise; None without one."""
    places = {k: rows[k - 1] for k in taken}
    for column in columns:
        cells = [row[column.place] for row in places.values() if column.place < len(row)]
        names = {cell.casefold() for cell in cells if names_a_file(cell)}
        if column.kind.name == "trial" and len(names) == len(places):
            return column
    return None


def _check_units(columns: Sequence[SheetColumn], source: str) -> None:
    wrong = tuple(
        InputError(
            c.no_unit, source=source, key=c.header, allowed=", ".join(UNITS[c.kind.quantity])
        )
        for c in columns
        if c.unitless
    )
    if wrong:
        raise InputErrors(wrong)


def _check_columns(
    columns: Sequence[SheetColumn], told: Sequence[tuple[str, str]], source: str
) -> None:
    """Refuse a sheet without a column of the approach, or without one of what was measured."""
    names = {c.kind.name for c in columns if not c.spread}
    others = ", ".join(repr(h) for h, became in told if not became.startswith("row"))
    for needed, words in (
        (APPROACHES, "drop height (cm), impact speed (m/s) or load (N)"),
        ({*MEASURED, *REBOUNDS}, "rebound height (mm), restitution, dent diameter (mm)"),
    ):
        if not names & set(needed):
            raise InputError(
                f"no column such as {words} is understood", source=source,
                allowed=f"a name for one of {others}" if others else "one such column",
            )  # fmt: skip


def _aside(row: Sequence[str], columns: Sequence[SheetColumn]) -> str:
    """Why a row is none of measured numbers: headers stand in it, or it sums up others."""
    again = {place: kind for place, kind in enumerate(map(kind_of, row)) if kind is not None}
    if sum(kind.quantity != "text" for kind in again.values()) > 1:
        if all(again.get(c.place) == c.kind for c in columns if not c.spread):
            return ": left out, the headers once more"
        return " and those below: left out, headers of another table"
    summary = _summary(row, columns)
    return f": left out, {summary!r} sums up other rows" if summary else ""


def _summary(row: Sequence[str], columns: Sequence[SheetColumn]) -> str:
    """The cell that says that a row sums up others; a note may say of itself what it likes."""
    kinds = {c.place: c.kind.name for c in columns}
    for place, cell in enumerate(row):
        word, kind = bare(cell).strip(" .:"), kinds.get(place)
        someone = kind == "person" and word in ("max", "min")
        if kind != "note" and not someone and SUMMARY.fullmatch(word):
            return cell
    return ""


def _read(
    row: Sequence[str], k: int, columns: Sequence[SheetColumn], decimals: str, left: list[str]
) -> tuple[dict[str, list[Measured]], str, set[str]]:
    """Numbers of a row by kind, its note, and the conditions that are written but not read."""
    found: dict[str, list[Measured]] = {}
    note, unread = "", set()
    for column in columns:
        cell, name = row[column.place] if column.place < len(row) else "", column.kind.name
        if not cell:
            continue
        if column.kind.quantity == "text":
            note = f"{note}; {cell}".strip("; ") if name == "note" else note
            column.taken += 1
            continue
        value = number_in(cell, column, decimals)
        why = why_not(cell, column, value, decimals)
        if value is None or why:
            left.append(f"row {k}, {column.header}: {why}")
            unread |= {name} & {*APPROACHES, "angle_deg"}
            continue
        column.taken += 1
        if column.across and name in found:
            found[name][-1] = _mean(found[name][-1], value)
        elif not column.spread:
            found.setdefault(name, []).append(value)
        elif name in found:
            found[name][-1] = Measured(found[name][-1].value, value.value)
    return found, note, unread


def _became(
    column: SheetColumn, taken: set[str], used: set[str], striker: Mapping[str, Measured],
    naming: SheetColumn | None,
) -> str:  # fmt: skip
    name, back = column.kind.name, taken & {*REBOUNDS}
    words = {
        REBOUND_HEIGHT: "restitution, the root of rebound over drop height",
        REBOUND_SPEED: "restitution, over the speed of approach",
        "trial": "left out: rows are numbered", "person": "left out: who measured",
    }  # fmt: skip
    became = words.get(name, name)
    if name == "trial" and naming is not None:
        became = "names of the trials" if column is naming else "left out: others name the trials"
    elif name in BODY:
        key = "mass_kg" if name == BALL_MASS else "tip_radius_m"
        became = f"{key} of the striker" if key in striker else "left out: not one ball's"
    elif name == "restitution" and back:
        became = "restitution, where heights or speeds give none"
    elif name in back and name not in used:
        other = "speeds" if name == REBOUND_HEIGHT else "heights"
        became = f"restitution, where {other} give none"
    elif column.across:
        became = f"{name}, the mean of it and d1"
    of = "standard deviation of " if column.spread else ""
    return f"{of}{became} ({column.taken} cells)"


def _of_row(
    found: dict[str, list[Measured]], last: dict[str, Measured], note: str
) -> Iterator[Trial]:
    """Yield the trials of one row: one, or as many as there are repeats."""
    common = {k: v[0] for k, v in found.items() if k in _VARIED}
    other = {*common, *APPROACHES, *REBOUNDS}
    measured = {k: v for k, v in found.items() if v and k not in other}
    repeats = max(map(len, measured.values()), default=0)
    for k in range(repeats):
        seen = {n: v[k] for n, v in measured.items() if k < len(v)}
        label = "" if repeats == 1 else f"-{k + 1}"
        yield Trial({**last, **common, **seen}, label=label, note=note)


def _restitutions(
    found: dict[str, list[Measured]], last: dict[str, Measured]
) -> tuple[list[Measured], str, bool]:
    """What a row says of the restitution, the column it is of, and whether v^2 = 2 g h is taken.

    Measured heights and speeds come before what a sheet worked out of them itself, like over like
    before one over the other. The approach's error stays in its own column.
    """
    fallen, speed = (last[name].value if name in last else None for name in APPROACHES[:2])
    heights, speeds = (found.get(name, []) for name in REBOUNDS)
    if fallen and heights:
        return [_root(h.scaled(1.0 / fallen)) for h in heights], REBOUND_HEIGHT, False
    if speed and speeds:
        return [v.scaled(1.0 / speed) for v in speeds], REBOUND_SPEED, False
    if speed and heights:
        up = [_root(h.scaled(2.0 * GRAVITY)) for h in heights]
        return [v.scaled(1.0 / speed) for v in up], REBOUND_HEIGHT, True
    if fallen and speeds:
        down = math.sqrt(2.0 * GRAVITY * fallen)
        return [v.scaled(1.0 / down) for v in speeds], REBOUND_SPEED, True
    return found.get("restitution", []), "restitution", False


def _differing(own: Sequence[Measured], back: Sequence[Measured], row: int) -> list[str]:
    """A line where a sheet's own restitutions are not those of its heights or speeds."""
    apart = [
        f"{mine.value:g}, not {other.value:.3g}"
        for mine, other in zip(own, back, strict=False)
        if abs(mine.value - other.value) > OWN.speed_bin * max(mine.value, other.value)
    ]
    told = "; ".join(apart)
    return [f"row {row}: the restitution written is {told} of the rebound measured"] if told else []


def _mean(one: Measured, other: Measured) -> Measured:
    return Measured(0.5 * (one.value + other.value), 0.5 * math.hypot(one.std, other.std))


def _root(square: Measured) -> Measured:
    root = math.sqrt(square.value)
    return Measured(root, 0.5 * square.std / root if root else 0.0)
