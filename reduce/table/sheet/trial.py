"""One trial of a sheet: the mean of its readings, its name and note, and how sure it is."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from ....core.inputs.names import names_a_file
from ....core.tables import counted
from ....recordings.columns import CONDITIONS
from ....recordings.rules import RULES as OWN
from ...bounces.options import GRAVITY
from ...measured import Measured
from . import words
from .headers import SheetColumn

Readings = dict[str, list[Measured]]
"""Numbers of one row by kind."""


def mean_of(readings: Sequence[Measured]) -> Measured:
    """Return the mean of some readings, their errors independent."""
    n = len(readings)
    return Measured(sum(v.value for v in readings) / n, math.hypot(*(v.std for v in readings)) / n)


def along_normal(found: Readings, last: dict[str, Measured]) -> tuple[dict[str, Measured], str]:
    """Return the approach along the normal where a row has its speeds along the path, and a remark.

    Rebounds become their parts along the normal and along the flat, forwards against x.
    """
    angle, back = found.get("angle_deg", []), found.pop(words.REBOUND_ANGLE, [])
    if not angle:
        return last, ""
    if speed := last.get("impact_speed_m_s"):
        last = {**last, "impact_speed_m_s": _part(speed, mean_of(angle))}
    if "impact_speed_m_s" in found:
        found["impact_speed_m_s"] = [last["impact_speed_m_s"]]
    if not (up := found.pop(words.REBOUND_SPEED, [])):
        return last, ""
    if not back:
        return last, "rebound speed left out, it has no angle"
    speed, angle_back = mean_of(up), mean_of(back)
    found[words.REBOUND_SPEED] = [_part(speed, angle_back)]
    beside = Measured(90.0 - angle_back.value, angle_back.std)
    found.setdefault("tangential_rebound_m_s", [_part(speed, beside).scaled(-1.0)])
    return last, ""


def _part(speed: Measured, angle: Measured) -> Measured:
    """The part of a speed across a line, from the angle to it [deg]."""
    a, std = math.radians(angle.value), math.radians(angle.std)
    return speed.times(Measured(math.sin(a), abs(math.cos(a)) * std)).rounded()


def restitutions_of(
    found: Readings, last: Mapping[str, Measured]
) -> tuple[list[Measured], str, bool, str]:
    """Return what a row says of the restitution, a value a reading, and the column it is of.

    Measured heights and speeds come before what a sheet worked out of them itself, like over like
    before one over the other; then whether v^2 = 2 g h is taken, and where the sheet's own
    restitution differs, a line. The approach's error stays in its own column.
    """
    back, of, crossed = _measured_back(found, last)
    apart = [
        f"{mine.value:g}, not {other.value:.3g}"
        for mine, other in zip(found.get("restitution", []), back, strict=False)
        if abs(mine.value - other.value) > OWN.speed_bin * max(mine.value, other.value)
    ]
    told = f"the restitution written is {'; '.join(apart)} of the rebound measured"
    return back, of, crossed, told if apart else ""


def _measured_back(
    found: Readings, last: Mapping[str, Measured]
) -> tuple[list[Measured], str, bool]:
    fallen, speed = (last[name].value if name in last else None for name in words.APPROACHES[:2])
    heights, speeds = (found.get(name, []) for name in words.REBOUNDS)
    if fallen and heights:
        return [_root(h.scaled(1.0 / fallen)) for h in heights], words.REBOUND_HEIGHT, False
    if speed and speeds:
        return [v.scaled(1.0 / speed) for v in speeds], words.REBOUND_SPEED, False
    if speed and heights:
        up = [_root(h.scaled(2.0 * GRAVITY)) for h in heights]
        return [v.scaled(1.0 / speed) for v in up], words.REBOUND_HEIGHT, True
    if fallen and speeds:
        down = math.sqrt(2.0 * GRAVITY * fallen)
        return [v.scaled(1.0 / down) for v in speeds], words.REBOUND_SPEED, True
    return found.get("restitution", []), "restitution", False


def _root(square: Measured) -> Measured:
    root = math.sqrt(square.value)
    return Measured(root, 0.5 * square.std / root if root else 0.0)


def scatter_of(trials: Sequence[tuple[Mapping[str, Measured], Readings]]) -> dict[str, float]:
    """Return relative standard deviations of one reading, of what no rows tell by repeats [-].

    Pooled over the trials and widened for how few they are, as Student's distribution is. Several
    readings of one mark say nothing of the next one.
    """
    rows = Counter(tuple(n in s and s[n].value for n in words.APPROACHES) for s, _ in trials)
    found = {}
    for name in {n for _, readings in trials for n in readings} - {*words.DENTS, *CONDITIONS}:
        each = [readings[name] for _, readings in trials if name in readings]
        values = [np.array([v.value for v in several]) for several in each]
        freedom = sum(v.size - 1 for v in values)
        stated = any(v.std for several in each for v in several)
        squares = sum(float(np.var(v / v.mean())) * v.size for v in values if v.mean() > 0.0)
        if squares and freedom > 2 and not stated and max(rows.values()) < OWN.repeats:
            found[name] = math.sqrt(squares / (freedom - 2))
    return found


def naming_of(
    rows: Sequence[Sequence[str]], taken: Sequence[int], columns: Sequence[SheetColumn]
) -> tuple[SheetColumn | None, str]:
    """Return the column that names the rows that are taken, each otherwise; without one why not."""
    why = ""
    for column in (c for c in columns if c.kind.name == "trial"):
        cells = [rows[k - 1][column.place].casefold() for k in taken]
        if len(set(filter(names_a_file, cells))) == len(taken):
            return column, ""
        twice = next((name for name, n in Counter(filter(None, cells)).items() if n > 1), "")
        if twice and not why:
            a, b, *_ = (k for k, cell in zip(taken, cells, strict=True) if cell == twice)
            said = rows[a - 1][column.place]
            why = f"{column.header!r} does not name the trials: {said!r} is in rows {a} and {b}"
    return None, why


def note_of(row: Sequence[str], columns: Sequence[SheetColumn], naming: SheetColumn | None) -> str:
    """Return what stands beside a trial's numbers: remarks, who measured, other names of it."""
    texts = [(c, row[c.place]) for c in columns
             if c.kind.quantity == "text" and c.kind.name != "spot" and c is not naming
             and row[c.place]]  # fmt: skip
    return "; ".join(t if c.kind.name == "note" else f"{c.header} {t}" for c, t in texts)


def became(
    column: SheetColumn, columns: Sequence[SheetColumn], used: set[str],
    striker: Mapping[str, Measured], naming: SheetColumn | None,
) -> str:  # fmt: skip
    """Return what became of a column, in words, beside those of the sheet."""
    name, back = column.kind.name, {c.kind.name for c in columns if c.taken} & {*words.REBOUNDS}
    usual = {
        words.REBOUND_HEIGHT: "restitution, the root of rebound over drop height",
        words.REBOUND_SPEED: "restitution, over the speed of approach",
        words.REBOUND_ANGLE: "parts of the rebound speed",
        **dict.fromkeys(("trial", "person", "ball"), "in the notes of the trials"),
    }  # fmt: skip
    told = usual.get(name, name)
    if column is naming:
        told = "names of the trials"
    elif name in words.BODY:
        key = "mass_kg" if name == words.BALL_MASS else "tip_radius_m"
        told = f"{key} of the striker" if key in striker else "left out: not one ball's"
    elif name == "restitution" and back:
        told = "restitution, where heights or speeds give none"
    elif name in back and name not in used:
        other = "speeds" if name == words.REBOUND_HEIGHT else "heights"
        told = f"restitution, where {other} give none"
    alike = sum(c.kind == column.kind and not c.spread for c in columns)
    if alike > 1 and column.kind.quantity != "text" and not column.spread:
        told += f", one of {alike} readings of a trial"
    told += ", without its sign" * (column.sign < 0.0)
    of = "standard deviation of " if column.spread else ""
    return f"{of}{told} ({counted(column.taken, 'cell')})"
