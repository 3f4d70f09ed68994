"""Waves carry energy off into the flat, a half-space or a plate."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

from ...core.material import Material
from ..rules import RULES
from ..scene import Scene
from ..support import half_space_radiation, plate_support
from .arithmetic import contact_time, density_of
from .base import Literature, Mechanism, Parameter, Situation, Surroundings, Values


class HalfSpaceWaves(Mechanism):
    """Waves carry energy off into the flat: a half-space, or a plate that bends as well (Zener).

    A plate of any thickness takes what a half-space does, and what bends it as far as that comes
    back within the contact. An explicit elastic solution (tools/benchmarks/wave_plate.py) loses
    within 10 % of this from 3 to 100 mm.
    """

    name = "half-space-waves"
    title = "waves carry energy off into the flat"
    equations = (
        "F + kappa (dF/dd)^2 d', and of a plate w' = s F/(8 sqrt(rho h D)), s from 1 to 0 as a "
        "wave there and back takes the whole contact"
    )
    parameters = (
        Parameter(
            "wave_scale", "-", 0.4, 2.0, "log", 0.0,
            "1 is the theory (Hunter 1957, Zener 1941); edges and finite contacts move it",
            literature=Literature(1.0, "the theory: Zener 1941, Hunter 1957"),
        ),
    )  # fmt: skip
    direction = {"restitution": -1}
    rests_on = ("target", "striker")

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a flat."""
        if situations[0][1].struck is not None:
            return "a second sphere is struck, and no half-space or plate that waves run off into"
        return ""

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the rigid half-space."""
        scale, flat = values["wave_scale"], scene.pair.flat
        if flat.rigid:
            return scene
        flat = replace(flat, density=density_of(flat))
        # kappa goes with density^(1/2)/E^(3/2); the integral over the waves knows nu only
        one = _unit_radiation(flat.nu) * math.sqrt(flat.density) / flat.E**1.5
        kappa = scene.force.radiation + scale * one
        found = scene.with_(force=replace(scene.force, radiation=kappa))
        if not around.thickness > 0.0 or math.isfinite(scene.support.mass):
            return found  # a half-space, or what moves as a block
        bending = plate_support(flat, thickness=around.thickness).plate_mobility
        mobility = scene.support.plate_mobility
        mobility += scale * bending * _returned(scene, flat, around.thickness)
        return found.with_(support=replace(scene.support, plate_mobility=mobility))


def _returned(scene: Scene, flat: Material, thickness: float) -> float:
    """Share of a thin plate's motion that comes back from its lower face within this contact.

    That of a half-sine of force with itself, later by the way there and back over the contact time;
    up to a share `wave_back` of it the plate moves as a whole.
    """
    fast = math.sqrt(
        (1.0 - flat.nu) / ((1.0 + flat.nu) * (1.0 - 2.0 * flat.nu)) * flat.E / flat.density
    )
    way = 2.0 * thickness / (fast * contact_time(scene))
    late = (way - RULES.wave_back) / (1.0 - RULES.wave_back)
    late = min(max(late, 0.0), 1.0)
    return (1.0 - late) * math.cos(math.pi * late) + math.sin(math.pi * late) / math.pi


@lru_cache(maxsize=256)
def _unit_radiation(nu: float) -> float:
    return half_space_radiation(Material(E=1.0, nu=nu, density=1.0))
