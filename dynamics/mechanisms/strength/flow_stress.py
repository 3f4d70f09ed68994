"""What mechanisms of the flow stress share: a relative strength over the depth.

Each gives the metal's strength relative to the stated one; the law then answers for a pair of that
strength (`dynamics.strength`). The strain rate of an indentation is taken as 0.4 v/a, its
representative strain as 0.2 (a - a_c)/R, as the law of metals that harden has it.

D. Tabor, The Hardness of Metals (1951).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ....core.arrays import Array
from ....models import critical_depth
from ....models.hardening import REPRESENTATIVE, representative_strain
from ....models.rules import RULES as MODELS
from ...force import F_RADIUS
from ...scene import FlowStress, Scene
from ...strength import StrengthTable
from ..base import Mechanism, Situation, Surroundings, Values

RATE = 0.4
"""Strain rate of an indentation over v/a [-] (Tabor 1951)."""

STRAIN = REPRESENTATIVE  # of (a - a_c)/R

Relative = Callable[..., Array]
"""Strength over the stated one at the depths of a table, (nodes,): of scene, table and numbers."""


@dataclass(frozen=True, slots=True)
class StrengthProfile:
    """A relative strength over the depth, with its numbers in one impact."""

    of: Relative
    numbers: tuple[float, ...]
    falls: bool = False  # one over it, which falls where that rises and stays above 0

    def profile(self, scene: Scene, table: StrengthTable) -> Array:
        """Return relative strengths at the depths of `table`, shape (nodes,)."""
        found = self.of(scene, table, *self.numbers)
        return np.asarray(1.0 / found if self.falls else found)


class FlowMechanism(Mechanism):
    """A mechanism that changes the flow stress; subclasses say by what profile."""

    static = True
    falls: ClassVar[bool] = False
    relative: ClassVar[Relative]
    direction = {"restitution": 1, "permanent_depth_m": -1, "contact_time_s": -1, "peak_force_N": 1}

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a metal that yields."""
        if all(math.isinf(scene.pair.Sy_min) for scene, _ in situations):
            return "the bodies have no yield strength"
        return ""

    def strength(self, scene: Scene, values: Values, around: Surroundings) -> FlowStress:
        """Return the flow stress of this impact: `relative` of the parameters in their order."""
        numbers = tuple(values[p.name] for p in self.parameters)
        return StrengthProfile(self.relative, numbers, self.falls)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Multiply the flow stress that the scene has."""
        return scene.with_(flow=(*scene.flow, self.strength(scene, values, around)))


def strain(scene: Scene, table: StrengthTable, strength: Array | None = None) -> Array:
    """Representative plastic strain at the depths of a table, 0.2 (a - a_c)/R with a at most R.

    `scene`, `table`: the impact and the table of its contact; `strength`: relative strengths at the
    depths, which move the radius; none: as stated.
    """
    pair, radius = scene.pair, table.radius
    if strength is not None:
        radius = radius * table.factors(strength)[F_RADIUS]
    at_yield = math.sqrt(critical_depth(pair) / pair.R)
    return representative_strain(np.minimum(radius / pair.R, 1.0), at_yield)


def settled_strain(scene: Scene, table: StrengthTable, strength: Callable[[Array], Array]) -> Array:
    """Return the strain at which the contact has the radius that its strength there gives it."""
    p = strain(scene, table)
    for _ in range(MODELS.radius_rounds):
        p = strain(scene, table, strength(p))
    return p


class FallingStrength(FlowMechanism):
    """A flow stress that falls: physics that a verdict has no name for."""

    named = False
    direction = {"restitution": -1, "permanent_depth_m": 1, "peak_force_N": -1}
