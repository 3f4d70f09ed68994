"""From a checked set-up file to the scene of one law, without the mechanisms that it asks for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from ...core.approach import speeds_at_touch
from ...core.errors import InputError
from ...core.inputs.rig_numbers import RigNumbers
from ...models.base import ContactLaw
from ..beam import rod_modes
from ..scene import Approach, ForceTransform, Friction, Scene, Support
from ..support import half_space_radiation, plate_support, rod_support
from .bodies import bodies_of, flowing
from .second import second_of

if TYPE_CHECKING:
    from .setup import ImpactTable, SetupFile


def curves_in(found: SetupFile) -> list[str]:
    """Keys that give a body a flow curve."""
    return [
        f"{key}.{name}" for key, body in found.bodies.items()
        for name in ("flow_curve", "hardening") if getattr(body, name)
    ]  # fmt: skip


def scene_in(found: SetupFile, numbers: RigNumbers, law: ContactLaw, *, source: str) -> Scene:
    """Return the scene of one law."""
    impact, target, of = found.impact, found.target, numbers.of
    name = found.striker
    rod = found.strikers[name].shape == "rod"
    pair, striker = bodies_of(numbers, name, source=source)
    if target.law == "elastic" and curves_in(found):
        raise InputError(
            "a flow curve in an elastic baseline", source=source, key=curves_in(found)[0],
            allowed='left out with target.law = "elastic"',
        )  # fmt: skip
    if curves_in(found):
        ball, key = found.strikers[name], f"strikers.{name}"
        pair = replace(
            pair, sphere=flowing(pair.sphere, ball, key, source=source),
            flat=flowing(pair.flat, target, "target", source=source),
        )  # fmt: skip
    support, radiation = Support(), 0.0
    if impact.support == "sprung":
        support = Support(
            of["target.support_mass_kg"], of.get("target.support_stiffness_N_m", 0.0),
            impact.support_damping_N_s_m,
        )  # fmt: skip
    elif impact.support == "plate":
        support = plate_support(pair.flat, thickness=of["target.thickness_m"])
    elif impact.support == "rod":
        support = rod_support(pair.flat, radius=impact.support_radius_m)
    elif impact.support == "half-space":
        radiation = half_space_radiation(pair.flat)
    edge = striker.radius if impact.finite_tip and rod else math.inf
    try:
        modes = rod_modes(
            striker.length, striker.radius, pair.sphere, mass=striker.mass, count=impact.modes,
            loss_factor=impact.loss_factor,
        )  # fmt: skip
    except InputError as error:
        raise error.at(source, "impact.modes") from None
    scene = Scene(
        law, pair, striker, _approach(impact, of, rod=rod),
        gravity=of["gravity_m_s2"], friction=Friction(of.get("friction.coefficient", 0.0)),
        force=ForceTransform(radiation=radiation, edge=edge), modes=modes, support=support,
    )  # fmt: skip
    second = second_of(numbers)
    try:
        return scene if second is None else second.facing(scene)
    except InputError as error:
        raise error.at(source, error.key) from None


def _approach(impact: ImpactTable, of: Mapping[str, float], *, rod: bool) -> Approach:
    """The motion at touch; a sphere's angle is that of its velocity, a rod's that of its axis."""
    angle = math.radians(impact.angle_deg)
    normal, along = speeds_at_touch(
        of.get("impact.impact_speed_m_s", math.nan), of.get("impact.drop_height_m", math.nan),
        angle, rod, gravity=of["gravity_m_s2"],
    )  # fmt: skip
    return Approach(
        float(normal), angle if rod else math.pi / 2.0,
        of.get("impact.approach_tangential_m_s", float(along)), of["impact.approach_spin_rad_s"],
    )  # fmt: skip
