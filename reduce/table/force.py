"""A table of force or acceleration against time: peak, duration, impulse, restitution."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ...core.arrays import Array
from ..bounces.options import GRAVITY
from ..gates import Refused
from ..measured import Measured, Trial
from ..rules import RULES
from .pulse import Pulse, find_pulse


@dataclass(frozen=True)
class PulseReduction:
    """The largest pulse of a record and what it says of the impact."""

    pulse: Pulse
    unit: str
    values: dict[str, Measured]
    trial: Trial
    notes: tuple[str, ...]


def reduce_pulse(
    time: Array,
    value: Array,
    *,
    holds: str,
    mass: float | None,
    approach: Measured | None,
    gravity: float = GRAVITY,
    source: str,
    scale_std: float = 0.0,
) -> PulseReduction:
    """Measure a pulse.

    The impulse that is more than the weight's turns the momentum of the approach round:
    e = (J/m - gT)/v - 1.

    Parameters
    ----------
    time, value
        (n,), time increasing [s]; force [N] or acceleration [m/s²].
    holds
        `"force"` or `"acceleration"`.
    mass
        Of the striker [kg], if it is known.
    approach
        Normal speed before [m/s], if it is known.
    gravity
        Acceleration of the fall [m/s²].
    source
        The file.
    scale_std
        Relative error of the sensor's scale.

    Raises
    ------
    InputError
        No pulse above the noise.
    """
    pulse = find_pulse(time, value, source=source)
    peak, area = (v.widened(scale_std * v.value) for v in (pulse.peak, pulse.area))
    pulse = replace(pulse, peak=peak, area=area)
    values = {("peak_force_N" if holds == "force" else "peak_acceleration_m_s2"): pulse.peak}
    values["contact_time_s"] = pulse.duration
    row = {"contact_time_s": pulse.duration}
    change: Measured | None
    force: Array | None
    if holds == "force":
        values["impulse_N_s"] = pulse.area
        row["peak_force_N"] = pulse.peak
        change = None if mass is None else pulse.area.scaled(1.0 / mass)
        force = pulse.value
    else:
        # an accelerometer at rest shows zero here, for its level before the pulse is taken off
        change = pulse.area
        force = None if mass is None else mass * pulse.value
        if mass is not None:
            row["peak_force_N"] = values["peak_force_N"] = pulse.peak.scaled(mass)
    if change is not None:
        values["speed_change_m_s"] = change
    notes = pulse.notes
    if approach is not None:
        values["impact_speed_m_s"] = row["impact_speed_m_s"] = approach
        if change is not None:
            restitution = _restitution(change, approach, gravity * pulse.duration.value)
            values["restitution"] = row["restitution"] = _possible(restitution, source)
    trace = {} if force is None else {"time_s": time - pulse.start.value, "force_N": force}
    unit = "N" if holds == "force" else "m/s²"
    return PulseReduction(pulse, unit, values, Trial(row, notes, trace=trace), notes)


def _possible(restitution: Measured, source: str) -> Measured:
    """Return the restitution within 0 to 1, its error so much wider; refuse what is far outside."""
    off = max(-restitution.value, restitution.value - 1.0, 0.0)
    if off > RULES.by_chance * restitution.std:
        raise Refused(
            "restitution", f"the impulse asks for a restitution of {restitution}", source=source,
            key="approach_speed_m_s", allowed="0 to 1: scale of the record, mass and speed that "
            "fit, of a striker that is free; without the speed the impulse alone is told",
        )  # fmt: skip
    return Measured(min(max(restitution.value, 0.0), 1.0), math.hypot(restitution.std, off))


def _restitution(change: Measured, approach: Measured, fall: float) -> Measured:
    """Return what turns the approach round: the change of speed less what gravity took."""
    ratio = Measured(change.value - fall, change.std).over(approach)
    return Measured(ratio.value - 1.0, ratio.std)
