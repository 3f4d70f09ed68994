"""Chapter 3 again: the thesis's upright rod dropped on the thesis's flat, with our laws."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.inputs.toml_input import read_toml
from ...core.material import Material, Pair
from ...dynamics.integrate import strike
from ...dynamics.result import Impact
from ...dynamics.scene import Approach, Scene, Striker
from ...models.base import ContactLaw

REFERENCE = Path(__file__).resolve().parents[2] / "data" / "reference"


@dataclass(frozen=True, slots=True)
class Bench:
    """The rod, the flat and the measured values of chapter 3."""

    sphere: Material
    flat: Material
    striker: Striker
    mass_that_fits: float
    heights: tuple[float, float]
    measured: tuple[Mapping[str, Any], ...]

    def scene(self, law: ContactLaw, *, height: float, mass: float) -> Scene:
        """Return the drop from `height` [m] with the rod's mass replaced [kg]."""
        rod = replace(self.striker, mass=mass, inertia=math.nan)  # that of its shape
        return Scene(law, self.pair, rod, Approach.dropped(height))

    @property
    def pair(self) -> Pair:
        """Rod and flat."""
        return Pair(self.sphere, self.flat, self.striker.tip_radius)


@dataclass(frozen=True, slots=True)
class Curve:
    """Impacts of one law and one mass over the drop heights."""

    law: ContactLaw
    mass: float
    heights: Array
    impacts: tuple[Impact, ...]


def bench() -> Bench:
    """Read chapter 3's inputs and measured values."""
    data = read_toml(REFERENCE / "chapter3.toml")
    rod, flat, nu = data["rod"], data["flat"], data["assumed"]["nu"]
    density = data["assumed"]["steel_density_kg_m3"]
    return Bench(
        Material(rod["E_Pa"], nu, rod["Sy_Pa"], density=density, name=rod["material"]),
        Material(flat["E_Pa"], nu, flat["Sy_Pa"], density=density, name=flat["material"]),
        Striker(
            mass=rod["mass_kg"],
            tip_radius=rod["tip_radius_m"],
            length=rod["length_m"],
            radius=0.5 * rod["diameter_m"],
        ),
        data["mass_that_fits"]["value_kg"],
        (data["heights"]["first_m"], data["heights"]["last_m"]),
        tuple(data["measured"]),
    )


def curves(
    found: Bench, laws: Sequence[ContactLaw], *, masses: Sequence[float], count: int = 9
) -> list[Curve]:
    """Drop the rod from `count` heights for each law and each mass."""
    measured = [row["drop_height_m"] for row in found.measured]
    heights = np.unique([*np.linspace(*found.heights, count), *measured])

    def along(law: ContactLaw, mass: float) -> tuple[Impact, ...]:
        return tuple(strike(found.scene(law, height=float(h), mass=mass)) for h in heights)

    return [Curve(law, mass, heights, along(law, mass)) for mass in masses for law in laws]


def deviation(curve: Curve, measured: Mapping[str, Any]) -> tuple[float, float]:
    """Return our value at a measured height and its relative deviation."""
    place = int(np.argmin(np.abs(curve.heights - measured["drop_height_m"])))
    impact = curve.impacts[place]
    ours = impact.restitution if measured["observable"] == "restitution" else impact.residual_flat_m
    return ours, ours / measured["value"] - 1.0
