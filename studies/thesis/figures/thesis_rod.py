"""The rod of chapters 4 and 5 above the thesis's flat."""

from __future__ import annotations

import math

from ....core.inputs.toml_input import read_toml
from ....core.material import Material
from ....dynamics.scene import Approach, Friction, Scene, scene_of
from ....models.base import ContactLaw
from .. import chapter5
from ..chapter3 import REFERENCE


def scene_at(law: ContactLaw, degrees: float, speed: float, mu: float) -> Scene:
    """Return the impact at an angle to the flat, a speed [m/s] and a friction coefficient."""
    data = read_toml(REFERENCE / "chapter45.toml")
    rod, flat = (
        Material(b["E_Pa"], b["nu"], b["Sy_Pa"], density=b["density_kg_m3"])
        for b in (data["rod"], data["flat"])
    )
    return scene_of(
        law, sphere=rod, flat=flat, striker=chapter5.thesis_rod(),
        approach=Approach(speed, math.radians(degrees)), friction=Friction(mu),
    )  # fmt: skip
