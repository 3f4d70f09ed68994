"""Waves carry energy off into the flat, a half-space or a plate."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import ClassVar

from ...core.material import Material
from ..scene import Scene
from ..support import half_space_radiation, plate_support
from .arithmetic import density_of, shortest_contact, wave_speed
from .base import Literature, Mechanism, Parameter, Situation, Surroundings, Values


class HalfSpaceWaves(Mechanism):
    """Waves carry energy off into the flat: a half-space, or a plate that bends (Zener)."""

    name = "half-space-waves"
    title = "waves carry energy off into the flat"
    equations = (
        "half-space: F + kappa (dF/dd)^2 d'; plate: w' = s F/(8 sqrt(rho h D)) while h is crossed "
        "many times within the contact"
    )
    parameters = (
        Parameter(
            "wave_scale", "-", 0.4, 2.0, "log", 0.0,
            "1 is the theory (Hunter 1957, Zener 1941); edges and finite contacts move it",
            literature=Literature(1.0, "the theory: Zener 1941, Hunter 1957"),
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {"restitution": -1}
    rests_on: ClassVar[tuple[str, ...]] = ("target", "striker")

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
        flat = flat.with_(density=density_of(flat))
        if _is_plate(scene, around):
            plate = plate_support(flat, thickness=around.thickness)
            mobility = scene.support.plate_mobility + scale * plate.plate_mobility
            return scene.with_(support=replace(scene.support, plate_mobility=mobility))
        # kappa goes with density^(1/2)/E^(3/2); the integral over the waves knows nu only
        one = _unit_radiation(flat.nu) * math.sqrt(flat.density) / flat.E**1.5
        kappa = scene.force.radiation + scale * one
        return scene.with_(force=replace(scene.force, radiation=kappa))


def _is_plate(scene: Scene, around: Surroundings) -> bool:
    """Whether waves cross the thickness at least twice there and back within the contact."""
    if not around.thickness > 0.0:
        return False
    crossed = wave_speed(scene.pair.flat) * shortest_contact(scene)
    return 4.0 * around.thickness < crossed


@lru_cache(maxsize=256)
def _unit_radiation(nu: float) -> float:
    return half_space_radiation(Material(E=1.0, nu=nu, density=1.0))
