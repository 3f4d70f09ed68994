"""Vertical flight of a body under gravity and drag that grows with the square of its speed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from ...core.arrays import Array
from ...core.drag import Fluid, air, drag_coefficient
from ...core.errors import InputError

_SMALL = 0.05
"""Argument below which the logarithms of cosh and cos are summed as series."""


@dataclass(frozen=True)
class Fall:
    """Vertical flight under quadratic drag: gravity at rest [m/s²], terminal speed [m/s] or inf."""

    gravity: float
    terminal: float

    def landing(self, launch: float) -> float:
        """Return the speed at which a ball launched upwards comes back [m/s]."""
        return launch / math.sqrt(1.0 + (launch / self.terminal) ** 2)

    def duration(self, launch: float) -> float:
        """Return the time from launch to landing [s]."""
        if math.isinf(self.terminal):
            return 2.0 * launch / self.gravity
        rise = math.atan(launch / self.terminal)
        drop = math.atanh(self.landing(launch) / self.terminal)
        return self.terminal / self.gravity * (rise + drop)

    def launch(self, duration: float) -> float:
        """Return the speed at which a flight of this duration began [m/s]."""
        vacuum = 0.5 * self.gravity * duration
        if math.isinf(self.terminal):
            return vacuum
        high = vacuum
        while self.duration(high) < duration:
            high *= 1.5
        return float(brentq(lambda v: self.duration(v) - duration, 0.5 * vacuum, high, rtol=1e-13))

    def speed(self, height: float, way: float = -1.0) -> float:
        """Return the speed after a fall from rest, or `way` 1 to rise as high [m/s]."""
        if math.isinf(self.terminal):
            return math.sqrt(2.0 * self.gravity * height)
        exponent = way * 2.0 * self.gravity * height / self.terminal**2
        return self.terminal * math.sqrt(way * math.expm1(exponent))


@dataclass(frozen=True)
class Ball:
    """A sphere of mass [kg] and diameter [m] in a fluid under gravity [m/s²].

    Without mass or diameter its drag and buoyancy are not known; without a coefficient the drag is
    that of the standard curve of smooth spheres.
    """

    gravity: float
    mass: float | None
    diameter: float | None
    fluid: Fluid
    coefficient: float | None = None

    def fall(self, speed: float) -> Fall:
        """Return the flight at about a speed [m/s], by which the drag coefficient is taken.

        Buoyancy ρV/m is taken off, and the fluid that is carried along, half a volume, counts as
        mass (L. Landau, E. Lifshitz, Fluid Mechanics, §11). Refuses a ball that is lighter than the
        fluid.
        """
        if self.mass is None or self.diameter is None:
            return Fall(self.gravity, math.inf)
        lifted = self.fluid.density * math.pi * self.diameter**3 / 6.0 / self.mass
        if lifted >= 1.0:
            raise InputError(
                f"{self.mass:g} kg", key="mass_kg", allowed="a ball heavier than the air"
            )
        gravity = self.gravity * (1.0 - lifted) / (1.0 + 0.5 * lifted)
        reynolds = abs(speed) * self.diameter * self.fluid.density / self.fluid.viscosity
        coefficient = self.coefficient
        if coefficient is None:
            coefficient = drag_coefficient(max(reynolds, 1e-6)) if self.fluid.density > 0.0 else 0.0
        area = 0.25 * math.pi * self.diameter**2
        push = 0.5 * self.fluid.density * coefficient * area / (self.mass * (1.0 + 0.5 * lifted))
        return Fall(gravity, math.sqrt(gravity / push) if push > 0.0 else math.inf)


UNKNOWN = Ball(9.81, None, None, air())
"""Something that falls in air, drag and buoyancy not known."""


def flight(
    time: Array, start: float, speed: float, fall: float, drag: float
) -> tuple[Array, Array]:
    """Return height and upward speed of a body in vertical flight, exactly, y'' = -a - d y'|y'|.

    At times (n,) from the instant of `start` and `speed`, upwards [s, unit, unit/s]; `fall` is a
    [unit/s²], `drag` d [1/unit], of which a small negative one is allowed, as a fit may try one.
    """
    if drag == 0.0 or fall <= 0.0:
        return start + speed * time - 0.5 * fall * time**2, speed - fall * time
    terminal = math.sqrt(fall / abs(drag))
    # heights below the apex and times from it, in units of terminal²/fall and terminal/fall
    rising, falling = (_log_cos, _log_sech) if drag > 0.0 else (_log_sech, _log_cos)
    x = speed / terminal
    if (x > 0.0) == (drag > 0.0):
        apex = math.atan(x)
    else:
        apex = math.atanh(max(min(x, 0.999), -0.999))
    later = np.append(time * fall / terminal, 0.0) - apex
    up = later < 0.0
    below, moving = np.empty_like(later), np.empty_like(later)
    below[up], moving[up] = rising(later[up])
    below[~up], moving[~up] = falling(later[~up])
    return start + terminal**2 / fall * (below[:-1] - below[-1]), terminal * moving[:-1]


def _log_cos(x: Array) -> tuple[Array, Array]:
    """Return ln cos x and its slope; beyond 1.5, where a fit may stray, those of 1.5."""
    x = np.clip(x, -1.5, 1.5)
    series = -(x**2) / 2.0 - x**4 / 12.0 - x**6 / 45.0
    return np.where(np.abs(x) < _SMALL, series, np.log(np.cos(x))), -np.tan(x)


def _log_sech(x: Array) -> tuple[Array, Array]:
    """Return -ln cosh x and its slope."""
    size = np.abs(x)
    series = -(x**2) / 2.0 + x**4 / 12.0 - x**6 / 45.0
    exact = math.log(2.0) - size - np.log1p(np.exp(-2.0 * size))
    return np.where(size < _SMALL, series, exact), -np.tanh(x)
