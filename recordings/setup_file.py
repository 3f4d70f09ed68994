"""The keys of set.toml as frozen, typed tables: what was dropped on what, and how well known.

The attributes carry the names of the keys, unit included, so that file and program speak the same
language. A value that the file leaves out is `None`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, field_validator, model_validator

from ..core.material import Material
from ..core.toml_input import InputTable

FORMAT = "recording-set/1"

Number = Annotated[float, Field(strict=True)]
PositiveNumber = Annotated[float, Field(strict=True, gt=0.0)]


class Quantity(InputTable):
    """A value and its standard deviation; 0 means taken as exact.

    Examples
    --------
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
        if isinstance(given, dict | Quantity):
            return given
        if isinstance(given, bool) or not isinstance(given, int | float):
            raise ValueError("a number, or { value = ..., std = ... }")
        return {"value": given}

    @property
    def relative(self) -> float:
        """Standard deviation over value [-]."""
        return self.std / abs(self.value) if self.value else 0.0


def _within(accept: Callable[[float], bool], allowed: str) -> AfterValidator:
    def check(quantity: Quantity) -> Quantity:
        if not accept(quantity.value):
            raise ValueError(allowed)
        return quantity

    return AfterValidator(check)


Positive = Annotated[Quantity, _within(lambda x: x > 0.0, "a number above 0")]
NotNegative = Annotated[Quantity, _within(lambda x: x >= 0.0, "a number not below 0")]
Poisson = Annotated[Quantity, _within(lambda x: 0.0 <= x < 0.5, "0 <= nu < 0.5")]


class _Body(InputTable):
    """Material keys of the flat and of every striker."""

    material: str = ""
    E_Pa: Positive | None = None
    nu: Poisson | None = None
    Sy_Pa: Positive | None = None
    density_kg_m3: Positive | None = None
    hardness_Pa: Positive | None = None
    Ra_m: NotNegative | None = None
    cp_J_kgK: Positive | None = None
    melting_K: Positive | None = None

    def to_material(self, *, E: float, nu: float, Sy: float) -> Material:
        """Return the `Material` at the stated values; `E`, `nu`, `Sy` replace those left out.

        Parameters
        ----------
        E, nu, Sy
            What to take where the set says nothing [Pa, -, Pa].
        """
        return Material(
            E=self.E_Pa.value if self.E_Pa else E,
            nu=self.nu.value if self.nu else nu,
            Sy=self.Sy_Pa.value if self.Sy_Pa else Sy,
            density=self.density_kg_m3.value if self.density_kg_m3 else float("nan"),
            name=self.material,
        )


class Target(_Body):
    """`[target]`: the flat, its support and the baseline that its law asks for."""

    shape: Literal["flat"] = "flat"
    thickness_m: Positive | None = None
    layer_thickness_m: Positive | None = None
    support_mass_kg: Positive | None = None
    support_stiffness_N_m: NotNegative | None = None
    law: Literal["elastic-plastic", "elastic", "measured-restitution"] = "elastic-plastic"


class Striker(_Body):
    """`[strikers.NAME]`: a rod with two round ends, or a sphere."""

    shape: Literal["rod", "sphere"]
    tip_radius_m: Positive
    mass_kg: Positive
    radius_m: Positive | None = None
    length_m: Positive | None = None
    tip_flat_radius_m: NotNegative | None = None
    inertia_kg_m2: Positive | None = None

    @property
    def body_radius(self) -> float:
        """Radius of the rod's shank, or of the sphere [m]."""
        return (self.radius_m or self.tip_radius_m).value

    @property
    def length(self) -> float:
        """Distance between the centres of a rod's tip spheres [m]; 0 for a sphere."""
        return self.length_m.value if self.shape == "rod" and self.length_m else 0.0

    @property
    def inertia(self) -> float:
        """Moment of inertia about the centre of mass, across the axis [kg m^2].

        As given; else m (L^2/12 + r^2/4) of a rod, 2/5 m r^2 of a solid sphere.
        """
        if self.inertia_kg_m2 is not None:
            return self.inertia_kg_m2.value
        m, r, L = self.mass_kg.value, self.body_radius, self.length
        return m * (L**2 / 12.0 + r**2 / 4.0) if self.shape == "rod" else 0.4 * m * r**2


class Friction(InputTable):
    """`[friction]`."""

    coefficient: NotNegative | None = None


class Environment(InputTable):
    """`[environment]`."""

    fluid: str = ""
    viscosity_Pa_s: NotNegative | None = None
    temperature_K: Positive | None = None


class Setup(InputTable):
    """All of set.toml."""

    format: Literal["recording-set/1"]
    name: str = ""
    description: str = ""
    source: str = ""
    licence: str = ""
    gravity_m_s2: NotNegative = Quantity(value=9.81)
    target: Target
    strikers: dict[str, Striker] = Field(min_length=1)
    friction: Friction = Friction()
    environment: Environment = Environment()
    noise: dict[str, PositiveNumber] = Field(default_factory=dict)

    @field_validator("noise", mode="before")
    @classmethod
    def _plain_numbers(cls, given: Any) -> Any:
        if not isinstance(given, dict):
            return given
        return {
            key: item["value"] if isinstance(item, dict) and set(item) <= {"value", "std"}
            and "value" in item else item
            for key, item in given.items()
        }  # fmt: skip
