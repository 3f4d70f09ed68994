"""Small tips meet a harder metal."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ....core.arrays import Array
from ...rules import RULES
from ...scene import Scene
from ...strength import StrengthTable, strength_table
from ..arithmetic import deepest
from ..base import Parameter, Situation
from .flow_stress import FlowMechanism


def _sized(scene: Scene, table: StrengthTable, length: float) -> Array:
    """sqrt(1 + R*/R), the same at every depth."""
    return np.full(table.depth.shape, math.sqrt(1.0 + length / scene.pair.R))


class SizeEffect(FlowMechanism):
    """Smaller spheres meet a harder metal (geometrically necessary dislocations)."""

    name = "size-effect"
    title = "small tips meet a harder metal"
    equations = "S = S_y sqrt(1 + R*/R)"
    parameters = (
        Parameter(
            "size_length_m", "m", 1e-6, 3e-4, "log", 0.0,
            "Swadener, George and Pharr, J. Mech. Phys. Solids 50 (2002) 681: some tens of um for "
            "annealed iridium, less for stronger metals; up to ten times that",
        ),
    )  # fmt: skip
    relative = staticmethod(_sized)

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a metal that yields, tips of different radius, and small contacts."""
        if reason := super().applies(situations):
            return reason
        radii = [scene.pair.R for scene, _ in situations]
        if max(radii) < 1.3 * min(radii):
            return (
                "all tips have nearly one radius: a size effect is then the same as another "
                "yield strength"
            )
        contacts = [_contact(scene) for scene, _ in situations]
        if min(contacts) > RULES.size_largest:
            return (
                f"the smallest contact has a radius of {1e6 * min(contacts):.0f} um: the effect is "
                "that of tens of um"
            )
        return ""

    def idle(self, situations: Sequence[Situation]) -> str:
        """One radius is enough to be told of."""
        return super().applies(situations)


def _contact(scene: Scene) -> float:
    """Largest radius of the contact [m]."""
    table = strength_table(scene.law, scene.pair)
    return float(np.interp(math.log(deepest(scene)), table.log_depth, table.radius))
