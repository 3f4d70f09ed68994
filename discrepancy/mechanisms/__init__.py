"""The mechanisms that a diagnosis knows, in reading order: material, bodies, contact, approach."""

from __future__ import annotations

from .adhesion import Adhesion
from .air_drag import AirDrag
from .approach import ImpactSpeedLoss, Tilt
from .base import Mechanism, Parameter, Surroundings
from .contact_damping import ContactDamping
from .friction import PloughingFriction, VelocityDependentFriction
from .half_space_waves import HalfSpaceWaves
from .hardened_layer import HardenedLayer
from .rod_vibration import RodFlexuralVibration, RodLongitudinalWaves
from .roughness import Roughness
from .size_effect import SizeEffect
from .squeeze_film import SqueezeFilm
from .strain_rate_hardening import StrainRateHardening
from .support_compliance import SupportCompliance
from .tangential_compliance import TangentialCompliance
from .thermal_softening import ThermalSoftening
from .truncated_tip import TruncatedTip
from .work_hardening import WorkHardening

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

__all__ = ["MECHANISMS", "Mechanism", "Parameter", "Surroundings"]
