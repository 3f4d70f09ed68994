"""Tables of readings: rebound heights beside drop heights, and Leeb numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError, InputErrors
from ..bounces.fall import Ball, Fall
from ..measured import Measured, Trial
from ..rules import RULES
from ..shared.units import LENGTH, quantity_of
from .file import Columns


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
    """The first column that is named as a drop height."""
    from .sheet.kinds import kind_of

    kinds = [kind_of(name) for name in table.names]
    named = [k for k, kind in enumerate(kinds) if kind and kind.name == "drop_height_m"]
    if not named:
        raise InputError(
            "no column is named as a drop height", source=table.source, key="value",
            allowed="its name or number; the rebound heights follow it",
        )  # fmt: skip
    return named[0]
