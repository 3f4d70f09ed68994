"""From a rig's file to what mechanisms may know of it besides the scene."""

from __future__ import annotations

import math

from ...core.inputs.flow_curve import Rise
from ...core.inputs.second_sphere import struck_sphere
from ...core.rig import Rig, value_of
from .base import Surroundings


def weaker_table(rig: Rig, striker: str) -> str:
    """Return the table of the body that yields first; the flat's where neither does."""
    target, ball = rig.target, rig.strikers[striker]
    flat, tip = (value_of(body.strength, math.inf) for body in (target, ball))
    return "target" if flat <= tip else f"strikers.{striker}"


def surroundings_of(
    rig: Rig, striker: str, *, temperature: float, from_height: bool, height_share: float,
    rises: tuple[Rise, ...] = (),
) -> Surroundings:  # fmt: skip
    """Return what a rig says around the impacts of one striker.

    `temperature`: of the bodies [K]; nan where it is that of the surroundings; `from_height`,
    `height_share`, `rises`: as in `Surroundings`.
    """
    target, ball, air = rig.target, rig.strikers[striker], rig.environment
    strikers = rig.strikers.values()
    weaker = rig.bodies[weaker_table(rig, striker)]
    rough = [q.value for q in (target.Ra_m, ball.Ra_m) if q is not None]
    ambient = value_of(air.temperature_K, Surroundings().ambient)
    return Surroundings(
        thickness=value_of(target.thickness_m),
        support_mass=value_of(target.support_mass_kg),
        support_stiffness=value_of(target.support_stiffness_N_m),
        roughness=math.hypot(*rough) if rough else math.nan,
        viscosity=value_of(air.viscosity_Pa_s),
        density=value_of(air.density_kg_m3),
        pressure=value_of(air.pressure_Pa),
        fluid=air.fluid,
        heat_capacity=value_of(weaker.cp_J_kgK),
        melting=value_of(weaker.melting_K),
        temperature=ambient if math.isnan(temperature) else temperature,
        ambient=ambient,
        layer_thickness=value_of(target.layer_thickness_m),
        moduli_stated=None not in (target.E_Pa, ball.E_Pa),
        from_height=from_height,
        height_share=height_share,
        mass_share=min(s.mass_kg.value for s in strikers) / ball.mass_kg.value,
        tip_share=min(s.tip_radius_m.value for s in strikers) / ball.tip_radius_m.value,
        rises=rises,
        struck=struck_sphere(target),
    )
