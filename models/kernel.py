"""What the compiled kernels of all laws share: signatures, the numbers they read, Hertz.

A kernel takes a vector of numbers: first the common ones of the pair (`Common`), then the law's
own. It finds them by the places below, or as a named tuple by a function from `reader`.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from numba import float64, njit, types
from numba.core import cgutils
from numba.extending import intrinsic

from ..core.material import Pair

VECTOR = types.Array(types.float64, 1, "C")
LOADING_SIGNATURE = float64(VECTOR, float64)
BRANCH_SIGNATURE = float64(VECTOR, float64, float64)
RESIDUAL_SIGNATURE = types.UniTuple(float64, 2)(VECTOR, float64)
LOADING = types.FunctionType(LOADING_SIGNATURE)
BRANCH = types.FunctionType(BRANCH_SIGNATURE)
SPLIT = types.FunctionType(RESIDUAL_SIGNATURE)

# No signature: a law is compiled when it is first asked, for what it is asked with.
# error_model: no check for a division by zero, which costs as much as the division.
# _nrt: no reference counts, which cost as much as the arithmetic; a kernel allocates nothing.
kernel = njit(cache=True, _nrt=False, error_model="numpy")
loading_kernel = branch_kernel = residual_kernel = kernel  # as laws of other packages have it


class Common(NamedTuple):
    """Numbers of a pair that every law starts from."""

    R: float  # radius [m]
    E: float  # reduced modulus E' [Pa]
    S: float  # lower yield strength [Pa]
    ratio: float  # Sy* (2.1)
    share: float  # elastic share of the sphere (2.3)
    E_weak: float  # plane-strain modulus of the weaker body [Pa]
    nu_weak: float  # its Poisson's ratio
    C: float  # its yield constant (1.17, corrected)
    onset: float  # critical approach (1.16) [m]
    critical: float  # critical force (1.19, corrected) [N]
    k_hertz: float  # (4/3) E' sqrt(R) [N/m^1.5]


N_COMMON = len(Common._fields)
R, E, S, RATIO, SHARE, E_WEAK, NU_WEAK, C, ONSET, CRITICAL, K_HERTZ = range(N_COMMON)
"""Places of the common numbers in every law's vector; its own follow from `N_COMMON` on."""


def reader(kind: Any, start: int) -> Any:
    """Return a compiled function that reads the named tuple `kind` from place `start` on.

    It costs nothing: fields that a kernel does not use are never loaded.
    """
    count = len(kind._fields)
    read_type = types.NamedUniTuple(types.float64, count, kind)

    def read(_typing: Any, par: Any) -> Any:
        def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
            places = (cgutils.gep_inbounds(builder, data, start + k) for k in range(count))
            return context.make_tuple(builder, read_type, [builder.load(p) for p in places])

        return read_type(par), code

    return intrinsic(read)


def common_parameters(pair: Pair) -> Common:
    """Return the numbers of `pair` that every law starts from."""
    weak = pair.weaker
    nu = 0.0 if weak.rigid else weak.nu
    modulus, strength, C = pair.E_reduced, pair.Sy_min, yield_constant(nu)
    slope = math.pi * C * strength / (2.0 * modulus)
    return Common(
        R=pair.R,
        E=modulus,
        S=strength,
        ratio=pair.Sy_ratio,
        share=pair.elastic_share,
        E_weak=weak.plane_strain_modulus,
        nu_weak=nu,
        C=C,
        onset=slope * slope * pair.R,
        critical=4.0 / 3.0 * modulus * pair.R**2 * slope**3 if slope < math.inf else math.inf,
        k_hertz=4.0 / 3.0 * modulus * math.sqrt(pair.R),
    )


def yield_constant(nu: float) -> float:
    """C = 1.295 exp(0.736 nu), from the onset of yield below the contact (Eq. 1.17, corrected).

    Examples
    --------
    >>> round(yield_constant(0.3), 3)
    1.615
    """
    return 1.295 * math.exp(0.736 * nu)


def critical_depth(pair: Pair) -> float:
    """The laws' delta_c = (pi C Sy/(2 E'))^2 R [m] (Eq. 1.16), of the body of smaller strength.

    Bodies of nearly one strength and another Poisson's ratio: `Pair.first_yield` is smaller.
    """
    return common_parameters(pair).onset


def critical_force(pair: Pair) -> float:
    """F_c = (4/3) (R/E')^2 (pi C Sy/2)^3 [N] (Eq. 1.19, corrected)."""
    return common_parameters(pair).critical


@njit(cache=True, _nrt=False)
def cubic(t, low, high, slope_low, slope_high):
    """Cubic on 0 <= t <= 1 with the values and slopes of both ends."""
    rise = high - low
    bend = 3.0 * rise - 2.0 * slope_low - slope_high
    return low + t * (slope_low + t * (bend + t * (slope_low + slope_high - 2.0 * rise)))


@kernel
def hertz_force(par, depth):
    """F = (4/3) E' sqrt(R) delta^(3/2) (Eqs. 1.3-1.6)."""
    return par[K_HERTZ] * depth * math.sqrt(depth)


@njit(cache=True, _nrt=False)
def hertz_recovery(force_peak, depth, peak, residual):
    """Elastic recovery about the residual depth, F_m ((d - d_r)/(d_m - d_r))^(3/2) (3.5-3.6)."""
    if depth <= residual or peak <= residual:
        return 0.0
    if depth >= peak:
        return force_peak
    x = (depth - residual) / (peak - residual)
    return force_peak * x * math.sqrt(x)


@njit(cache=True, _nrt=False, error_model="numpy")
def power_recovery(force_peak, depth, peak, residual, exponent):
    """Recovery of another power of the depth left, F_m ((d - d_r)/(d_m - d_r))^N."""
    if depth <= residual or peak <= residual:
        return 0.0
    if depth >= peak:
        return force_peak
    return force_peak * ((depth - residual) / (peak - residual)) ** exponent
