"""Chang, Etsion and Bogy 1987: Hertz, then a sphere that keeps its volume at constant pressure.

A = pi R (2 delta - delta_c) and F = K H A beyond delta_c = (pi K H/(2 E'))^2 R, with H = 2.8 S and
K = 0.454 + 0.41 nu (4.15). The force steps up by exactly one half at delta_c, where the mean
pressure goes from 2/3 of its maximum to all of it: the discontinuity that section 1.3 names.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from ..base import (
    N_COMMON,
    NU_WEAK,
    Domain,
    E,
    Kernels,
    PublishedLaw,
    R,
    S,
    Standing,
    branch_kernel,
    hertz_force,
    loading_kernel,
    residual_kernel,
)
from .residual import bounded, elastic_recovery, recover, to_weaker

_DEPTH, _PRESSURE = N_COMMON, N_COMMON + 1


def yield_pressure(common: npt.NDArray[np.float64]) -> float:
    """Largest pressure at first yield, K H = (0.454 + 0.41 nu) 2.8 S [Pa] (4.15)."""
    return float((0.454 + 0.41 * common[NU_WEAK]) * 2.8 * common[S])


def yield_depth(common: npt.NDArray[np.float64]) -> float:
    """Critical approach delta_c = (pi K H/(2 E'))^2 R [m] (4.15)."""
    x = math.pi * yield_pressure(common) / (2.0 * common[E])
    return float(common[R] * x * x)


def _numbers(common: npt.NDArray[np.float64]) -> tuple[float, float]:
    return yield_depth(common), yield_pressure(common)


@branch_kernel
def _radius(par, depth, peak):
    if depth <= par[_DEPTH]:
        return math.sqrt(par[R] * depth)
    return math.sqrt(par[R] * (2.0 * depth - par[_DEPTH]))


@loading_kernel
def _loading(par, depth):
    if depth <= par[_DEPTH]:
        return hertz_force(par, depth)
    return math.pi * par[R] * (2.0 * depth - par[_DEPTH]) * par[_PRESSURE]


@residual_kernel
def _residual(par, peak):
    if peak <= par[_DEPTH]:
        return 0.0, 0.0
    a = _radius(par, peak, peak)
    left = elastic_recovery(par, _loading(par, peak), a, peak)
    return to_weaker(par, bounded(_loading, par, par[_DEPTH], peak, 1.5, left) * peak)


@branch_kernel
def _unloading(par, depth, peak):
    return recover(_loading, _residual, par, depth, peak)


CEB = PublishedLaw(
    name="ceb",
    title="Chang, Etsion and Bogy 1987",
    source="J. Tribol. 109 (1987) 257",
    equations="thesis 1.3 (in words), 4.15",
    standing=Standing.OUR_READING,
    domain=Domain(note="flattening; kept for its discontinuity"),
    breaks=(("force jumps at delta_c", 50.0), ("residual jumps at delta_c", 33.4)),
    regime="flattening",
    read="the thesis's words; K = 0.454 + 0.41 nu in tmd-lab/microslip-rough-contact (CEB_MU); the "
    "area after yield is the known consequence of constant volume, read nowhere",
    own=Kernels(_loading, _radius, _unloading, _residual),
    numbers=_numbers,
)
