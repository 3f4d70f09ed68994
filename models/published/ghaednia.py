"""The thesis's own model: sphere and flat both deform and yield (Eqs. 2.1-2.43), and 3.5-3.7.

The printed equations carry misprints; this is the reading in which the text, the limits and the
figures of chapters 2 to 5 agree (docs/thesis/errata.md). The weak body w is the sphere for Sy* <=
1.07 and the flat above; its share of the approach gives its own deformation, and the other body's
share the updated radius R' (2.18).

As it stands the model steps up by 29 to 43 % where Hertz ends, at Delta = 1.9 delta_y, steps up by
another 22 % at delta_n = 3.7, and is meant for delta_n of 5 and more. Between delta_n = 1.9 and 8
the two are blended here, smoothly in ln delta_n, and the radius goes from Jackson and Green's
(1.21) to 2.21 and 2.28 without 2.20 and 2.27. At delta_n = 408 the printed factors fall by 0.4 to
0.9 %, and beyond with an infinite slope; the hand-over is stretched to 480, where the radius
differs by up to 2.3 % from the printed one. Both are our choice and make the law smooth.

What depends on the pair alone is computed once, and every power comes from a logarithm.
"""

from __future__ import annotations

import math

from numba import njit

from ...core.material import Pair
from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import E_WEAK, N_COMMON, ONSET, SHARE, Common, R, S, hertz_force, kernel
from . import residual
from .hardness import slip_line_pressure
from .jackson_green import growth_exponent

_ELASTIC = 1.9  # end of Hertz, and of the elastic weight's argument
_BLENDED = 8.0  # from here on the model alone
_LOG_ELASTIC = math.log(_ELASTIC)
_LOG_BLENDED = math.log(_BLENDED)
_HIGH = 408.0  # border of the two correction factors
_HIGHER = 480.0  # where the second one stands alone
BORDER = 1.07  # Sy* at which the weak body changes
_FLATTENING_ONLY = 0.06  # Sy* below which 2.34 has no real value

# ratios beyond these have long reached their limits, and their powers would overflow
_RATIO_MAX, _EXPONENT_MAX = 1e6, 1e3

# places of the pair's own numbers
(_SCALE, _PHASE, _STEEP, _LOG_LOG, _LOG_RATIO, _POWER_6, _WEIGHT, _B, _SLOPE_2, _BRANCH) = range(
    N_COMMON, N_COMMON + 10
)
_SPHERE, _MIDDLE, _FLAT = 0.0, 1.0, 2.0


def share_numbers(q: float, ratio: float, border: float) -> tuple[float, float, float, float]:
    """Return what 2.13-2.16 need of q = E'/Sy_min and Sy*: scale, phase, exponent, ln ln Sy*.

    `border` is the Sy* at which 2.13 hands over to 2.14: 1 for figure 2.5, 1.07 for the force.
    """
    if ratio <= border:
        return 1.115 * math.sin(0.625 * ratio**2 + math.pi / 2.16), 0.0, 0.0, 0.0
    if ratio <= 1.53:
        scale = -22.49 * q**-0.7 * math.sin(1.546 * ratio**-9.22 + 1.035 * math.pi)
        return scale, 0.094 * math.pi * ratio**4.01, 0.0, 0.0
    held = min(ratio, _RATIO_MAX)
    scale = 0.852 * q**-0.7 * held**0.031
    return scale, 0.0, 0.46 * min(ratio, _EXPONENT_MAX), math.log(math.log(held))


@njit(cache=True, _nrt=False, error_model="numpy")
def _share(D, branch, scale, phase, steep, log_log):
    """delta_s* of 2.13, 2.14 (with 1.035 pi) and 2.15-2.16."""
    log_D = math.log(D)
    if branch == _SPHERE:
        angle = 5.592 * math.exp(1.37 * log_D) + math.pi / 2.37
        return scale * math.exp(0.0528 * log_D) * math.sin(angle)
    if branch == _MIDDLE:
        return scale * math.sin(45.63 * math.exp(1.75 * log_D) + phase)
    exponent = 2.307 * math.exp(steep * log_D) - 0.7
    angle = math.atan(0.142 * math.exp(1.06 * D * log_log) + 3.22)
    return scale * angle * math.exp(exponent - 0.41 * log_D)


def _branch(ratio: float, border: float) -> float:
    if ratio <= border:
        return _SPHERE
    return _MIDDLE if ratio <= 1.53 else _FLAT


def share_of_sphere(D: float, q: float, ratio: float, border: float) -> float:
    """delta_s* from D = Delta/R, q = E'/Sy_min and Sy* (2.13-2.16, 2.14 with 1.035 pi)."""
    return float(_share(D, _branch(ratio, border), *share_numbers(q, ratio, border)))


def indentation_weight(ratio: float) -> float:
    """Weight of the indentation hardness, 0 for flattening and 1 for indentation (2.34).

    The logarithm is the natural one; below Sy* = 0.06 it has no real value and the weight is 0.
    """
    if ratio <= _FLATTENING_ONLY:
        return 0.0
    return math.atan(300.0 * math.log(ratio - _FLATTENING_ONLY)) / math.pi + 0.5


def _numbers(common: Common) -> tuple[float, ...]:
    ratio = float(common.ratio)
    if math.isnan(ratio):  # nothing yields: the kernels never get beyond Hertz
        return (0.0,) * 10
    held = min(ratio, _RATIO_MAX)
    return (
        *share_numbers(float(common.E / common.S), ratio, BORDER),
        math.log(max(held, 1e-300)),
        held**6 if ratio <= BORDER else 0.0,
        indentation_weight(ratio),
        growth_exponent(common.S, common.E),
        float(common.onset / common.R),
        _branch(ratio, BORDER),
    )


@njit(cache=True, _nrt=False, error_model="numpy")
def _weak_body(par, depth):
    """Deformation of the weak body, updated radius R' (2.18) and delta_n (2.19, 2.26)."""
    D = depth / par[R]
    share = _share(D, par[_BRANCH], par[_SCALE], par[_PHASE], par[_STEEP], par[_LOG_LOG])
    if par[_BRANCH] == _SPHERE:
        x = 1.0 - share
    else:
        # 2.15 grows without bound at small load; the elastic share is its ceiling
        x = min(share, par[SHARE])
    delta = (1.0 - x) * depth
    updated = par[R] * (1.0 + x - D * x)
    return delta, updated, delta / (par[_SLOPE_2] * updated)


@njit(cache=True, _nrt=False, error_model="numpy")
def _smooth_step(value, low, high):
    """Rise from 0 at `low` to 1 at `high`; three derivatives vanish at either end."""
    x = (value - low) / (high - low)
    return x**4 * (35.0 + x * (-84.0 + x * (70.0 - 20.0 * x)))


@njit(cache=True, _nrt=False, error_model="numpy")
def _correction_low(par, n, log_n):
    """The factors chi of 2.23 and 2.29-2.30 (with an exponent)."""
    power = par[_POWER_6]
    if par[_BRANCH] != _SPHERE:
        power = math.exp(-0.091 * math.exp(-0.008 * n) * par[_LOG_RATIO])
    return 0.4 + 0.55 * math.exp(0.022 * log_n) + 0.283 / math.sqrt(n) * power


@njit(cache=True, _nrt=False, error_model="numpy")
def _correction_high(par, n):
    """The factors chi of 2.25 and 2.32-2.33 (with an exponent)."""
    beyond = n - _HIGH
    power = par[_POWER_6]
    if par[_BRANCH] != _SPHERE:
        power = 1.0  # below 409 the power of 2.33 has no real value
        if beyond > 1.0:
            power = math.exp(-0.0091 * math.log(beyond) ** 3.53 * par[_LOG_RATIO])
    return 1.024 - 0.004 * beyond**0.3814 + (0.013 + 2.2e-5 * beyond) * power


@njit(cache=True, _nrt=False, error_model="numpy")
def _correction(par, n, log_n):
    """The correction chi of the contact radius."""
    if n <= _HIGH:
        return _correction_low(par, n, log_n)
    if n >= _HIGHER:
        return _correction_high(par, n)
    k = _smooth_step(n, _HIGH, _HIGHER)
    return (1.0 - k) * _correction_low(par, n, log_n) + k * _correction_high(par, n)


@njit(cache=True, _nrt=False, error_model="numpy")
def _model_radius(par, delta, updated, n, log_n):
    """Contact radius chi sqrt(R' delta (delta_n/1.9)^B) (2.21, 2.24, 2.28, 2.31, with the root)."""
    grown = updated * delta * math.exp(par[_B] * (log_n - _LOG_ELASTIC))
    return _correction(par, n, log_n) * math.sqrt(grown)


@njit(cache=True, _nrt=False)
def model_hardness(weight, a_over_R):
    """H/Sy_min between flattening (2.35) and indentation (2.36 with the sign of 1.13), by 2.34."""
    x = min(a_over_R, 1.0)
    flattening = 1.92 + 0.92 * math.cos(math.pi * x)
    if weight == 0.0:
        return flattening
    return flattening + weight * (slip_line_pressure(x) - flattening)


@njit(cache=True, _nrt=False, error_model="numpy")
def _model_force(par, delta, updated, n, log_n):
    """F = W_e F_e + W_p pi a^2 H Sy_min (2.37-2.43)."""
    a = _model_radius(par, delta, updated, n, log_n)
    plastic = math.pi * a * a * model_hardness(par[_WEIGHT], a / par[R]) * par[S]
    elastic = 4.0 / 3.0 * par[E_WEAK] * math.sqrt(updated * delta) * delta
    log_x = math.log(n - _ELASTIC)
    if par[_BRANCH] == _SPHERE:
        we = math.exp(-1.6 * math.exp(0.16 * log_x))
        wp = 0.95 - math.exp(-0.58 * math.exp(0.3 * log_n))
    else:
        we = math.exp(-1.7 * math.exp(0.26 * log_x))
        wp = 1.0 - math.exp(-0.465 * math.exp(0.45 * log_n))
    return we * elastic + wp * plastic


@kernel
def _loading(par, depth):
    if depth <= _ELASTIC * par[ONSET]:
        return hertz_force(par, depth)
    delta, updated, n = _weak_body(par, depth)
    if n <= _ELASTIC:
        return hertz_force(par, depth)
    log_n = math.log(n)
    force = _model_force(par, delta, updated, n, log_n)
    if n >= _BLENDED:
        return force
    k = _smooth_step(log_n, _LOG_ELASTIC, _LOG_BLENDED)
    return (1.0 - k) * hertz_force(par, depth) + k * force


@kernel
def _radius(par, depth, peak):
    w = depth / par[ONSET]
    if w <= _ELASTIC:
        return math.sqrt(par[R] * depth)
    # until the model takes over the contact spreads as Jackson and Green's does (1.21)
    start = math.sqrt(par[R] * depth * math.exp(par[_B] * (math.log(w) - _LOG_ELASTIC)))
    delta, updated, n = _weak_body(par, depth)
    if n <= _ELASTIC:
        return start
    log_n = math.log(n)
    k = _smooth_step(log_n, _LOG_ELASTIC, _LOG_BLENDED) if n < _BLENDED else 1.0
    return (1.0 - k) * start + k * _model_radius(par, delta, updated, n, log_n)


@kernel
def _residual(par, peak):
    return residual.to_weaker(par, residual.ghaednia(peak / par[ONSET]) * peak)


@kernel
def _unloading(par, depth, peak):
    return residual.recover(_loading, _residual, par, depth, peak)


GHAEDNIA = PublishedLaw(
    name="ghaednia",
    title="Ghaednia et al., corrected reading",
    source="Ghaednia, PhD thesis, Auburn University, chapters 2 and 3",
    equations="2.13-2.43, 3.5-3.7",
    standing=Standing.OWN_SOURCE,
    domain=Domain(a_over_R_max=0.5, note="delta_n above about 5, a/R up to 0.5"),
    read="the thesis itself",
    own=Kernels(_loading, _radius, _unloading, _residual),
    numbers=_numbers,
)


def updated_jackson_green(pair: Pair, depth: float) -> tuple[float, float]:
    """Jackson and Green's contact radius [m] with the weak body's share and R', and delta_n.

    a = sqrt(R' delta (delta_n/1.9)^B) before the corrections chi of 2.21-2.33 (figures 2.12 and
    2.13), with the shares of 2.13-2.16 and R' of 2.18; below delta_n = 1.9 the power is 1. The
    approach [m] is above 0.
    """
    par = GHAEDNIA.parameters(pair)
    delta, updated, n = _weak_body(par, depth)
    growth = max(n / _ELASTIC, 1.0) ** par[_B]
    return math.sqrt(updated * delta * growth), float(n)
