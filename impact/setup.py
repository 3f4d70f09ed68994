"""The set-up file of an impact: the keys of a recording set's set.toml, and `[impact]`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

from ..core.errors import InputError, InputErrors
from ..core.toml_input import InputTable, MaterialTable, parse_model, read_toml
from ..models.base import ContactLaw
from .beam import rod_modes
from .integrate import Settings
from .scene import Approach, ForceTransform, Friction, Scene, Striker, Support, scene_of
from .support import half_space_radiation, plate_support, sprung_support


def _plain(value: Any) -> Any:
    """Return the value of a quantity given as `{ value = ..., std = ... }`."""
    if isinstance(value, dict) and set(value) <= {"value", "std"} and "value" in value:
        return value["value"]
    return value


Quantity = Annotated[float, BeforeValidator(_plain)]
Positive = Annotated[float, BeforeValidator(_plain), Field(gt=0.0)]
NotNegative = Annotated[float, BeforeValidator(_plain), Field(ge=0.0)]


class _Body(MaterialTable):
    """Material keys of set.toml, quantities allowed; what an impact does not use is accepted."""

    E_Pa: Positive | None = None
    nu: Annotated[float, BeforeValidator(_plain), Field(ge=0.0, lt=0.5)] | None = None
    Sy_Pa: Positive | None = None
    density_kg_m3: Positive | None = None
    hardness_Pa: Positive | None = None
    Ra_m: NotNegative | None = None
    cp_J_kgK: Positive | None = None
    melting_K: Positive | None = None


class TargetTable(_Body):
    """`[target]`: the flat."""

    shape: Literal["flat"] = "flat"
    thickness_m: Positive | None = None
    layer_thickness_m: Positive | None = None
    support_mass_kg: Positive | None = None
    support_stiffness_N_m: NotNegative | None = None
    law: Literal["elastic-plastic", "elastic", "measured-restitution"] = "elastic-plastic"


class StrikerTable(_Body):
    """`[strikers.NAME]`: a rod or a sphere."""

    shape: Literal["rod", "sphere"]
    tip_radius_m: Positive
    mass_kg: Positive
    radius_m: Positive | None = None
    length_m: Positive | None = None
    tip_flat_radius_m: NotNegative = 0.0
    inertia_kg_m2: Positive | None = None


class FrictionTable(InputTable):
    """`[friction]`."""

    coefficient: NotNegative = 0.0


class ImpactTable(InputTable):
    """`[impact]`: what is dropped, how, with which laws and which of the options."""

    striker: str = ""
    angle_deg: float = Field(default=90.0, gt=0.0, le=90.0)
    impact_speed_m_s: Positive | None = None
    drop_height_m: Positive | None = None
    approach_tangential_m_s: Quantity | None = None
    approach_spin_rad_s: Quantity = 0.0
    laws: tuple[str, ...] = ("ghaednia",)
    modes: int = Field(default=0, ge=0, le=60)
    loss_factor: float = Field(default=0.0, ge=0.0, lt=1.0)
    support: Literal["rigid", "sprung", "plate", "half-space"] = "rigid"
    support_damping_N_s_m: float = Field(default=0.0, ge=0.0)
    finite_tip: bool = False
    repeats: int = Field(default=1, ge=1, le=100)
    flight_s: float | None = Field(default=None, ge=0.0)
    max_steps: int = Field(default=20_000, ge=10)
    max_contacts: int = Field(default=50, ge=1)
    sweep_m_s: tuple[Positive, ...] = ()


class SetupFile(BaseModel):
    """The whole file."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    format: str = ""
    name: str = ""
    description: str = ""
    source: str = ""
    licence: str = ""
    gravity_m_s2: NotNegative = 9.81
    target: TargetTable
    strikers: dict[str, StrikerTable]
    friction: FrictionTable = FrictionTable()
    environment: dict[str, Any] = Field(default_factory=dict)
    noise: dict[str, Any] = Field(default_factory=dict)
    impact: ImpactTable


@dataclass(frozen=True, slots=True)
class Setup:
    """What a set-up file asks for, ready to run."""

    name: str
    laws: tuple[str, ...]
    repeats: int
    sweep: tuple[float, ...]
    settings: Settings
    file: SetupFile
    source: str

    def scene(self, law: ContactLaw, *, speed: float | None = None) -> Scene:
        """Return the scene of one law; `speed` replaces the file's normal approach speed [m/s]."""
        return _scene(self.file, law, source=self.source, speed=speed)


def read_setup(path: Path) -> Setup:
    """Read and check a set-up file.

    Raises
    ------
    InputErrors
        One line for each mistake: file, key, value, what is allowed.
    """
    source = str(path)
    found = parse_model(read_toml(path), SetupFile, source=source)
    errors = tuple(_mistakes(found, source))
    if errors:
        raise InputErrors(errors)
    impact = found.impact
    flight = math.nan if impact.flight_s is None else impact.flight_s
    settings = Settings(max_steps=impact.max_steps, max_contacts=impact.max_contacts, flight=flight)
    return Setup(
        found.name or path.stem, tuple(impact.laws), impact.repeats, tuple(impact.sweep_m_s),
        settings, found, source,
    )  # fmt: skip


def _mistakes(found: SetupFile, source: str) -> list[InputError]:
    """What the single keys cannot show."""
    errors = []

    def add(key: str, message: str, allowed: str) -> None:
        errors.append(InputError(message, source=source, key=key, allowed=allowed))

    impact, names = found.impact, ", ".join(found.strikers)
    if not found.strikers:
        add("strikers", "there is none", "at least one table [strikers.NAME]")
    if not impact.striker and len(found.strikers) > 1:
        add("impact.striker", "missing", f"one of {names}")
    if impact.striker and impact.striker not in found.strikers:
        add("impact.striker", f"no striker {impact.striker!r}", f"one of {names}")
    for name, table in found.strikers.items():
        if table.shape == "rod" and (table.radius_m is None or table.length_m is None):
            add(f"strikers.{name}", "a rod without size", "radius_m and length_m")
        if table.tip_flat_radius_m >= table.tip_radius_m:
            add(
                f"strikers.{name}.tip_flat_radius_m",
                f"{table.tip_flat_radius_m:g}",
                f"below tip_radius_m = {table.tip_radius_m:g}",
            )
    if (impact.impact_speed_m_s is None) == (impact.drop_height_m is None):
        add("impact.impact_speed_m_s", "give one of speed and height", "or impact.drop_height_m")
    if impact.support == "sprung" and found.target.support_mass_kg is None:
        add("target.support_mass_kg", "missing", "the mass of a sprung support")
    if impact.support == "plate" and found.target.thickness_m is None:
        add("target.thickness_m", "missing", "the thickness of the plate")
    if impact.support in ("plate", "half-space") and found.target.density_kg_m3 is None:
        add("target.density_kg_m3", "missing", "the density of a support that carries waves off")
    return errors


def _scene(found: SetupFile, law: ContactLaw, *, source: str, speed: float | None) -> Scene:
    impact = found.impact
    name = impact.striker or next(iter(found.strikers))
    table = found.strikers[name]
    sphere = table.to_material(source=source, key=f"strikers.{name}")
    flat = found.target.to_material(source=source, key="target")
    if found.target.law == "elastic":
        sphere, flat = sphere.with_(Sy=math.inf), flat.with_(Sy=math.inf)
    rod = table.shape == "rod"
    striker = Striker(
        mass=table.mass_kg,
        tip_radius=table.tip_radius_m,
        length=(table.length_m or 0.0) if rod else 0.0,
        radius=table.radius_m or table.tip_radius_m,
        inertia=table.inertia_kg_m2 or math.nan,
        tip_flat_radius=table.tip_flat_radius_m,
        name=name,
    )
    support, radiation = Support(), 0.0
    if impact.support == "sprung":
        support = sprung_support(
            found.target.support_mass_kg or 0.0,
            found.target.support_stiffness_N_m or 0.0,
            damping=impact.support_damping_N_s_m,
        )
    elif impact.support == "plate":
        support = plate_support(flat, thickness=found.target.thickness_m or 0.0)
    elif impact.support == "half-space":
        radiation = half_space_radiation(flat)
    edge = striker.radius if impact.finite_tip and rod else math.inf
    try:
        modes = rod_modes(
            striker.length, striker.radius, sphere, mass=striker.mass, count=impact.modes,
            loss_factor=impact.loss_factor,
        )  # fmt: skip
    except InputError as error:
        raise InputError(
            error.message, source=source, key="impact.modes", allowed=error.allowed
        ) from None
    return scene_of(
        law, sphere=sphere, flat=flat, striker=striker,
        approach=_approach(impact, found.gravity_m_s2, rod=rod, speed=speed),
        gravity=found.gravity_m_s2, friction=Friction(found.friction.coefficient),
        force=ForceTransform(radiation=radiation, edge=edge), modes=modes, support=support,
    )  # fmt: skip


def _approach(impact: ImpactTable, gravity: float, *, rod: bool, speed: float | None) -> Approach:
    """The motion at touch; a sphere's angle is that of its velocity, a rod's that of its axis."""
    angle = math.radians(impact.angle_deg)
    normal = speed if speed is not None else impact.impact_speed_m_s
    if normal is None:
        normal = math.sqrt(2.0 * gravity * (impact.drop_height_m or 0.0))
        normal *= 1.0 if rod else math.sin(angle)
    tangential = impact.approach_tangential_m_s
    if tangential is None:
        upright = rod or impact.angle_deg == 90.0
        tangential = 0.0 if upright else -normal / math.tan(angle)
    return Approach(normal, angle if rod else math.pi / 2.0, tangential, impact.approach_spin_rad_s)
