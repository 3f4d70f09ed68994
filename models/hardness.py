"""Mean pressure in full plasticity over the yield strength, as functions of a/R or E'/Sy.

All are compiled element by element: they take numbers or arrays of any shape.
"""

from __future__ import annotations

import math

from numba import float64, njit, vectorize

scalar = vectorize([float64(float64)], cache=True)
_PRANDTL = (2.0 + math.pi) / math.sqrt(3.0)


@scalar
def kogut_komvopoulos(modulus_ratio):
    """p/S = 0.201 ln(E'/S) + 1.685 (Eq. 1.9)."""
    return 0.201 * math.log(modulus_ratio) + 1.685


@scalar
def yu_blanchard(a_over_R):
    """p/S = (2/sqrt 3) (2.845 - 0.4921 a/R) (Eq. 1.10); above finite elements."""
    return 2.0 / math.sqrt(3.0) * (2.845 - 0.4921 * a_over_R)


@scalar
def alcala(a_over_R):
    """p/S = 3.044 - 1.885 a/R (Eq. 1.11)."""
    return 3.044 - 1.885 * a_over_R


@njit(float64(float64), cache=True, error_model="numpy")
def slip_line_pressure(x):
    """p/S of 1.13 at x = a/R, for use inside compiled laws."""
    if x < 1e-4:  # the series replaces the difference of two equal terms
        return _PRANDTL - 4.0 * math.sqrt(3.0) / 9.0 * x
    rest = max(1.0 - x * x, 0.0)
    arc = (1.0 + math.acos(min(x, 1.0))) * rest * math.sqrt(rest)
    bracket = x * x * x / 3.0 - arc - x + 0.5 * math.pi + 1.0
    return 4.0 / (3.0 * math.sqrt(3.0)) / (x * x) * bracket


@scalar
def slip_line(a_over_R):
    """Slip-line hardness of Jackson, Ghaednia and Pope (Eq. 1.13); (2 + pi)/sqrt 3 at a/R = 0."""
    return slip_line_pressure(a_over_R)


@scalar
def jackson_green(a_over_R):
    """p/S = 2.84 [1 - exp(-0.82 (a/R)^-0.7)] (Eq. 1.14); 2.84 at a/R = 0."""
    if a_over_R <= 0.0:
        return 2.84
    return 2.84 * (1.0 - math.exp(-0.82 * a_over_R**-0.7))


@scalar
def jackson_green_2007(a_over_R):
    """p/S = 2.84 - 0.92 [1 - cos(pi a/R)] (Eqs. 1.15, 2.35), a/R <= 1."""
    return 2.84 - 0.92 * (1.0 - math.cos(math.pi * min(a_over_R, 1.0)))
