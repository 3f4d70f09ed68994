"""The mechanisms that a diagnosis knows, in reading order: material, bodies, contact, approach."""

from __future__ import annotations

from .approach import ImpactSpeedLoss, Tilt
from .base import Mechanism, Parameter, Surroundings
from .contact import Adhesion, ContactDamping, Roughness, SqueezeFilm, TruncatedTip
from .flow import (
    HardenedLayer,
    SizeEffect,
    StrainRateHardening,
    ThermalSoftening,
    WorkHardening,
)
from .sliding import PloughingFriction, TangentialCompliance, VelocityDependentFriction
from .waves import HalfSpaceWaves, RodFlexuralVibration, RodLongitudinalWaves, SupportCompliance

MECHANISMS: tuple[Mechanism, ...] = (
    StrainRateHardening(),
    WorkHardening(),
    ThermalSoftening(),
    HalfSpaceWaves(),
    RodLongitudinalWaves(),
    RodFlexuralVibration(),
    SupportCompliance(),
    TangentialCompliance(),
    VelocityDependentFriction(),
    PloughingFriction(),
    ContactDamping(),
    Adhesion(),
    SqueezeFilm(),
    Roughness(),
    TruncatedTip(),
    HardenedLayer(),
    SizeEffect(),
    ImpactSpeedLoss(),
    Tilt(),
)
"""Every mechanism by the names and in the order of docs/diagnose.md."""

__all__ = ["MECHANISMS", "Mechanism", "Parameter", "Surroundings"]
