"""A table of force or acceleration against time: peak, duration, impulse, restitution."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..gates import Refused
from ..measured import Measured, Trial
from ..pictures import drawn_if_refused
from ..reduced import Reduced
from ..rules import RULES
from .file import Columns
from .options import TableOptions
from .picture import draw_pulse
from .pulse import Pulse, find_pulse
from .series import Series, no_number, series_of


def reduce(path: Path, table: Columns, options: TableOptions) -> Reduced:
    """Measure the largest pulse of a record.

    The impulse that is more than the weight's turns the momentum of the approach round: e = (J/m -
    gT)/v - 1. Volts without a gain are refused.
    """
    series, source = series_of(table, options), str(path)
    scale = _scale(table, series.column, options, source)
    value = series.value * scale
    with drawn_if_refused(series.time, value, axes=("time [s]", options.holds)):
        pulse = find_pulse(series.time, value, source=source)
        part = options.gain_std / scale if options.gain else 0.0
        peak, area = (v.widened(part * v.value) for v in (pulse.peak, pulse.area))
        pulse = replace(pulse, peak=peak, area=area)
        values, row = _numbers(pulse, options, source)
        _whole(pulse, series, source)
    mass = 1.0 if options.holds == "force" else options.mass_kg
    trace = {} if mass is None else {
        "time_s": series.time - pulse.start.value, "force_N": mass * pulse.value
    }  # fmt: skip
    return Reduced(
        source=path, values=values, trials=(Trial(row, trace=trace),),
        notes=pulse.notes + series.notes + series.missed_notes(", none of them beside the pulse"),
        draw=lambda to: draw_pulse(pulse, "N" if options.holds == "force" else "m/s²", to),
    )  # fmt: skip


def _scale(table: Columns, column: int, options: TableOptions, source: str) -> float:
    """Newtons or m/s² that one of the column's unit is worth."""
    if options.gain is not None:
        return options.gain
    if table.unit(column) in ("V", "mV"):
        raise InputError(
            f"column {table.names[column]!r} holds volts", source=source, key="gain",
            allowed="newtons or m/s2 a volt, from the sensor's sheet",
        )  # fmt: skip
    return table.factor(column, options.holds, given=options.value_unit, key="value_unit")


def _numbers(
    pulse: Pulse, options: TableOptions, source: str
) -> tuple[dict[str, Measured], dict[str, Measured]]:
    """Everything that a pulse tells, and what of it makes a row."""
    mass, row = options.mass_kg, {"contact_time_s": pulse.duration}
    change: Measured | None
    if options.holds == "force":
        values = {"peak_force_N": pulse.peak, "contact_time_s": pulse.duration,
                  "impulse_N_s": pulse.area}  # fmt: skip
        row["peak_force_N"] = pulse.peak
        change = None if mass is None else pulse.area.scaled(1.0 / mass)
    else:
        # an accelerometer at rest shows zero here, for its level before the pulse is taken off
        values = {"peak_acceleration_m_s2": pulse.peak, "contact_time_s": pulse.duration}
        change = pulse.area
        if mass is not None:
            row["peak_force_N"] = values["peak_force_N"] = pulse.peak.scaled(mass)
    if change is not None:
        # gravity took its part of what the pulse gave
        change = replace(change, value=change.value - options.gravity_m_s2 * pulse.duration.value)
        values["speed_change_m_s"] = change
    if options.approach_speed_m_s is not None:
        approach = Measured(options.approach_speed_m_s, options.approach_speed_m_s_std)
        values["impact_speed_m_s"] = row["impact_speed_m_s"] = approach
        if change is not None:
            ratio = change.over(approach)
            restitution = _possible(Measured(ratio.value - 1.0, ratio.std), source)
            values["restitution"] = row["restitution"] = restitution
    return values, row


def _whole(pulse: Pulse, series: Series, source: str) -> None:
    """Refuse a pulse with a hole in it: the largest values are missing where a range ends."""
    near = pulse.duration.value
    beside = (series.missed > pulse.start.value - near) & (series.missed < pulse.end.value + near)
    if beside.any():
        raise Refused(
            f"{no_number(series.missed.size, series.marks)}, {int(beside.sum())} of them in or "
            "beside the pulse", source=source,
            allowed="a whole pulse: a range that it does not reach, no lost samples",
        )  # fmt: skip
    longest = float(np.diff(pulse.time[pulse.inside]).max(initial=0.0))
    usual = float(np.median(np.diff(pulse.time)))
    if longest > max(RULES.hole * pulse.duration.value, 2.5 * usual):
        raise Refused(
            f"no sample for {longest:.3g} s within a pulse of {pulse.duration.value:.3g} s",
            source=source, allowed="a whole pulse: no lost samples",
        )  # fmt: skip


def _possible(restitution: Measured, source: str) -> Measured:
    """Return the restitution within 0 to 1, its error so much wider; refuse what is far outside."""
    off = max(-restitution.value, restitution.value - 1.0, 0.0)
    if off > RULES.by_chance * restitution.std:
        raise Refused(
            f"the impulse asks for a restitution of {restitution}", source=source,
            key="approach_speed_m_s", allowed="0 to 1: scale of the record, mass and speed that "
            "fit, of a striker that is free; without the speed the impulse alone is told",
        )  # fmt: skip
    return Measured(min(max(restitution.value, 0.0), 1.0), math.hypot(restitution.std, off))
