"""Whether markers show one rigid body that falls freely, and what it means where they hardly do."""

from __future__ import annotations

import math

from ..gates import Refused
from ..measured import Measured
from ..rules import RULES
from .body import Body
from .flight import Flights
from .rigid import Poses


def check_fall(fall: Measured, gravity: float, source: str) -> None:
    """Refuse what does not fall as gravity asks, both [m/s²], by more than drag and buoyancy make.

    It is carried, it walks, or unit, rate or up are wrong.
    """
    if abs(fall.value - gravity) > max(RULES.fall_off * gravity, 3.0 * fall.std):
        raise Refused(
            f"between its contacts the body falls with {fall} m/s2", source=source,
            key="gravity_m_s2", allowed=f"about {gravity:g}: a body in free flight (check unit, "
            "frame_rate_hz and up)",
        )  # fmt: skip


def check_shape(poses: Poses, source: str) -> None:
    """Refuse markers that lie too far off one shape: they are no rigid body."""
    if poses.spread > RULES.not_rigid * poses.extent:
        raise Refused(
            f"the markers lie {1e3 * poses.spread:.3g} mm off one rigid shape of "
            f"{1e3 * poses.extent:.3g} mm", source=source, key="markers",
            allowed=f"markers of one rigid body: up to {RULES.not_rigid:.0%} off",
        )  # fmt: skip


def possible(restitution: Measured, body: Body) -> bool:
    """Whether an impact can have a restitution; spin and friction may lift that of a rod's tip."""
    most = RULES.by_chance * restitution.std
    return restitution.value > -most and (body.shape == "rod" or restitution.value < 1.0 + most)


def widened(
    measured: dict[str, Measured], poses: Poses, flights: Flights, fall: Measured, gravity: float
) -> dict[str, Measured]:
    """Return the numbers of an impact with errors that hold what its own checks say.

    A fall that is not that of gravity means lengths or times that are as wrong; markers that lie
    farther off their shape than off their motion move the body as a whole; a spin that changes by
    something else than the momentum at the contact is as wrong; an impulse out of the plane of
    motion is friction too.
    """
    loose = max(poses.spread / max(2.0 * flights.sigma, 1e-12), 1.0)
    off = abs(fall.value / gravity - 1.0)
    off = off if off * gravity > 3.0 * fall.std else 0.0
    found = {}
    for name, value in measured.items():
        more = off * abs(value.value) if name.endswith("_m_s") else 0.0
        found[name] = Measured(value.value, loose * value.std).widened(more)
    if "spin_change_by_momentum_rad_s" in found:
        spin, asked = found["rebound_spin_rad_s"], found["spin_change_by_momentum_rad_s"]
        apart = spin.minus(found["approach_spin_rad_s"]).minus(asked)
        if abs(apart.value) > 3.0 * apart.std:
            found["rebound_spin_rad_s"] = spin.widened(apart.value)
    friction, out = found["friction_impulse_ratio"], found["out_of_plane_ratio"]
    beside = math.hypot(friction.value, out.value) - friction.value
    found["friction_impulse_ratio"] = friction.widened(beside)
    return found
