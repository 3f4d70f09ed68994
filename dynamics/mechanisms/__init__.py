"""The mechanisms that a diagnosis knows, in reading order: material, bodies, contact, approach."""

from __future__ import annotations

from .adhesion import Adhesion
from .air_drag import AirDrag
from .approach import ImpactSpeedLoss, Tilt
from .base import Mechanism, Parameter, Surroundings
from .contact_damping import ContactDamping
from .friction import PloughingFriction, VelocityDependentFriction
from .half_space_waves import HalfSpaceWaves
from .rod_vibration import RodFlexuralVibration, RodLongitudinalWaves
from .roughness import Roughness
from .squeeze_film import SqueezeFilm
from .strength.hardened_layer import HardenedLayer, SofterSurface
from .strength.size_effect import SizeEffect
from .strength.strain_rate_hardening import NegativeRateSensitivity, StrainRateHardening
from .strength.thermal_softening import ThermalSoftening
from .strength.work_hardening import StrainSoftening, WorkHardening
from .support_compliance import SupportCompliance
from .tangential_compliance import TangentialCompliance
from .truncated_tip import TruncatedTip

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
    AirDrag(),
    Tilt(),
)
"""Every mechanism by the names and in the order of docs/diagnose-method.md."""

NAMELESS: tuple[Mechanism, ...] = (SofterSurface(), StrainSoftening(), NegativeRateSensitivity())
"""Physics that a verdict has no name for, but that would pass for one of the named where nothing
stands for it: a strength that falls."""

__all__ = ["MECHANISMS", "NAMELESS", "Mechanism", "Parameter", "Surroundings"]
