"""Bounds that mechanics sets to an impact: masses, forces, contact sizes, durations, energies."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...core.inputs.rig_numbers import solid_mass
from ...core.rig import Quantity, StrikerTable, TargetTable
from ..rules import RULES

FULLY_PLASTIC = 2.84
"""Contact pressure of a fully developed dent over the yield strength (Tabor; thesis 1.2)."""

FIRST_BENDING = 4.730041
"""First root of cos(x) cosh(x) = 1: free-free bending."""


@dataclass(frozen=True, slots=True)
class Range:
    """Smallest and largest value, and the relative standard deviation of both."""

    low: float
    high: float
    relative: float


def geometric_mass(striker: StrikerTable) -> Range | None:
    """Return the mass that density and size allow [kg]; `None` without a density.

    A sphere: 4/3 pi rho r^3. A rod: from rho pi r^2 L, plain ends, to that and what the shank and
    the tip sphere have in common beyond its centre (hemispheres when tip and shank have one
    radius), L between the tips' centres. A flatter tip adds at most one shank radius of length,
    since the length of such a rod is measured over all.
    """
    if striker.density_kg_m3 is None:
        return None
    rho, r = striker.density_kg_m3, striker.radius_m or striker.tip_radius_m
    if striker.shape == "sphere":
        return _solid_sphere(rho, r)
    length, R = striker.length_m or Quantity(value=0.0), striker.tip_radius_m.value
    plain = rho.value * math.pi * r.value**2 * striker.length
    ends = rho.value * 2.0 * _end_volume(R, r.value)
    relative = math.hypot(math.hypot(rho.relative, 2.0 * r.relative), length.relative)
    return Range(plain, plain + ends, relative)


def second_mass(target: TargetTable) -> Range | None:
    """Return the mass that density and size allow a second sphere [kg].

    `None` where one is left out, and of a seat, whose radius is negative.
    """
    rho, r = target.density_kg_m3, target.radius_m
    return None if rho is None or r is None or r.value < 0.0 else _solid_sphere(rho, r)


def _solid_sphere(rho: Quantity, r: Quantity) -> Range:
    m = solid_mass(r.value, rho.value)
    return Range(m, m, math.hypot(rho.relative, 3.0 * r.relative))


def _end_volume(R: float, r: float) -> float:
    """Volume of a cylinder of radius r inside a sphere of radius R beyond its centre [m^3]."""
    if r >= R:
        return 2.0 / 3.0 * math.pi * R**3
    common = 2.0 / 3.0 * math.pi * (R**3 - math.sqrt(R**2 - r**2) ** 3)
    return min(common, math.pi * r**3)


def hardness(target: TargetTable, striker: StrikerTable) -> Quantity | None:
    """Return the pressure that makes a dent in the flat [Pa]: its hardness, else 2.84 S_y.

    `None` when neither is stated or when the striker is the weaker body.
    """
    if target.hardness_Pa is not None:
        found = target.hardness_Pa
    elif target.Sy_Pa is not None:
        found = Quantity(
            value=FULLY_PLASTIC * target.Sy_Pa.value, std=FULLY_PLASTIC * target.Sy_Pa.std
        )
    else:
        return None
    if target.strength and striker.strength and striker.strength.value < target.strength.value:
        return None
    return Quantity(value=found.value, std=found.std or RULES.unstated_strength * found.value)


def clearly_softer(target: TargetTable, striker: StrikerTable) -> bool:
    """Whether all that stays is left in the target."""
    if target.Sy_Pa is None:
        return False
    return striker.Sy_Pa is None or target.Sy_Pa.value < 0.6 * striker.Sy_Pa.value


def rod_area(striker: StrikerTable) -> float:
    """Cross-section of a rod's shank [m^2]."""
    return math.pi * striker.body_radius**2


def density(striker: StrikerTable) -> float:
    """Density of a rod: as stated, else its mass over its plain volume [kg/m^3]."""
    if striker.density_kg_m3 is not None:
        return striker.density_kg_m3.value
    return striker.mass_kg.value / (rod_area(striker) * striker.length)


def bar_wave_speed(striker: StrikerTable) -> float:
    """Speed of long waves in a rod, sqrt(E / rho) [m/s]; NaN without a modulus."""
    return math.sqrt(striker.E_Pa.value / density(striker)) if striker.E_Pa else math.nan


def wave_limit(striker: StrikerTable, speed: float) -> float:
    """Largest force at the end of an elastic rod that strikes end-on, rho c v A [N]."""
    return density(striker) * bar_wave_speed(striker) * speed * rod_area(striker)


def bending_period(striker: StrikerTable) -> float:
    """First free-free bending period of the shank (Euler-Bernoulli) [s].

    T = 2 pi L^2 / (x1^2 c r / 2), x1 = 4.730.
    """
    wave = bar_wave_speed(striker) * striker.body_radius / 2.0
    return 2.0 * math.pi * striker.length**2 / (FIRST_BENDING**2 * wave)


def dent_radius(striker: StrikerTable, depth: float) -> float:
    """Radius of a crater that has the tip's shape and this depth [m], at most the shank's.

    a^2 = 2 R d - d^2; pile-up and elastic recovery change it.
    """
    a = open_dent_radius(striker.tip_radius_m.value, depth)
    return min(a, striker.body_radius) if striker.shape == "rod" else a


def open_dent_radius(R: float, depth: float) -> float:
    """The same of a radius R, without the limit of the shank [m]."""
    return math.sqrt(max(2.0 * R * depth - depth**2, 0.0)) if depth < R else R


def dent_work(R: float, depth: float, pressure: float) -> float:
    """Work of pressing a crater of the tip's shape at a constant pressure, p pi R d^2 [J]."""
    return pressure * math.pi * R * depth**2


def plastic_duration(striker: StrikerTable, mass: float, pressure: float) -> float:
    """Duration of the loading at constant pressure, (pi/2) sqrt(m / (2 pi R p)) [s]."""
    return 0.5 * math.pi * math.sqrt(mass / (2.0 * math.pi * striker.tip_radius_m.value * pressure))
