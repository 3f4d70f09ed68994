"""What arithmetic says of a scene, before any simulation; used by `applies` and `attach`."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from ...core.arrays import Array
from ...core.material import Material
from ..scene import Scene
from ..strength import strength_table
from .base import Situation

_STEEL_DENSITY = 7800.0


def effective_mass(scene: Scene) -> float:
    """Mass that the normal motion of the contact point meets, 1/(1/m + c^2/I) [kg]."""
    striker = scene.striker
    c = 0.5 * striker.length * math.cos(scene.approach.angle)
    return 1.0 / (1.0 / striker.mass + c * c / striker.inertia)


def energy(scene: Scene) -> float:
    """Kinetic energy that the contact must take up, m_eff v^2 / 2 [J]."""
    return 0.5 * effective_mass(scene) * scene.approach.speed**2


def deepest(scene: Scene) -> float:
    """Depth that the law by itself reaches: at the energy of an impact, or a press's load [m]."""
    table = strength_table(scene.law, scene.pair)
    if scene.press is None:
        return table.peak(energy(scene))
    known = np.maximum.accumulate(table.stated.force)
    return float(np.exp(np.interp(math.log(scene.press.load), known, table.log_depth)))


def as_deep(scene: Scene) -> float:
    """Normal speed at which this striker's impact goes as deep as its press [m/s]."""
    table = strength_table(scene.law, scene.pair)
    work = np.interp(math.log(deepest(scene)), table.log_depth, np.log(table.work))
    return math.sqrt(2.0 * math.exp(float(work)) / effective_mass(scene))


def shortest_contact(scene: Scene) -> float:
    """Time of the shortest contact there is [s]: on a fully plastic dent until the striker stops.

    Its stiffness is 2 pi R 2.8 S_y; the strength of a metal that does not yield is a hundredth of
    its modulus.
    """
    strength = min(scene.pair.Sy_min, 0.01 * scene.pair.E_reduced)
    stiffness = 2.0 * math.pi * scene.pair.R * 2.8 * strength
    return 0.5 * math.pi * math.sqrt(effective_mass(scene) / stiffness)


def contact_time(scene: Scene) -> float:
    """Time of this blow's contact by its law alone, on a flat that does not move [s].

    The recovery is Hertz's, F_m x^(3/2) over the depth l: 1.472 l/sqrt(0.8 F_m l/m).
    """
    table, mass, work = strength_table(scene.law, scene.pair), effective_mass(scene), energy(scene)
    peak = table.peak(work)
    s = (np.arange(64) + 0.5) / 64.0
    at = np.log(peak * (1.0 - s**2))
    left = work - np.exp(np.interp(at, table.log_depth, np.log(table.work)))
    pressing = float(np.mean(2.0 * peak * s / np.sqrt(2.0 * np.maximum(left, 1e-9 * work) / mass)))
    force, back = (
        math.exp(float(np.interp(math.log(peak), table.log_depth, logs)))
        for logs in (table.stated.force, table.stated.recovery)
    )
    return pressing + 1.472 * back / math.sqrt(0.8 * force * back / mass)


def wave_speed(material: Material) -> float:
    """Speed of a wave that spreads into a flat, sqrt(E/((1 - nu^2) rho)) [m/s]."""
    return math.sqrt(material.plane_strain_modulus / density_of(material))


def density_of(material: Material) -> float:
    """Density as stated, else that of steel [kg/m^3]."""
    return material.density if math.isfinite(material.density) else _STEEL_DENSITY


def is_oblique(scene: Scene) -> bool:
    """Whether the contact point has a tangential motion, or gets one from the rod's lean."""
    leaning = scene.striker.length > 0.0 and scene.approach.angle < math.pi / 2.0 - 1e-6
    return leaning or scene.approach.tangential != 0.0 or scene.approach.spin != 0.0


def needs_yielding_law(situations: Sequence[Situation]) -> str:
    """Return the reason against a mechanism of the surface's shape, or ""."""
    if all(scene.law.name == "hertz" for scene, _ in situations):
        # its recovery is Hertz's own, so another loading curve would lose energy
        return "the bodies do not yield: the surface's shape takes no energy, and is not simulated"
    return ""


def slower(
    seen: Mapping[str, Array], restitution: Array, arrived: Array | float = 1.0
) -> dict[str, Array]:
    """Return the observables with another restitution, and with it the centre's rebound speed.

    `arrived` is the speed that the contact met over the one that the restitution is now of.
    """
    left = seen["restitution"] * arrived
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(left > 0.0, restitution / left, 1.0)
    rebound = seen["rebound_speed_m_s"] * ratio
    return {**seen, "rebound_speed_m_s": rebound, "restitution": restitution}


def times(present: tuple[float, ...], factors: Array) -> tuple[float, ...]:
    """Multiply two tables over the depth nodes; an empty one is neutral."""
    if not present:
        return tuple(factors.tolist())
    old = np.array(present)
    if len(old) != len(factors):
        grid = np.linspace(0.0, 1.0, len(factors))
        old = np.interp(grid, np.linspace(0.0, 1.0, len(present)), old)
    return tuple((old * factors).tolist())
