"""One row of a set, seen with its striker and its motion before touch."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property, lru_cache
from typing import Any, TypeVar, cast

from ...core.rig import Quantity, StrikerTable
from ..recording_set import RecordingSet
from . import rigid

Found = TypeVar("Found")

UNSTATED_SPEED = 0.02
"""Relative standard deviation of an approach speed that is stated without one."""


class TrialView:
    """Trial number `i` of a set; what was asked of it once is kept.

    Parameters
    ----------
    found
        The set.
    i
        Number of the trial.
    known
        What was found out for each striker, shared by the trials of the set.
    """

    def __init__(self, found: RecordingSet, i: int, known: dict[tuple[str, str], Any]) -> None:
        self.found, self.i, self._known = found, i, known
        self._measured: dict[str, Quantity | None] = {}

    @property
    def name(self) -> str:
        """The trial's name."""
        return self.found.trials.trial[self.i]

    @cached_property
    def striker(self) -> StrikerTable:
        """What was dropped."""
        return self.found.setup.strikers[self.found.trials.striker[self.i]]

    def of_striker(self, what: str, find: Callable[[], Found]) -> Found:
        """Return what is the same for all trials of this striker."""
        key = (what, self.found.trials.striker[self.i])
        if key not in self._known:
            self._known[key] = find()
        return cast("Found", self._known[key])

    @cached_property
    def speed(self) -> Quantity:
        """Normal approach speed [m/s]."""
        approach = self.found.approach
        value, std = float(approach.normal[self.i]), float(approach.normal_std[self.i])
        return plain(value=value, std=UNSTATED_SPEED * value if math.isnan(std) else std)

    @cached_property
    def angle(self) -> Quantity:
        """Angle between a rod's axis and the flat, pi/2 for a sphere [rad]."""
        std = math.radians(self.found.trials.angle_deg_std[self.i])
        if self.striker.shape == "sphere":
            std = 0.0
        elif math.isnan(std):
            std = rigid.DEFAULT_ANGLE_STD
        return plain(value=float(self.found.approach.angle[self.i]), std=std)

    @cached_property
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
        if name not in self._measured:
            self._measured[name] = self._read(name)
        return self._measured[name]

    def _read(self, name: str) -> Quantity | None:
        if name not in self.found.observed:
            return None
        value = float(self.found.values(name)[self.i])
        if math.isnan(value):
            return None
        return plain(value=value, std=float(self.found.std(name)[self.i]))


@lru_cache(maxsize=1)
def views(found: RecordingSet) -> tuple[TrialView, ...]:
    """Every trial of a set in turn; the same ones for all checks of the set."""
    known: dict[tuple[str, str], Any] = {}
    return tuple(TrialView(found, i, known) for i in range(len(found.trials)))


def plain(*, value: float, std: float) -> Quantity:
    """Return a quantity of numbers that need no check, of which an audit makes many."""
    return Quantity.model_construct(value=value, std=std)


def combined(*relatives: float) -> float:
    """Return the root of the sum of squares of relative standard deviations."""
    return math.hypot(*relatives)
