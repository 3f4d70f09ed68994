"""One row of a set, seen with its striker and its motion before touch."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from functools import cached_property, lru_cache, wraps
from typing import NamedTuple

import numpy as np

from ...core.arrays import Array
from ...core.inputs.second_sphere import StruckSphere, struck_sphere
from ...core.rig import StrikerTable
from ..recording_set import RecordingSet
from ..rules import RULES
from . import limits, rigid
from .findings import Finding, gathered

Check = Callable[[RecordingSet], list[Finding]]


class TrialReading(NamedTuple):
    """A number and its standard deviation, of which an audit makes many."""

    value: float
    std: float

    @property
    def relative(self) -> float:
        """Standard deviation over value [-]."""
        return self.std / abs(self.value) if self.value else 0.0


def value_of(reading: TrialReading | None, otherwise: float) -> float:
    """Return the value of a reading, or `otherwise` where nothing was read."""
    return otherwise if reading is None else reading.value


class TrialView:
    """Trial number `i` of a set; what was asked of it once is kept."""

    def __init__(self, found: RecordingSet, i: int) -> None:
        self.found, self.i = found, i
        self._measured: dict[str, TrialReading | None] = {}

    @property
    def name(self) -> str:
        """The trial's name."""
        return self.found.trials.trial[self.i]

    @cached_property
    def striker(self) -> StrikerTable:
        """What was dropped."""
        return self.found.setup.strikers[self.found.trials.striker[self.i]]

    @cached_property
    def second(self) -> StruckSphere | None:
        """The second sphere; none where a flat is struck."""
        return struck_sphere(self.found.setup.target)

    @cached_property
    def R(self) -> float:
        """Radius of the sphere on a flat that answers for the contact [m]."""
        own = self.striker.tip_radius_m.value
        return own if self.second is None else self.second.equivalent(own)

    @cached_property
    def parted(self) -> bool:
        """Whether each of two spheres alike keeps a part of the dent."""
        target = self.found.setup.target
        return self.second is not None and not limits.clearly_softer(target, self.striker)

    @cached_property
    def speed(self) -> TrialReading:
        """Normal approach speed [m/s]."""
        normal = self.found.approach.normal
        return TrialReading(float(normal[self.i]), float(speed_std(self.found)[self.i]))

    @cached_property
    def angle(self) -> TrialReading:
        """Angle between a rod's axis and the flat, pi/2 for a sphere [rad]."""
        angle = self.found.approach.angle
        return TrialReading(float(angle[self.i]), float(angle_std(self.found)[self.i]))

    @cached_property
    def touch(self) -> rigid.RigidTouch[float]:
        """The rigid body just before touch."""
        return self.touch_at(self.angle.value)

    def touch_at(self, angle: float) -> rigid.RigidTouch[float]:
        """Return the same with the axis at another angle [rad]."""
        approach = self.found.approach
        return rigid.touch(
            self.striker, angle=angle, normal=self.speed.value,
            tangential=float(approach.tangential[self.i]), spin=float(approach.spin[self.i]),
            second=self.second,
        )  # fmt: skip

    def measured(self, name: str) -> TrialReading | None:
        """Return an observable and its standard deviation, `None` where not measured."""
        if name not in self._measured:
            self._measured[name] = self._read(name)
        return self._measured[name]

    def _read(self, name: str) -> TrialReading | None:
        if name not in self.found.observed:
            return None
        value = float(self.found.values(name)[self.i])
        if math.isnan(value):
            return None
        # what laws of nature ask of one trial is asked within its scale's error too
        scale = self.found.setup.gauge.get(name, 0.0)
        return TrialReading(value, math.hypot(float(self.found.std(name)[self.i]), scale * value))


@lru_cache(maxsize=1)
def speed_std(found: RecordingSet) -> Array:
    """Standard deviations of the normal approach speeds, shape (n,) [m/s]."""
    approach = found.approach
    unstated = np.isnan(approach.normal_std)
    return np.where(unstated, RULES.unstated_speed * approach.normal, approach.normal_std)


@lru_cache(maxsize=1)
def angle_std(found: RecordingSet) -> Array:
    """Standard deviations of the axes' angles, shape (n,) [rad]; a sphere has no axis."""
    stated = np.radians(found.trials.angle_deg_std)
    ball = np.array([striker.shape == "sphere" for striker in found.strikers()])
    return np.where(ball, 0.0, np.where(np.isnan(stated), rigid.DEFAULT_ANGLE_STD, stated))


@lru_cache(maxsize=1)
def views(found: RecordingSet) -> tuple[TrialView, ...]:
    """Every trial of a set in turn; the same ones for all checks of the set."""
    return tuple(TrialView(found, i) for i in range(len(found.trials)))


def by_trial(check: Callable[[TrialView], Iterable[Finding]]) -> Check:
    """Return a check of one trial as one of a set: the worst finding of each kind."""

    @wraps(check)
    def of_set(found: RecordingSet) -> list[Finding]:
        return gathered([finding for view in views(found) for finding in check(view)])

    return of_set
