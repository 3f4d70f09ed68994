"""The columns that trials.csv, traces and profiles may have: kind, range and meaning of each."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from ..core.observables import OBSERVABLES

# limit: largest number of a column without a unit [-]; a restitution written in percent is beyond
_HIGHEST_RATIO = 20.0

# limit: largest number of a column by its unit [that unit]; beyond it a slip of the unit
_HIGHEST = {
    "_rad_s": 1e7,
    "_m_s": 2e4,
    "_Ns": 1e6,
    "_depth_m": 0.1,
    "_m": 1.0,
    "_s": 100.0,
    "_N": 1e10,
}

Kind = Literal["text", "condition", "observable", "std"]


@dataclass(frozen=True, slots=True)
class Column:
    """One column: what it holds and which numbers it accepts.

    - `kind`: `text`, a number that sets the trial's condition, a measured observable, or the
      standard deviation of another column.
    - `meaning`: one sentence for the documentation and the template.
    - `low`, `high`: range of the numbers, in the unit of the column's name.
    - `low_allowed`: whether `low` itself is accepted.
    """

    kind: Kind
    meaning: str
    low: float = -math.inf
    high: float = math.inf
    low_allowed: bool = True

    def accepts(self, value: float) -> bool:
        """Whether a number lies in the column's range."""
        above = value >= self.low if self.low_allowed else value > self.low
        return above and value <= self.high

    @property
    def allowed(self) -> str:
        """The range in words."""
        if self.low == -math.inf and self.high == math.inf:
            return "a number"
        if self.low == -math.inf:
            return f"a number up to {self.high:g}"
        least = f"not below {self.low:g}" if self.low_allowed else f"above {self.low:g}"
        return f"a number {least}" + (f" and up to {self.high:g}" if self.high < math.inf else "")


def _positive(kind: Kind, meaning: str, *, high: float = math.inf) -> Column:
    return Column(kind, meaning, low=0.0, low_allowed=False, high=high)


def _not_negative(kind: Kind, meaning: str) -> Column:
    return Column(kind, meaning, low=0.0)


CONDITIONS: dict[str, Column] = {
    "trial": Column("text", "name of the trial"),
    "striker": Column("text", "a name from set.toml"),
    "angle_deg": Column(
        "condition", "90 for a normal impact", low=0.0, high=90.0, low_allowed=False
    ),
    "impact_speed_m_s": _positive("condition", "normal approach speed", high=2e4),
    "drop_height_m": _positive("condition", "height of fall", high=200.0),
    "drop_height_m_std": _not_negative("std", "of a height; all its trials share it"),
    "angle_deg_std": _not_negative("std", "standard deviation of the angle"),
    "impact_speed_m_s_std": _not_negative("std", "standard deviation of the speed"),
    "temperature_K": _positive("condition", "temperature of the bodies", high=1e4),
    "order": Column("condition", "place in the order of testing"),
    "batch": Column("condition", "which session it is of; 1 if empty", low=1.0, high=1e6),
    "spot": Column("text", "same text: same place on the flat"),
    "approach_tangential_m_s": Column("condition", "tangential speed of the centre before"),
    "approach_spin_rad_s": Column("condition", "angular velocity before, counter-clockwise"),
    "load_N": _positive("condition", "largest load of a quasi-static press", high=1e8),
    "load_N_std": _not_negative("std", "standard deviation of the load"),
    "press_rate_per_s": _positive("condition", "strain rate of a press; none if empty", high=1e4),
}
"""Columns that describe a trial, in the order in which they are written."""


def _highest(name: str) -> float:
    return next((high for end, high in _HIGHEST.items() if name.endswith(end)), _HIGHEST_RATIO)


MEASURED: dict[str, Column] = {
    name: Column("observable", row.meaning, low=row.low, low_allowed=row.zero, high=_highest(name))
    for name, row in OBSERVABLES.items()
    if row.in_trials
}
"""Measured columns, in the order of the format's table."""

STD_SUFFIX = "_std"

TRIAL_COLUMNS: dict[str, Column] = (
    CONDITIONS
    | MEASURED
    | {name + STD_SUFFIX: _positive("std", f"of {name}") for name in MEASURED}
    | {"note": Column("text", "free text, not used")}
)
"""Every column that trials.csv may have."""

VARIED = "x_"
"""Beginning of a column of a condition that was varied and that no simulation knows."""

TRACE_COLUMNS: tuple[str, ...] = ("time_s", "tip_height_m", "force_N", "tip_x_m", "angle_rad")
PROFILE_COLUMNS: tuple[str, ...] = ("x_m", "z_m")
