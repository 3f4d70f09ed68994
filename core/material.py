"""The two materials and the radius of a contact pair, in SI units.

Every law, every finite-element case and every impact takes its numbers from a `Pair`; a contact
law itself owns no material number.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Self

from .errors import InputError
from .tables import html_table
from .unstated import unstated_equal

if TYPE_CHECKING:  # numpy comes with it, and the command line starts without
    from .flow import Flow


@unstated_equal
@dataclass(frozen=True, slots=True)
class Material:
    """An isotropic, elastic-perfectly-plastic body (or an elastic, a rigid, a hardening one).

    - `E`: Young's modulus [Pa].
    - `nu`: Poisson's ratio [-], 0 <= nu < 0.5.
    - `Sy`: uniaxial yield strength, a true (Cauchy) stress [Pa]; `inf` for a purely elastic body.
    - `rigid`: a body that does not deform at all; `E` and `Sy` are then ignored.
    - `density`: mass density [kg/m^3]; only dynamics needs it.
    - `name`: text for tables and pictures.
    - `flow`: how the strength changes with plastic strain, rate and heat; only the finite elements
      know of it, and its curve begins at `Sy`.

    Raises `InputError`: a number outside its range; the key is the field's name in input files.
    """

    E: float
    nu: float
    Sy: float = math.inf
    rigid: bool = False
    density: float = math.nan
    name: str = ""
    flow: Flow | None = None
    strength: float = field(init=False, repr=False, compare=False)
    """Yield strength [Pa]; infinite for an elastic or a rigid body."""

    def __post_init__(self) -> None:
        if self.rigid not in (True, False):
            raise InputError(repr(self.rigid), key="rigid", allowed="True or False")
        object.__setattr__(self, "strength", math.inf if self.rigid else self.Sy)
        if self.rigid:
            return
        if not (self.E > 0.0 and math.isfinite(self.E)):
            raise InputError(
                f"{self.E:g} is no modulus", key="E_Pa",
                allowed="a number above 0; for a rigid body rigid = true",
            )  # fmt: skip
        if not 0.0 <= self.nu < 0.5:
            raise InputError(f"{self.nu:g} is no Poisson ratio", key="nu", allowed="0 <= nu < 0.5")
        if not self.Sy > 0.0:
            raise InputError(
                f"{self.Sy:g} is no yield strength",
                key="Sy_Pa",
                allowed="a number above 0, or left out for a purely elastic body",
            )
        if self.flow is not None:
            self._check_flow(self.flow)

    def _check_flow(self, flow: Flow) -> None:
        if not hasattr(flow, "curve"):
            allowed = "a core.flow.Flow; dentscope.Material(flow=...) reads files and rows"
            raise InputError(repr(flow), key="flow", allowed=allowed)
        if math.isinf(self.Sy):
            raise InputError("missing", key="Sy_Pa", allowed="a strength where a flow law is given")
        if flow.curve is not None and abs(flow.curve.strength / self.Sy - 1.0) > 1e-9:
            raise InputError(
                f"{self.Sy:g}", key="Sy_Pa",
                allowed=f"the flow curve's first stress, {flow.curve.strength:g}",
            )  # fmt: skip

    @property
    def plane_strain_modulus(self) -> float:
        """E / (1 - nu^2) [Pa]; infinite for a rigid body."""
        return math.inf if self.rigid else self.E / (1.0 - self.nu**2)

    def with_(self, **changes: Any) -> Self:
        """Return a copy with some fields replaced.

        Raises `InputError`: in place of a number in SI units one that is of a metal in another.
        """
        from .inputs.ranges import in_si  # with numpy

        return replace(self, **in_si(self, changes))

    def strengthened(self, factor: float) -> Self:
        """Return the body with so many times its strength, its flow curve with it."""
        flow = self.flow
        if flow is not None and flow.curve is not None:
            flow = replace(flow, curve=flow.curve.scaled(factor))
        return replace(self, Sy=self.Sy * factor, flow=flow)


@dataclass(frozen=True, slots=True)
class Pair:
    """A sphere (or the round end of a rod) and the flat that it touches.

    `sphere`, `flat`: the two bodies; `R`: radius of the undeformed sphere [m].

    Field symbols: E' is the reduced modulus (1.7), Sy* the ratio of the sphere's strength to the
    flat's (2.1), `Sy_min` the strength of the weaker body.
    """

    sphere: Material
    flat: Material
    R: float
    Sy_min: float = field(init=False, repr=False, compare=False)
    """Yield strength of the weaker body [Pa]; infinite if neither yields."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "Sy_min", min(self.sphere.strength, self.flat.strength))
        if not (self.R > 0.0 and math.isfinite(self.R)):
            raise InputError(f"{self.R:g} is no radius", key="radius_m", allowed="a number above 0")
        if self.sphere.rigid and self.flat.rigid:
            raise InputError("both bodies are rigid", key="rigid", allowed="at most one rigid body")

    @property
    def turned(self) -> Self:
        """The same with sphere and flat in each other's place."""
        return replace(self, sphere=self.flat, flat=self.sphere)

    @property
    def E_reduced(self) -> float:
        """Reduced modulus E' [Pa], 1/E' = (1-nu_s^2)/E_s + (1-nu_f^2)/E_f (Eq. 1.7)."""
        return 1.0 / (1.0 / self.sphere.plane_strain_modulus + 1.0 / self.flat.plane_strain_modulus)

    @property
    def Sy_ratio(self) -> float:
        """Sy* = S_ys / S_yf (Eq. 2.1); nan if neither body yields."""
        s, f = self.sphere.strength, self.flat.strength
        if math.isinf(s) and math.isinf(f):
            return math.nan
        if math.isinf(f):
            return 0.0
        return math.inf if math.isinf(s) else s / f

    @property
    def first_yield(self) -> float:
        """Approach at first yield over R, (pi C Sy/(2 E'))^2 (Eq. 1.16); infinite if none yields.

        The smaller of the two bodies' values, C = 1.295 exp(0.736 nu) (Eq. 1.17 corrected).
        """
        return min(self._first_yield_of(body) for body in (self.sphere, self.flat))

    def _first_yield_of(self, body: Material) -> float:
        if math.isinf(body.strength):
            return math.inf
        pi_C = math.pi * 1.295 * math.exp(0.736 * body.nu)
        return (pi_C * body.strength / (2.0 * self.E_reduced)) ** 2

    @property
    def weaker(self) -> Material:
        """The body of smaller strength; the sphere when they are equal."""
        return self.sphere if self.sphere.strength <= self.flat.strength else self.flat

    def _repr_html_(self) -> str:
        rows = [
            (name, *("rigid" if b.rigid else f"{x:.4g}" for x in (b.E / 1e9, b.nu, b.Sy / 1e6)))
            for name, b in (("sphere", self.sphere), ("flat", self.flat))
        ]
        told = f"R = {self.R * 1e3:g} mm, E' = {self.E_reduced / 1e9:.4g} GPa"
        return html_table(("body", "E [GPa]", "nu", "Sy [MPa]"), rows, title=told)

    @property
    def perfectly_plastic(self) -> bool:
        """Whether both bodies keep their strength, whatever strain, rate and heat do to metals."""
        return self.sphere.flow is None and self.flat.flow is None

    @property
    def elastic_share(self) -> float:
        """Sphere's share of the approach in the elastic limit, E'(1-nu_s^2)/E_s (Eq. 2.3)."""
        return self.E_reduced / self.sphere.plane_strain_modulus
