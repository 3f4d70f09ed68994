"""The numbers of a rig: what an input file says, read once, in SI, each under its key there.

What varies (nuisances, mechanisms, sweeps) takes this value and returns another; no file's table is
read again and nothing is checked anew below it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

from ..errors import InputError
from ..material import Material


@dataclass(frozen=True, eq=False)
class RigNumbers:
    """One immutable value of floats with an index by key.

    - `of`: every number by its key, for example `target.E_Pa` or `strikers.ball.mass_kg` [SI]. Of a
      body also what follows: the strength from a hardness (`inf` where it does not yield), a
      striker's radius, length between its tips (0 of a sphere) and inertia.
    - `rigid`: tables of the bodies that do not deform.
    - `metals`: name of each body's metal, by its table.
    - `solids`: tables of the spheres whose mass follows from their radius.
    """

    of: Mapping[str, float]
    rigid: frozenset[str] = frozenset()
    metals: Mapping[str, str] = field(default_factory=dict)
    solids: frozenset[str] = frozenset()

    def __reduce__(self) -> tuple[object, ...]:
        """Return how it is made again in another process, which takes no view of a mapping."""
        return _made_again, (dict(self.of), self.rigid, dict(self.metals), self.solids)

    def with_(self, changes: Mapping[str, float]) -> RigNumbers:
        """Return the same with some numbers replaced.

        A mass takes its inertia with it, the radius of a sphere that was not weighed its mass.
        """
        of = {**self.of, **changes}
        for key, mass in changes.items():
            body = key.removesuffix(".mass_kg")
            inertia = f"{body}.inertia_kg_m2"
            if body != key and inertia in self.of:
                of[inertia] = self.of[inertia] * mass / self.of[key]
        for body in self.solids:
            larger = of[f"{body}.tip_radius_m"] / self.of[f"{body}.tip_radius_m"]
            if larger != 1.0:
                for name, power in (("radius_m", 1), ("mass_kg", 3), ("inertia_kg_m2", 5)):
                    of[f"{body}.{name}"] *= larger**power
        return replace(self, of=MappingProxyType(of))

    def assuming(self, **numbers: float) -> RigNumbers:
        """Return the same with these numbers of every body that deforms and lacks them."""
        lacking = {
            f"{body}.{name}": value
            for body in self.metals
            for name, value in numbers.items()
            if body not in self.rigid and f"{body}.{name}" not in self.of
        }
        return self.with_(lacking)

    def with_striker(self, name: str, like: str, numbers: Mapping[str, float]) -> RigNumbers:
        """Return the same with one more striker, of the metal of `like` and of these numbers."""
        of, key = {f"strikers.{name}.{k}": x for k, x in numbers.items()}, f"strikers.{name}"
        rigid = self.rigid | {key} if f"strikers.{like}" in self.rigid else self.rigid
        return replace(
            self, of=MappingProxyType({**self.of, **of}), rigid=rigid,
            metals={**self.metals, key: self.metals[f"strikers.{like}"]},
        )  # fmt: skip

    def striker(self, name: str) -> dict[str, float]:
        """Return the numbers of one striker by the last part of their keys."""
        table = f"strikers.{name}."
        return {k.removeprefix(table): x for k, x in self.of.items() if k.startswith(table)}

    def material(self, body: str, *, source: str = "") -> Material:
        """Return the metal of a body by its table; `source` is the file that errors name.

        Refused where modulus or Poisson's ratio is missing, or a number is outside its range.
        """
        name = self.metals[body]
        if body in self.rigid:
            return Material(E=math.nan, nu=math.nan, rigid=True, name=name)
        of = self.of
        # a listed material has both
        unlisted = f", or a material of `dentscope materials`, which {name!r} is not"
        for key in (f"{body}.E_Pa", f"{body}.nu"):
            if key not in of:
                raise InputError(
                    "missing", source=source, key=key,
                    allowed=f"a number (or rigid = true){unlisted if name else ''}",
                )  # fmt: skip
        return Material(
            E=of[f"{body}.E_Pa"], nu=of[f"{body}.nu"], Sy=of[f"{body}.Sy_Pa"],
            density=of.get(f"{body}.density_kg_m3", math.nan), name=name,
        )  # fmt: skip


def _made_again(of: dict[str, float], *others: Any) -> RigNumbers:
    return RigNumbers(MappingProxyType(of), *others)


def solid_mass(radius: float, density: float) -> float:
    """Return the mass of a solid sphere [kg]."""
    return 4.0 / 3.0 * math.pi * radius**3 * density


def solid_inertia(mass: float, radius: float, length: float) -> float:
    """Return the moment of inertia across the axis [kg m^2] of a solid rod, or sphere if L = 0.

    m (L^2/12 + r^2/4) or 2/5 m r^2.
    """
    if length > 0.0:
        return mass * (length**2 / 12.0 + radius**2 / 4.0)
    return 0.4 * mass * radius**2
