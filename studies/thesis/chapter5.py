"""Chapter 5: the thesis's oblique rows, and our own rigid impacts beside them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ...core.inputs.toml_input import read_toml
from ...core.material import Material
from ...dynamics.files.inverse_file import InverseRow
from ...dynamics.integrate import strike
from ...dynamics.inverse import MeasuredScar, infer
from ...dynamics.result import Impact
from ...dynamics.scene import Approach, Friction, Instrument, Scene, Striker, scene_of
from ...models.base import ContactLaw
from .chapter3 import REFERENCE

PROFILOMETER = Instrument(scan_step=3e-6, scan_height=0.4e-6)
"""How the thesis read its scars: the step of 5.2, down to the roughness of its flats (3.2)."""


def thesis_rod(*, mass: float | None = None) -> Striker:
    """Return chapter 5's rod; its inertia is m L^2 / 12 as in the thesis."""
    rod = read_toml(REFERENCE / "chapter45.toml")["rod"]
    m = mass or rod["mass_kg"]
    return Striker(
        mass=m, tip_radius=rod["radius_m"], length=rod["length_m"], radius=rod["radius_m"],
        inertia=m * rod["length_m"] ** 2 / 12.0, name=rod["material"],
    )  # fmt: skip


def thesis_rows(*, mass: float | None = None) -> tuple[Striker, list[InverseRow]]:
    """Infer chapter 5's three experiments from their measured values."""
    rod = thesis_rod(mass=mass)
    rows = []
    for e in read_toml(REFERENCE / "chapter45.toml")["experiment"]:
        measured = MeasuredScar(
            math.radians(e["angle_deg"]), -e["approach_m_s"], e["friction"], e["restitution"],
            -e["depth_m"], -e["sliding_m"], e["rebound_m_s"],
        )  # fmt: skip
        rows.append(InverseRow(f"{e['angle_deg']} degrees", measured, infer(rod, measured)))
    return rod, rows


def scene_at(
    law: ContactLaw, degrees: float, speed: float, mu: float, *, mass: float | None = None
) -> Scene:
    """Return the rod's impact at an angle to the flat, a speed [m/s] and a friction coefficient."""
    data = read_toml(REFERENCE / "chapter45.toml")
    rod, flat = (
        Material(b["E_Pa"], b["nu"], b["Sy_Pa"], density=b["density_kg_m3"])
        for b in (data["rod"], data["flat"])
    )
    return scene_of(
        law, sphere=rod, flat=flat, striker=thesis_rod(mass=mass),
        approach=Approach(speed, math.radians(degrees)), friction=Friction(mu),
    )  # fmt: skip


def simulate_experiment(experiment: Mapping[str, Any], law: ContactLaw, *, mass: float) -> Impact:
    """Simulate one row of tables 5.2-5.4 with the rigid rod of the given mass."""
    speed, mu = -experiment["approach_m_s"], experiment["friction"]
    scene = scene_at(law, experiment["angle_deg"], speed, mu, mass=mass)
    return strike(scene.with_(instrument=PROFILOMETER))
