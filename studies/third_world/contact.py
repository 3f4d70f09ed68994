"""Loading and unloading of a sphere on a softer flat, by rules that nothing else here uses.

Loading: mean pressure against E'a/(Y R): Hertz's line up to first yield, Meyer's power law where
the dent is plastic (Meyer, VDI-Z. 52 (1908) 645; Tabor, The hardness of metals, 1951), a cubic in
the logarithms between them (regimes of Johnson, J. Mech. Phys. Solids 18 (1970) 115; joined as by
Brake, Int. J. Solids Struct. 49 (2012) 3129). The contact's edge leaves Hertz's a^2 = R d for
a^2 = c R d, with a larger c where more metal piles up (Norbury and Samuel, J. Iron Steel Inst. 117
(1928) 673).

Unloading: F = F_m ((d - d_r)/(d_m - d_r))^n, its first slope that of a punch, 2 E'a (Oliver and
Pharr, J. Mater. Res. 7 (1992) 1564), so that d_m - d_r = n F_m/(2 E'a).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ...core.arrays import Array

_YIELD = 1.07
"""Mean pressure over strength at first yield, von Mises (Johnson, Contact mechanics, 1985)."""

_START = 0.75 * math.pi * _YIELD
_PLASTIC = 12.0
_EDGE = (3.8, 170.0)  # E'a/(Y R) between which the edge leaves Hertz's
_WIDE = np.linspace(math.log(1e-6), math.log(1e5), 3000)


@dataclass(frozen=True)
class Law:
    """What the dents of one metal are like; the defaults are finite elements' within 5 % rms.

    - `hardness`: mean pressure over strength at E'a/(Y R) = 12.
    - `meyer`: meyer's exponent m.
    - `pile`: c of the contact's edge in deep dents.
    - `unloading`: exponent n of the unloading where the dent is plastic.
    - `fall`: share by which the pressure falls with a/R, as in dents that are no longer shallow.
    """

    hardness: float = 2.53
    meyer: float = 2.08
    pile: float = 2.46
    unloading: float = 1.23
    fall: float = 0.44
    _curve: tuple[Array, Array] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        x = np.exp(_WIDE)
        span, rise = math.log(_PLASTIC / _START), self.meyer - 2.0
        s = np.clip(np.log(x / _START) / span, 0.0, 1.0)
        cubic = (
            math.log(_YIELD) * (1.0 + 2.0 * s) * (1.0 - s) ** 2 + span * s * (1.0 - s) ** 2
            + math.log(self.hardness) * s * s * (3.0 - 2.0 * s) - span * rise * s * s * (1.0 - s)
        )  # fmt: skip
        meyer = cubic + rise * np.maximum(np.log(x / _PLASTIC), 0.0)
        pressure = np.where(x < _START, x / (0.75 * math.pi), np.exp(meyer))
        edge = 1.0 + (self.pile - 1.0) * _smooth(x, *_EDGE)
        curve = (np.log(x * x / edge), np.log(math.pi * x * x * pressure))
        object.__setattr__(self, "_curve", curve)

    def load(self, d: Array, E: Array, Y: Array, R: Array) -> tuple[Array, Array]:
        """Force [N] and contact radius [m] of a first loading to the depths d [m], (n,) each."""
        W = np.log(np.maximum(d, 1e-15) * E * E / (Y * Y * R))
        x = np.exp(np.interp(W, self._curve[0], _WIDE))
        F = np.exp(np.interp(W, *self._curve)) * Y**3 * R * R / (E * E)
        return np.where(d > 0.0, F, 0.0), x * Y * R / E

    def exponent(self, a: Array, E: Array, Y: Array, R: Array) -> Array:
        """Exponent of the unloading from a contact radius, Hertz's where nothing yields."""
        return 1.5 + (self.unloading - 1.5) * _smooth(E * a / (Y * R), _START, _PLASTIC)


def _smooth(x: Array, low: float, high: float) -> Array:
    s = np.clip(np.log(x / low) / math.log(high / low), 0.0, 1.0)
    return np.asarray(s * s * (3.0 - 2.0 * s))


def reduced(E1: float, nu1: float, E2: float, nu2: float) -> float:
    """Contact modulus of two bodies [Pa]."""
    return 1.0 / ((1.0 - nu1**2) / E1 + (1.0 - nu2**2) / E2)
