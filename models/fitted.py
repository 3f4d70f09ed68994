"""Our closed form: one smooth expression over all strength ratios, fitted to our finite elements.

With D = Delta/R, w = Delta/delta_c, X = D E'/Sy_min, F_H Hertz's force and m = Sy*^n:

    F/F_H      = [1 + (w/w_1)^p]^(-q/p) exp(-h D^(1/2) w/(w + w_1))
    a^2/(R D)  = [1 + (w/w_2)^s]^(t/s)
    delta_s*   = (1 - eps) phi + kappa F/(E_s* a Delta),  eps = kappa F/(E' a Delta)
    residual   = 1 - psi F/(E' a Delta), of which the sphere keeps phi
    kappa      = 3/4 - k_1 w/(w + k_2),   psi = 3/4 - r_1 w/(w + r_2)
    logit phi  = -g_0 ln Sy* + g_2 logit(elastic share) + 4m/(1+m)^2 g_1 ln(1 + g_3 X)

w_1, q, h run from their flattening value (Sy* = 0) through one for equal strengths to the
indentation value (Sy* = infinity) with the weights of m: 1/(1+m)^2, 2m/(1+m)^2, m^2/(1+m)^2.
Between bodies of like strength the sphere, which can spread, takes ever more of the plastic part
as the contact deepens; how far that has gone follows X, and not D or w alone.

Why this form: 3/4 F/(E_i* a) is exactly a body's elastic displacement under Hertz's pressure, and
(2/pi) F/(E_i* a) that under a uniform one, so kappa hardly moves and the stronger body's elastic
part comes out right at every load; the limits at small load are Hertz's law, his contact radius and
the elastic share (2.3), and nothing is left behind.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import resources
from typing import Any

import numpy as np
import numpy.typing as npt
from numba import float64, njit

from ..core.material import Pair
from .base import (
    N_COMMON,
    SHARE,
    VECTOR,
    ContactLaw,
    Domain,
    E,
    Kernels,
    R,
    branch_kernel,
    common_parameters,
    hertz_force,
    hertz_recovery,
    loading_kernel,
    onset,
    residual_kernel,
)

Floats = npt.NDArray[np.float64]

BLENDED = ("w1", "q", "h")
"""Coefficients with a value each for flattening, equal strengths and indentation."""

ENDS = ("flattening", "equal", "indentation")
SINGLE = ("n", "p", "w2", "s", "t", "k1", "k2", "r1", "r2", "g0", "g1", "g2", "g3")
NAMES = (*(f"{name}_{end}" for name in BLENDED for end in ENDS), *SINGLE)
"""Every coefficient, in the order of the coefficients file."""

_FILE = "fitted.json"

# places of the pair's own numbers behind the common ones
(_W1, _Q, _H, _P, _W2, _S, _T, _K1, _K2, _R1, _R2, _PHI, _SHIFT, _GROW) = range(
    N_COMMON, N_COMMON + 14
)


@njit(float64(VECTOR, float64), cache=True)
def _force(par, depth):
    w = depth / onset(par, 0.0)
    D = depth / par[R]
    soft = math.exp(-par[_Q] / par[_P] * math.log1p((w / par[_W1]) ** par[_P]))
    return hertz_force(par, depth) * soft * math.exp(-par[_H] * math.sqrt(D) * w / (w + par[_W1]))


@loading_kernel
def _loading(par, depth):
    return _force(par, depth)


@njit(float64(VECTOR, float64), cache=True)
def _contact_radius(par, depth):
    w = depth / onset(par, 0.0)
    grow = math.exp(par[_T] / par[_S] * math.log1p((w / par[_W2]) ** par[_S]))
    return math.sqrt(par[R] * depth * grow)


@branch_kernel
def _radius(par, depth, peak):
    return _contact_radius(par, depth)


@njit(float64(VECTOR, float64), cache=True)
def _elastic_part(par, depth):
    """F/(E' a Delta): 4/3 under Hertz's pressure."""
    return _force(par, depth) / (par[E] * _contact_radius(par, depth) * depth)


@njit(float64(VECTOR, float64), cache=True)
def _phi(par, depth):
    """Sphere's part of what is not elastic."""
    logit = par[_PHI] + par[_SHIFT] * math.log1p(par[_GROW] * depth / par[R])
    return 1.0 / (1.0 + math.exp(-logit))


@loading_kernel
def share(par, depth):
    """delta_s*, the sphere's share of the approach."""
    w = depth / onset(par, 0.0)
    kappa = 0.75 - par[_K1] * w / (w + par[_K2])
    elastic = min(kappa * _elastic_part(par, depth), 1.0)
    return (1.0 - elastic) * _phi(par, depth) + elastic * par[SHARE]


@residual_kernel
def _residual(par, peak):
    w = peak / onset(par, 0.0)
    psi = 0.75 - par[_R1] * w / (w + par[_R2])
    total = max(1.0 - psi * _elastic_part(par, peak), 0.0) * peak
    phi = _phi(par, peak)
    return phi * total, (1.0 - phi) * total


@branch_kernel
def _unloading(par, depth, peak):
    s, f = _residual(par, peak)
    return hertz_recovery(_force(par, peak), depth, peak, s + f)


_KERNELS = Kernels(_loading, _radius, _unloading, _residual)
_TINY_RATIO, _HUGE_RATIO = 1e-3, 1e3  # beyond these the weights have long reached their ends


@dataclass(frozen=True)
class Fitted(ContactLaw):
    """The fitted law with its coefficients.

    Parameters
    ----------
    coefficients
        Value of every name in `NAMES`.
    """

    coefficients: Mapping[str, float] = field(default_factory=dict)

    @property
    def kernels(self) -> Kernels:
        """The compiled functions."""
        return _KERNELS

    def parameters(self, pair: Pair) -> Floats:
        """Common numbers and this pair's blended coefficients, shape (22,)."""
        k = self.coefficients
        common = common_parameters(pair)
        ratio = pair.Sy_ratio
        ratio = 1.0 if math.isnan(ratio) else min(max(ratio, _TINY_RATIO), _HUGE_RATIO)
        m = ratio ** k["n"]
        weights = np.array([1.0, 2.0 * m, m * m]) / (1.0 + m) ** 2
        own = [float(weights @ [k[f"{name}_{end}"] for end in ENDS]) for name in BLENDED]
        elastic = min(max(pair.elastic_share, 1e-9), 1.0 - 1e-9)
        phi = -k["g0"] * math.log(ratio) + k["g2"] * math.log(elastic / (1.0 - elastic))
        shift = 4.0 * m / (1.0 + m) ** 2 * k["g1"]
        # without a yield strength there is no plastic part to share out
        grow = k["g3"] * pair.E_reduced / pair.Sy_min if math.isfinite(pair.E_reduced) else 0.0
        single = [k[name] for name in ("p", "w2", "s", "t", "k1", "k2", "r1", "r2")]
        return np.concatenate([common, own, single, [phi, shift, grow]])

    def share(self, pair: Pair, depth: npt.ArrayLike) -> Floats:
        """delta_s*, shape (...); the elastic share where the contact is open."""
        par = self.parameters(pair)
        d = np.asarray(depth, dtype=float)
        return np.array([share(par, x) if x > 0.0 else par[SHARE] for x in d.ravel()]).reshape(
            d.shape
        )


def fitted_law(coefficients: Mapping[str, float], *, domain: Domain) -> Fitted:
    """Return the law with the given coefficients."""
    return Fitted(
        name="fitted",
        title="dentscope, fitted to finite elements",
        source="data/coefficients/fitted.json",
        equations="docs/closed-form.md",
        verified=True,
        domain=domain,
        coefficients=dict(coefficients),
    )


def read_coefficients() -> dict[str, Any] | None:
    """Content of the shipped coefficients file; none if there is none yet."""
    place = resources.files("dentscope").joinpath("data", "coefficients", _FILE)
    return json.loads(place.read_text("utf-8")) if place.is_file() else None


def shipped_law() -> Fitted | None:
    """The law with the shipped coefficients; none if they were never fitted."""
    content = read_coefficients()
    if content is None:
        return None
    values = {name: entry["value"] for name, entry in content["coefficients"].items()}
    domain = Domain(note=content["domain"]["note"])
    return fitted_law(values, domain=domain)


__all__ = ["BLENDED", "ENDS", "NAMES", "SINGLE", "Fitted", "fitted_law", "shipped_law"]
