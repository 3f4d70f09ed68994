"""From a rig to the bodies of a scene: the one way from an input file to what is simulated."""

from __future__ import annotations

import math

from ...core.errors import InputError
from ...core.flow import Flow
from ...core.inputs.flow_curve import read_flow_curve
from ...core.inputs.flow_tables import HardeningTable
from ...core.inputs.input_file import file_beside
from ...core.inputs.rig_numbers import RigNumbers
from ...core.material import Material, Pair
from ...core.rig import BodyTable
from ..rules import RULES
from ..scene import Striker


def bodies_of(rig: RigNumbers, name: str, *, source: str = "") -> tuple[Pair, Striker]:
    """Return pair and striker of a rig; refused without a modulus or Poisson's ratio of a body."""
    of, key = rig.of, f"strikers.{name}"
    body, flat = (rig.material(table, source=source) for table in (key, "target"))
    if body.rigid and flat.rigid:
        raise InputError(
            "given beside a rigid striker", source=source, key="target.rigid",
            allowed="at most one rigid body",
        )  # fmt: skip
    striker = Striker(
        mass=of[f"{key}.mass_kg"], tip_radius=of[f"{key}.tip_radius_m"],
        length=of[f"{key}.length_m"], radius=of[f"{key}.radius_m"],
        inertia=of[f"{key}.inertia_kg_m2"], tip_flat_radius=of.get(f"{key}.tip_flat_radius_m", 0.0),
        name=name,
    )  # fmt: skip
    return Pair(body, flat, striker.tip_radius), striker


def flowing(metal: Material, table: BodyTable, key: str, *, source: str) -> Material:
    """Return a body with the flow curve that its table names or whose law it states.

    A curve without a stated strength is taken as it is. Beside one it is scaled to reach it at a
    plastic strain of 0.2 %, as in a recording set, unless it begins at it. A law begins at it.
    Refused where both are given, the strength of a law is missing, or the body cannot flow.
    """
    law: HardeningTable | None = getattr(table, "hardening", None)
    if not table.flow_curve and law is None:
        return metal
    named = "flow_curve" if table.flow_curve else "hardening"
    if metal.rigid:
        raise InputError(
            "a rigid body does not flow", source=source, key=f"{key}.{named}", allowed="left out"
        )
    if table.flow_curve and law is not None:
        raise InputError(
            "given beside flow_curve", source=source, key=f"{key}.hardening",
            allowed="one of the two",
        )  # fmt: skip
    if law is not None:
        if math.isinf(metal.Sy):
            raise InputError(
                "missing", source=source, key=f"{key}.Sy_Pa", allowed="a number above 0"
            )
        curve = law.curve(metal.Sy, key=f"{key}.hardening", source=source)
        return metal.with_(flow=Flow(curve))
    measured = read_flow_curve(file_beside(source, table.flow_curve, key=f"{key}.flow_curve"))
    own = measured.strength
    first = measured.curve(own).strength
    stated = math.isfinite(metal.Sy) and abs(metal.Sy / first - 1.0) > RULES.same_strength
    curve = measured.curve(metal.Sy if stated else own)
    return metal.with_(Sy=curve.strength, flow=Flow(curve))
