"""How a metal's flow stress depends on plastic strain, rate and its own heat.

A flow curve is a table of true (Cauchy) stress over equivalent plastic strain, between whose rows
runs a cubic with the slopes of the table; Swift's, Ludwik's, Voce's and Johnson and Cook's laws are
ways to write one. The finite elements solve with it; laws in closed form take the strength alone.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import lru_cache
from typing import Any, Literal

import numpy as np

from .arrays import Array
from .errors import InputError
from .rules import RULES

# limit: last plastic strain of a written law's table [-]; beyond every strain in a contact
FLOW_LAST = 10.0


@dataclass(frozen=True, slots=True)
class FlowCurve:
    """True stress over equivalent plastic strain; constant beyond the last row.

    `strain`: equivalent plastic strains, increasing from 0 [-]; `stress`: flow stress there [Pa];
    `slope`: its slope there [Pa].

    Raises `InputError`: the table does not begin at 0, does not increase, or holds a stress that is
    not positive.
    """

    strain: tuple[float, ...]
    stress: tuple[float, ...]
    slope: tuple[float, ...]

    def __post_init__(self) -> None:
        strain, stress = np.array(self.strain), np.array(self.stress)
        if not len(strain) == len(stress) == len(self.slope) >= 2:
            raise InputError(f"{len(strain)} rows", key="flow_curve", allowed="two or more rows")
        if strain[0] != 0.0:
            raise InputError(
                f"begins at {strain[0]:g}", key="flow_curve", allowed="a first plastic strain of 0"
            )
        for k in np.flatnonzero(~(np.diff(strain) > 0.0)):
            allowed = f"plastic strains that increase (above {strain[k]:g})"
            raise InputError(f"{strain[k + 1]:g} in row {k + 2}", key="flow_curve", allowed=allowed)
        for k in np.flatnonzero(~((stress > 0.0) & np.isfinite(stress))):
            allowed = "stresses above 0 [Pa]"
            raise InputError(f"{stress[k]:g} in row {k + 1}", key="flow_curve", allowed=allowed)

    def __repr__(self) -> str:
        last = f"{self.stress[-1]:.4g} Pa at {self.strain[-1]:g}"
        return f"FlowCurve({self.stress[0]:.4g} Pa at 0 to {last}, {len(self.strain)} rows)"

    @property
    def strength(self) -> float:
        """Flow stress at first yield [Pa]."""
        return self.stress[0]

    def scaled(self, factor: float) -> FlowCurve:
        """Return the curve with so many times its stresses."""
        stress, slope = (tuple(factor * y for y in row) for row in (self.stress, self.slope))
        return FlowCurve(self.strain, stress, slope)

    def drawn_together(self, factor: float) -> FlowCurve:
        """Return the curve with its strains divided by `factor`."""
        strain = tuple(x / factor for x in self.strain)
        return FlowCurve(strain, self.stress, tuple(factor * y for y in self.slope))

    def __call__(self, strain: float) -> float:
        """Flow stress at a plastic strain [Pa]."""
        if strain >= self.strain[-1]:
            return self.stress[-1]
        return float(_spline(self)(strain))


@lru_cache(maxsize=1024)
def _spline(curve: FlowCurve) -> Any:
    from scipy.interpolate import CubicHermiteSpline

    return CubicHermiteSpline(curve.strain, curve.stress, curve.slope)


def tabulated(strain: Array, stress: Array) -> FlowCurve:
    """Flow curve through measured rows, smooth and without overshoot (Fritsch and Butland, 1984).

    Equivalent plastic strain [-] and true stress [Pa], shape (n,); two rows make a line.
    """
    rows = (tuple(map(float, strain)), tuple(map(float, stress)))
    if len(strain) != len(stress) or len(strain) < 2 or not (np.diff(strain) > 0.0).all():
        return FlowCurve(*rows, slope=(0.0,) * len(strain))  # says what is wrong
    from scipy.interpolate import PchipInterpolator

    slope = PchipInterpolator(strain, stress).derivative()(strain)
    return FlowCurve(*rows, slope=tuple(map(float, slope)))


_LEAST = sys.float_info.min
"""The least number whose inverse is one too."""


def swift(*, Sy: float, K: float, n: float) -> FlowCurve:
    """Swift's law K (e0 + p)^n, e0 = (Sy/K)^(1/n) (J. Mech. Phys. Solids 1 (1952) 1)."""
    start = (Sy / K) ** (1.0 / n)
    # a small exponent takes e0 to 0, where the slope is infinite: three times the first row's mean
    # is as steep as a cubic may begin without overshoot (Fritsch and Carlson, 1980)
    steepest = 3.0 * (K * (start + RULES.flow_first) ** n - Sy) / RULES.flow_first
    return _written(
        lambda p: np.maximum(K * (start + p) ** n, Sy),
        lambda p: n * K * (start + p) ** (n - 1.0),
        first=min(n * K * start ** (n - 1.0), steepest) if start > _LEAST else steepest,
    )


def ludwik(*, Sy: float, K: float, n: float) -> FlowCurve:
    """Ludwik's law Sy + K p^n (1909); with K = B also Johnson and Cook's at rest and cold."""
    # it leaves the origin vertically: a straight line up to the second row
    return _written(
        lambda p: Sy + K * p**n,
        lambda p: n * K * p ** (n - 1.0),
        first=K * RULES.flow_first ** (n - 1.0),
    )


def voce(*, Sy: float, Q: float, b: float) -> FlowCurve:
    """Voce's law Sy + Q (1 - exp(-b p)) (J. Inst. Metals 74 (1948) 537)."""
    return _written(
        lambda p: Sy - Q * np.expm1(-b * p), lambda p: Q * b * np.exp(-b * p), first=Q * b
    )


def _written(
    stress: Callable[[Array], Array], slope: Callable[[Array], Array], *, first: float
) -> FlowCurve:
    strain = np.append(0.0, np.geomspace(RULES.flow_first, FLOW_LAST, RULES.flow_rows))
    values = stress(strain)
    slopes = np.append(first, slope(strain[1:]))
    return FlowCurve(*(tuple(x.tolist()) for x in (strain, values, slopes)))


@dataclass(frozen=True, slots=True)
class Rate:
    """How the flow stress rises with the rate r of plastic strain.

    - `law`: `cowper-symonds`: times 1 + (r/reference)^(1/number). `johnson-cook`: times 1 + number
      ln(r/reference), 1 below the reference. `overstress`: plus stress (r/reference)^number.
    - `reference`: [1/s].
    - `number`: q, C or m of the law [-].
    - `stress`: overstress at the reference rate [Pa]; of that law only.

    Cowper and Symonds, Brown University Tech. Rep. 28 (1957); Johnson and Cook, 7th Int. Symp. on
    Ballistics (1983) 541; Perzyna, Adv. Appl. Mech. 9 (1966) 243.
    """

    law: Literal["cowper-symonds", "johnson-cook", "overstress"]
    reference: float
    number: float
    stress: float = 0.0


@dataclass(frozen=True, slots=True)
class Heating:
    """Adiabatic heating, and how it softens: times 1 - (T_rise/range)^exponent, 0.01 at least.

    - `fraction`: part of the plastic work that heats (Taylor and Quinney) [-].
    - `capacity`: heat capacity of a volume [J/(m^3 K)].
    - `range`: rise of temperature at which no strength is left, melting over the start [K].
    - `exponent`: 1 for a linear law.
    """

    fraction: float
    capacity: float
    range: float
    exponent: float = 1.0


@dataclass(frozen=True, slots=True)
class Flow:
    """What makes a metal more than perfectly plastic; each part may be left out."""

    curve: FlowCurve | None = None
    rate: Rate | None = None
    heating: Heating | None = None

    def as_dict(self) -> dict[str, Any]:
        """Return what is set, as plain values."""
        return {name: part for name, part in asdict(self).items() if part is not None}

    @classmethod
    def from_dict(cls, content: dict[str, Any]) -> Flow:
        """Rebuild from `as_dict`."""
        curve, rate, heating = (content.get(k) for k in ("curve", "rate", "heating"))
        return cls(
            curve=FlowCurve(**{k: tuple(v) for k, v in curve.items()}) if curve else None,
            rate=Rate(**rate) if rate else None,
            heating=Heating(**heating) if heating else None,
        )
