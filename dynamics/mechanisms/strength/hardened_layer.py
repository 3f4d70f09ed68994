"""The surface is harder than the bulk."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ....core.arrays import Array
from ...scene import Scene
from ...strength import StrengthTable
from ..base import Literature, Parameter, Situation, Surroundings, Values
from .flow_stress import FallingStrength, FlowMechanism


def _layered(scene: Scene, table: StrengthTable, rise: float, thickness: float) -> Array:
    """1 + k exp(-z/t) at z = a/2, the depth of the largest shear."""
    return np.asarray(1.0 + rise * np.exp(-0.5 * table.radius / thickness))


def _softened(scene: Scene, table: StrengthTable, fall: float, thickness: float) -> Array:
    return _layered(scene, table, -fall, thickness)


class HardenedLayer(FlowMechanism):
    """A surface harder than the bulk: a case, a machined or polished skin."""

    name = "hardened-layer"
    title = "the surface is harder than the bulk"
    equations = "S = S_y [1 + k exp(-a/(2 t))]"
    parameters = (
        Parameter(
            "layer_hardening", "-", 0.1, 2.5, "log", 0.0,
            "machined skins 10-50 % harder, carburised cases up to 3 times", nodes=5,
            literature=Literature(0.3, "the middle of machined skins"),
        ),
        Parameter(
            "layer_thickness_m", "m", 2e-5, 2e-3, "log", 0.0,
            "polished 5-50 um, machined 0.1-0.3 mm, carburised 0.5-2 mm", nodes=5,
            literature=Literature(1.5e-4, "a machined skin"),
        ),
    )  # fmt: skip
    relative = staticmethod(_layered)
    reads = ("layer_thickness_m",)

    def stated(self, around: Surroundings) -> Values:
        """Return the thickness of the layer."""
        t = around.layer_thickness
        return {"layer_thickness_m": t} if t > 0.0 else {}

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """A stated thickness narrows the range to a factor of two."""
        stated = situations[0][1].layer_thickness
        if not stated > 0.0:
            return self.parameters
        one, two = self.parameters
        return one, replace(two, low=0.5 * stated, high=2.0 * stated, source="stated in set.toml")


class SofterSurface(FallingStrength):
    """A surface softer than the bulk: decarburised, overaged, plated with a soft metal."""

    name = "softer-surface"
    title = "the surface is softer than the bulk"
    equations = "S = S_y [1 - k exp(-a/(2 t))]"
    parameters = (
        Parameter(
            "layer_softening", "-", 0.1, 0.9, "linear", 0.0,
            "decarburised steel 30-60 % softer, tin or silver on steel by nine tenths", nodes=5,
        ),
        HardenedLayer.parameters[1],
    )  # fmt: skip
    relative = staticmethod(_softened)
