"""One row of a set, seen with its striker and its motion before touch."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from ...core.rig import Quantity, StrikerTable
from ..recording_set import RecordingSet
from . import rigid

UNSTATED_SPEED = 0.02
"""Relative standard deviation of an approach speed that is stated without one."""


@dataclass(frozen=True, slots=True)
class TrialView:
    """Trial number `i` of a set."""

    found: RecordingSet
    i: int

    @property
    def name(self) -> str:
        """The trial's name."""
        return self.found.trials.trial[self.i]

    @property
    def striker(self) -> StrikerTable:
        """What was dropped."""
        return self.found.setup.strikers[self.found.trials.striker[self.i]]

    @property
    def speed(self) -> Quantity:
        """Normal approach speed [m/s]."""
        approach = self.found.approach
        value, std = float(approach.normal[self.i]), float(approach.normal_std[self.i])
        return Quantity(value=value, std=UNSTATED_SPEED * value if math.isnan(std) else std)

    @property
    def angle(self) -> Quantity:
        """Angle between a rod's axis and the flat, pi/2 for a sphere [rad]."""
        std = math.radians(self.found.trials.angle_deg_std[self.i])
        if self.striker.shape == "sphere":
            std = 0.0
        elif math.isnan(std):
            std = rigid.DEFAULT_ANGLE_STD
        return Quantity(value=float(self.found.approach.angle[self.i]), std=std)

    @property
    def touch(self) -> rigid.Touch:
        """The rigid body just before touch."""
        return self.touch_at(self.angle.value)

    def touch_at(self, angle: float) -> rigid.Touch:
        """Return the same with the axis at another angle [rad]."""
        approach = self.found.approach
        return rigid.touch(
            self.striker,
            angle=angle,
            normal=self.speed.value,
            tangential=float(approach.tangential[self.i]),
            spin=float(approach.spin[self.i]),
        )

    def measured(self, name: str) -> Quantity | None:
        """Return an observable and its standard deviation, `None` where not measured."""
        if name not in self.found.observed:
            return None
        value = float(self.found.values(name)[self.i])
        if math.isnan(value):
            return None
        return Quantity(value=value, std=float(self.found.std(name)[self.i]))


def views(found: RecordingSet) -> Iterator[TrialView]:
    """Every trial of a set in turn."""
    return (TrialView(found, i) for i in range(len(found.trials)))


def combined(*relatives: float) -> float:
    """Return the root of the sum of squares of relative standard deviations."""
    return math.hypot(*relatives)
