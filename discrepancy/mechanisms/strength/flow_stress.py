"""What mechanisms of the flow stress share: a relative strength over the depth.

Each gives the metal's strength relative to the stated one; the law then answers for a pair of that
strength (`impact.strength`). The strain rate of an indentation is taken as 0.4 v/a and its
representative strain as 0.2 a/R (Tabor, The Hardness of Metals, 1951).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ....core.material import Pair
from ....impact import Profiles, RateFree, Scene
from ....impact.scene import FlowStress
from ....impact.strength import StrengthTable
from ..base import Array, Mechanism, Situation, Surroundings, Values

RATE, STRAIN = 0.4, 0.2  # of v/a, and of a/R


class StrengthProfile(ABC):
    """A strength that follows the depth: the stated pair, and a factor at each depth."""

    __slots__ = ()

    def strengthened(self, scene: Scene) -> Pair:
        """Return the pair as stated."""
        return scene.pair

    @abstractmethod
    def profile(self, scene: Scene, table: StrengthTable) -> Array:
        """Return relative strengths at the depths of `table`, shape (nodes,)."""


@dataclass(frozen=True, slots=True)
class Fallen(StrengthProfile):
    """One over another profile: a strength that falls where that one rises, and stays above 0."""

    risen: StrengthProfile

    def profile(self, scene: Scene, table: StrengthTable) -> Array:
        """Return relative strengths at the depths of `table`, shape (nodes,)."""
        return np.asarray(1.0 / self.risen.profile(scene, table))


class FlowMechanism(Mechanism):
    """A mechanism that changes the flow stress; subclasses say by what profile."""

    static: ClassVar[bool] = True
    direction: ClassVar[Mapping[str, int]] = {
        "restitution": 1, "permanent_depth_m": -1, "contact_time_s": -1, "peak_force_N": 1,
    }  # fmt: skip

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a metal that yields."""
        if all(math.isinf(scene.pair.Sy_min) for scene, _ in situations):
            return "the bodies have no yield strength"
        return ""

    @abstractmethod
    def strength(self, scene: Scene, values: Values, around: Surroundings) -> FlowStress:
        """Return the flow stress of this impact."""

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Multiply the flow stress that the scene has."""
        own = self.strength(scene, values, around)
        alone = isinstance(scene.flow, RateFree)
        return scene.with_(flow=own if alone else Profiles((scene.flow, own)))


def strain(scene: Scene, table: StrengthTable) -> Array:
    """Representative plastic strain at the depths of a table, 0.2 a/R with a at most R."""
    return np.asarray(STRAIN * np.minimum(table.radius / scene.pair.R, 1.0))


class FallingStrength(FlowMechanism):
    """A flow stress that falls: physics that a verdict has no name for."""

    named = False
    direction: ClassVar[Mapping[str, int]] = {
        "restitution": -1, "permanent_depth_m": 1, "peak_force_N": -1,
    }  # fmt: skip
