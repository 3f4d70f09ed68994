"""A rigid striker under an impulse at its contact point: mobility, motion before and after.

x points the way the rod's upper end leans, y out of the flat, spin counter-clockwise. The contact
point lies (c, s) = ((L/2) cos(theta), (L/2) sin(theta) + R) below the centre of mass; for a sphere
c = 0, s = R. Masses cancel in every ratio of velocities unless the inertia is given on its own. A
second sphere that is free rests before and moves off; the contact's motion is that between the two.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Generic, TypeVar, cast

import numpy as np

from ...core.arrays import Array
from ...core.inputs.second_sphere import StruckSphere
from ...core.observables import OBSERVABLES
from ...core.rig import StrikerTable

Number = TypeVar("Number", float, Array)
"""Of one trial, or an array with one for each."""

DEFAULT_ANGLE_STD = math.radians(1.0)
"""Standard deviation of an angle that the set does not state [rad]."""

_TURNING = 3.5
"""m (1/m + r^2/I) of a solid sphere."""

FIXED_BY_MOMENTUM = tuple(
    name for name, o in OBSERVABLES.items() if o.instrument == "motion" and o.in_trials
)
"""Observables that follow from the impulse alone."""


@dataclass(frozen=True, slots=True)
class RigidTouch(Generic[Number]):
    """Striker and motion just before touch, of one trial or, in arrays, of many.

    - `m`, `I`: mass [kg] and moment of inertia about the centre, across the axis [kg m^2].
    - `c`, `s`: arms of the contact point [m].
    - `vx`, `vy`, `spin`: velocity of the centre of mass [m/s] (vy < 0) and angular velocity
      [rad/s].
    - `lightness`: 1/m of a second sphere that is free [1/kg]; 0 of what is held.
    - `struck_vx`, `struck_vy`: velocity of the struck body's surface at the contact [m/s].
    """

    m: float
    I: float  # noqa: E741 (the field's symbol)
    c: Number
    s: Number
    vx: Number
    vy: Number
    spin: Number
    lightness: float = 0.0
    struck_vx: Number | float = 0.0
    struck_vy: Number | float = 0.0

    @property
    def across(self) -> Number:
        """M_xy [1/kg]."""
        return -self.c * self.s / self.I

    @property
    def along(self) -> Number:
        """M_yy [1/kg]."""
        return 1.0 / self.m + self.c**2 / self.I + self.lightness

    @property
    def tip(self) -> tuple[Number, Number]:
        """Velocity of the contact point on what is struck, x and y [m/s]."""
        return (
            self.vx + self.spin * self.s - self.struck_vx,
            self.vy - self.spin * self.c - self.struck_vy,
        )

    def after(self, impulse: tuple[Number, Number]) -> RigidTouch[Number]:
        """Return the motion after an impulse (P_x, P_y) [N s]; vy is then upward."""
        px, py = impulse
        return RigidTouch(
            self.m, self.I, self.c, self.s, self.vx + px / self.m, self.vy + py / self.m,
            self.spin + (self.s * px - self.c * py) / self.I, self.lightness,
            self.struck_vx - _TURNING * self.lightness * px, self.struck_vy - self.lightness * py,
        )  # fmt: skip

    @property
    def energy(self) -> Number:
        """Kinetic energy of both [J]."""
        own = 0.5 * self.m * (self.vx**2 + self.vy**2) + 0.5 * self.I * self.spin**2
        if self.lightness == 0.0:
            return own
        along = self.struck_vx**2 / _TURNING
        return own + 0.5 * (along + self.struck_vy**2) / self.lightness

    def impulse(self, e: Number, mu: Number) -> tuple[Number, Number]:
        """Return the impulse that gives restitution `e` at the impulse ratio `mu`, x and y [N s].

        P_y = (1 + e) |v_y| / (M_yy + M_xy P_x / P_y), friction against the sliding of the tip
        (corrected Eqs. 5.5-5.8 of the thesis).
        """
        across, tip = self.across, self.tip
        # a tip that starts at rest slides the way the normal impulse pushes it
        slides = np.where(np.abs(tip[0]) > 1e-12 * np.abs(tip[1]), tip[0], across)
        ratio = cast("Number", -np.sign(slides) * mu)
        py = (1.0 + e) * -tip[1] / (self.along + ratio * across)
        return ratio * py, py

    @property
    def stick_ratio(self) -> Number:
        """Impulse ratio at which a tip that starts at rest would stick, c s / (I/m + s^2)."""
        return self.c * self.s / (self.I / self.m + self.s**2)


def touch(
    striker: StrikerTable, *, angle: Number, normal: Number, tangential: Number, spin: Number,
    second: StruckSphere | None = None,
) -> RigidTouch[Number]:  # fmt: skip
    """Return the `RigidTouch` of a striker; `angle` of the axis [rad], speeds [m/s, rad/s]."""
    half = striker.length / 2.0  # 0 for a sphere
    c, s = half * np.cos(angle), half * np.sin(angle) + striker.tip_radius_m.value
    # `normal` is the approach of the contact point, which a starting spin moves too
    return RigidTouch(
        striker.mass_kg.value, striker.inertia, c, s, tangential, -normal + spin * c, spin,
        0.0 if second is None else 1.0 / second.mass,
    )  # fmt: skip


def measured_after(before: RigidTouch[Number], impulse: tuple[Number, Number]) -> dict[str, Number]:
    """Return the observables that momentum fixes, under the names of their columns."""
    px, py = impulse
    found = before.after(impulse)
    return {
        "restitution": -found.tip[1] / before.tip[1],
        "friction_impulse_ratio": abs(px) / py,
        "rebound_spin_rad_s": found.spin,
        "rebound_speed_m_s": found.vy,
        "tangential_rebound_m_s": found.vx,
    }
