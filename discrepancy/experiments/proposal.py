"""What is proposed: one thing to do, with what it would tell."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from ...core.unstated import unstated_equal


@unstated_equal
@dataclass(frozen=True, slots=True)
class Proposal:
    """What to do, how well it would discriminate, and what it would do to the interval.

    - `expected_discrimination`: D averaged over the rivals; 0 where there are none.
    - `kind`: `trial`, `press`, `build`, `noise`, `observable`, `hardness`, `weigh`, `calliper` or
      `none`.
    - `information`: nats by which the entropy of which rival is true is expected to fall.
    - `interval`: width of the leading parameter's interval over that of today; nan where not worked
      out.
    - `trial`: striker, speed [m/s] and angle [degrees] of a trial, mass [kg] and tip radius [m],
      repeats; of a press its load [N]; of a number of the sheet its key.
    - `observable`: what to measure as well, of a proposal of that kind.
    - `minutes`: how long it takes; nan where there is nothing to do.
    """

    change: str
    expected_discrimination: float
    kind: str = "trial"
    interval: float = math.nan
    trial: Mapping[str, str | float] = field(default_factory=dict)
    information: float = 0.0
    observable: str = ""
    minutes: float = math.nan

    @property
    def per_hour(self) -> float:
        """Information over the hours it takes [nat/h]; 0 where there is nothing to do."""
        return 60.0 * self.information / self.minutes if self.minutes > 0.0 else 0.0
