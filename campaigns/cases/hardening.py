"""Cases drawn over metals that harden by a power of the strain.

Each body follows S = Sy (1 + E p/Sy)^n, p the plastic strain: the power law of indentation theory
that continues the elastic line, Swift's law with e0 = Sy/E. Two numbers a body, Sy/E and n, are
then all that a closed form has to know.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from ...core.arrays import Array
from ...core.flow import Flow, FlowCurve, ludwik, swift, voce
from ...core.material import Material, Pair
from ..case import Case
from .drawn import robust_case
from .pairs import deep_case, digits, sobol, two_metals, widest_pair

_YIELD_STRAINS = (3e-4, 6e-3)  # soft copper and aluminium to spring steel and titanium
_RATIOS = (0.1, 10.0)  # Sy*
_LARGEST_EXPONENT = 0.5


@cache
def hardening() -> tuple[Case, ...]:
    """96 scrambled Sobol points; in a third one body alone hardens, the sphere or the flat."""
    points = sobol(8, seed=20143, power=7)[:96]
    return tuple(deep_case(f"hardening-{k:02}", _pair(u, k)) for k, u in enumerate(points))


@cache
def validation_hardening() -> tuple[Case, ...]:
    """24 pairs of the same ranges, kept out of every fit."""
    draw = np.random.default_rng(77005).random((24, 8))
    return tuple(deep_case(f"validation-hardening-{k:02}", _pair(u, k)) for k, u in enumerate(draw))


@cache
def robustness_hardening() -> tuple[Case, ...]:
    """200 scrambled Sobol points over all metals that the solver is meant for, medium resolution.

    The curve of each body is a power of the strain with n 0.02 to 0.6, Ludwik's with K/Sy 0.1 to 5,
    or Voce's with Q/Sy 0.1 to 5.
    """
    points = sobol(9, seed=1952, power=8)[:200]
    return tuple(
        robust_case(f"robustness-hardening-{k:03}", _any_pair(u)) for k, u in enumerate(points)
    )


def _any_pair(u: Array) -> Pair:
    """Pair from nine numbers in [0, 1): five of `widest_pair`, two of each curve."""
    pair = widest_pair(u[:5])
    return replace(
        pair, sphere=_curved(pair.sphere, u[5], u[6]), flat=_curved(pair.flat, u[7], u[8])
    )


def _curved(body: Material, form: float, size: float) -> Material:
    """Give a body one of three forms of hardening, of a size; both numbers in [0, 1)."""
    which, along = divmod(3.0 * form, 1.0)
    high = body.Sy * 0.1 * 50.0**size
    curve: FlowCurve
    if which == 0.0:
        return power_law(body, round(float(0.02 + 0.58 * size), 3))
    if which == 1.0:
        curve = ludwik(Sy=body.Sy, K=high, n=round(float(0.2 + 0.8 * along), 3))
    else:
        curve = voce(Sy=body.Sy, Q=high, b=digits(60.0**along))
    return replace(body, flow=Flow(curve=curve))


def power_law(body: Material, n: float) -> Material:
    """Give a body the hardening S = Sy (1 + E p/Sy)^n; n = 0 leaves it as it is."""
    if n == 0.0:
        return body
    K = body.Sy * (body.E / body.Sy) ** n
    return replace(body, flow=Flow(curve=swift(Sy=body.Sy, K=K, n=n)))


def _pair(u: Array, k: int) -> Pair:
    """Pair from eight numbers in [0, 1): moduli and Poisson ratios linear, exponents linear,
    yield strain of the weaker body and Sy* logarithmic; in every third one body alone hardens.
    """  # noqa: D205
    strain = _YIELD_STRAINS[0] * (_YIELD_STRAINS[1] / _YIELD_STRAINS[0]) ** u[4]
    ratio = digits(_RATIOS[0] * (_RATIOS[1] / _RATIOS[0]) ** u[5])
    n_s, n_f = (round(float(_LARGEST_EXPONENT * x), 3) for x in u[6:])
    pair = two_metals(u[:4], strain=strain, ratio=ratio)
    return replace(
        pair,
        sphere=power_law(pair.sphere, 0.0 if k % 6 == 5 else n_s),
        flat=power_law(pair.flat, 0.0 if k % 6 == 4 else n_f),
    )
