"""Tables with a row a trial: any unit in the columns' names, and rebound beside drop heights."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError, InputErrors
from ...recordings.columns import CONDITIONS, MEASURED, STD_SUFFIX
from ..bounces.fall import Ball, Fall
from ..measured import Measured, Trial
from ..rules import RULES
from ..shared.units import LENGTH, UNITS, quantity_of
from .file import Columns
from .heading import DROPS

_QUANTITY_OF_UNIT = {
    "_m_s": "speed", "_m": "length", "_s": "time", "_N": "force", "_rad_s": "spin",
    "_deg": "angle", "_K": "temperature",
}  # fmt: skip


@dataclass(frozen=True)
class TrialsReduction:
    """Rows that a table makes, and what a picture shows of them: two named columns (n,)."""

    values: dict[str, Measured]
    trials: tuple[Trial, ...]
    notes: tuple[str, ...]
    x: tuple[str, Array]
    y: tuple[str, Array]


def reduce_rebounds(
    table: Columns, *, value: str, unit: str, std: float, ball: Ball
) -> TrialsReduction:
    """Return a trial for each rebound height beside a drop height.

    Parameters
    ----------
    table
        Drop heights in the column `value`, rebound heights of the repeats in all columns after it.
    value
        Column of the drop heights; empty for the one that is named so.
    unit
        Of all of them, or `"file"`.
    std
        Standard deviation of a height [that unit].
    ball
        What flies: with drag it lands slower than it was dropped.

    Raises
    ------
    InputError
        No rebound heights, or one above its drop.
    """
    heights, metres = _heights(table, value, unit)
    error = std * metres
    trials: list[Trial] = []
    for row, (drop, *rebounds) in enumerate(heights, start=1):
        if not np.isfinite(drop):
            continue
        speed = _fall(ball, drop).impact(float(drop))
        approach = Measured(speed, 0.5 * speed * error / drop)
        for k, height in enumerate(rebounds, start=1):
            if np.isfinite(height):
                up = _fall(ball, height).rise(float(height))
                ratio = Measured(up, 0.5 * up * error / height).over(approach)
                seen = {"impact_speed_m_s": approach, "restitution": ratio}
                trials.append(Trial(seen, label=f"drop{row}-{k}"))
    if not trials:
        raise InputError("no rebound height", source=table.source, allowed="heights above 0")
    speeds = np.array([t.observables["impact_speed_m_s"].value for t in trials])
    ratios = np.array([t.observables["restitution"].value for t in trials])
    values = {}
    for speed in np.unique(speeds):
        same = ratios[speeds == speed]
        spread = float(np.std(same, ddof=1) / math.sqrt(same.size)) if same.size > 1 else math.nan
        values[f"restitution_at_{speed:.4g}_m_s"] = Measured(float(same.mean()), spread)
    return TrialsReduction(
        values, tuple(trials), (f"{len(trials)} rebounds",),
        ("impact speed [m/s]", speeds), ("restitution", ratios),
    )  # fmt: skip


_LEEB_SPEED = 2.05
"""Approach of the body of a device D [m/s] (ISO 16859-1)."""


def reduce_leeb(table: Columns, *, value: str, std: float, speed: float | None) -> TrialsReduction:
    """Return a trial for each Leeb number, a thousand times the restitution of the device's ball.

    Parameters
    ----------
    table
        Numbers in the column `value` and in all after it.
    value
        Their first column.
    std
        Standard deviation of a number.
    speed
        Approach [m/s]; None takes that of device D.

    Raises
    ------
    InputError
        No number, or one that is not between 0 and 1000.
    """
    first = table.find(value, key="value")
    approach = Measured(speed or _LEEB_SPEED, 0.0)
    trials, wrong = [], []
    for row, numbers in enumerate(table.values[:, first:], start=1):
        for k, number in enumerate(numbers[np.isfinite(numbers)], start=1):
            if not 0.0 < number < 1000.0:
                wrong.append(InputError(
                    f"{number:g}", source=table.source, key=f"row {row} of the numbers",
                    allowed="a Leeb number between 0 and 1000",
                ))  # fmt: skip
            ratio = Measured(float(number) / 1e3, std / 1e3)
            seen = {"impact_speed_m_s": approach, "restitution": ratio}
            trials.append(Trial(seen, label=f"{row}-{k}"))
    if wrong:
        raise InputErrors(tuple(wrong))
    if not trials:
        raise InputError("no Leeb number", source=table.source, allowed="numbers of 0 to 1000")
    ratios = np.array([t.observables["restitution"].value for t in trials])
    spread = float(np.std(ratios, ddof=1)) if ratios.size > 1 else math.nan
    notes = () if speed else (f"approach {_LEEB_SPEED} m/s, as of device D",)
    return TrialsReduction(
        {"restitution": Measured(float(ratios.mean()), spread / math.sqrt(ratios.size))},
        tuple(trials), notes, ("number", np.arange(1.0, ratios.size + 1)), ("restitution", ratios),
    )  # fmt: skip


def _fall(ball: Ball, height: float) -> Fall:
    """Return the flight over a height [m], its drag taken at a typical speed."""
    return ball.fall(RULES.drag_speed * math.sqrt(2.0 * ball.gravity * height))


def _heights(table: Columns, value: str, unit: str) -> tuple[Array, float]:
    """Return drop and rebound heights, (rows, 1 + repeats) [m], and their unit [m]."""
    first = table.find(value, key="value") if value else _drops(table)
    metres = table.factor(first, "length", given=unit, key="value_unit")
    said = [table.unit(k) if unit == "file" else "" for k in range(len(table.names))]
    lengths = (k for k in range(first + 1, len(said)) if quantity_of(said[k]) in ("", "length"))
    columns = [first, *lengths]
    heights = table.values[:, columns] * [LENGTH.get(said[k], metres) for k in columns]
    if heights.shape[1] < 2:
        raise InputError(
            "no column after the drop heights", source=table.source, key="value",
            allowed="rebound heights in the columns that follow",
        )  # fmt: skip
    wrong = tuple(
        InputError(
            f"{h[k]:g} m after a drop of {h[0]:g} m", source=table.source,
            key=f"row {row + 1} of the numbers, column {columns[k] + 1}",
            allowed="a rebound above 0 and below the drop",
        )
        for row, h in enumerate(heights)
        for k in range(1, h.size)
        if np.isfinite(h[k]) and not 0.0 < h[k] < h[0]
    )  # fmt: skip
    if wrong:
        raise InputErrors(wrong)
    return heights, metres


def _drops(table: Columns) -> int:
    """The first column that is named as a drop height, or h0."""
    words = rf"{DROPS}|^h_?0(?!\d)"
    named = [k for k, n in enumerate(table.names) if re.search(words, n, re.IGNORECASE)]
    if not named:
        raise InputError(
            "no column is named as a drop height", source=table.source, key="value",
            allowed="its name or number; the rebound heights follow it",
        )  # fmt: skip
    return named[0]


def reduce_trials(table: Columns) -> TrialsReduction:
    """Return the rows of a table whose columns are named as in trials.csv, in any unit.

    `permanent_depth_um`, `impact_speed_mm/s` or `contact_time (ms)` are taken for
    `permanent_depth_m`, `impact_speed_m_s` and `contact_time_s`.

    Raises
    ------
    InputError
        A column that is no column of trials.csv, or none with an approach.
    """
    known = _known_columns(table)
    labels = _labels(table)
    names = [name for name, _ in known.values()]
    if not {"impact_speed_m_s", "drop_height_m"} & set(names):
        raise InputError(
            "no column of the approach", source=table.source,
            allowed="impact_speed or drop_height with a unit",
        )  # fmt: skip
    if not any(name in MEASURED for name in names):
        raise InputError("no measured column", source=table.source, allowed=", ".join(MEASURED))
    trials = []
    for label, cells in zip(labels, table.values, strict=True):
        numbers = {name: cells[k] * unit for k, (name, unit) in known.items()}
        observed = {
            name: Measured(float(v), float(numbers.get(name + STD_SUFFIX, math.nan)))
            for name, v in numbers.items()
            if math.isfinite(v) and not name.endswith(STD_SUFFIX)
        }
        if observed:
            trials.append(Trial(observed, label=label))
    place = {name: k for k, (name, _) in known.items()}
    across = next(n for n in ("impact_speed_m_s", "drop_height_m") if n in place)
    up = next(n for n in MEASURED if n in place)
    column = {n: table.values[:, place[n]] * known[place[n]][1] for n in (across, up)}
    return TrialsReduction(
        {"trials": Measured(float(len(trials)), math.nan)}, tuple(trials), (),
        (across, column[across]), (up, column[up]),
    )  # fmt: skip


def _labels(table: Columns) -> list[str]:
    """Names of the trials: those of the column `trial`, else the number of the row."""
    if "trial" not in table.names:
        return [f"{row:03d}" for row in range(1, len(table.cells) + 1)]
    place = table.names.index("trial")
    labels = [row[place] for row in table.cells]
    twice = {name for name in labels if not name or labels.count(name) > 1}
    if twice:
        raise InputError(
            f"{min(twice)!r} stands more than once or is empty", source=table.source, key="trial",
            allowed="a name of its own for each row",
        )  # fmt: skip
    return labels


def _known_columns(table: Columns) -> dict[int, tuple[str, float]]:
    """Place, name in trials.csv and factor of every column."""
    found: dict[int, tuple[str, float]] = {}
    wrong: list[InputError] = []
    numbers = [n for n, c in (CONDITIONS | MEASURED).items() if c.kind != "text"]
    all_names = [*numbers, *(n + STD_SUFFIX for n in MEASURED)]
    for place, name in enumerate(table.names):
        if name in ("trial", "striker", "note", "spot", ""):
            continue
        match = _match(name, all_names)
        if match is None:
            close = get_close_matches(name, all_names, n=1)
            wrong.append(
                InputError(
                    "unknown column or unit", source=table.source, key=name,
                    allowed=f"did you mean {close[0]}?" if close else "a column of trials.csv",
                )
            )  # fmt: skip
        elif match[0] in [n for n, _ in found.values()]:
            wrong.append(InputError("given twice", source=table.source, key=name, allowed="once"))
        else:
            found[place] = match
    if wrong:
        raise InputErrors(tuple(wrong))
    return found


def _match(given: str, names: list[str]) -> tuple[str, float] | None:
    """Name in trials.csv of a column, and the factor to its unit."""
    if given in names:
        return given, 1.0
    for name in names:
        plain = name.removesuffix(STD_SUFFIX)
        tail = STD_SUFFIX if plain != name else ""
        ending = next((e for e in _QUANTITY_OF_UNIT if plain.endswith(e)), "")
        quantity = _QUANTITY_OF_UNIT.get(ending, "number")
        base = plain.removesuffix(ending)
        for unit, size in UNITS[quantity].items():
            words = {unit, unit.replace("/", "_"), unit.replace("µ", "u")} - {""}
            for word in words:
                if re.fullmatch(
                    rf"{base}{tail}(_{re.escape(word)}| ?[\[(]{re.escape(word)}[\])])"
                    rf"|{base}_{re.escape(word)}{tail}",
                    given,
                ):
                    return name, size
    return None
