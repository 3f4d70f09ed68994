"""Pairs of the thesis's kind, and the cases that the large sweeps make of them.

Strengths follow the thesis: Sy_min is held and Sy* = S_ys/S_yf sets the stronger body.
"""

from __future__ import annotations

from ... import fem
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


# Table 2.1 of the thesis: E_s, E_f [GPa], Sy_min [MPa], nu_s, nu_f
TABLE_2_1 = {
    1: (200.0, 200.0, 200.0, 0.30, 0.30),
    2: (200.0, 200.0, 300.0, 0.33, 0.30),
    3: (71.7, 200.0, 300.0, 0.33, 0.30),
    4: (71.7, 200.0, 503.0, 0.30, 0.30),
    5: (200.0, 200.0, 503.0, 0.33, 0.30),
}

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
    onset = fem.critical_depth(pair)
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
