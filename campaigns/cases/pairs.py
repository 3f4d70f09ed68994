"""Pairs of the thesis's kind, and the cases that the large sweeps make of them.

Strengths follow the thesis: Sy_min is held and Sy* = S_ys/S_yf sets the stronger body.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ... import fem
from ...core.arrays import Array
from ...core.material import Material, Pair
from ..case import Case, standard_case


def pair_of(
    *, E_s: float, E_f: float, Sy_min: float, ratio: float, nu_s: float = 0.3, nu_f: float = 0.3
) -> Pair:
    """Pair from moduli [GPa], the weaker strength [MPa] and Sy* = S_ys/S_yf; R = 1 mm."""
    s, f = (Sy_min, Sy_min / ratio) if ratio < 1.0 else (Sy_min * ratio, Sy_min)
    return Pair(
        sphere=Material(E=E_s * 1e9, nu=nu_s, Sy=s * 1e6),
        flat=Material(E=E_f * 1e9, nu=nu_f, Sy=f * 1e6),
        R=1e-3,
    )


def widest_pair(u: Array) -> Pair:
    """Pair of any metals that the solver is meant for, from five numbers in [0, 1).

    E_s/E_f 1/6 to 6, nu 0.1 to 0.45, Sy* 0.05 to 20 and E'/Sy_min 20 to 4000.
    """
    stiffness = 6.0 ** (2.0 * u[0] - 1.0)
    nu_s, nu_f = (round(float(0.1 + 0.35 * x), 3) for x in u[1:3])
    pair = pair_of(
        E_s=digits(100.0 * stiffness**0.5),
        E_f=digits(100.0 / stiffness**0.5),
        Sy_min=1.0,
        ratio=digits(0.05 * 400.0 ** u[3]),
        nu_s=nu_s,
        nu_f=nu_f,
    )
    strength = digits(pair.E_reduced / (20.0 * 200.0 ** u[4]))
    return replace(
        pair,
        sphere=replace(pair.sphere, Sy=pair.sphere.Sy / 1e6 * strength),
        flat=replace(pair.flat, Sy=pair.flat.Sy / 1e6 * strength),
    )


def sobol(dimensions: int, *, seed: int, power: int) -> Array:
    """2^power scrambled Sobol points of [0, 1), shape (2^power, dimensions)."""
    from scipy.stats import qmc

    rng = np.random.default_rng(seed)
    return np.asarray(qmc.Sobol(dimensions, scramble=True, rng=rng).random_base2(power))


def two_metals(u: Array, *, strain: float, ratio: float) -> Pair:
    """Pair from four numbers in [0, 1), yield strain of the weaker body and Sy*; R = 1 mm.

    Moduli 50 to 300 GPa and Poisson ratios 0.2 to 0.45 are linear in the numbers.
    """
    E_s, E_f = (digits(50.0 + 250.0 * x) * 1e9 for x in u[:2])
    nu_s, nu_f = (round(float(0.2 + 0.25 * x), 3) for x in u[2:])
    weaker = digits(strain * (E_s if ratio < 1.0 else E_f))
    Sy_s, Sy_f = (weaker, weaker / ratio) if ratio < 1.0 else (weaker * ratio, weaker)
    return Pair(Material(E=E_s, nu=nu_s, Sy=Sy_s), Material(E=E_f, nu=nu_f, Sy=Sy_f), R=1e-3)


def digits(x: float) -> float:
    """Round to four digits, as a table would print it."""
    return float(f"{x:.4g}")


# Table 2.1 of the thesis: E_s, E_f [GPa], Sy_min [MPa], nu_s, nu_f
TABLE_2_1 = {
    1: (200.0, 200.0, 200.0, 0.30, 0.30),
    2: (200.0, 200.0, 300.0, 0.33, 0.30),
    3: (71.7, 200.0, 300.0, 0.33, 0.30),
    4: (71.7, 200.0, 503.0, 0.30, 0.30),
    5: (200.0, 200.0, 503.0, 0.33, 0.30),
}


def table_2_1(number: int, ratio: float) -> Pair:
    """Pair `number` of Table 2.1 at Sy* = `ratio`."""
    E_s, E_f, Sy, nu_s, nu_f = TABLE_2_1[number]
    return pair_of(E_s=E_s, E_f=E_f, Sy_min=Sy, ratio=ratio, nu_s=nu_s, nu_f=nu_f)


# Sy* of the thesis's sweeps; its steep part, 0.9 to 1.7, in steps of 0.05 and at its dip, 1.07
RATIOS = (
    *(0.1, 0.14, 0.2, 0.28, 0.4, 0.5, 0.6, 0.7, 0.8),
    *(round(0.9 + 0.05 * k, 2) for k in range(17)),
    *(1.07, 1.85, 2.0, 2.5, 3.5, 5.0, 7.0, 10.0),
)

_THESIS_DEPTH = 0.04  # Delta/R of the thesis's figures over Sy*


def deep_case(
    name: str,
    pair: Pair,
    *,
    deepest: float = 0.1,
    fields: bool = False,
    accuracy: fem.Accuracy = fem.Accuracy.production(),  # noqa: B008 (frozen)
) -> Case:
    """Case to a/R = 0.5: three unloadings below 20 critical depths, two beyond."""
    onset = pair.first_yield
    last_light = min(18.0 * onset, 0.5 * deepest)
    light = fem.geometric_depths(1.5 * onset, last_light, 3)
    return standard_case(
        name,
        pair,
        deepest=deepest,
        n_depths=48,
        unload_depths=(*light, (last_light * deepest) ** 0.5, deepest),
        radius_at_least=0.5,
        through=_THESIS_DEPTH,
        fields=fields,
        accuracy=accuracy,
    )
