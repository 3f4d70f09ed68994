"""What is measured of an impact: one row an observable, with all that is known of it.

Reading, comparing, plotting, texts and proposals take their facts from here. The order is that of
the columns of trials.csv, then of what only a curve (trace or profile) gives.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

Instrument = Literal["motion", "force", "surface"]
Phase = Literal["loading", "unloading", "sliding", "free-flight"]

RELATIVE_SUFFIX = "_relative"


@dataclass(frozen=True, slots=True, kw_only=True)
class Observable:
    """One observable.

    Parameters
    ----------
    column
        Its name in files, SI unit included: a column of trials.csv and a key of `[noise]`.
    label, meaning
        Two or three words for lists and axes; one sentence for the documentation.
    instrument
        What measures it: a camera, markers, light gates or sound (`motion`), a force sensor or an
        electric contact (`force`), a scan of the crater (`surface`).
    phase
        The phase of the impact that shapes it most.
    low, zero
        Smallest value, and whether zero itself is accepted where that is 0.
    log
        Whether it is compared as a logarithm.
    power
        D ln y / D ln v of a fully plastic contact, good enough between repeats of one speed.
    simulated
        The number of a simulated impact that it is compared with; empty if several make it.
    in_trials
        Whether trials.csv has the column; else only a curve gives it.
    usual_noise
        Relative standard deviation of a usual instrument (of a ratio the absolute one); 0 for what
        is not proposed as a further measurement.
    unit, scale
        Unit for people, and how many of it are one of the SI.
    """

    column: str
    label: str
    meaning: str
    instrument: Instrument
    phase: Phase
    low: float = 0.0
    zero: bool = True
    log: bool = False
    power: float
    simulated: str
    in_trials: bool = True
    usual_noise: float = 0.0
    unit: str = "-"
    scale: float = 1.0

    @property
    def axis(self) -> str:
        """Text of a plot's axis."""
        return self.label if self.unit == "-" else f"{self.label} [{self.unit}]"


_ROWS = (
    Observable(
        column="restitution", label="restitution",
        meaning="rebound over approach normal tip velocity",
        instrument="motion", phase="unloading", log=True, power=-0.25, simulated="restitution",
        usual_noise=0.01,
    ),
    Observable(
        column="permanent_depth_m", label="crater depth", meaning="depth of the crater in the flat",
        instrument="surface", phase="loading", log=True, power=1.0, simulated="residual_flat_m",
        usual_noise=0.03, unit="um", scale=1e6,
    ),
    Observable(
        column="contact_time_s", label="contact time", meaning="first touch to last separation",
        instrument="force", phase="loading", zero=False, log=True, power=0.0,
        simulated="contact_time_s", usual_noise=0.01, unit="ms", scale=1e3,
    ),
    Observable(
        column="peak_force_N", label="peak force", meaning="largest normal force",
        instrument="force", phase="loading", zero=False, log=True, power=1.0,
        simulated="peak_force_N", usual_noise=0.03, unit="kN", scale=1e-3,
    ),
    Observable(
        column="rebound_spin_rad_s", label="spin",
        meaning="angular velocity after, counter-clockwise", instrument="motion",
        phase="sliding", low=-math.inf, power=1.0, simulated="rebound_spin_rad_s",
        usual_noise=0.03, unit="rad/s",
    ),
    Observable(
        column="friction_impulse_ratio", label="impulse ratio",
        meaning="tangential over normal impulse", instrument="motion", phase="sliding", power=0.0,
        simulated="friction_impulse_ratio", usual_noise=0.01,
    ),
    Observable(
        column="sliding_length_m", label="sliding length",
        meaning="range of the contact point's travel", instrument="surface", phase="sliding",
        power=1.0, simulated="sliding_length_m", unit="um", scale=1e6,
    ),
    Observable(
        column="rebound_speed_m_s", label="rebound speed",
        meaning="velocity of the centre of mass after, along +y", instrument="motion",
        phase="free-flight", low=-math.inf, power=0.75, simulated="rebound_speed_m_s", unit="m/s",
    ),
    Observable(
        column="tangential_rebound_m_s", label="tangential rebound", meaning="the same along +x",
        instrument="motion", phase="free-flight", low=-math.inf, power=1.0,
        simulated="tangential_rebound_m_s", unit="m/s",
    ),
    Observable(
        column="peak_depth_m", label="largest depth",
        meaning="deepest place of the tip below the undisturbed flat", instrument="motion",
        phase="loading", log=True, power=1.0, simulated="peak_depth_m", in_trials=False,
        unit="um", scale=1e6,
    ),
    Observable(
        column="loading_time_s", label="time to the largest force",
        meaning="first touch to the largest force", instrument="force", phase="loading", log=True,
        power=0.0, simulated="loading_time_s", in_trials=False, unit="ms", scale=1e3,
    ),
    Observable(
        column="normal_impulse_Ns", label="impulse",
        meaning="normal force over the time in contact", instrument="force", phase="unloading",
        log=True, power=1.0, simulated="normal_impulse_Ns", in_trials=False, unit="N s",
    ),
    Observable(
        column="below_flat_s", label="time below the flat",
        meaning="how long the tip is below the undisturbed flat", instrument="motion",
        phase="unloading", log=True, power=0.1, simulated="", in_trials=False, unit="ms",
        scale=1e3,
    ),
)  # fmt: skip

OBSERVABLES: dict[str, Observable] = {row.column: row for row in _ROWS}
"""Every observable by its column."""

_MEASURED = tuple(row.column for row in _ROWS if row.in_trials)

NOISE_KEYS: tuple[str, ...] = (
    *_MEASURED,
    *(name + RELATIVE_SUFFIX for name in _MEASURED),
    "tip_height_m",
    "force_N",
    "force_N" + RELATIVE_SUFFIX,
    "impact_speed" + RELATIVE_SUFFIX,
    "frame_rate_hz",
)
"""Every key that `[noise]` may have: observables, traces, the approach, the camera."""
