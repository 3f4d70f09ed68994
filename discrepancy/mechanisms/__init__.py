"""The mechanisms that a diagnosis knows, in reading order: material, bodies, contact, approach."""

from __future__ import annotations

from .adhesion import Adhesion
from .air_drag import AirDrag
from .approach import ImpactSpeedLoss, Tilt
from .base import Mechanism, Parameter, Surroundings
from .contact_damping import ContactDamping
from .friction import PloughingFriction, VelocityDependentFriction
from .half_space_waves import HalfSpaceWaves
from .hardened_layer import HardenedLayer, SofterSurface
from .rod_vibration import RodFlexuralVibration, RodLongitudinalWaves
from .roughness import Roughness
from .size_effect import SizeEffect
from .squeeze_film import SqueezeFilm
from .strain_rate_hardening import NegativeRateSensitivity, StrainRateHardening
from .support_compliance import SupportCompliance
from .tangential_compliance import TangentialCompliance
from .thermal_softening import ThermalSoftening
from .truncated_tip import TruncatedTip
from .work_hardening import StrainSoftening, WorkHardening

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
"""Every mechanism by the names and in the order of docs/diagnose.md."""

NAMELESS: tuple[Mechanism, ...] = (SofterSurface(), StrainSoftening(), NegativeRateSensitivity())
"""Physics that a verdict has no name for, but that would pass for one of the named where nothing
stands for it: a strength that falls."""

__all__ = ["MECHANISMS", "NAMELESS", "Mechanism", "Parameter", "Surroundings"]
