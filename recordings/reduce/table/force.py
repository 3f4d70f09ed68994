"""A table of force or acceleration against time: peak, duration, impulse, restitution."""

from __future__ import annotations

from dataclasses import dataclass

from ..bounce_times import GRAVITY
from ..measured import Array, Measured, Trial
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

    Raises
    ------
    InputError
        No pulse above the noise.
    """
    pulse = find_pulse(time, value, source=source)
    is_force = holds == "force"
    values = {("peak_force_N" if is_force else "peak_acceleration_m_s2"): pulse.peak}
    values["contact_time_s"] = pulse.duration
    change: Measured | None = None
    row = {"contact_time_s": pulse.duration}
    if is_force:
        values["impulse_N_s"] = pulse.area
        row["peak_force_N"] = pulse.peak
        change = None if mass is None else pulse.area.scaled(1.0 / mass)
    else:
        # an accelerometer at rest shows zero here, for its level before the pulse is taken off
        change = pulse.area
        if mass is not None:
            row["peak_force_N"] = values["peak_force_N"] = pulse.peak.scaled(mass)
    notes = list(pulse.notes)
    if change is not None:
        values["speed_change_m_s"] = change
    if approach is not None:
        values["impact_speed_m_s"] = row["impact_speed_m_s"] = approach
        if change is not None:
            fall = gravity * pulse.duration.value
            turned = Measured(change.value - fall, change.std)
            ratio = turned.over(approach)
            restitution = Measured(ratio.value - 1.0, ratio.std)
            if 0.0 <= restitution.value <= 1.0:
                values["restitution"] = row["restitution"] = restitution
            else:
                notes.append(
                    f"the impulse asks for a restitution of {restitution}: scale of the record, "
                    "mass or speed are off, or the striker is not free"
                )
    force = pulse.value if is_force else None if mass is None else mass * pulse.value
    trace = {} if force is None else {"time_s": time - pulse.start.value, "force_N": force}
    return PulseReduction(
        pulse, "N" if is_force else "m/s²", values, Trial(row, tuple(notes), trace=trace),
        tuple(notes),
    )  # fmt: skip
