"""Mechanisms that act through the flow stress: rate, strain, heat, layer, size.

Each gives the metal's strength relative to the stated one, as a function of the depth; the law
then answers for a pair of that strength (`impact.strength`). The strain rate of an indentation is
taken as 0.4 v/a and its representative strain as 0.2 a/R (Tabor, The Hardness of Metals, 1951).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ...core.material import Pair
from ...impact import Scene
from ...impact.strength import StrengthTable
from .base import (
    Array,
    Mechanism,
    Parameter,
    Situation,
    Surroundings,
    Values,
    energy,
    with_flow,
)

_REFERENCE_RATE = 1000.0  # 1/s, within the rates of impacts at a few m/s
_SLOWEST = 0.2  # the rate's memory at the turning point, of the approach speed


class _Depth:
    """A strength profile: the static pair, and a function of the depth."""

    __slots__ = ()

    def strengthened(self, scene: Scene) -> Pair:
        return scene.pair


@dataclass(frozen=True, slots=True)
class RateProfile(_Depth):
    """1 + A (r/1000)^n with r = 0.4 v(depth)/a: the rate falls as the impact slows down.

    At the turning point the metal keeps the strength of the rate just before it: a strength taken
    from the vanishing rate itself would turn the effect on restitution round.
    """

    rise: float
    exponent: float

    def profile(self, scene: Scene, table: StrengthTable) -> Array:
        deepest = table.peak(energy(scene))
        slowing = 1.0 - (table.depth / deepest) ** 2
        speed = scene.approach.speed * np.sqrt(np.maximum(slowing, _SLOWEST**2))
        rate = 0.4 * speed / table.radius
        return np.asarray(1.0 + self.rise * (rate / _REFERENCE_RATE) ** self.exponent)


class StrainRateHardening(Mechanism):
    """The flow stress rises with the strain rate, as a power (Cowper-Symonds) or a logarithm."""

    name = "strain-rate-hardening"
    title = "the metal is stronger at the rates of the impact"
    equations = "S = S_y [1 + A (r / 1000 s^-1)^n], r = 0.4 v(delta)/a"
    parameters = (
        Parameter(
            "rise_at_1000_per_s", "-", 0.03, 2.5, "log", 0.0,
            "Johnson-Cook C 0.014-0.06 gives 0.1-0.4; Cowper-Symonds (40.4, 5) gives 1.9", nodes=7,
        ),
        Parameter(
            "rate_exponent", "-", 0.03, 0.4, "linear", 0.0,
            "Cowper-Symonds 1/q 0.1-0.25; a logarithm looks like C/A", nodes=3,
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {
        "restitution": 1,
        "permanent_depth_m": -1,
        "contact_time_s": -1,
        "peak_force_N": 1,
    }

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a metal that yields."""
        return _needs_yield(situations)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the flow stress."""
        rise = values["rise_at_1000_per_s"]
        if rise == 0.0:
            return scene
        return with_flow(scene, RateProfile(rise, values["rate_exponent"]))


@dataclass(frozen=True, slots=True)
class StrainProfile(_Depth):
    """1 + K (0.2 a/R)^n."""

    rise: float
    exponent: float

    def profile(self, scene: Scene, table: StrengthTable) -> Array:
        strain = 0.2 * np.minimum(table.radius / scene.pair.R, 1.0)
        return np.asarray(1.0 + self.rise * strain**self.exponent)


class WorkHardening(Mechanism):
    """The flow stress rises with plastic strain."""

    name = "work-hardening"
    title = "the metal hardens as it is deformed"
    equations = "S = S_y [1 + K (0.2 a/R)^n]"
    parameters = (
        Parameter(
            "hardening_ratio", "-", 0.15, 6.0, "log", 0.0,
            "B/A of Johnson and Cook's metals: 0.6 (4340) to 3.2 (OFHC copper)", nodes=7,
        ),
        Parameter(
            "hardening_exponent", "-", 0.15, 1.0, "linear", 1.0,
            "0.26 (4340) to 0.36 (1006); 1 for linear hardening", nodes=3,
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {
        "restitution": 1,
        "permanent_depth_m": -1,
        "contact_time_s": -1,
        "peak_force_N": 1,
    }

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a metal that yields."""
        return _needs_yield(situations)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the flow stress."""
        if values["hardening_ratio"] == 0.0:
            return scene
        return with_flow(
            scene, StrainProfile(values["hardening_ratio"], values["hardening_exponent"])
        )


@dataclass(frozen=True, slots=True)
class HeatProfile(_Depth):
    """1 - T*^m over that at the reference temperature."""

    heat: float
    exponent: float
    temperature: float
    ambient: float
    melting: float

    def profile(self, scene: Scene, table: StrengthTable) -> Array:
        strain = 0.2 * np.minimum(table.radius / scene.pair.R, 1.0)
        hot = self.temperature - self.ambient + self.heat * strain
        share = np.clip(hot / (self.melting - self.ambient), 0.0, 0.95)
        return np.asarray(1.0 - share**self.exponent)


class ThermalSoftening(Mechanism):
    """The flow stress falls with the stated temperature and the heat of deformation."""

    name = "thermal-softening"
    title = "the metal is softened by heat"
    equations = "S = S_y (1 - T*^m), T* = (T - T_0 + 0.9 S_y eps/(rho c_p))/(T_m - T_0)"
    parameters = (
        Parameter(
            "softening_exponent", "-", 0.4, 2.5, "linear", math.inf,
            "Johnson and Cook 1983: 1.00 (1006) to 1.70 (7039); half as far again for other metals",
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {"restitution": -1, "permanent_depth_m": 1}

    def applies(self, situations: Sequence[Situation]) -> str:
        """Compare the heat of deformation with the way to melting."""
        reason = _needs_yield(situations)
        if reason:
            return reason
        largest, heat = 0.0, 0.0
        for scene, around in situations:
            hot = _heat(scene, around) * 0.2 * _edge(scene)
            heat = max(heat, hot)
            hot += max(around.temperature - around.ambient, 0.0)
            largest = max(largest, hot / (_melting(around) - around.ambient))
        if largest < 0.02:
            return (
                f"deformation heats the metal by at most {heat:.1f} K, "
                f"{100.0 * largest:.1f} % of the way to melting"
            )
        return ""

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the flow stress."""
        m = values["softening_exponent"]
        if math.isinf(m):
            return scene
        heat = _heat(scene, around)
        return with_flow(
            scene, HeatProfile(heat, m, around.temperature, around.ambient, _melting(around))
        )


def _melting(around: Surroundings) -> float:
    return around.melting if around.melting > around.ambient else 1790.0


def _heat(scene: Scene, around: Surroundings) -> float:
    """Warming per unit of plastic strain, 0.9 S_y/(rho c_p) [K]."""
    weak = scene.pair.weaker
    density = weak.density if math.isfinite(weak.density) else 7800.0
    capacity = around.heat_capacity if around.heat_capacity > 0.0 else 470.0
    return 0.9 * weak.Sy / (density * capacity)


def _edge(scene: Scene) -> float:
    """Largest a/R, from the volume of a dent that takes up the energy at 2.8 S_y."""
    volume = energy(scene) / (2.8 * scene.pair.Sy_min)
    return float(min((4.0 * volume * scene.pair.R / math.pi) ** 0.25 / scene.pair.R, 1.0))


@dataclass(frozen=True, slots=True)
class LayerProfile(_Depth):
    """1 + k exp(-z/t) at z = a/2, the depth of the largest shear."""

    rise: float
    thickness: float

    def profile(self, scene: Scene, table: StrengthTable) -> Array:
        return np.asarray(1.0 + self.rise * np.exp(-0.5 * table.radius / self.thickness))


class HardenedLayer(Mechanism):
    """A surface harder than the bulk: a case, a machined or polished skin."""

    name = "hardened-layer"
    title = "the surface is harder than the bulk"
    equations = "S = S_y [1 + k exp(-a/(2 t))]"
    parameters = (
        Parameter(
            "layer_hardening", "-", 0.1, 2.5, "log", 0.0,
            "machined skins 10-50 % harder, carburised cases up to 3 times", nodes=5,
        ),
        Parameter(
            "layer_thickness_m", "m", 2e-5, 2e-3, "log", 0.0,
            "polished 5-50 um, machined 0.1-0.3 mm, carburised 0.5-2 mm", nodes=5,
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {"restitution": 1, "permanent_depth_m": -1}

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a metal that yields."""
        return _needs_yield(situations)

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """A stated thickness narrows the range to a factor of two."""
        stated = situations[0][1].layer_thickness
        if not stated > 0.0:
            return self.parameters
        one, two = self.parameters
        near = Parameter(
            two.name, two.unit, 0.5 * stated, 2.0 * stated, "log", 0.0, "stated in set.toml", 5
        )
        return one, near

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the flow stress."""
        if values["layer_hardening"] == 0.0:
            return scene
        return with_flow(
            scene, LayerProfile(values["layer_hardening"], values["layer_thickness_m"])
        )


@dataclass(frozen=True, slots=True)
class SizeProfile(_Depth):
    """sqrt(1 + R*/R), the same at every depth."""

    length: float

    def profile(self, scene: Scene, table: StrengthTable) -> Array:
        return np.full(table.depth.shape, math.sqrt(1.0 + self.length / scene.pair.R))


class SizeEffect(Mechanism):
    """Smaller spheres meet a harder metal (geometrically necessary dislocations)."""

    name = "size-effect"
    title = "small tips meet a harder metal"
    equations = "S = S_y sqrt(1 + R*/R)"
    parameters = (
        Parameter(
            "size_length_m", "m", 1e-6, 1e-3, "log", 0.0,
            "Swadener, George and Pharr, J. Mech. Phys. Solids 50 (2002) 681",
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {"restitution": 1, "permanent_depth_m": -1}

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a metal that yields, and tips of different radius."""
        reason = _needs_yield(situations)
        if reason:
            return reason
        radii = [scene.pair.R for scene, _ in situations]
        if max(radii) < 1.3 * min(radii):
            return (
                "all tips have nearly one radius: a size effect is then the same as another "
                "yield strength"
            )
        return ""

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the flow stress."""
        if values["size_length_m"] == 0.0:
            return scene
        return with_flow(scene, SizeProfile(values["size_length_m"]))


def _needs_yield(situations: Sequence[Situation]) -> str:
    if all(math.isinf(scene.pair.Sy_min) for scene, _ in situations):
        return "the bodies have no yield strength"
    return ""


__all__ = [
    "HardenedLayer",
    "SizeEffect",
    "StrainRateHardening",
    "ThermalSoftening",
    "WorkHardening",
]
