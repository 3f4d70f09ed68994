"""The rig: what strikes what, as a person writes it in TOML; every input file is read by it.

set.toml of a recording set, the set-up of an impact and the bodies of CASE.toml are made of these
frozen tables. The attributes carry the names of the keys, unit included, so that file and program
speak the same language. A value that the file leaves out is `None`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from types import MappingProxyType
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    TypeAdapter,
    ValidationInfo,
    field_validator,
    model_validator,
)

from .errors import InputError
from .inputs.materials import Mistyped, filled, unlisted
from .inputs.names import FileName
from .inputs.ranges import DENSITIES, HARDNESSES, MODULI, RADII, SPEEDS, STRENGTHS, Within, span
from .inputs.rig_numbers import RigNumbers, solid_inertia, solid_mass
from .inputs.toml_input import InputTable
from .material import Material
from .observables import GAUGE_KEYS, NOISE_KEYS
from .rules import RULES

Number = Annotated[float, Field(strict=True)]


class Quantity(InputTable):
    """A value and its standard deviation; 0 means taken as exact, `known = "guess"` half of it.

    Examples
    --------
    >>> Quantity.model_validate({"value": 3.5e8, "known": "guess"}).std
    175000000.0
    >>> Quantity.model_validate({"value": 2.0e11, "std": 4.0e9}).std
    4000000000.0
    >>> Quantity.model_validate(9.81)
    Quantity(value=9.81, std=0.0)
    """

    value: Number
    std: Annotated[float, Field(strict=True, ge=0.0)] = 0.0

    @model_validator(mode="before")
    @classmethod
    def _from_number(cls, given: Any) -> Any:
        if isinstance(given, dict) and "known" in given:
            return _guessed(given)
        if isinstance(given, dict | Quantity):
            return given
        if isinstance(given, bool) or not isinstance(given, int | float):
            raise ValueError("a number, or { value = ..., std = ... }")
        return {"value": given}

    @property
    def relative(self) -> float:
        """Standard deviation over value [-]."""
        return self.std / abs(self.value) if self.value else 0.0


def _guessed(given: dict[str, Any]) -> dict[str, Any]:
    """A quantity that its table marks as a guess, with the standard deviation of one."""
    plain = {name: entry for name, entry in given.items() if name != "known"}
    if given["known"] != "guess":
        raise ValueError('known = "guess", or a std')
    if "std" in plain:
        raise ValueError('known = "guess" or a std, not both')
    value = plain.get("value")
    if isinstance(value, int | float):
        plain["std"] = RULES.guessed * abs(value)
    return plain


def value_of(quantity: Quantity | None, otherwise: float = math.nan) -> float:
    """Return the value of a quantity, or `otherwise` where the file leaves it out."""
    return otherwise if quantity is None else quantity.value


def quantities(table: InputTable, prefix: str = "") -> dict[str, float]:
    """Return the values of a table's quantities, each under its key behind `prefix`."""
    given = {name: getattr(table, name) for name in type(table).model_fields}
    return {f"{prefix}{k}": q.value for k, q in given.items() if isinstance(q, Quantity)}


def _within(accept: Callable[[float], bool], allowed: str) -> AfterValidator:
    return AfterValidator(Within(accept, allowed))


Positive = Annotated[Quantity, _within(lambda x: x > 0.0, "a number above 0")]
NotNegative = Annotated[Quantity, _within(lambda x: x >= 0.0, "a number not below 0")]
Modulus = Annotated[Quantity, AfterValidator(MODULI)]
Strength = Annotated[Quantity, AfterValidator(STRENGTHS)]
Density = Annotated[Quantity, AfterValidator(DENSITIES)]
Length = Annotated[Quantity, AfterValidator(span(1e-9, 10.0, mm=1e-3, um=1e-6))]
Radius = Annotated[Quantity, AfterValidator(RADII)]
SeatRadius = Annotated[
    Quantity, _within(lambda x: 1e-9 <= abs(x) <= 1e3, "a radius up to 1000 m, or below 0 a seat's")
]
Roughness = Annotated[Quantity, AfterValidator(span(0.0, 1e-3, um=1e-6, nm=1e-9))]
Mass = Annotated[Quantity, AfterValidator(span(1e-18, 1e6))]
Speed = Annotated[Quantity, AfterValidator(SPEEDS)]
Height = Annotated[Quantity, AfterValidator(span(1e-9, 200.0, mm=1e-3))]
Temperature = Annotated[Quantity, AfterValidator(span(0.1, 1e4))]
HeatCapacity = Annotated[Quantity, AfterValidator(span(10.0, 3e4, **{"J/(g K)": 1e3}))]
Gravity = Annotated[Quantity, AfterValidator(span(0.0, 1e3))]
Friction = Annotated[Quantity, AfterValidator(span(0.0, 20.0))]
Poisson = Annotated[Quantity, _within(lambda x: 0.0 <= x < 0.5, "0 <= nu < 0.5")]


def _below(key: str, units: str = "", times: float = 1.0) -> Callable[..., Quantity | None]:
    """Hold a quantity below another one of its table, or so many times that."""
    named = key if times == 1.0 else f"{times:g} {key}"

    def check(given: Quantity | None, info: ValidationInfo) -> Quantity | None:
        other = info.data.get(key)
        if given is not None and other is not None and given.value >= times * other.value:
            raise ValueError(f"below {named} = {times * other.value:g}{units}")
        return given

    return check


class MaterialTable(InputTable):
    """What every input file may say of a body's metal.

    `Sy_Pa` left out means purely elastic; `rigid = true` needs no other key.
    """

    material: str = ""
    """Name of the metal; one that `dentscope materials` lists gives what is left out here."""
    E_Pa: Modulus | None = None
    """Young's modulus."""
    nu: Poisson | None = None
    """Poisson's ratio."""
    Sy_Pa: Strength | None = None
    """Yield strength; left out: purely elastic."""
    density_kg_m3: Density | None = None
    """Density."""
    rigid: Annotated[bool, Field(strict=True)] = False
    """Does not deform at all; then no other number is needed."""

    @model_validator(mode="before")
    @classmethod
    def _of_a_known_material(cls, given: Any) -> Any:
        if not isinstance(given, dict):
            return given
        known = frozenset(cls.model_fields)
        found = filled(given, known | {"hardness_Pa"})
        if known | given.keys() >= {"hardness_Pa"} or "hardness_Pa" not in found:
            return found
        hardness = Quantity.model_validate(found["hardness_Pa"])
        rest = {key: x for key, x in found.items() if key != "hardness_Pa"}
        return {"Sy_Pa": by_tabor(hardness).model_dump(), **rest}

    @field_validator("material", mode="before")
    @classmethod
    def _listed(cls, given: Any) -> Any:
        if isinstance(given, Mistyped):
            raise ValueError(given.allowed)
        return given

    @property
    def strength(self) -> Quantity | None:
        """Yield strength as far as the file says it [Pa]."""
        return self.Sy_Pa

    _below_the_modulus = field_validator("Sy_Pa")(_below("E_Pa", "; both in Pa"))

    def numbers(self, key: str, *, source: str = "") -> dict[str, float]:
        """Return the numbers of this table by their keys, of what is not stated those that follow.

        Errors name `key` and `source`; a number of a rigid body's metal is refused.
        """
        if self.rigid:
            for name in ("E_Pa", "nu", "Sy_Pa", "hardness_Pa"):
                if getattr(self, name, None) is not None:
                    raise InputError(
                        "given beside rigid = true", source=source, key=f"{key}.{name}",
                        allowed="left out: a rigid body does not deform",
                    )  # fmt: skip
        return {**quantities(self, f"{key}."), f"{key}.Sy_Pa": value_of(self.strength, math.inf)}

    def to_material(self, key: str = "", *, source: str = "") -> Material:
        """Return the `Material` at the stated values.

        Errors name `key` and `source`: modulus or Poisson's ratio is missing, or a number of a
        rigid body is given.
        """
        numbers = self.numbers(key, source=source)
        rigid = frozenset({key} if self.rigid else ())
        return RigNumbers(numbers, rigid, {key: self.material}).material(key, source=source)


def material_keys(body: Material) -> dict[str, float | bool]:
    """Return the keys of a `MaterialTable` that give this body's statics again."""
    if body.rigid:
        return {"rigid": True}
    strength = {"Sy_Pa": body.Sy} if math.isfinite(body.Sy) else {}
    return {"E_Pa": body.E, "nu": body.nu, **strength}


TABOR = 2.8
"""Indentation hardness over yield strength [-] (Tabor, The Hardness of Metals, 1951)."""
TABOR_STRAIN = 0.08
"""Plastic strain at which a hardness over `TABOR` is the flow stress [-] (the same; Vickers)."""


def by_tabor(hardness: Quantity) -> Quantity:
    """Return the yield strength behind a hardness [Pa].

    Its standard deviation is that of the hardness, and how far metals differ in the ratio.
    """
    value, own = hardness.value / TABOR, hardness.relative or RULES.hardness_spread
    return Quantity(value=value, std=value * math.hypot(own, RULES.tabor_spread))


class BodyTable(MaterialTable):
    """A body that strikes or is struck."""

    hardness_Pa: Annotated[Quantity, AfterValidator(HARDNESSES)] | None = None
    """Indentation hardness; gives the yield strength where that is left out."""
    Ra_m: Roughness | None = None
    """Mean roughness of the surface."""
    cp_J_kgK: HeatCapacity | None = None
    """Specific heat."""
    melting_K: Temperature | None = None
    """Melting temperature."""
    flow_curve: str = ""
    """File beside this one: true stress over plastic strain as measured."""

    _softer_than_elastic = field_validator("hardness_Pa")(_below("E_Pa", "; both in Pa", TABOR))

    @property
    def strength(self) -> Quantity | None:
        """Yield strength: as stated, else by the hardness [Pa]."""
        if self.Sy_Pa is not None or self.hardness_Pa is None:
            return self.Sy_Pa
        return by_tabor(self.hardness_Pa)

    @property
    def tabor(self) -> tuple[float, float, str] | None:
        """Hardness over strength, its standard deviations off Tabor's ratio, and both in words.

        None unless hardness and strength are stated.
        """
        if self.hardness_Pa is None or self.Sy_Pa is None:
            return None
        ratio = self.hardness_Pa.value / self.Sy_Pa.value
        std = math.hypot(by_tabor(self.hardness_Pa).relative, self.Sy_Pa.relative)
        told = f"hardness over strength {ratio:.3g} as stated; {TABOR:g} for most metals"
        return ratio, abs(math.log(ratio / TABOR)) / std, told


class TargetTable(BodyTable):
    """`[target]`: the flat or second sphere, its support and the baseline that its law asks for."""

    shape: Literal["flat", "sphere"] = "flat"
    """The struck body is flat, or a second sphere."""
    radius_m: SeatRadius | None = None
    """Radius of a second sphere; below 0 of a concave seat."""
    mass_kg: Mass | None = None
    """Mass of a second sphere that is free; left out: it is held."""
    thickness_m: Length | None = None
    """Thickness of the flat."""
    layer_thickness_m: Length | None = None
    """Thickness of a surface layer."""
    support_mass_kg: Mass | None = None
    """Mass that moves with the flat."""
    support_stiffness_N_m: NotNegative | None = None
    """Stiffness of what the flat rests on."""
    law: Literal["elastic-plastic", "table", "elastic", "measured-restitution"] = "elastic-plastic"
    """What the contact does: elastic and plastic by the closed form, or by finite elements of the
    set's own pair; elastic; or a restitution to be measured."""

    @property
    def yields(self) -> bool:
        """Whether bodies of this baseline can be left with a dent."""
        return self.law in ("elastic-plastic", "table")


def possible_inertia(inertia: Quantity | None, info: ValidationInfo) -> Quantity | None:
    """Return a striker's moment of inertia, or refuse what no body of this mass and size has."""
    mass, length, *radii = (
        value_of(info.data.get(k), 0.0) for k in ("mass_kg", "length_m", "radius_m", "tip_radius_m")
    )
    # leaves room for what is mounted on it, and finds a wrong unit
    most = mass * (length + 2.0 * max(radii)) ** 2
    if inertia is not None and inertia.value > most > 0.0:
        raise ValueError(f"at most {most:.3g}, all mass twice as far out as the ends")
    return inertia


class StrikerTable(BodyTable):
    """`[strikers.NAME]`: a rod with two round ends, or a sphere.

    A sphere without `mass_kg` is a solid one of its radius and density.
    """

    shape: Literal["rod", "sphere"]
    """A rod with two round ends, or a sphere."""
    tip_radius_m: Radius
    """Radius of the round tip; a sphere may have it as `radius_m`."""
    mass_kg: Mass
    """Mass; a sphere without it is solid."""
    radius_m: Radius | None = Field(default=None, validate_default=True)
    """Radius of the rod's shank, or of the sphere."""
    length_m: Length | None = Field(default=None, validate_default=True)
    """Between the centres of a rod's two tip spheres."""
    tip_flat_radius_m: NotNegative | None = None
    """Radius of a flat at the end of the tip."""
    inertia_kg_m2: Positive | None = None
    """Moment of inertia across the axis; left out: of a rod or sphere of this mass."""

    @model_validator(mode="before")
    @classmethod
    def _radius_of_a_sphere(cls, given: Any) -> Any:
        of_ball = isinstance(given, dict) and given.get("shape") != "rod"
        if not of_ball or "tip_radius_m" in given or "radius_m" not in given:
            return given
        rest = {key: value for key, value in given.items() if key != "radius_m"}
        return {**rest, "tip_radius_m": given["radius_m"]}

    @model_validator(mode="before")
    @classmethod
    def _mass_of_a_sphere(cls, given: Any) -> Any:
        if not isinstance(given, dict) or given.get("shape") == "rod" or "mass_kg" in given:
            return given
        given = filled(given, frozenset(cls.model_fields))  # the density of a known material
        if isinstance(given.get("material"), Mistyped):
            return {**given, "mass_kg": 1.0}  # the name has a line of its own
        if given.get("density_kg_m3") is None:
            return {**given, "mass_kg": None}
        try:
            density = TypeAdapter(Density).validate_python(given["density_kg_m3"])
            radius = TypeAdapter(Radius).validate_python(
                given.get("radius_m", given.get("tip_radius_m"))
            )
        except ValueError:
            # what it would follow from has a line of its own: none for the mass as well
            return {**given, "mass_kg": 1.0}
        mass = solid_mass(radius.value, density.value)
        std = mass * math.hypot(density.relative, 3.0 * radius.relative)
        return {**given, "mass_kg": {"value": mass, "std": std}}

    @field_validator("mass_kg", mode="before")
    @classmethod
    def _solid(cls, given: Any, info: ValidationInfo) -> Any:
        if given is None:
            told = unlisted(info.data.get("material", "")).rstrip("; ")
            also = f"; {told}" if told else ""
            raise ValueError(f"a mass, or density_kg_m3 of a solid sphere{also}")
        return given

    @field_validator("shape", mode="before")
    @classmethod
    def _no_ball(cls, given: Any) -> Any:
        if given == "ball":
            raise ValueError("'rod' or 'sphere'; a ball is a sphere")
        return given

    @field_validator("radius_m", "length_m")
    @classmethod
    def _size_of_a_rod(cls, given: Quantity | None, info: ValidationInfo) -> Quantity | None:
        if given is None and info.data.get("shape") == "rod":
            raise ValueError("this key is needed for a rod")
        return given

    _within_the_tip = field_validator("tip_flat_radius_m")(_below("tip_radius_m"))
    _possible_inertia = field_validator("inertia_kg_m2")(possible_inertia)

    @property
    def weighed(self) -> bool:
        """Whether the mass is stated; else it follows from radius and density of a sphere."""
        density = value_of(self.density_kg_m3)
        return self.shape != "sphere" or self.mass_kg.value != solid_mass(
            self.tip_radius_m.value, density
        )

    @property
    def body_radius(self) -> float:
        """Radius of the rod's shank, or of the sphere [m]."""
        return (self.radius_m or self.tip_radius_m).value

    @property
    def length(self) -> float:
        """Distance between the centres of a rod's tip spheres [m]; 0 for a sphere."""
        return value_of(self.length_m, 0.0) if self.shape == "rod" else 0.0

    @property
    def inertia(self) -> float:
        """Moment of inertia about the centre of mass, across the axis [kg m^2].

        As given; else m (L^2/12 + r^2/4) of a rod, 2/5 m r^2 of a solid sphere.
        """
        if self.inertia_kg_m2 is not None:
            return self.inertia_kg_m2.value
        return solid_inertia(self.mass_kg.value, self.body_radius, self.length)

    def numbers(self, key: str, *, source: str = "") -> dict[str, float]:
        """Return the numbers of this table by their keys, of what is not stated those that follow.

        The length of a sphere is 0; its radius, where that is left out, its tip's. A number of a
        rigid body's metal is refused.
        """
        return {
            **super().numbers(key, source=source), f"{key}.radius_m": self.body_radius,
            f"{key}.length_m": self.length, f"{key}.inertia_kg_m2": self.inertia,
        }  # fmt: skip


class FrictionTable(InputTable):
    """`[friction]`."""

    coefficient: Friction | None = None
    """Coulomb's coefficient of friction."""


class EnvironmentTable(InputTable):
    """`[environment]`."""

    fluid: str = ""
    """What is between the bodies, for example air."""
    viscosity_Pa_s: NotNegative | None = None
    """Its viscosity."""
    density_kg_m3: NotNegative | None = None
    """Its density."""
    pressure_Pa: NotNegative | None = None
    """Its pressure."""
    temperature_K: Temperature | None = None
    """Temperature of bodies and surroundings."""


def _one_of(known: tuple[str, ...], *elsewhere: str) -> AfterValidator:
    def check(key: str) -> str:
        if key not in known:
            raise ValueError(", ".join((*known, *elsewhere)))
        return key

    return AfterValidator(check)


def _plain(given: Any) -> Any:
    """The value of a noise that is written as a quantity."""
    whole = isinstance(given, dict) and set(given) <= {"value", "std"} and "value" in given
    return given["value"] if whole else given


_EDGE = "dent_edge"
NoiseKey = Annotated[str, _one_of(NOISE_KEYS, _EDGE)]
NoiseStd = Annotated[float, BeforeValidator(_plain), Field(strict=True, gt=0.0)]
GaugeKey = Annotated[str, _one_of(GAUGE_KEYS)]
GaugeStd = Annotated[float, Field(strict=True, gt=0.0, le=0.5)]
DentEdge = Literal["contact", "rim"]


class Rig(InputTable):
    """What strikes what, where, and how noisy the readings are: the keys of set.toml."""

    format: str = ""
    """Version of the file's format."""
    name: str = ""
    """Name, for people."""
    description: str = ""
    """What was dropped on what, and how it was measured."""
    source: str = ""
    """Who measured it, where it is published."""
    licence: str = ""
    """Who may use it."""
    gravity_m_s2: Gravity = Quantity(value=9.81)
    """Gravity."""
    target: TargetTable
    """The flat."""
    strikers: dict[FileName, StrikerTable] = Field(min_length=1)
    """What strikes, by name: `[strikers.NAME]`."""
    friction: FrictionTable = FrictionTable()
    """Friction between tip and flat."""
    environment: EnvironmentTable = EnvironmentTable()
    """What is around the bodies."""
    noise: dict[NoiseKey, NoiseStd] = Field(default_factory=dict)
    """Standard deviations of the readings, by column; NAME_relative is a fraction of the value."""
    gauge: dict[GaugeKey, GaugeStd] = Field(default_factory=dict)
    """Relative standard deviation of a scale that all readings of a column share."""
    dent_edge: DentEdge = "contact"
    """In `[noise]`: what a dent's diameter is measured between, the largest contact circle or the
    rim (crest of the pile-up, or where the surface leaves its level)."""

    @model_validator(mode="before")
    @classmethod
    def _edge_stands_in_the_noise(cls, given: Any) -> Any:
        if not isinstance(given, dict):
            return given
        if _EDGE in given:
            raise ValueError(f"{_EDGE} stands in [noise]")
        noise = given.get("noise")
        if not isinstance(noise, dict) or _EDGE not in noise:
            return given
        rest = {k: v for k, v in noise.items() if k != _EDGE}
        return {**given, "noise": rest, _EDGE: noise[_EDGE]}

    @property
    def bodies(self) -> dict[str, BodyTable]:
        """Every body by the key of its table."""
        return {"target": self.target, **{f"strikers.{k}": t for k, t in self.strikers.items()}}

    def numbers(self, *, source: str = "") -> RigNumbers:
        """Return every number as stated, or as it follows; `source` names the file in errors."""
        of = {**quantities(self), **quantities(self.friction, "friction."),
              **quantities(self.environment, "environment.")}  # fmt: skip
        for key, table in self.bodies.items():
            of |= table.numbers(key, source=source)
        return RigNumbers(
            MappingProxyType(of), frozenset(k for k, t in self.bodies.items() if t.rigid),
            {k: t.material for k, t in self.bodies.items()},
            frozenset(f"strikers.{k}" for k, t in self.strikers.items() if not t.weighed),
        )  # fmt: skip
