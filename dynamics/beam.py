"""Axial and bending modes of a free rod, and how far the struck tip moves in each.

Axial modes are exact; bending modes are those of a free-free Timoshenko beam by a Ritz method in
Legendre polynomials, which meets the free ends naturally and converges exponentially.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, lru_cache

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import eigh

from ..core.arrays import Array
from ..core.errors import InputError
from ..core.material import Material

# limit: length over radius of a rod at most [-]; up to it round-off moves no frequency by more
# than 0.5 %
_SLENDER = 3000.0


@dataclass(frozen=True, slots=True)
class Modes:
    """Vibration modes of the striker; none by default (a rigid body).

    - `frequencies`: (n,) angular frequencies [rad/s].
    - `axial`, `transverse`, `rotation`: (n,) of the struck end, mass-normalised: displacement along
      the axis (towards the far end), displacement across it [kg^-1/2], and slope [kg^-1/2 m^-1].
    - `loss_factor`: twice the damping ratio, the same for each mode [-].
    """

    frequencies: tuple[float, ...] = ()
    axial: tuple[float, ...] = ()
    transverse: tuple[float, ...] = ()
    rotation: tuple[float, ...] = ()
    loss_factor: float = 0.0

    def at_contact(self, angle: float, tip_radius: float) -> Array:
        """Return (3, n): displacement per modal coordinate, along x and y at the contact point.

        The third row is that of the tip's centre along x: below it lies the place of contact.
        """
        along = np.asarray(self.axial, dtype=float)
        across = np.asarray(self.transverse, dtype=float)
        turn = np.asarray(self.rotation, dtype=float)
        x = along * math.cos(angle) - across * math.sin(angle)
        y = along * math.sin(angle) + across * math.cos(angle)
        return np.stack([x + turn * tip_radius, y, x])

    def scaled(self, by: Callable[[float], float]) -> Modes:
        """Return the modes with another displacement of the struck end, by the one it has."""
        axial, transverse, rotation = (
            tuple(map(by, shape)) for shape in (self.axial, self.transverse, self.rotation)
        )
        return replace(self, axial=axial, transverse=transverse, rotation=rotation)


def axial_frequencies(length: float, material: Material, *, count: int) -> Array:
    """Angular frequencies of a free-free rod, k pi c / L with c = sqrt(E / rho) [rad/s].

    Examples
    --------
    >>> steel = Material(E=200e9, nu=0.3, density=7800.0)
    >>> round(float(2e3 * np.pi / axial_frequencies(0.3048, steel, count=1)[0]), 4)  # round trip
    0.1204
    """
    c = math.sqrt(material.E / material.density)
    return np.arange(1.0, count + 1.0) * (math.pi * c / length)


def shear_coefficient(nu: float) -> float:
    """Cowper's coefficient of a round section, 6 (1 + nu) / (7 + 6 nu).

    G. R. Cowper, J. Appl. Mech. 33 (1966) 335-340.
    """
    return 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu)


def bending_modes(
    length: float, radius: float, material: Material, *, count: int, degree: int = 0
) -> tuple[Array, Array, Array]:
    """Bending modes of a free-free Timoshenko beam of round section; lengths [m].

    `degree` is the highest Legendre polynomial; by default enough for 1e-8 of the highest frequency
    asked. Returns angular frequencies (count,) [rad/s]; displacement and slope [1/m] of the struck
    end for modes of unit mean square mass (modal mass = the beam's mass).
    """
    degree = degree or 2 * count + 14
    n = degree + 1
    weight, value, steepness, end = _polynomials(degree)
    area, second = math.pi * radius**2, math.pi * radius**4 / 4.0
    shear = shear_coefficient(material.nu) * material.E / (2.0 * (1.0 + material.nu)) * area
    slope = steepness * (2.0 / length)
    w = weight * length / 2.0

    def integral(left: Array, right: Array) -> Array:
        return np.asarray((left * w[:, None]).T @ right)

    ss, sv, vv = integral(slope, slope), integral(slope, value), integral(value, value)
    stiffness = np.block(
        [[shear * ss, -shear * sv], [-shear * sv.T, material.E * second * ss + shear * vv]]
    )
    zero = np.zeros_like(vv)
    mass = material.density * np.block([[area * vv, zero], [zero, second * vv]])
    squared, shape = eigh(stiffness, mass, subset_by_index=[2, count + 1])
    scale = math.sqrt(material.density * area * length)
    return np.sqrt(squared), scale * end @ shape[:n], scale * end @ shape[n:]


@cache
def _polynomials(degree: int) -> tuple[Array, Array, Array, Array]:
    """Legendre's: weights of the points, values and slopes there (points, n), values at -1."""
    point, weight = (np.asarray(x, dtype=float) for x in legendre.leggauss(degree + 2))
    value: Array = np.asarray(legendre.legvander(point, degree), dtype=float)
    slope: Array = np.stack(
        [legendre.legval(point, legendre.legder(one)) for one in np.eye(degree + 1)], axis=1
    )
    return weight, value, slope, legendre.legvander(np.array([-1.0]), degree)[0]


@lru_cache(maxsize=256)
def rod_modes(
    length: float, radius: float, material: Material, *, mass: float, count: int,
    loss_factor: float = 0.0,
) -> Modes:  # fmt: skip
    """Return the `count` modes of lowest frequency, axial and bending together.

    Frequencies follow from the material and the geometry, the modal masses from the stated mass. A
    rod without length, density or finite modulus, or too slender for double precision, is refused.
    """
    if count == 0:
        return Modes()
    if not (length > 0.0 and math.isfinite(material.density) and not material.rigid):
        raise InputError(
            "vibration modes need a deformable rod with a length and a density",
            key="modes",
            allowed="0, or length_m, E_Pa and density_kg_m3 of the striker",
        )
    if length > _SLENDER * radius:
        raise InputError(
            f"vibration modes of a rod {length / radius:.3g} radii long", key="modes",
            allowed=f"0, or a rod of at most {_SLENDER:g} radii",
        )  # fmt: skip
    axial = axial_frequencies(length, material, count=count)
    bending, transverse, slope = bending_modes(length, radius, material, count=count)
    zero = np.zeros(count)
    table = np.stack(
        [
            np.concatenate([axial, bending]),
            np.concatenate([np.full(count, math.sqrt(2.0)), zero]) / math.sqrt(mass),
            np.concatenate([zero, transverse]) / math.sqrt(mass),
            np.concatenate([zero, slope]) / math.sqrt(mass),
        ]
    )
    table = table[:, np.argsort(table[0], kind="stable")[:count]]
    omega, along, across, turn = (tuple(row.tolist()) for row in table)
    return Modes(omega, along, across, turn, loss_factor)
