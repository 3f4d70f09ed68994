"""What a reduction hands on: values with standard deviations, and the rows they make."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from ..core.arrays import Array


@dataclass(frozen=True, slots=True)
class Measured:
    """A value and its standard deviation, in the unit that its name ends in.

    Examples
    --------
    >>> str(Measured(0.51234, 0.0031))
    '0.5123 ± 0.0031'
    """

    value: float
    std: float

    def __str__(self) -> str:
        if not (math.isfinite(self.std) and self.std > 0.0):
            return f"{self.value:.6g}"
        decimals = 1 - math.floor(math.log10(self.std))
        if 0 <= decimals <= 9:
            return f"{self.value:.{decimals}f} ± {self.std:.{decimals}f}"
        return f"{self.value:.{max(2, _digits(self.value, self.std))}g} ± {self.std:.2g}"

    def scaled(self, factor: float) -> Measured:
        """Return the value times an exact factor."""
        return Measured(self.value * factor, self.std * abs(factor))

    def times(self, other: Measured) -> Measured:
        """Return the product with an independent value."""
        std = math.hypot(self.std * other.value, self.value * other.std)
        return Measured(self.value * other.value, std)

    def over(self, other: Measured) -> Measured:
        """Return the quotient by an independent value."""
        ratio = self.value / other.value
        return Measured(ratio, math.hypot(self.std, ratio * other.std) / abs(other.value))

    def rounded(self) -> Measured:
        """Return the value to 12 digits: 0.35 for 35 cm, not 0.35000000000000003 m."""
        return Measured(float(f"{self.value:.12g}"), float(f"{self.std:.12g}"))

    def minus(self, other: Measured) -> Measured:
        """Return the difference to an independent value."""
        return Measured(self.value - other.value, math.hypot(self.std, other.std))

    def widened(self, more: float) -> Measured:
        """Return the value with another, independent error."""
        return Measured(self.value, math.hypot(self.std, more))


UNITY = Measured(1.0, 0.0)
"""The scale of an instrument that is taken as exact."""

ZERO = Measured(0.0, 0.0)
"""An effect that is taken as absent."""


def _digits(value: float, std: float) -> int:
    if value == 0.0:
        return 2
    return 2 + math.floor(math.log10(abs(value))) - math.floor(math.log10(std))


def propagate(
    function: Callable[[Array], Array], x: Array, covariance: Array
) -> tuple[Measured, ...]:
    """Return `function(x)` with standard deviations from the covariance of x, to first order."""
    value = function(x)
    step = 1e-4 * np.sqrt(np.diag(covariance)) + 1e-12 * np.abs(x) + 1e-300
    jacobian = np.stack(
        [
            (function(x + h * e) - function(x - h * e)) / (2.0 * h)
            for h, e in zip(step, np.eye(x.size), strict=True)
        ],
        axis=1,
    )
    std = np.sqrt(np.einsum("ij,jk,ik->i", jacobian, covariance, jacobian))
    return tuple(Measured(float(v), float(s)) for v, s in zip(value, std, strict=True))


def labels(count: int, of: str = "bounce") -> list[str]:
    """Return how the bounces, or others, of one file are told apart: not at all if there is one."""
    return [""] if count == 1 else [f"{of}{k}" for k in range(1, count + 1)]


def labelled(each: Iterable[tuple[str, Mapping[str, Measured]]]) -> dict[str, Measured]:
    """Return the numbers of all bounces by name, each after the label of its own."""
    return {
        f"{label}_{name}" if label else name: value
        for label, numbers in each
        for name, value in numbers.items()
    }


@dataclass(frozen=True)
class Trial:
    """One row of trials.csv, and the curves that belong to it.

    - `observables`: column of trials.csv and its value; the standard deviation fills the column
      `NAME_std`.
    - `trace`, `profile`: columns of traces/TRIAL.csv and profiles/TRIAL.csv, each (n,).
    - `label`: part of the trial's name that tells several trials of one file apart.
    - `spot`: the place on the flat, in words; `note`: what the person who measured wrote beside it;
      `place`: where it stands in the file.
    """

    observables: Mapping[str, Measured]
    trace: Mapping[str, Array] = field(default_factory=dict)
    profile: Mapping[str, Array] = field(default_factory=dict)
    label: str = ""
    spot: str = ""
    note: str = ""
    place: str = ""

    def __post_init__(self) -> None:
        for name in ("observables", "trace", "profile"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))
