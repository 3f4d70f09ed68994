"""How far off a law may be, as a function of pair and depth.

Ours are calibrated on pairs that the fit had not seen: a standard deviation of each quantity grows
from nothing at first yield and follows how close the strengths are, how near the taking over is,
how deep the contact. A published law states none: `beside.beside_fitted` says how far it is off.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..core.arrays import Array
from .closed_form import PairNumbers, plastic_depth, small_radius_at
from .rules import RULES

FEATURES = ("one", "yield", "depth", "equal", "taking_over", "stiffness", "elastic_share", "unlike")
"""What a standard deviation depends on; see `features_of`."""

LEAST = RULES.least_error
"""Standard deviation that no law goes below."""

METAL = dict(RULES.metal_error)
"""Standard deviations of elastic-perfect plasticity to a metal, where all is lost. Finite elements
with the measured flow curve of 6061-T6 differ from it by 1 to 2.5 % in force, 4 % in the dent and
2 to 4 % in the restitution, with exponents of 1.31 to 1.44; softer tempers by twice that."""
WITH_CURVE = dict(RULES.metal_error_with_curve)
"""The same where the baseline follows the flow curve of the body that yields first: what hardening
does is no error any more; shape and turning of the yield surface and the unloading's modulus are.
How strong the piece is, is an error of the data sheet. `radius` is the contact's at one force,
from Tabor's constraint, 2.8 within 4 to 5 % of metals; with a curve half of it."""
RECOVERY_EXPONENT = RULES.exponent_error
"""Standard deviation of the recovery's exponent, of the closed form to finite elements."""


class Uncertainty(NamedTuple):
    """Standard deviations of what a law says of a pair at a depth, each of the depth's shape.

    All relative but that of the share, which is absolute. `dent` is the whole permanent depth left
    by unloading from this depth; `given_back` the energy of that unloading at equal peak force.
    """

    force: Array
    radius: Array
    share: Array
    dent: Array
    given_back: Array


@dataclass(frozen=True)
class Calibration:
    """Weights of `FEATURES` in the logarithm of each standard deviation.

    `weights`: one row for each field of `Uncertainty`, shape (5, n_features).
    """

    weights: Array

    def of(self, numbers: PairNumbers, D: Array) -> Uncertainty:
        """Return the standard deviations of one pair at Delta/R = D, shape (...)."""
        features = features_of(numbers, np.maximum(D, 1e-12))
        sizes = (deviation(features, row) for row in self.weights)
        return Uncertainty(*(np.where(D > 0.0, size, LEAST) for size in sizes))

    @classmethod
    def from_content(cls, content: Mapping[str, Sequence[float]]) -> Calibration:
        """Rebuild from `content()`."""
        return cls(np.array([content[name] for name in Uncertainty._fields], dtype=float))

    def content(self) -> dict[str, list[float]]:
        """Plain values for a file."""
        return {
            name: [float(f"{x:.6g}") for x in row]
            for name, row in zip(Uncertainty._fields, self.weights, strict=True)
        }


def features_of(numbers: PairNumbers, D: Any) -> Array:
    """Features at Delta/R = D, shape (..., n_features); fields of the numbers go with D.

    One; how far the contact has yielded (logarithm, 0 in the end); depth beyond yield; closeness of
    the strengths; of the taking over; E'/S; the elastic share of the stiffer body; how unlike the
    Poisson ratios are where the strengths are close.
    """
    y = plastic_depth(numbers.W * D)
    small = small_radius_at(D, y, numbers)
    even = 1.0 / (1.0 + (numbers.L / 0.2) ** 2)
    turn = 1.0 / (1.0 + (np.log(small / numbers.a_t) / 0.25) ** 2)
    columns = (
        np.ones_like(y),
        np.log(np.maximum(y, 1e-9) / (1.0 + y)),
        np.log1p(y) / 5.0,
        even + 0.0 * y,
        turn / (1.0 + (numbers.L / 0.7) ** 2),
        (0.5 * np.log(numbers.W) - 5.0) / 1.2 + 0.0 * y,
        np.abs(numbers.x_s - 0.5) / 0.22 + 0.0 * y,
        even * np.abs(numbers.L_C) / 0.05 + 0.0 * y,
    )
    return np.stack(columns, axis=-1)


def deviation(features: Array, weights: Array, *, least: float = LEAST) -> Array:
    """Standard deviation, shape (...): at least `least`, hardly above 1."""
    log_size = np.minimum(features @ weights, 0.0)
    return np.asarray(np.hypot(least, np.exp(log_size)))
