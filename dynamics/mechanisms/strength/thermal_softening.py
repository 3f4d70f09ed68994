"""The flow stress falls with temperature and with the heat of deformation."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ....core.arrays import Array
from ...rules import RULES
from ...scene import FlowStress, Scene
from ...strength import StrengthTable
from ..arithmetic import density_of, energy
from ..base import Literature, Parameter, Situation, Surroundings, Values
from .flow_stress import STRAIN, FlowMechanism, StrengthProfile, strain


def _heated(
    scene: Scene, table: StrengthTable, exponent: float, heat: float, temperature: float,
    ambient: float, melting: float,
) -> Array:  # fmt: skip
    """1 - T*^m over that at the reference temperature."""
    hot = temperature - ambient + heat * strain(scene, table)
    share = np.clip(hot / (melting - ambient), 0.0, RULES.hottest)
    return np.asarray(1.0 - share**exponent)


class ThermalSoftening(FlowMechanism):
    """The flow stress falls with the stated temperature and the heat of deformation."""

    name = "thermal-softening"
    title = "the metal is softened by heat"
    equations = "S = S_y (1 - T*^m), T* = (T - T_0 + 0.9 S_y eps/(rho c_p))/(T_m - T_0)"
    parameters = (
        Parameter(
            "softening_exponent", "-", 0.4, 2.5, "linear", math.inf,
            "Johnson and Cook 1983: 1.00 (1006) to 1.70 (7039); half as far again for other metals",
            literature=Literature(1.0, "m of 1006 steel, Johnson and Cook 1983"),
        ),
    )  # fmt: skip
    direction = {"restitution": -1, "permanent_depth_m": 1}
    reads = ("cp_J_kgK", "melting_K", "environment.temperature_K", "impact.temperature_K")

    def applies(self, situations: Sequence[Situation]) -> str:
        """Compare the heat of deformation with the way to melting."""
        return self._cold(situations, 0.02)

    def _cold(self, situations: Sequence[Situation], least: float) -> str:
        """Return why nothing comes so far to melting, or ""."""
        if reason := super().applies(situations):
            return reason
        largest, heat = 0.0, 0.0
        for scene, around in situations:
            hot = _heat(scene, around) * STRAIN * _edge(scene)
            heat = max(heat, hot)
            hot += max(around.temperature - around.ambient, 0.0)
            largest = max(largest, hot / (_melting(around) - around.ambient))
        if largest < least:
            return (
                f"deformation heats the metal by at most {heat:.1f} K, "
                f"{100.0 * largest:.1f} % of the way to melting"
            )
        return ""

    def idle(self, situations: Sequence[Situation]) -> str:
        """The law ends where the metal melts, and begins at the reference temperature."""
        for _, around in situations:
            if not around.melting > 0.0:
                return "melting_K of the body that yields first is not stated"
            first = around.ambient
            last = first + RULES.hottest * (_melting(around) - first)
            if not first <= around.temperature <= last:
                return (
                    f"the law holds from the reference, {first:g} K, to {last:.4g} K, shortly "
                    f"before the metal melts; this is {around.temperature:g} K"
                )
        # the lowest exponent makes the most of a little heat
        return self._cold(situations, RULES.visible ** (1.0 / self.parameters[0].low))

    def strength(self, scene: Scene, values: Values, around: Surroundings) -> FlowStress:
        """Return the profile of this mechanism."""
        about = _heat(scene, around), around.temperature, around.ambient, _melting(around)
        return StrengthProfile(_heated, (values["softening_exponent"], *about))


def _melting(around: Surroundings) -> float:
    return around.melting if around.melting > around.ambient else 1790.0


def _heat(scene: Scene, around: Surroundings) -> float:
    """Warming per unit of plastic strain, 0.9 S_y/(rho c_p) [K]; none of a press, which is slow."""
    if scene.press is not None:
        return 0.0
    weak = scene.pair.weaker
    capacity = around.heat_capacity if around.heat_capacity > 0.0 else 470.0
    return 0.9 * weak.Sy / (density_of(weak) * capacity)


def _edge(scene: Scene) -> float:
    """Largest a/R, from the volume of a dent that takes up the energy at 2.8 S_y."""
    volume = energy(scene) / (2.8 * scene.pair.Sy_min)
    return float(min((4.0 * volume * scene.pair.R / math.pi) ** 0.25 / scene.pair.R, 1.0))
