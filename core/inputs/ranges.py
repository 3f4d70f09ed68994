"""Ranges that numbers of real bodies keep, and the units that those outside may be meant in."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

from ..arrays import one_number
from ..errors import InputError

if TYPE_CHECKING:
    from ..material import Material
    from ..rig import Quantity

Stated = TypeVar("Stated", float, "Quantity")

# limit: largest standard deviation over a value that is stated [-]; what is known within e^100
# either way is not known: leave it out
LEAST_KNOWN = 100.0

# limit: smallest standard deviation over a value [-]; 0.05 of a modulus in Pa is a fraction
BEST_KNOWN = 1e-7


@dataclass(frozen=True)
class Within:
    """Accepts what is of a range; says which in `allowed`, for errors and the reference."""

    accept: Callable[[float], bool]
    allowed: str
    units: tuple[tuple[str, float], ...] = ()

    def __call__(self, quantity: Stated) -> Stated:
        """Return the quantity, or the number, if it lies in the range."""
        stated: Any = quantity
        if wanted := self.wanted(getattr(stated, "value", stated)):
            raise ValueError(wanted)
        relative = getattr(stated, "relative", 0.0)
        if relative > LEAST_KNOWN:
            raise ValueError(f"a std of at most {LEAST_KNOWN:g} times the value")
        if 0.0 < relative < BEST_KNOWN:
            raise ValueError(f"0, or a std from {BEST_KNOWN:g} times the value on, in its unit")
        return quantity

    def wanted(self, value: float) -> str:
        """Return what is allowed, and the unit perhaps meant; empty for a value in the range."""
        if self.accept(value):
            return ""
        meant = ((unit, times * value) for unit, times in self.units if self.accept(times * value))
        return self.allowed + next((f"; {value:g} {u} would be {x:g}" for u, x in meant), "")


def span(low: float, high: float, **units: float) -> Within:
    """Return a range that every real body keeps; a number outside it is mostly in another unit."""
    allowed = f"a number from {low:g} to {high:g}"
    return Within(lambda x: low <= x <= high, allowed, tuple(units.items()))


STRENGTHS = span(1e3, 5e11, MPa=1e6, GPa=1e9)
"""Of any stress at which a metal flows [Pa]."""
HARDNESSES = span(1e3, 5e11, **{"HBW or HV": 9.80665e6, "GPa": 1e9})
STRAINS = span(0.0, 3.0, **{"%": 1e-2})
"""Of measured plastic strains: torsion reaches the largest."""
SPEEDS = span(1e-9, 2e4, **{"mm/s": 1e-3})
"""Of any approach [m/s]."""
RADII = span(1e-9, 3.0, mm=1e-3, um=1e-6)
MODULI = span(1e3, 2e12, GPa=1e9, MPa=1e6)
DENSITIES = span(25.0, 25e3, **{"g/cm^3": 1e3})


def in_si(body: Material, changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return changes of a body, numbers as such; refuse what would take it out of SI units."""
    found = dict(changes)
    for name, known in (("E", MODULI), ("Sy", STRENGTHS), ("density", DENSITIES)):
        if name not in changes:
            continue
        key = "density_kg_m3" if name == "density" else f"{name}_Pa"
        now = found[name] = one_number(changes[name], source="Material", key=key)
        was, wanted = getattr(body, name), known.wanted(now)
        if (known.accept(was) or not math.isfinite(was)) and wanted not in ("", known.allowed):
            raise InputError(f"{now:g}", source="Material", key=key, allowed=wanted)
    return found
