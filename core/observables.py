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
Event = Literal["impact", "press"]

RELATIVE_SUFFIX = "_relative"


@dataclass(frozen=True, slots=True, kw_only=True)
class Observable:
    """One observable.

    - `column`: its name in files, SI unit included: a column of trials.csv and a key of `[noise]`.
    - `label`, `meaning`: two or three words for lists and axes; one sentence for the documentation.
    - `instrument`: what measures it: a camera, markers, light gates or sound (`motion`), a force
      sensor, a testing machine or an electric contact (`force`), a scan of the crater (`surface`).
    - `phase`: the phase of the impact that shapes it most.
    - `low`, `zero`: smallest value, and whether zero itself is accepted where that is 0.
    - `log`: whether it is compared as a logarithm.
    - `power`: D ln y / D ln v of a fully plastic contact, good enough between repeats of one speed.
    - `simulated`: the number of a simulated impact that it is compared with; empty if several make
      it.
    - `in_trials`: whether trials.csv has the column; else only a curve gives it.
    - `usual_noise`: relative standard deviation of a usual instrument; 0 for what is not proposed
      as a further measurement.
    - `of`: what shows it: an impact, a quasi-static press, or either.
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
    of: tuple[Event, ...] = ("impact",)

    @property
    def unit(self) -> str:
        """Unit for people."""
        return _shown(self.column)[1]

    @property
    def scale(self) -> float:
        """How many units for people are one of the SI."""
        return _shown(self.column)[2]

    @property
    def axis(self) -> str:
        """Text of a plot's axis."""
        return self.label if self.unit == "-" else f"{self.label} [{self.unit}]"


_SHOWN = (
    ("_rad_s", "rad/s", 1.0), ("_m_s", "m/s", 1.0), ("_Ns", "N s", 1.0),
    ("_m", "um", 1e6), ("_s", "ms", 1e3), ("_N", "kN", 1e-3), ("", "-", 1.0),
)  # fmt: skip
"""End of a column, unit in which people read it, and how many of it are one of the SI."""


def _shown(column: str) -> tuple[str, str, float]:
    return next(row for row in _SHOWN if column.endswith(row[0]))


_ROWS = (
    Observable(
        column="restitution", label="restitution",
        meaning="rebound over approach normal tip velocity", simulated="restitution",
        instrument="motion", phase="unloading", power=-0.25, usual_noise=0.01,
    ),
    Observable(
        column="permanent_depth_m", label="crater depth",
        meaning="depth of the crater in the flat", simulated="residual_flat_m",
        instrument="surface", phase="loading", log=True, power=1.0, usual_noise=0.03,
        of=("impact", "press"),
    ),
    Observable(
        column="dent_diameter_m", label="dent diameter", zero=False,
        meaning="diameter of the dent in the flat, its edge as `[noise] dent_edge` says",
        simulated="", instrument="surface", phase="loading", log=True, power=0.5, usual_noise=0.01,
        of=("impact", "press"),
    ),
    Observable(
        column="contact_time_s", label="contact time", zero=False,
        meaning="first touch to last separation", simulated="contact_time_s",
        instrument="force", phase="loading", log=True, power=0.0, usual_noise=0.01,
    ),
    Observable(
        column="peak_force_N", label="peak force", zero=False,
        meaning="largest normal force", simulated="peak_force_N",
        instrument="force", phase="loading", log=True, power=1.0, usual_noise=0.03,
    ),
    Observable(
        column="rebound_spin_rad_s", label="spin", low=-math.inf,
        meaning="angular velocity after, counter-clockwise", simulated="rebound_spin_rad_s",
        instrument="motion", phase="sliding", power=1.0, usual_noise=0.03,
    ),
    Observable(
        column="friction_impulse_ratio", label="impulse ratio",
        meaning="tangential over normal impulse", simulated="friction_impulse_ratio",
        instrument="motion", phase="sliding", power=0.0, usual_noise=0.01,
    ),
    Observable(
        column="sliding_length_m", label="sliding length",
        meaning="range of the contact point's travel", simulated="sliding_length_m",
        instrument="surface", phase="sliding", power=1.0,
    ),
    Observable(
        column="scar_length_m", label="scar length",
        meaning="length of the mark of all touches", simulated="scar_length_m",
        instrument="surface", phase="sliding", power=0.5,
    ),
    Observable(
        column="scar_width_m", label="scar width",
        meaning="its width at the deepest place", simulated="scar_width_m",
        instrument="surface", phase="loading", power=0.5,
    ),
    Observable(
        column="scar_excess_m", label="scar length less width", low=-math.inf,
        meaning="length of the mark minus its width at the deepest place",
        simulated="scar_excess_m", instrument="surface", phase="sliding", power=1.0,
    ),
    Observable(
        column="rebound_speed_m_s", label="rebound speed", low=-math.inf,
        meaning="velocity of the centre of mass after, along +y", simulated="rebound_speed_m_s",
        instrument="motion", phase="free-flight", power=0.75,
    ),
    Observable(
        column="tangential_rebound_m_s", label="tangential rebound", low=-math.inf,
        meaning="the same along +x", simulated="tangential_rebound_m_s",
        instrument="motion", phase="free-flight", power=1.0,
    ),
    Observable(
        column="press_depth_m", label="press depth", zero=False,
        meaning="largest approach under the load of a press, the machine's own taken off",
        simulated="", instrument="force", phase="loading", log=True, power=1.0, of=("press",),
    ),
    Observable(
        column="recovered_depth_m", label="recovered depth", zero=False,
        meaning="approach given back as the load of a press is taken off", simulated="",
        instrument="force", phase="unloading", log=True, power=0.5, of=("press",),
    ),
    Observable(
        column="peak_depth_m", label="largest depth", in_trials=False,
        meaning="deepest place of the tip below the undisturbed flat", simulated="peak_depth_m",
        instrument="motion", phase="loading", log=True, power=1.0,
    ),
    Observable(
        column="loading_time_s", label="time to the largest force", in_trials=False,
        meaning="first touch to the largest force", simulated="loading_time_s",
        instrument="force", phase="loading", log=True, power=0.0,
    ),
    Observable(
        column="normal_impulse_Ns", label="impulse", in_trials=False,
        meaning="normal force over the time in contact", simulated="normal_impulse_Ns",
        instrument="force", phase="unloading", log=True, power=1.0,
    ),
    Observable(
        column="below_flat_s", label="time below the flat", in_trials=False,
        meaning="how long the tip is below the undisturbed flat", simulated="",
        instrument="motion", phase="unloading", log=True, power=0.1,
    ),
)  # fmt: skip

OBSERVABLES: dict[str, Observable] = {row.column: row for row in _ROWS}
"""Every observable by its column."""

_MEASURED = tuple(row.column for row in _ROWS if row.in_trials)

TRACE_NOISE = ("tip_height_m", "force_N", "force_N" + RELATIVE_SUFFIX)
RIG_NOISE = ("impact_speed" + RELATIVE_SUFFIX, "frame_rate_hz")
LOAD = "load_N"
"""Column of the largest load of a quasi-static press."""

NOISE_KEYS: tuple[str, ...] = (
    *_MEASURED, *(name + RELATIVE_SUFFIX for name in _MEASURED), *TRACE_NOISE, *RIG_NOISE,
    LOAD, LOAD + RELATIVE_SUFFIX,
)  # fmt: skip
"""Every number that `[noise]` may have: of observables, traces, approach, camera, load."""
GAUGE_KEYS: tuple[str, ...] = (*_MEASURED, LOAD)
"""Columns whose readings may share a scale: the keys of `[gauge]`."""
