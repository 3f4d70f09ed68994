"""A rigid striker under an impulse at its contact point: mobility, motion after, what fits best.

x points the way the rod's upper end leans, y out of the flat, spin counter-clockwise. The contact
point lies (c, s) = ((L/2) cos(theta), (L/2) sin(theta) + R) below the centre of mass; for a sphere
c = 0, s = R. Masses cancel in every ratio of velocities unless the inertia is given on its own.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from ...core.observables import OBSERVABLES
from ...core.rig import Quantity, StrikerTable, value_of
from ..csv_table import Array

MODEL_TOLERANCE = 0.005
"""Part of the approach speed by which a frozen angle and a fixed contact point may err."""

DEFAULT_ANGLE_STD = math.radians(1.0)
"""Standard deviation of an angle that the set does not state [rad]."""

FIXED_BY_MOMENTUM = tuple(
    name for name, o in OBSERVABLES.items() if o.instrument == "motion" and o.in_trials
)
"""Observables that follow from the impulse alone."""


@dataclass(frozen=True, slots=True)
class Touch:
    """One trial's striker and motion just before touch.

    Parameters
    ----------
    m, I
        Mass [kg] and moment of inertia about the centre, across the axis [kg m^2].
    c, s
        Arms of the contact point [m].
    vx, vy, spin
        Velocity of the centre of mass [m/s] (vy < 0) and angular velocity [rad/s].
    """

    m: float
    I: float  # noqa: E741 (the field's symbol)
    c: float
    s: float
    vx: float
    vy: float
    spin: float

    @property
    def mobility(self) -> Array:
        """M with (velocity change of the contact point) = M (impulse), shape (2, 2) [1/kg]."""
        xx = 1.0 / self.m + self.s**2 / self.I
        return np.array([[xx, self.across], [self.across, self.along]])

    @property
    def across(self) -> float:
        """M_xy [1/kg]."""
        return -self.c * self.s / self.I

    @property
    def along(self) -> float:
        """M_yy [1/kg]."""
        return 1.0 / self.m + self.c**2 / self.I

    @property
    def tip(self) -> tuple[float, float]:
        """Velocity of the contact point before, x and y [m/s]."""
        return self.vx + self.spin * self.s, self.vy - self.spin * self.c

    def after(self, impulse: Array | tuple[float, float]) -> Touch:
        """Return the motion after an impulse (P_x, P_y) [N s]; vy is then upward."""
        px, py = impulse
        return Touch(
            self.m, self.I, self.c, self.s, self.vx + px / self.m, self.vy + py / self.m,
            self.spin + (self.s * px - self.c * py) / self.I,
        )  # fmt: skip

    @property
    def energy(self) -> float:
        """Kinetic energy [J]."""
        return 0.5 * self.m * (self.vx**2 + self.vy**2) + 0.5 * self.I * self.spin**2

    def impulse(self, e: float, mu: float) -> tuple[float, float]:
        """Return the impulse that gives restitution `e` at the impulse ratio `mu`, x and y [N s].

        P_y = (1 + e) |v_y| / (M_yy + M_xy P_x / P_y), friction against the sliding of the tip
        (corrected Eqs. 5.5-5.8 of the thesis).
        """
        across, tip = self.across, self.tip
        # a tip that starts at rest slides the way the normal impulse pushes it
        slides = tip[0] if abs(tip[0]) > 1e-12 * abs(tip[1]) else across
        ratio = -math.copysign(mu, slides) if slides else 0.0
        py = (1.0 + e) * -tip[1] / (self.along + ratio * across)
        return ratio * py, py

    @property
    def stick_ratio(self) -> float:
        """Impulse ratio at which a tip that starts at rest would stick, c s / (I/m + s^2)."""
        return self.c * self.s / (self.I / self.m + self.s**2)


def touch(
    striker: StrikerTable, *, angle: float, normal: float, tangential: float, spin: float
) -> Touch:
    """Return the `Touch` of a striker; `angle` of the axis [rad], speeds [m/s, rad/s]."""
    half = striker.length / 2.0
    c, s = half * math.cos(angle), half * math.sin(angle) + striker.tip_radius_m.value
    if striker.shape == "sphere":
        c = 0.0
    # `normal` is the approach of the contact point, which a starting spin moves too
    return Touch(striker.mass_kg.value, striker.inertia, c, s, tangential, -normal + spin * c, spin)


def measured_after(before: Touch, impulse: Array | tuple[float, float]) -> dict[str, float]:
    """Return the observables that momentum fixes, under the names of their columns."""
    px, py = impulse
    found = before.after(impulse)
    return {
        "restitution": float(-found.tip[1] / before.tip[1]),
        "friction_impulse_ratio": abs(px) / py,
        "rebound_spin_rad_s": found.spin,
        "rebound_speed_m_s": found.vy,
        "tangential_rebound_m_s": found.vx,
    }


def momentum_misfit(
    striker: StrikerTable,
    before: Touch,
    angle: Quantity,
    speed: Quantity,
    measured: Mapping[str, Quantity],
) -> tuple[float, int]:
    """Return chi squared and degrees of freedom of the one impulse that fits a trial best.

    Parameters
    ----------
    striker
        The body.
    before
        Its motion just before touch.
    angle, speed
        Of the axis [rad] and of the normal approach [m/s]; both may move within their standard
        deviations.
    measured
        Observables of `FIXED_BY_MOMENTUM`; each beyond two is a test.

    Notes
    -----
    Unknown are the two components of the impulse; a part `MODEL_TOLERANCE` of the approach speed
    is added to every standard deviation.
    """
    names = list(measured)
    degrees = len(names) - 2
    if degrees < 1:
        return 0.0, 0
    unit = {name: _unit(name, speed.value, striker) for name in names}
    sigma = {n: math.hypot(measured[n].std, MODEL_TOLERANCE * unit[n]) for n in names}

    def residuals(x: Array) -> Array:
        stretch = 1.0 + x[2] * speed.relative
        moved = touch(
            striker,
            angle=angle.value + x[3] * angle.std,
            normal=speed.value * stretch,
            tangential=before.vx * stretch,
            spin=before.spin,
        )
        found = measured_after(moved, x[:2] * before.m * speed.value)
        return np.array([*((found[n] - measured[n].value) / sigma[n] for n in names), x[2], x[3]])

    e = measured["restitution"].value if "restitution" in measured else 0.5
    mu = measured.get("friction_impulse_ratio")
    best = math.inf
    for start_mu in (value_of(mu, 0.1), 0.3):
        start = np.array(before.impulse(e, start_mu)) / (before.m * speed.value)
        fit = least_squares(residuals, np.array([*start, 0.0, 0.0]), method="lm")
        best = min(best, 2.0 * float(fit.cost))
    return best, degrees


def _unit(name: str, speed: float, striker: StrikerTable) -> float:
    """What the model tolerance is a part of: 1, a speed, or a speed over an arm."""
    if name == "rebound_spin_rad_s":
        return speed / (striker.length / 2.0 or striker.tip_radius_m.value)
    return speed if name.endswith("_m_s") else 1.0
