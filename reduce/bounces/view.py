"""What all flights of a track share: the fall, the drag, and how the camera bends heights."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...core.arrays import Array
from .fall import flight


class View(NamedTuple):
    """Shared unknowns of a track.

    A height y above the flat is seen as y (1 + bend y/H + bow (y/H)²)(1 + growth t/T), with H the
    largest height and T the length of the track: the scale drifts with height (lens, perspective,
    tilt of the picture) and with time (a body that comes nearer).
    """

    fall: float
    """Acceleration at rest in the track's unit of length [unit/s²]."""
    drag: float
    """Deceleration over the square of the speed [1/unit]."""
    bend: float
    bow: float
    growth: float


class Launch(NamedTuple):
    """A flight at its reference time: height above the flat and speed [unit, unit/s]."""

    height: float
    speed: float


@dataclass(frozen=True)
class Stage:
    """The ranges by which drifts of the scale are counted.

    Height of the flat, near which the scale is 1, and H, the largest height above it [unit];
    beginning of the track and T, its length [s].
    """

    floor: float
    reach: float
    start: float
    span: float

    def flight(self, view: View, launch: Launch, tau: Array) -> tuple[Array, Array]:
        """Return true height above the flat and upward speed at times from the reference."""
        return flight(tau, launch.height, launch.speed, view.fall, view.drag)

    def seen(self, view: View, launch: Launch, reference: float, time: Array) -> Array:
        """Return the height that the camera sees, (n,) [unit]."""
        y = self.flight(view, launch, time - reference)[0]
        z, late = y / self.reach, (time - self.start) / self.span
        bent = y * (1.0 + view.bend * z + view.bow * z**2) * (1.0 + view.growth * late)
        return np.asarray(self.floor + bent)

    def slopes(self, view: View, launch: Launch, reference: float, time: Array) -> Array:
        """Return the derivatives of the seen heights by the shared unknowns and the launch, (n, 7).

        In the order of the fields of `View` and `Launch`.
        """
        tau = time - reference
        y = self.flight(view, launch, tau)[0]
        fall = 1e-6 * abs(view.fall) + 1e-9
        drag = 1e-6 / self.reach
        by_fall = (self.flight(view._replace(fall=view.fall + fall), launch, tau)[0] - y) / fall
        by_drag = (self.flight(view._replace(drag=view.drag + drag), launch, tau)[0] - y) / drag
        z, grown, steep = self._bends(view, y, time)
        bent = 1.0 + view.bend * z + view.bow * z**2
        late = (time - self.start) / self.span
        return np.column_stack([
            by_fall * steep, by_drag * steep, y * z * grown, y * z**2 * grown, y * bent * late,
            self.launch_slopes(view, launch, reference, time),
        ])  # fmt: skip

    def launch_slopes(self, view: View, launch: Launch, reference: float, time: Array) -> Array:
        """Return the derivatives of the seen heights by the launch, (n, 2)."""
        tau = time - reference
        y = self.flight(view, launch, tau)[0]
        speed = 1e-6 * self.reach / self.span
        faster = self.flight(view, launch._replace(speed=launch.speed + speed), tau)[0]
        steep = self._bends(view, y, time)[2]
        return np.stack([steep, (faster - y) / speed * steep], axis=1)

    def _bends(self, view: View, y: Array, time: Array) -> tuple[Array, Array, Array]:
        """Return height over the reach, growth of the scale, slope of the seen height."""
        z = y / self.reach
        grown = 1.0 + view.growth * (time - self.start) / self.span
        return z, grown, (1.0 + 2.0 * view.bend * z + 3.0 * view.bow * z**2) * grown
