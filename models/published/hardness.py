"""Mean pressure in full plasticity over the yield strength, as functions of a/R or E'/Sy.

They take numbers or arrays of any shape. `FLATTENING` and `INDENTATION` list them in the order of
the equations, for pictures and tables.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from numba import njit

from ...core.arrays import Array
from ...core.errors import InputError

_PRANDTL = (2.0 + math.pi) / math.sqrt(3.0)


def kogut_komvopoulos(modulus_ratio: npt.ArrayLike) -> Array:
    """p/S = 0.201 ln(E'/S) + 1.685 (Eq. 1.9)."""
    return np.asarray(0.201 * np.log(np.asarray(modulus_ratio, float)) + 1.685)


def yu_blanchard(a_over_R: npt.ArrayLike) -> Array:
    """p/S = (2/sqrt 3) (2.845 - 0.4921 a/R) (Eq. 1.10); above finite elements."""
    return np.asarray(2.0 / math.sqrt(3.0) * (2.845 - 0.4921 * np.asarray(a_over_R, float)))


def alcala(a_over_R: npt.ArrayLike) -> Array:
    """p/S = 3.044 - 1.885 a/R (Eq. 1.11)."""
    return np.asarray(3.044 - 1.885 * np.asarray(a_over_R, float))


def olsson_larsson(a_over_R: npt.ArrayLike, *, LD: float) -> Array:
    """p/S = 3 {1 - 0.0461 [ln(a/R) - ln(L D)]^2.214} (Eq. 1.12), a/R >= L D.

    The thesis defines neither L nor D and the paper was not readable, so that their product is the
    caller's, a positive number; below it the power has no real value and the pressure is 3 S.
    """
    if not 0.0 < LD < math.inf:
        raise InputError(f"{LD:g}", key="LD", allowed="a number above 0")
    x = np.log(np.maximum(np.asarray(a_over_R, float) / LD, 1.0))
    return np.asarray(3.0 * (1.0 - 0.0461 * x**2.214))


@njit(cache=True, _nrt=False, error_model="numpy")
def slip_line_pressure(x):
    """p/S of 1.13 at x = a/R, for use inside compiled laws."""
    if x < 1e-4:  # the series replaces the difference of two equal terms
        return _PRANDTL - 4.0 * math.sqrt(3.0) / 9.0 * x
    rest = max(1.0 - x * x, 0.0)
    arc = (1.0 + math.acos(min(x, 1.0))) * rest * math.sqrt(rest)
    bracket = x * x * x / 3.0 - arc - x + 0.5 * math.pi + 1.0
    return 4.0 / (3.0 * math.sqrt(3.0)) / (x * x) * bracket


def slip_line(a_over_R: npt.ArrayLike) -> Array:
    """Slip-line hardness of Jackson, Ghaednia and Pope (Eq. 1.13); (2 + pi)/sqrt 3 at a/R = 0."""
    x = np.asarray(a_over_R, float)
    return np.array([slip_line_pressure(v) for v in x.ravel()]).reshape(x.shape)


def jackson_green(a_over_R: npt.ArrayLike) -> Array:
    """p/S = 2.84 [1 - exp(-0.82 (a/R)^-0.7)] (Eq. 1.14); 2.84 at a/R = 0."""
    x = np.maximum(np.asarray(a_over_R, float), 1e-300)
    return np.asarray(2.84 * (1.0 - np.exp(-0.82 * x**-0.7)))


def jackson_green_2007(a_over_R: npt.ArrayLike) -> Array:
    """p/S = 2.84 - 0.92 [1 - cos(pi a/R)] (Eqs. 1.15, 2.35), a/R <= 1."""
    x = np.minimum(np.asarray(a_over_R, float), 1.0)
    return np.asarray(2.84 - 0.92 * (1.0 - np.cos(math.pi * x)))


INDENTATION: dict[str, Callable[[npt.ArrayLike], Array]] = {
    "Yu and Blanchard (1.10)": yu_blanchard,
    "Alcalá and Esqué-de los Ojos (1.11)": alcala,
    "Jackson, Ghaednia and Pope (1.13)": slip_line,
}
"""Laws of a/R for a flat under a rigid sphere."""

FLATTENING: dict[str, Callable[[npt.ArrayLike], Array]] = {
    "Jackson and Green (1.14)": jackson_green,
    "the later form (1.15)": jackson_green_2007,
}
"""Laws of a/R for a sphere under a rigid flat."""
