"""From a rig to the bodies of a scene: the one way from an input file to what is simulated."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

from ...core.errors import InputError
from ...core.flow import Flow
from ...core.inputs.flow_curve import read_flow_curve
from ...core.inputs.flow_tables import HardeningTable
from ...core.material import Material, Pair
from ...core.rig import BodyTable, Rig, StrikerTable, value_of
from ..scene import Striker

_SAME = 1e-3  # between a stated strength and a curve's first stress, that is then the strength


def bodies_of(
    rig: Rig, name: str, *, source: str = "", values: Mapping[str, float] | None = None,
    E: float | None = None, nu: float | None = None,
) -> tuple[Pair, Striker]:  # fmt: skip
    """Return pair and striker of a rig.

    Parameters
    ----------
    rig, name
        The rig and one of its strikers.
    source
        File that an error names.
    values
        Numbers that replace stated ones, by key, for example `strikers.ball.mass_kg`.
    E, nu
        What to take where the rig says nothing [Pa, -].

    Raises
    ------
    InputError
        A modulus or Poisson's ratio is missing, and nothing stands in for it.
    """
    table, key = rig.strikers[name], f"strikers.{name}"
    body = table.to_material(key, source=source, values=values, E=E, nu=nu)
    flat = rig.target.to_material("target", source=source, values=values, E=E, nu=nu)
    striker = striker_of(table, name, values)
    return Pair(body, flat, striker.tip_radius), striker


def striker_of(
    table: StrikerTable, name: str, values: Mapping[str, float] | None = None
) -> Striker:
    """Return the rigid body of a striker; a mass among `values` scales the inertia with it."""
    values, stated = values or {}, table.mass_kg.value
    mass = values.get(f"strikers.{name}.mass_kg")
    return Striker(
        mass=stated if mass is None else mass,
        tip_radius=values.get(f"strikers.{name}.tip_radius_m", table.tip_radius_m.value),
        length=table.length,
        radius=table.body_radius,
        inertia=table.inertia if mass is None else table.inertia * mass / stated,
        tip_flat_radius=value_of(table.tip_flat_radius_m, 0.0),
        name=name,
    )


def flowing(metal: Material, table: BodyTable, key: str, *, source: str) -> Material:
    """Return a body with the flow curve that its table names or whose law it states.

    A curve without a stated strength is taken as it is. Beside one it is scaled to reach it at a
    plastic strain of 0.2 %, as in a recording set, unless it begins at it. A law begins at it.

    Raises
    ------
    InputError
        Both are given, the strength of a law is missing, or the body cannot flow.
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
    measured = read_flow_curve(Path(source).parent / table.flow_curve)
    own = measured.strength
    first = measured.curve(own).strength
    stated = math.isfinite(metal.Sy) and abs(metal.Sy / first - 1.0) > _SAME
    curve = measured.curve(metal.Sy if stated else own)
    return metal.with_(Sy=curve.strength, flow=Flow(curve))
