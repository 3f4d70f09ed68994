"""The pairs that several checks share."""

from __future__ import annotations

import math

from ...core.material import Material, Pair

R = 1e-3
"""Radius of the sphere in every check that does not vary it [m]."""

RIGID = Material(E=math.nan, nu=math.nan, rigid=True)


def elastic_pair() -> Pair:
    """Two bodies of E = 200 GPa that never yield."""
    body = Material(E=200e9, nu=0.3)
    return Pair(sphere=body, flat=body, R=R)


def hertz_force(pair: Pair, delta: float) -> float:
    """F = 4/3 E' R^(1/2) delta^(3/2) (Johnson, Contact Mechanics, Eq. 4.23) [N]."""
    return 4.0 / 3.0 * pair.E_reduced * math.sqrt(pair.R) * math.pow(delta, 1.5)


def exact_yield_constant(nu: float) -> float:
    """C with p_0 = C Sy at first yield, from the axis stresses of Hertz's solution.

    The largest von Mises stress on the axis, found on a fine grid (Johnson, Contact Mechanics,
    Eqs. 3.45); Eq. 1.17 is a fit of this function.
    """
    n = 20000
    largest = max(abs(_axis_stress_difference(2.0 * (k + 0.5) / n, nu)) for k in range(n))
    return 1.0 / largest


def axis_stresses(z: float, nu: float) -> tuple[float, float]:
    """Radial and axial stress over p_0 at depth z (in a) below the centre of a Hertz contact.

    Johnson, Contact Mechanics, Eqs. 3.45.
    """
    axial = -1.0 / (1.0 + z * z)
    radial = -(1.0 + nu) * (1.0 - z * math.atan2(1.0, z)) + 0.5 / (1.0 + z * z)
    return radial, axial


def _axis_stress_difference(z: float, nu: float) -> float:
    radial, axial = axis_stresses(z, nu)
    return radial - axial
