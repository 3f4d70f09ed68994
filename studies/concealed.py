"""Bodies of concealed sets, whichever world strikes them: what they are, not what they do."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Metal:
    """A material as the sheet states it, SI; an endless strength is not stated."""

    name: str
    E: float
    nu: float
    Sy: float
    density: float
    cp: float = 500.0
    melting: float = 1700.0


@dataclass(frozen=True)
class Striker:
    """A rod with two round ends (length above 0), or a ball; SI."""

    name: str
    metal: Metal
    tip_radius: float
    radius: float
    length: float = 0.0

    @property
    def mass(self) -> float:
        """Of the ball, or of the rod as a cylinder [kg]."""
        if self.length == 0.0:
            return self.metal.density * 4.0 / 3.0 * math.pi * self.radius**3
        return self.metal.density * math.pi * self.radius**2 * self.length

    @property
    def inertia(self) -> float:
        """About the centre, across the axis [kg m^2]."""
        if self.length == 0.0:
            return 0.4 * self.mass * self.radius**2
        return self.mass * (self.length**2 / 12.0 + self.radius**2 / 4.0)
