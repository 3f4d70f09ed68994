"""Numbers of a table against time: the rows that are used, and the cells that hold no number."""

from __future__ import annotations

import math
from collections.abc import Iterable
from datetime import date
from typing import NamedTuple

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ..rules import RULES
from ..shared.units import HERTZ, LARGEST_NUMBER, TIME
from .cells import DAY
from .file import Columns
from .options import TableOptions


class Series(NamedTuple):
    """Numbers (n,) against time [s] as they stand, and the column they are of.

    `missed` are the times of rows without a number, `marks` what their cells hold instead, each
    once; `behind` rows stand at a time that has been before, and are left out.
    """

    time: Array
    value: Array
    column: int
    missed: Array
    marks: tuple[str, ...]
    behind: int

    @property
    def notes(self) -> tuple[str, ...]:
        """What is said of rows whose time does not go on: rounded, or a second record."""
        told = f"{self.behind} rows at or before the time of an earlier one are left out"
        return (told,) if self.behind else ()

    def missed_notes(self, but: str) -> tuple[str, ...]:
        """Return what is said of cells that hold no number, if there are some."""
        return (f"{no_number(self.missed.size, self.marks)}{but}",) if self.missed.size else ()


def no_number(count: int, marks: Iterable[str]) -> str:
    """Return how many cells hold no number, and what they hold."""
    held = ", ".join(repr(mark) if mark else "nothing" for mark in tuple(marks)[:4])
    return f"{count} cells hold no number but {held}"


_DAY_0 = date(1899, 12, 30).toordinal()
"""From which spreadsheets count days."""


def counts(column: Array) -> bool:
    """Return whether a column without a unit holds 0, 1, 2 ... instead of times."""
    steps = np.diff(column[np.isfinite(column)])
    return steps.size > 0 and bool(np.mean(steps == 1.0) > 0.9)


def series_of(table: Columns, options: TableOptions) -> Series:
    """Times and numbers of the part that is used, and the cells in it that hold no number."""
    alone = table.values.shape[1] == 1
    chosen = "value" in options.model_fields_set or not alone
    column = table.find(options.value, key="value") if chosen else 0
    time = _times(table, options, alone=alone)
    value = table.values[:, column]
    known = np.isfinite(time)
    part = known & options.keeps(np.where(known, time, 0.0))
    whole = part & np.isfinite(value)
    holes = part & ~whole
    marks = tuple(sorted({table.cells[int(k)][column] for k in np.flatnonzero(holes)}))
    time, value, missed = time[whole], value[whole], time[holes]
    largest = float(np.abs([time, value]).max(initial=0.0))
    # a tracker that begins anew writes its frames again further down
    ahead = time > np.concatenate([[-np.inf], np.maximum.accumulate(time)[:-1]])
    rows = int(ahead.sum())
    for wrong, told, key, allowed in (
        (largest > LARGEST_NUMBER, f"a number of {largest:.3g}", "value",
         f"up to {LARGEST_NUMBER:g}"),
        (rows < 0.5 * time.size, "the times do not increase", "time",
         "a column of times, or of numbers of samples with rate_hz"),
        (rows < RULES.table_rows, f"{rows} rows with a time and a value", "value",
         f"{RULES.table_rows} or more"),
    ):  # fmt: skip
        if wrong:
            raise InputError(told, source=table.source, key=key, allowed=allowed)
    return Series(time[ahead], value[ahead], column, missed, marks, int((~ahead).sum()))


def _stated_rate(table: Columns) -> float | None:
    """Samples a second by the header's line of a sampling rate, frequency or interval."""
    number, unit = table.heading.quantity("sampl") or (math.nan, "")
    number *= HERTZ.get(unit, TIME.get(unit, math.nan))
    return (number if unit in HERTZ else 1.0 / number) if number > 0.0 else None


def _times(table: Columns, options: TableOptions, *, alone: bool) -> Array:
    """Times of all rows [s]: of their column, or of rows that are as far apart as is said."""
    rows = np.arange(table.values.shape[0], dtype=float)
    if alone:
        rate = options.rate_hz or _stated_rate(table)
        if rate is None:
            raise InputError(
                "no column of the time", source=table.source, key="rate_hz",
                allowed="samples a second",
            )  # fmt: skip
        return rows / rate
    where = table.find(options.time, key="time")
    second = table.factor(where, "time", given=options.time_unit, key="time_unit", default="s")
    given = table.values[:, where]
    if options.rate_hz is not None:
        # a clock of a computer is coarser than the samples: their number tells the time
        return (given if counts(given) else rows) / options.rate_hz
    unsaid = options.time_unit == "file" and not table.unit(where)
    column = f"column {table.names[where] or where + 1!r}"
    days = [float(date(y, 1, 1).toordinal() - _DAY_0) for y in (1970, 2100)]
    first = float(given[np.isfinite(given)][:1].sum())
    late = float(np.fmax.reduce(np.abs(given), initial=0.0))
    for wrong, told, key, allowed in (
        (not np.isfinite(given).any(), f"no times in {column}", "time",
         "a column of times, or samples a second as rate_hz"),
        (unsaid and counts(given), "the column counts samples", "rate_hz",
         "samples a second, or time_unit if these are times"),
        (unsaid and days[0] < first < days[1],
         f"{column}: {first:.9g} are seconds, or days of a spreadsheet", "time_unit",
         "s, or another column; days: seconds or a clock in their place"),
        (unsaid and late > date.max.toordinal() * DAY,
         f"{column}: {late:.3g} are no seconds, they pass the year {date.max.year}", "time_unit",
         "ms, us, ns, or another column of times"),
    ):  # fmt: skip
        if wrong:
            raise InputError(told, source=table.source, key=key, allowed=allowed)
    return np.asarray(given * second)
