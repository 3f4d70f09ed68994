"""A table of what an instrument or a person wrote down, read, measured and drawn.

What one kind of table needs is imported where it is read: the drag of a flight and the tools of
signals take longer to load than a small file to reduce.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ..gates import Refused, drawn
from ..measured import Measured
from ..pictures import draw_refused
from ..reduced import Reduced
from ..rules import RULES
from ..shared.units import HERTZ, LARGEST_NUMBER, LENGTH, TIME
from .cells import DAY
from .file import Columns, read_columns
from .options import TableOptions
from .picture import draw_heights, draw_pulse, draw_tension, draw_times, draw_trials

if TYPE_CHECKING:
    from .pulse import Pulse


class Series(NamedTuple):
    """Numbers against time.

    Parameters
    ----------
    time, value
        (n,): time [s], number as it stands.
    column
        Place of the numbers in the table.
    missed
        Times of the rows without a number [s].
    marks
        What their cells hold instead, each once.
    behind
        How many rows stand at a time that has been before, and are left out.
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
        return (
            (f"{self.behind} rows at or before the time of an earlier one are left out",)
            if self.behind else ()
        )  # fmt: skip

    def told(self) -> str:
        """Return how many cells hold no number, and what they hold."""
        return _no_number(self.missed.size, self.marks)


def _no_number(count: int, marks: Iterable[str]) -> str:
    held = ", ".join(repr(mark) if mark else "nothing" for mark in tuple(marks)[:4])
    return f"{count} cells hold no number but {held}"


def reduce(path: Path, options: TableOptions) -> Reduced:
    """Measure what a table holds.

    Raises
    ------
    InputError
        The table cannot be read, or does not hold what it should.
    """
    if options.holds == "trials":
        from .sheet import read_sheet

        columns = options.column.split(";")
        found = read_sheet(path, columns, sheet=options.sheet, select=options.select)
        return found.reduced(path)
    table = read_columns(path, sheet=options.sheet)
    if options.select:
        table = table.select(options.select)
    if options.holds in ("force", "acceleration"):
        return _pulse(path, table, options)
    if options.holds == "height":
        return _heights(path, table, options)
    if options.holds == "bounces":
        return _bounces(path, table, options)
    if options.holds == "tension":
        return _tension(path, table, options)
    return _readings(path, table, options)


def _readings(path: Path, table: Columns, options: TableOptions) -> Reduced:
    from .trials import reduce_leeb, reduce_rebounds

    if options.holds == "rebounds":
        chosen = options.value if "value" in options.model_fields_set else ""
        found = reduce_rebounds(
            table, value=chosen, unit=options.value_unit, std=options.value_std,
            ball=options.ball,
        )  # fmt: skip
    else:
        found = reduce_leeb(
            table, value=options.value, std=options.value_std, speed=options.approach_speed_m_s
        )
    return Reduced(
        source=path, values=found.values, trials=found.trials, notes=found.notes,
        draw=lambda to: draw_trials(found, to),
    )  # fmt: skip


def _pulse(path: Path, table: Columns, options: TableOptions) -> Reduced:
    from .force import reduce_pulse

    series = _series(table, options)
    time, value, column = series.time, series.value, series.column
    unit = options.gain
    if unit is None and table.unit(column) in ("V", "mV"):
        raise InputError(
            f"column {table.names[column]!r} holds volts", source=str(path), key="gain",
            allowed="newtons or m/s2 a volt, from the sensor's sheet",
        )  # fmt: skip
    if unit is None:
        unit = table.factor(column, options.holds, given=options.value_unit, key="value_unit")
    speed = options.approach_speed_m_s
    axes = ("time [s]", options.holds)
    with drawn(lambda to, why: draw_refused(time, value * unit, to, why, axes=axes)):
        found = reduce_pulse(
            time, value * unit, holds=options.holds, mass=options.mass_kg,
            approach=None if speed is None else Measured(speed, options.approach_speed_m_s_std),
            gravity=options.gravity_m_s2, source=str(path),
            scale_std=options.gain_std / unit if options.gain else 0.0,
        )  # fmt: skip
        _whole(found.pulse, series, str(path))
    notes = found.notes + series.notes
    if series.missed.size:
        notes += (f"{series.told()}, none of them beside the pulse",)
    return Reduced(
        source=path, values=found.values, trials=(found.trial,), notes=notes,
        draw=lambda to: draw_pulse(found, to),
    )  # fmt: skip


def _whole(pulse: Pulse, series: Series, source: str) -> None:
    """Refuse a pulse with a hole in it: the largest values are missing where a range ends."""
    near = pulse.duration.value
    beside = (series.missed > pulse.start.value - near) & (series.missed < pulse.end.value + near)
    if beside.any():
        raise Refused(
            "hole", f"{series.told()}, {int(beside.sum())} of them in or beside the pulse",
            source=source,
            allowed="a whole pulse: a range that it does not reach, no lost samples",
        )  # fmt: skip
    longest = float(np.diff(pulse.time[pulse.inside]).max(initial=0.0))
    usual = float(np.median(np.diff(pulse.time)))
    if longest > max(RULES.hole * pulse.duration.value, 2.5 * usual):
        raise Refused(
            "hole", f"no sample for {longest:.3g} s within a pulse of {pulse.duration.value:.3g} s",
            source=source, allowed="a whole pulse: no lost samples",
        )  # fmt: skip


def _tension(path: Path, table: Columns, options: TableOptions) -> Reduced:
    from .tension import reduce_tension, strain_unit, stress_unit

    at, value = table.find(options.time, key="time"), table.find(options.value, key="value")
    parts = strain_unit(table, at, given=options.gauge_length_mm)
    unit = stress_unit(table, value, given=options.value_unit, area_mm2=options.area_mm2)
    with np.errstate(over="ignore"):  # what is too large is refused as that
        strain, stress = table.values[:, at] * parts, table.values[:, value] * unit
    with drawn(lambda to, why: draw_refused(strain, stress, to, why, axes=("strain", "stress"))):
        found = reduce_tension(
            strain, stress, strain_is=options.strain_is, E=options.E_Pa, source=str(path)
        )
    notes = found.notes
    if options.E_Pa is None and table.unit(at) in LENGTH:
        notes += ("a travel of the machine's head holds its give: state E_Pa if it is one",)
    pair = np.isfinite(table.values[:, [at, value]])
    if (holes := np.flatnonzero(pair.sum(axis=1) == 1)).size:
        marks = {table.cells[int(k)][value if pair[k, 0] else at] for k in holes}
        notes += (f"{_no_number(holes.size, sorted(marks))}: their rows are left out",)
    return Reduced(
        source=path, values=found.values, trials=(), notes=notes,
        draw=lambda to: draw_tension(found, to), flow=(options.body, found.flow),
    )  # fmt: skip


def _heights(path: Path, table: Columns, options: TableOptions) -> Reduced:
    from .height import reduce_heights

    series = _series(table, options)
    time, value, column = series.time, series.value, series.column
    said = table.unit(column) if options.value_unit == "file" else options.value_unit
    metres = None
    if said != "px":
        metres = table.factor(column, "length", given=options.value_unit, key="value_unit")
    axes = ("time [s]", "height")
    with drawn(lambda to, why: draw_refused(time, value, to, why, axes=axes)):
        found = reduce_heights(
            time, value if options.upwards == "up" else -value, metres=metres,
            std=options.value_std, ball=options.ball, source=str(path),
            contact=Measured(lasts, 0.0) if (lasts := options.contact_time_s) else None,
        )  # fmt: skip
    rate = float(1.0 / np.median(np.diff(time)))
    lost = series.notes
    if series.missed.size:
        lost += (f"{series.told()}: they are left out",)
    return Reduced(
        source=path, values=found.values, trials=found.trials, notes=found.found.notes + lost,
        draw=lambda to: draw_heights(found, to), noise={"frame_rate_hz": rate},
    )  # fmt: skip


def _bounces(path: Path, table: Columns, options: TableOptions) -> Reduced:
    from ..bounces.times import reduce_bounce_times

    column = table.find(options.time, key="time")
    unit = table.factor(column, "time", given=options.time_unit, key="time_unit", default="s")
    times = table.values[:, column] * unit
    times = times[np.isfinite(times)]
    times = times[options.keeps(times)]
    if times.size < 3:
        raise InputError(
            f"{times.size} instants", source=str(path), key="time", allowed="three or more"
        )
    if (np.diff(times) <= 0.0).any():
        raise InputError(
            "the instants do not increase", source=str(path), key="time",
            allowed="the column of the times, not of the intervals",
        )  # fmt: skip
    std = None if options.time_std_s is None else np.full(times.size, options.time_std_s)
    found = reduce_bounce_times(times, options, std=std, source=str(path))
    return Reduced(
        source=path, values=found.values(), trials=found.trials(), notes=found.notes,
        draw=lambda to: draw_times(found, to),
    )  # fmt: skip


_DAY_0 = date(1899, 12, 30).toordinal()
"""From which spreadsheets count days."""


def _counts(column: Array) -> bool:
    """Whether a column without a unit holds 0, 1, 2 ... instead of times."""
    steps = np.diff(column[np.isfinite(column)])
    return steps.size > 0 and bool(np.mean(steps == 1.0) > 0.9)


def _series(table: Columns, options: TableOptions) -> Series:
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
    if largest > LARGEST_NUMBER:
        raise InputError(
            f"a number of {largest:.3g}", source=table.source, key="value",
            allowed=f"up to {LARGEST_NUMBER:g}",
        )  # fmt: skip
    # a tracker that begins anew writes its frames again further down
    ahead = time > np.concatenate([[-np.inf], np.maximum.accumulate(time)[:-1]])
    if time.size and ahead.sum() < 0.5 * time.size:
        raise InputError(
            "the times do not increase", source=table.source, key="time",
            allowed="a column of times, or of numbers of samples with rate_hz",
        )  # fmt: skip
    if ahead.sum() < RULES.table_rows:
        raise InputError(
            f"{int(ahead.sum())} rows with a time and a value", source=table.source, key="value",
            allowed=f"{RULES.table_rows} or more",
        )  # fmt: skip
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
    if options.rate_hz is None and not np.isfinite(given).any():
        raise InputError(
            f"no times in column {table.names[where] or where + 1!r}", source=table.source,
            key="time", allowed="a column of times, or samples a second as rate_hz",
        )  # fmt: skip
    if options.rate_hz is not None:
        # a clock of a computer is coarser than the samples: their number tells the time
        return (given if _counts(given) else rows) / options.rate_hz
    if options.time_unit == "file" and not table.unit(where) and _counts(given):
        raise InputError(
            "the column counts samples", source=table.source, key="rate_hz",
            allowed="samples a second, or time_unit if these are times",
        )  # fmt: skip
    days = [float(date(y, 1, 1).toordinal() - _DAY_0) for y in (1970, 2100)]
    first = float(given[np.isfinite(given)][:1].sum())
    if options.time_unit == "file" and not table.unit(where) and days[0] < first < days[1]:
        raise InputError(
            f"column {table.names[where] or where + 1!r}: {first:.9g} are seconds, or days of a "
            "spreadsheet", source=table.source, key="time_unit",
            allowed="s, or another column; days: seconds or a clock in their place",
        )  # fmt: skip
    late = float(np.nanmax(np.abs(given), initial=0.0))
    if options.time_unit == "file" and not table.unit(where) and late > date.max.toordinal() * DAY:
        raise InputError(
            f"column {table.names[where] or where + 1!r}: {late:.3g} are no seconds, they pass the "
            f"year {date.max.year}",
            source=table.source, key="time_unit", allowed="ms, us, ns, or another column of times",
        )  # fmt: skip
    return np.asarray(given * second)
