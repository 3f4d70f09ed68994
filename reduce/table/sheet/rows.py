"""The rows of a laboratory's sheet as trials, and what became of every row and cell."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from statistics import median

import numpy as np

from ....core.errors import InputError, InputErrors
from ....core.rig import StrikerTable
from ....recordings.columns import CONDITIONS, MEASURED
from ....recordings.rules import RULES as OWN
from ....recordings.template import Shape
from ...bounces.options import GRAVITY
from ...measured import Measured, Trial
from ...reduced import Reduced
from ...shared.units import UNITS
from ..heading import in_short
from ..picture import draw_trials
from . import words
from .cell import number_in, why_not
from .headers import ABOVE, NOT_UNDERSTOOD, SheetColumn
from .kinds import SUMMARY, SUMS, kind_of
from .trial import (
    Readings,
    along_normal,
    became,
    mean_of,
    naming_of,
    note_of,
    restitutions_of,
    scatter_of,
)
from .words import APPROACHES, BODY, UNDERSTOOD, bare

_SIZE = re.compile(r"(?P<a>\d[\d.,]*)\s*(?P<b>[^\W\d_]+)|[(\[](?P<d>\w+)[)\]]\W*(?P<c>\d[\d.,]*)")
"""Such as 4.08 g, [g]: 4.08."""
_CLAUSE = re.compile(r"[^,;\d]*")
_BALLS = [kind for kind in words.KINDS if kind.name in BODY]
# limit: ratio of what is said of one ball's diameter or mass [-]; weighed again, rounded
_ONE_BALL = 1.02
_VARIED = ("temperature_K", "angle_deg", words.REBOUND_ANGLE)


@dataclass(frozen=True)
class SheetRows:
    """Rows of a whole sheet, the first below its headers from 0, and the columns understood.

    `decimals` is the sign before the decimals, empty where none is known.
    """

    rows: Sequence[Sequence[str]]
    top: int
    columns: Sequence[SheetColumn]
    decimals: str
    source: str


@dataclass(frozen=True)
class Sheet:
    """What a sheet became: its rows, and of each of its columns the header and what became of it.

    Then a line for each cell, row and sheet that was not taken, and what it has of the striker.
    """

    trials: tuple[Trial, ...]
    columns: tuple[tuple[str, str], ...]
    left_out: tuple[str, ...]
    striker: Mapping[str, Measured]

    @property
    def shape(self) -> Shape:
        """What struck: a rod where the sheet speaks of one, else a sphere."""
        headers = " ".join(bare(header) for header, _ in self.columns)
        return "rod" if re.search(words.ROD, headers) and not self.striker else "sphere"

    def shown(self, first: str) -> tuple[list[str], list[list[str]]]:
        """Return names and cells of a table of the trials, as a set has them; `first` is theirs."""
        names = dict.fromkeys(name for trial in self.trials for name in trial.observables)
        rows = [
            [f"{first}-{t.label}", *(str(t.observables.get(name, "")) for name in names), t.note]
            for t in self.trials
        ]
        return ["trial", *names, "note"], rows

    def refuse_another(self, body: StrikerTable, source: str, *, key: str) -> None:
        """Refuse rows of a ball that is not this body, by its size or mass beyond their errors."""
        for name, said in self.striker.items():
            stated = getattr(body, name)
            if abs(said.value - stated.value) > 3.0 * stated.std + (_ONE_BALL - 1.0) * stated.value:
                raise InputError(f"{said.value:g} of the sheet", source=source, key=f"{key}.{name}",
                                 allowed=f"{stated.value:g}, or a striker of its own")  # fmt: skip

    def reduced(self, path: Path) -> Reduced:
        """Return it as what every reduction hands on."""
        notes = (*(f"{header!r}: {became}" for header, became in self.columns), *self.left_out)
        seen = self.trials[0].observables
        across = next(n for n in APPROACHES if n in seen)
        up = next(n for n in seen if n in MEASURED)
        without = Measured(math.nan, math.nan)
        x, y = (np.array([t.observables.get(n, without).value for t in self.trials])
                for n in (across, up))  # fmt: skip
        values = {"trials": Measured(float(len(self.trials)), math.nan)}
        return Reduced(
            path, values, self.trials, lambda to: draw_trials((across, x), (up, y), to), notes,
            self.striker,
        )  # fmt: skip


@dataclass
class _SoFar:
    """What the rows above have given."""

    trials: list[tuple[int, Trial, Readings]] = field(default_factory=list)
    last: dict[str, Measured] = field(default_factory=dict)
    body: dict[str, set[Measured]] = field(default_factory=dict)
    left: list[str] = field(default_factory=list)
    from_above: list[str] = field(default_factory=list)
    across: list[str] = field(default_factory=list)
    used: set[str] = field(default_factory=set)
    first_with: dict[tuple[str, ...], int] = field(default_factory=dict)


def trials_of(sheet: SheetRows, told: Sequence[tuple[str, str]]) -> Sheet:
    """Return the trials of the rows, `told` what became of the columns that are not understood.

    Refuses a sheet without an approach, anything measured, or a unit.
    """
    rows, columns, found = sheet.rows, sheet.columns, _SoFar()
    _check_columns(columns, told, sheet.source)
    used = _above(sheet, found.body)
    told = [(header, used.get(became, became)) for header, became in told]
    for k, row in enumerate(rows[sheet.top :], start=sheet.top + 1):
        aside = _aside(row, sheet, found)
        if aside:
            found.left.append(f"row {k}{aside}")
        elif any(row):
            _take(row, k, sheet, found)
        if aside.startswith(" and"):
            break
    if wrong := [c for c in columns if c.unitless]:
        raise InputErrors(tuple(
            InputError(c.no_unit, source=sheet.source, key=c.header,
                       allowed=", ".join(UNITS[c.kind.quantity])) for c in wrong
        ))  # fmt: skip
    if not found.trials:
        why = f"; {found.left[0]}" if found.left else ""
        raise InputError(
            "no row with an approach and something measured", source=sheet.source,
            allowed=f"a row a drop or a press{why}",
        )  # fmt: skip
    if later := _later(sheet, [seen for *_, seen in found.trials]):
        told = [*told, *((c.header, "left out: of a later bounce") for c in later)]
        once = [replace(c, taken=0) for c in columns if c not in later]
        return trials_of(replace(sheet, columns=once), told)
    _check_one_ball(sheet, [k for k, *_ in found.trials], apart=not found.from_above)
    striker = _striker(found.body)
    _check_rebounds(sheet, found)
    naming, alike = naming_of(rows, [k for k, *_ in found.trials], columns)
    stds = scatter_of([(t.observables, seen) for _, t, seen in found.trials])
    named = [
        replace(
            trial, label=rows[k - 1][naming.place] if naming else f"{k:03d}",
            spot=next((rows[k - 1][c.place] for c in columns if c.kind.name == "spot"), ""),
            note=note_of(rows[k - 1], columns, naming), place=f"{sheet.source}: row {k}",
            observables={
                n: (Measured(v.value, stds[n] * v.value / len(seen[n]) ** 0.5) if n in stds else v)
                .rounded() for n, v in trial.observables.items()
            },
        )
        for k, trial, seen in found.trials
    ]  # fmt: skip
    own = [(c.header, became(c, columns, found.used, striker, naming)) for c in columns]
    lines = [*_lines(found, columns, [*stds], told), *filter(None, [alike])]
    return Sheet(tuple(named), (*own, *told), (*found.left, *lines), striker)


def _above(sheet: SheetRows, body: dict[str, set[Measured]]) -> dict[str, str]:
    """Add the ball's size and mass in lines above the headers; return what these lines became."""
    used = {}
    for k, row in enumerate(sheet.rows[: sheet.top], start=1):
        line, start, said = " ".join(dict.fromkeys(filter(None, row))), 0, []
        for found in _SIZE.finditer(line):
            text, spoken = bare(line[start : found.start()]), bare(line[: found.start()])
            if not words.has(words.BALL, spoken):  # a 10 mm steel ball
                text = spoken = bare(_CLAUSE.match(line, found.end())[0])  # type: ignore[index]
            number, unit = found["a"] or found["c"], in_short(found["b"] or found["d"])
            kind = next((n for n in _BALLS if unit in UNITS[n.quantity]), None)
            other = words.has(words.NO_BALL, re.split(words.letters(words.BALL), text)[-1])
            if kind is not None and words.has(words.BALL, spoken) and not other:
                column = SheetColumn(0, "", kind, unit)
                if value := number_in(number, column, sheet.decimals):
                    body.setdefault(kind.name, set()).add(value)
                    said.append(f"{kind.said} {number} {unit}")
            start = found.end()
        if said:
            used[ABOVE.format(k)] = f"row {k}: {', '.join(said)}, the striker's"
    return used


def _take(row: Sequence[str], k: int, sheet: SheetRows, so_far: _SoFar) -> None:
    left = so_far.left
    found, unread = _read(row, k, sheet, left)
    if not found and not unread:
        left.append(f"row {k}: left out: {' '.join(filter(None, row))}")
        return
    for name in BODY:
        so_far.body.setdefault(name, set()).update(found.pop(name, []))
    last = {name: found[name][0] for name in APPROACHES if name in found} or so_far.last
    so_far.last = last
    if any(column.kind.name == words.REBOUND_ANGLE for column in sheet.columns):
        last, alone = along_normal(found, last)
        left += [f"row {k}: {alone}"] * bool(alone)
    if why := _no_trial(found, unread, last):
        left.append(f"row {k}: {why}")
        return
    if not last.keys() & found.keys():
        so_far.from_above.append(str(k))
    back, of, crossed, differs = restitutions_of(found, last)
    so_far.used.add(of)
    if differs:
        left.append(f"row {k}: {differs}")
    if crossed:
        so_far.across.append(str(k))
    every = found | {"restitution": back}
    seen = {n: v for n, v in every.items() if v and n not in words.REBOUNDS}
    so_far.trials.append((k, Trial(last | {n: mean_of(v) for n, v in seen.items()}), seen))
    before = so_far.first_with.setdefault(tuple(row), k)
    if before < k and sum(map(bool, row)) > 2:
        left.append(f"row {k}: taken, though each cell is that of row {before}: copied?")


def _lines(
    found: _SoFar, columns: Sequence[SheetColumn], scattered: Sequence[str],
    told: Sequence[tuple[str, str]],
) -> list[str]:  # fmt: skip
    """What is told of several rows, or of all."""
    above, across = (", ".join(rows) for rows in (found.from_above, found.across))
    known = {c.kind.name for c in columns if c.taken}
    normal = known >= {"angle_deg", "impact_speed_m_s"}
    whole = words.REBOUND_ANGLE in known
    unknown = any(became.startswith(NOT_UNDERSTOOD) for _, became in told)
    lines = [
        (above, f"row {above}: the approach is that of the row above"),
        (across, f"row {across}: restitution with v^2 = 2 g h, g = {GRAVITY} m/s^2"),
        (normal and not whole, "speeds beside angles are taken as those along the normal"),
        (whole, "speeds beside angles of approach and rebound are taken as those along the path"),
        (unknown, f"what a column may be named, with its unit: {UNDERSTOOD}"),
        *((True, f"{n}: standard deviations of the means, from their readings") for n in scattered),
    ]
    return [line for said, line in lines if said]


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


class SeveralBallsError(InputError):
    """Rows of several balls: names of strikers, and what selects the rows of each.

    None where a row does not say which, or takes its approach from one above.
    """

    balls: Mapping[str, str]


def _check_one_ball(sheet: SheetRows, taken: Sequence[int], *, apart: bool) -> None:
    """Refuse rows of several balls: each is a striker, read `apart` where that can be."""
    for column in (c for c in sheet.columns if c.kind.name in ("ball", *BODY)):
        cells = [sheet.rows[k - 1][column.place] for k in taken]
        said = [*dict.fromkeys(filter(None, cells))]
        several = 1 < len(said) < len(cells)  # else each trial has its own of one kind
        if column.kind.name != "ball":
            sizes = [v.value for c in said if (v := number_in(c, column, sheet.decimals))]
            several = bool(sizes) and max(sizes) > _ONE_BALL * min(sizes)
        if several:
            error = SeveralBallsError(
                f"several balls: {', '.join(said[:4])}", source=sheet.source, key=column.header,
                allowed=f"one at a time: dentscope reduce table {sheet.source} --holds trials "
                f"--select '{column.header}={said[0]}' --into SET",
            )  # fmt: skip
            kind = "" if column.kind.name == "ball" else "ball "
            parted = said if apart and all(cells) else []
            error.balls = {f"{kind}{cell}": f"{column.header}={cell}" for cell in parted}
            raise error


def _striker(body: Mapping[str, set[Measured]]) -> dict[str, Measured]:
    """Keys of set.toml that a sheet has of the ball, where all rows say the same."""
    one = {name: next(iter(said)) for name, said in body.items() if len(said) == 1}
    size, mass = one.get(words.BALL_DIAMETER), one.get(words.BALL_MASS)
    found = {"tip_radius_m": size and size.scaled(0.5), "mass_kg": mass}
    return {key: value.rounded() for key, value in found.items() if value and value.value > 0.0}


def _later(sheet: SheetRows, readings: Sequence[Readings]) -> list[SheetColumn]:
    """The columns of later bounces, where rebounds of a row fall as bounces do, by e each.

    Refuses such rebounds where no header says which are later.
    """
    pairs = [(e[0].value, e[1].value) for r in readings if len(e := r.get("restitution", [])) > 1]
    if not pairs or any(second >= first**1.5 for first, second in pairs):
        return []
    back = [c for c in sheet.columns if c.kind.name in words.REBOUNDS]
    found = [c for c in back if words.has(words.LATER, bare(c.header))]
    if not found:
        raise InputError(
            "each row's second rebound falls short of its first as the next bounce does",
            source=sheet.source, key="restitution",
            allowed="drops from one height in one row; later bounces without a header",
        )  # fmt: skip
    return found


def _check_rebounds(sheet: SheetRows, so_far: _SoFar) -> None:
    """Refuse rebounds that as a whole are above their falls, whatever single rows remark."""
    every = [t.observables["restitution"].value for _, t, _ in so_far.trials
             if "restitution" in t.observables]  # fmt: skip
    if every and (middle := median(every)) > 1.0 + OWN.restitution_slip:
        names = {*so_far.used, *(APPROACHES if so_far.used & {*words.REBOUNDS} else ())}
        of = [repr(c.header) for c in sheet.columns if c.kind.name in names and not c.spread]
        raise InputError(
            f"restitution {middle:.3g}, the median of {len(every)} rows", source=sheet.source,
            key=" and ".join(of), allowed="up to 1; are their units mixed up?",
        )  # fmt: skip


def _check_columns(
    columns: Sequence[SheetColumn], told: Sequence[tuple[str, str]], source: str
) -> None:
    """Refuse a sheet without a column of the approach, or without one of what was measured."""
    names = {c.kind.name for c in columns if not c.spread}
    others = ", ".join(repr(h) for h, became in told if not became.startswith("row"))
    asks = dict.fromkeys(became for _, became in told if "--column" in became)
    asked = [became.removeprefix(f"{NOT_UNDERSTOOD}: ") for became in asks]
    hint = "; ".join(["", *asked[:3]]) or "; --column 'HEADER=quantity unit'"
    for needed, such in (
        (APPROACHES, "drop height (cm), impact speed (m/s) or load (N)"),
        ({*MEASURED, *words.REBOUNDS}, "rebound height (mm), restitution, dent diameter (mm)"),
    ):
        if not names & set(needed):
            raise InputError(
                f"no column such as {such} is understood", source=source,
                allowed=f"a name for one of {others}{hint}" if others else "one such column",
            )  # fmt: skip


def _aside(row: Sequence[str], sheet: SheetRows, so_far: _SoFar) -> str:
    """Why a row is none of measured numbers: headers stand in it, or it sums up others."""
    words = [cell if not cell[:1].isdigit() else "" for cell in row]
    again = {place: kind for place, kind in enumerate(map(kind_of, words)) if kind is not None}
    if sum(kind.quantity != "text" for kind in again.values()) > 1:
        if all(again.get(c.place) == c.kind for c in sheet.columns if not c.spread):
            return ": left out, the headers once more"
        return " and those below: left out, headers of another table"
    if summary := _summary(row, sheet.columns):
        return f": left out, {summary!r} sums up other rows"
    other = _other_name(row, sheet, so_far)
    return f": left out, {other!r} names no trial as those above are named" if other else ""


def _other_name(row: Sequence[str], sheet: SheetRows, so_far: _SoFar) -> str:
    """The name of a row without a number, where all trials above have one: n, CV, śr."""
    first = next(c.place for c in sheet.columns if c.kind.quantity != "text")
    remarks = [c.place for c in sheet.columns if c.kind.name == "note"]
    for place in (k for k in range(first) if k not in remarks):
        cell = row[place]
        if len(so_far.trials) > 1 and cell and not any(map(str.isdigit, cell)):
            above = (sheet.rows[k - 1][place] for k, *_ in so_far.trials)
            if all(any(map(str.isdigit, name)) for name in above):
                return cell
    return ""


def _summary(row: Sequence[str], columns: Sequence[SheetColumn]) -> str:
    """The cell that says that a row sums up others; a trial's note may say what it likes."""
    kinds = {c.place: c.kind.name for c in columns}
    names = [row[k] for k, name in kinds.items() if name == "trial"]
    for place, cell in enumerate(row):
        word, kind = bare(cell).strip(" .:"), kinds.get(place)
        someone = kind == "person" and word in ("max", "min")
        remark = kind == "note" and (any(names) or not names)
        sums = SUMMARY.fullmatch(word) or (kind == "trial" and SUMS.search(word))
        if sums and not remark and not someone:
            return cell
    return ""


def _read(
    row: Sequence[str], k: int, sheet: SheetRows, left: list[str]
) -> tuple[Readings, set[str]]:
    """Numbers of a row by kind, and the conditions that are written but not read."""
    found: Readings = {}
    spreads, unread = dict[str, list[float]](), set[str]()
    for column in sheet.columns:
        cell, name = row[column.place], column.kind.name
        if not cell:
            continue
        if column.kind.quantity == "text":
            column.taken += 1
            continue
        value = number_in(cell, column, sheet.decimals)
        why = why_not(cell, column, value, sheet.decimals)
        if value is None or why:
            if name in APPROACHES and value and value.value > CONDITIONS[name].high:
                most = f"up to {CONDITIONS[name].high:g} in the SI; is it in {column.unit}?"
                where = f"row {k}, {column.header}"
                raise InputError(why, source=sheet.source, key=where, allowed=most)
            left.append(f"row {k}, {column.header}: {why}")
            unread |= {name} & {*APPROACHES, "angle_deg"}
            continue
        column.taken += 1
        if column.spread:
            spreads.setdefault(name, []).append(value.value)
        else:
            found.setdefault(name, []).append(value)
    for name, stds in spreads.items():
        if len(found.get(name, ())) == len(stds):
            found[name] = [Measured(v.value, std) for v, std in zip(found[name], stds, strict=True)]
    return found, unread
