"""Cases drawn over metals that harden by a power of the strain.

Each body follows S = Sy (1 + E p/Sy)^n, p the plastic strain: the power law of indentation theory
that continues the elastic line, Swift's law with e0 = Sy/E. Two numbers a body, Sy/E and n, are
then all that a closed form has to know.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from ...core.flow import Flow, swift
from ...core.material import Material, Pair
from ..case import Case
from .pairs import deep_case

_YIELD_STRAINS = (3e-4, 6e-3)  # soft copper and aluminium to spring steel and titanium
_RATIOS = (0.1, 10.0)  # Sy*
_LARGEST_EXPONENT = 0.5


@cache
def hardening() -> tuple[Case, ...]:
    """96 scrambled Sobol points; in a third one body alone hardens, the sphere or the flat."""
    from scipy.stats import qmc

    points = qmc.Sobol(8, scramble=True, rng=np.random.default_rng(20143)).random_base2(7)[:96]
    return tuple(deep_case(f"hardening-{k:02}", _pair(u, k)) for k, u in enumerate(points))


@cache
def validation_hardening() -> tuple[Case, ...]:
    """24 pairs of the same ranges, kept out of every fit."""
    draw = np.random.default_rng(77005).random((24, 8))
    return tuple(deep_case(f"validation-hardening-{k:02}", _pair(u, k)) for k, u in enumerate(draw))


def power_law(body: Material, n: float) -> Material:
    """Give a body the hardening S = Sy (1 + E p/Sy)^n; n = 0 leaves it as it is."""
    if n == 0.0:
        return body
    K = body.Sy * (body.E / body.Sy) ** n
    return replace(body, flow=Flow(curve=swift(Sy=body.Sy, K=K, n=n)))


def _pair(u: np.ndarray[tuple[int], np.dtype[np.float64]], k: int) -> Pair:
    """Pair from eight numbers in [0, 1): moduli and Poisson ratios linear, exponents linear,
    yield strain of the weaker body and Sy* logarithmic; in every third one body alone hardens.
    """  # noqa: D205
    E_s, E_f = (_digits(50.0 + 250.0 * x) * 1e9 for x in u[:2])
    nu_s, nu_f = (round(float(0.2 + 0.25 * x), 3) for x in u[2:4])
    strain = _YIELD_STRAINS[0] * (_YIELD_STRAINS[1] / _YIELD_STRAINS[0]) ** u[4]
    ratio = _digits(_RATIOS[0] * (_RATIOS[1] / _RATIOS[0]) ** u[5])
    n_s, n_f = (round(float(_LARGEST_EXPONENT * x), 3) for x in u[6:])
    if k % 6 == 4:
        n_f = 0.0
    elif k % 6 == 5:
        n_s = 0.0
    weaker = _digits(strain * (E_s if ratio < 1.0 else E_f))
    Sy_s, Sy_f = (weaker, weaker / ratio) if ratio < 1.0 else (weaker * ratio, weaker)
    return Pair(
        sphere=power_law(Material(E=E_s, nu=nu_s, Sy=Sy_s), n_s),
        flat=power_law(Material(E=E_f, nu=nu_f, Sy=Sy_f), n_f),
        R=1e-3,
    )


def _digits(x: float) -> float:
    return float(f"{x:.4g}")
