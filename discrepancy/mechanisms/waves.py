"""Mechanisms that let the bodies vibrate or radiate: rod, half-space or plate, support."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import ClassVar

import numpy as np

from ...core.material import Material
from ...impact import Modes, Scene, Support, rod_modes
from ...impact.beam import axial_frequencies
from ...impact.support import half_space_radiation, plate_support
from .base import Mechanism, Parameter, Situation, Surroundings, Values, effective_mass, is_oblique

_AXIAL, _BENDING = 6, 9
_LOSS = 1e-3  # of steel rods; what it takes during a contact is below a thousandth


def _density(material: Material) -> float:
    return material.density if math.isfinite(material.density) else 7800.0


@lru_cache(maxsize=256)
def axial_modes(length: float, material: Material, mass: float) -> Modes:
    """Return the lowest axial modes of a free rod with the stated mass."""
    omega = axial_frequencies(length, material, count=_AXIAL)
    ends = tuple([math.sqrt(2.0 / mass)] * _AXIAL)
    none = (0.0,) * _AXIAL
    return Modes(tuple(float(w) for w in omega), ends, none, none, _LOSS)


@lru_cache(maxsize=256)
def _all_modes(length: float, radius: float, material: Material, mass: float) -> Modes:
    return rod_modes(length, radius, material, mass=mass, count=_BENDING, loss_factor=_LOSS)


@lru_cache(maxsize=256)
def _unit_radiation(nu: float) -> float:
    return half_space_radiation(Material(E=1.0, nu=nu, density=1.0))


def _scaled(modes: Modes, share: float) -> Modes:
    factor = math.sqrt(share)
    return replace(
        modes,
        axial=tuple(factor * x for x in modes.axial),
        transverse=tuple(factor * x for x in modes.transverse),
        rotation=tuple(factor * x for x in modes.rotation),
    )


_PARTICIPATION = Parameter(
    "modal_participation", "-", 0.5, 1.5, "linear", 0.0,
    "1 is the theory of the uniform rod; the ends' shape and the mass's spread move it", nodes=5,
)  # fmt: skip


class RodLongitudinalWaves(Mechanism):
    """The rod's axial modes store energy and shape the force."""

    name = "rod-longitudinal-waves"
    title = "the rod rings along its axis"
    equations = (
        "q_k'' + eta w_k q_k' + w_k^2 q_k = sqrt(2/m) F sin(theta), w_k = k pi sqrt(E/rho)/L"
    )
    parameters = (_PARTICIPATION,)
    form: ClassVar[float] = 0.05
    jumps: ClassVar[bool] = True
    direction: ClassVar[Mapping[str, int]] = {"contact_time_s": 1}

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a rod."""
        return _needs_rod(situations)

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the rigid striker."""
        share = values["modal_participation"]
        striker, body = scene.striker, scene.pair.sphere
        if share == 0.0 or striker.length == 0.0 or body.rigid:
            return scene
        body = body.with_(density=_density(body))
        return scene.with_(modes=_scaled(axial_modes(striker.length, body, striker.mass), share))


class RodFlexuralVibration(Mechanism):
    """The leaning rod bends as well: energy goes into bending, and the tip may touch again."""

    name = "rod-flexural-vibration"
    title = "the leaning rod bends and rings"
    equations = "free-free Timoshenko beam and axial modes; re-contact while the tip returns"
    parameters = (_PARTICIPATION,)
    form: ClassVar[float] = 0.05
    jumps: ClassVar[bool] = True
    direction: ClassVar[Mapping[str, int]] = {}

    def applies(self, situations: Sequence[Situation]) -> str:
        """Needs a rod that leans."""
        reason = _needs_rod(situations)
        if reason:
            return reason
        if not any(scene.striker.length > 0.0 and is_oblique(scene) for scene, _ in situations):
            return "every rod stands upright: a central blow along the axis does not bend it"
        return ""

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the rigid striker."""
        share = values["modal_participation"]
        striker, body = scene.striker, scene.pair.sphere
        if share == 0.0 or striker.length == 0.0 or body.rigid:
            return scene
        body = body.with_(density=_density(body))
        modes = _all_modes(striker.length, striker.radius, body, striker.mass)
        return scene.with_(modes=_scaled(modes, share))


def _needs_rod(situations: Sequence[Situation]) -> str:
    if not any(scene.striker.length > 0.0 for scene, _ in situations):
        return "no striker is a rod"
    return ""


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
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {"restitution": -1}

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the rigid half-space."""
        scale, flat = values["wave_scale"], scene.pair.flat
        if scale == 0.0 or flat.rigid:
            return scene
        flat = flat.with_(density=_density(flat))
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
    flat = scene.pair.flat
    speed = math.sqrt(flat.plane_strain_modulus / _density(flat))
    # the shortest contact there is: half a period on a fully plastic dent, 2.8 S_y over 2 pi R d
    strength = min(scene.pair.Sy_min, 0.01 * scene.pair.E_reduced)
    stiffness = 2.0 * math.pi * scene.pair.R * 2.8 * strength
    contact = 0.5 * math.pi * math.sqrt(effective_mass(scene) / stiffness)
    return 4.0 * around.thickness < speed * contact


class SupportCompliance(Mechanism):
    """The flat moves on its support."""

    name = "support-compliance"
    title = "the flat moves on its support"
    equations = "M w'' + c w' + k w = F"
    parameters = (
        Parameter(
            "support_stiffness_N_m", "N/m", 1e6, 1e9, "log", math.inf,
            "blocks on foam or clamped to a bench; frames 1e8-1e10 N/m", nodes=5,
        ),
        Parameter(
            "support_mass_kg", "kg", 0.1, 100.0, "log", math.inf,
            "from the flat alone to the bench with it", nodes=5,
        ),
    )  # fmt: skip
    direction: ClassVar[Mapping[str, int]] = {"restitution": -1, "permanent_depth_m": -1}

    def ranges(self, situations: Sequence[Situation]) -> tuple[Parameter, ...]:
        """Stated values narrow the ranges; the flat on one striker's mass bounds the mass."""
        around = situations[0][1]
        k, m = self.parameters
        heaviest = max(scene.striker.mass for scene, _ in situations)
        m = replace(m, low=2.0 * heaviest, high=300.0 * heaviest)
        stated = around.support_stiffness, around.support_mass
        if stated[0] > 0.0:
            k = replace(k, low=stated[0] / 2.0, high=stated[0] * 2.0, source="stated", nodes=3)
        if stated[1] > 0.0:
            m = replace(m, low=stated[1] / 1.5, high=stated[1] * 1.5, source="stated", nodes=3)
        return k, m

    def attach(self, scene: Scene, values: Values, around: Surroundings) -> Scene:
        """Replace the rigid base."""
        mass = values["support_mass_kg"]
        if not np.isfinite(mass):
            return scene
        k = values["support_stiffness_N_m"]
        damping = 0.04 * math.sqrt(k * mass)  # 2 % of critical, as bolted frames have
        return scene.with_(
            support=Support(mass, k, damping, plate_mobility=scene.support.plate_mobility)
        )
