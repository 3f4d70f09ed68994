"""Chapter 5's inverse: duration and mean force of an oblique impact from what it left behind.

The printed equations 5.5-5.12 are damaged; these are the exact rigid-body relations (see
docs/impact-method.md). They hold for one contact, during which the tip slides to -x throughout
under a constant friction coefficient, at an angle that does not change.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..core.errors import InputError
from ..core.unstated import unstated_equal
from .scene import Striker


@dataclass(frozen=True, slots=True)
class Mobility:
    """Inverse effective masses of the contact point [1/kg].

    v_T = v_i + M P with M_xx = 1/m + s^2/I, M_xy = -c s/I, M_yy = 1/m + c^2/I.
    """

    xx: float
    xy: float
    yy: float

    @property
    def stick_friction(self) -> float:
        """Friction coefficient from which the tip sticks, c s / (I/m + s^2)."""
        return -self.xy / self.xx

    def tangential(self, mu: float) -> float:
        """A of v_Tx = A P_y with the tip sliding to -x; negative while it does [1/kg]."""
        return mu * self.xx + self.xy

    def normal(self, mu: float) -> float:
        """B of v_Ty = v_i + B P_y with the tip sliding to -x [1/kg]."""
        return self.yy + mu * self.xy


def mobility(striker: Striker, angle: float) -> Mobility:
    """Return the contact point's mobility for a rod at `angle` [rad] to the flat (5.1-5.8)."""
    c, s = striker.arm(angle)
    m, inertia = striker.mass, striker.inertia
    return Mobility(1.0 / m + s * s / inertia, -c * s / inertia, 1.0 / m + c * c / inertia)


def alpha(striker: Striker, angle: float, *, mu: float) -> float:
    """Sliding per normal travel, alpha = A / B (corrected 5.12); positive means the tip sticks.

    Examples
    --------
    >>> rod = Striker(mass=0.4607, tip_radius=0.0088, length=0.3048, inertia=0.4607*0.3048**2/12)
    >>> round(alpha(rod, math.radians(45), mu=0.13), 4)
    -0.5523
    """
    found = mobility(striker, angle)
    return found.tangential(mu) / found.normal(mu)


@unstated_equal
@dataclass(frozen=True, slots=True)
class MeasuredScar:
    """What an oblique impact left behind; depth, sliding length and speeds positive, SI."""

    angle: float
    speed: float
    mu: float
    restitution: float
    depth: float
    sliding: float
    rebound: float = math.nan

    def __post_init__(self) -> None:
        if not 0.0 < self.angle < math.pi / 2.0:
            raise InputError(
                f"{math.degrees(self.angle):g}", key="angle_deg", allowed="above 0, below 90"
            )
        for key in ("speed", "depth", "sliding"):
            if not (getattr(self, key) > 0.0 and math.isfinite(getattr(self, key))):
                raise InputError(f"{getattr(self, key):g}", key=key, allowed="a number above 0")
        if not self.mu >= 0.0:
            raise InputError(f"{self.mu:g}", key="friction", allowed="0 or more")


@dataclass(frozen=True, slots=True)
class Inferred:
    """Duration and mean force at both end instants, and what speaks against them.

    `duration` ends with the tip at depth delta_p (last separation); `return_duration` when it is
    back at the undisturbed surface, at the speed with which it parted; nan where it stays.
    """

    alpha: float
    impulse: float
    duration: float
    mean_force: float
    return_duration: float
    return_force: float
    objections: tuple[str, ...]


INFERRED = ("alpha", "impulse", "duration", "mean_force", "return_duration", "return_force")
"""The numbers of `Inferred`."""


def infer(striker: Striker, measured: MeasuredScar) -> Inferred:
    """Mean force and duration from depth, sliding length and restitution (corrected 5.11, 5.14).

    x_T(T) = alpha (delta_p - v_i T) with x_T = -L_s gives T; P_y = (1 + e) abs(v_i) / B and F T =
    P_y give the mean force (gravity's share of the impulse is left out, as in 5.14). Refused where
    the tip would stick at this friction coefficient, so that it cannot have slid, or an inertia
    leaves no finite number.
    """
    found = mobility(striker, measured.angle)
    a, b = found.tangential(measured.mu), found.normal(measured.mu)
    if not a < 0.0:
        raise InputError(
            f"{measured.mu:g} makes the tip stick, and no sliding length follows",
            key="friction",
            allowed=f"below {found.stick_friction:.3g} at {math.degrees(measured.angle):g} degrees",
        )
    if not b > 0.0:
        raise InputError(f"{measured.mu:g} jams the rod", key="friction", allowed="a lower value")
    ratio = a / b
    impulse = (1.0 + measured.restitution) * measured.speed / b
    slid = measured.sliding / -ratio if ratio else math.nan
    duration = (slid + measured.depth) / measured.speed
    left = measured.restitution * measured.speed
    back = duration + measured.depth / left if left > 0.0 else math.nan
    # sizes and masses of 1e-300 leave nothing to divide by
    if not (slid > 0.0 and math.isfinite(duration) and 0.0 < impulse < math.inf):
        raise InputError(
            "no duration and force can be worked out", key="inertia_kg_m2",
            allowed="an inertia near m (L^2/12 + r^2/4)",
        )  # fmt: skip
    return Inferred(
        ratio, impulse, duration, impulse / duration, back, impulse / back,
        _objections(striker, measured, duration, impulse),
    )  # fmt: skip


def _objections(
    striker: Striker, measured: MeasuredScar, duration: float, impulse: float
) -> tuple[str, ...]:
    """Check the assumptions against the inputs; each failure is one line with its number."""
    found = []
    if math.isfinite(measured.rebound):
        implied = measured.rebound / measured.speed
        if abs(implied - measured.restitution) > 0.01:
            found.append(
                f"restitution {measured.restitution:g} is not rebound over approach ({implied:.3f})"
            )
    if measured.depth > striker.tip_radius:
        found.append(f"a depth of {measured.depth:g} m is above the tip's radius")
    if measured.restitution > 1.0:
        found.append(f"restitution {measured.restitution:g}: more comes back than came")
    mean = 0.5 * measured.speed * (1.0 - measured.restitution)
    travel = abs(mean) * duration
    longest = 6.0 * measured.depth / (measured.speed * (1.0 + measured.restitution))
    if duration > 10.0 * longest:
        found.append(
            f"{duration * 1e3:.3g} ms is {duration / longest:.0f} times what one contact over "
            f"three dent depths takes ({longest * 1e3:.2g} ms): more than one contact, or a "
            "rod that is not rigid"
        )
    elif duration < (least := 1.47 * measured.depth / measured.speed):
        found.append(
            f"{duration * 1e6:.3g} us is less than the way into such a dent takes alone, "
            f"{least * 1e6:.3g} us (by a force between depth and depth^(3/2)): sliding_length_m is "
            "not the path of the touching point"
        )
    elif travel > 3.0 * measured.depth:
        found.append(
            f"mean velocity {mean:.2g} m/s over {duration * 1e3:.3g} ms moves the tip by "
            f"{travel * 1e6:.0f} um, {travel / measured.depth:.1f} times the dent"
        )
    if striker.length > 0.0:
        period = _bending_period(striker)
        if math.isfinite(period) and duration < 3.0 * period:
            found.append(
                f"the first bending period of such a steel rod is {period * 1e3:.2g} ms: not "
                f"short against {duration * 1e3:.3g} ms, the rod is not rigid"
            )
    turned = impulse * striker.arm(measured.angle)[0] / striker.inertia * duration
    if turned > math.radians(1.0):
        found.append(
            f"the rod turns by {math.degrees(turned):.1f} degrees meanwhile: the angle is not "
            "constant"
        )
    return tuple(found)


def _bending_period(striker: Striker) -> float:
    """First free-free bending period of a slender steel rod [s] (c = 5060 m/s)."""
    if not striker.radius < 0.25 * striker.length:
        return math.nan
    return 2.0 * math.pi * striker.length**2 / (22.373 * 5060.0 * 0.5 * striker.radius)
