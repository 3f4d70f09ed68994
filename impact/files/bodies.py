"""From a rig to the bodies of a scene: the one way from an input file to what is simulated."""

from __future__ import annotations

from collections.abc import Mapping

from ...core.material import Pair
from ...core.rig import Rig, StrikerTable, value_of
from ..scene import Striker


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
