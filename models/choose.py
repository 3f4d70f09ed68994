"""What a pair and a depth ask of a law, and what each law was made for.

The borders come from the thesis's finite elements: the sphere's share of the approach and the
contact radius no longer change below Sy* = 0.6 and above 1.7 (chapter 2), yield sets in at
delta_c and shows from 1.9 delta_c on (1.3.2), and delta_n = 110 is full plasticity (2.3.2).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ..core.material import Pair
from .base import CombinedLaw, ContactLaw
from .hardening import REPRESENTATIVE, HardeningLaw
from .table import TableLaw
from .turned import SimilarLaw, TurnedLaw

# limit: ratio of strengths above which the flat alone is said to yield [-]
_INDENTATION_ABOVE = 1.7

# limit: ratio of strengths below which the sphere alone is said to yield [-]
_FLATTENING_BELOW = 0.6

# limit: strain in the middle of a contact over Tabor's [-]; finite elements that harden: 4 to 6
_DEEPEST_STRAIN = 3.0

_ELASTIC_DEPTH = 1.9
"""Depth up to which a contact is elastic [critical depths] (Jackson and Green 2005, Eq. 9)."""


@dataclass(frozen=True, slots=True)
class Demand:
    """What a pair asks of a law at its largest depth.

    - `regime`: "elastic", "flattening", "both bodies" or "indentation".
    - `w`: largest approach over the critical one; 0 if nothing yields.
    - `a_over_R`: contact radius over R, without pile-up or sink-in.
    """

    regime: str
    w: float
    a_over_R: float


def demand(pair: Pair, depth: float) -> Demand:
    """Return what `pair` asks of a law at an approach of `depth` [m].

    Examples
    --------
    >>> from dentscope.core import Material, Pair
    >>> soft, hard = Material(E=200e9, nu=0.3, Sy=300e6), Material(E=200e9, nu=0.3, Sy=3e9)
    >>> demand(Pair(soft, hard, 1e-3), 1e-5).regime
    'flattening'
    """
    onset = pair.first_yield * pair.R
    w = depth / onset if math.isfinite(onset) else 0.0
    ratio = pair.Sy_ratio
    if w <= 1.0:
        regime = "elastic"
    elif ratio < _FLATTENING_BELOW:
        regime = "flattening"
    elif ratio > _INDENTATION_ABOVE:
        regime = "indentation"
    else:
        regime = "both bodies"
    return Demand(regime, w, math.sqrt(2.0 * depth / pair.R))


def past_curves(pair: Pair, strains: Iterable[float]) -> Iterator[str]:
    """Say whose flow curve ends before the plastic strain in it; of sphere and flat [-]."""
    bodies = {"sphere": pair.sphere, "flat": pair.flat}
    for (name, body), strain in zip(bodies.items(), strains, strict=True):
        curve = body.flow.curve if body.flow else None
        if curve and strain > curve.strain[-1]:
            yield (
                f"the {name}'s flow curve ends at a strain of {curve.strain[-1]:.3g}, the contact "
                f"reaches about {strain:.2g}: constant beyond"
            )


def strains_under(pair: Pair, radius: float, left: tuple[float, float]) -> tuple[float, ...]:
    """Largest plastic strains in sphere and flat, by contact radius and what stays in each [m].

    Three of Tabor's 0.2 a/R in the body that keeps more, in the other by its part of that.
    """
    most = max(left)
    strain = _DEEPEST_STRAIN * REPRESENTATIVE * radius / pair.R
    return tuple(strain * x / most if most > 0.0 else 0.0 for x in left)


def objection(law: ContactLaw, need: Demand) -> str:
    """Why `law` should not be used for `need`; empty if it may."""
    if need.regime == "elastic":
        return ""
    if law.name == "hertz":
        return "" if need.w <= _ELASTIC_DEPTH else "elastic only"
    other = {"flattening": "indentation", "indentation": "flattening"}.get(need.regime)
    if law.regime == other:
        return f"made for {law.regime}"
    if need.regime == "both bodies" and law.regime != "either":
        return f"made for {law.regime}, while both bodies yield here"
    if need.a_over_R > law.domain.a_over_R_max:
        return f"a/R of about {need.a_over_R:.2g} is beyond {law.domain.a_over_R_max:.2g}"
    return ""


def follows_flow(law: ContactLaw) -> bool:
    """Whether a law follows the flow curve of a metal; others take its strength at first yield."""
    if isinstance(law, CombinedLaw):
        return follows_flow(law.first)
    if isinstance(law, TurnedLaw | SimilarLaw):
        return follows_flow(law.law)
    return isinstance(law, HardeningLaw | TableLaw)
