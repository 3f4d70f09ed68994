"""A law whose bodies stand otherwise: in each other's place, or two spheres in place of one.

Turned, the body that is struck is the law's sphere.

Small contacts depend on the radii by 1/R = 1/R_1 + 1/R_2 alone: with E, R and all lengths along the
normal s, s and 1/s times as large, force, contact radius, pressure and first yield stay what they
are. Large ones do not: the pressure of a ball that is flattened falls with the contact's size over
its own radius R_1. Taken at s = R_1/R the law has both right, since its sphere is then as large as
the ball. Where the other body yields, the law's flat, its sphere is the stiff indenter and s is 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numba import njit

from ..core.arrays import Array
from ..core.material import Material, Pair
from .anchored import AnchoredLaw
from .base import ContactLaw, Kernels
from .driver import Depths, Pairs
from .fitted import ClosedForm
from .hardening import HardeningLaw
from .kernel import BRANCH_SIGNATURE, LOADING_SIGNATURE, RESIDUAL_SIGNATURE
from .table import TableLaw
from .uncertainty import Uncertainty

# limit: sphere's strength over the flat's from which on the flat alone yields [-]; finite elements
# of two spheres at 1, 1.1, 1.25 and 3.3 (tools/benchmarks/two_spheres.py)
_FLAT_ALONE = 1.2
_REGIMES = {"flattening": "indentation", "indentation": "flattening"}


@dataclass(frozen=True, kw_only=True, repr=False)
class TurnedLaw(ContactLaw):
    """Another law whose sphere is the pair's flat; force, radius and recovery are of both."""

    law: ContactLaw

    @property
    def kernels(self) -> Kernels:
        """Those of the law, what stays given to the other body."""
        return _kernels(self.law.kernels)

    def parameters(self, pair: Pair) -> Array:
        """Return the law's numbers of the pair turned round, shape (n,)."""
        return self.law.parameters(pair.turned)

    def share(self, pair: Pair, depth: Depths) -> Array:
        """Share of the approach that the pair's sphere takes, shape (...)."""
        split = getattr(self.law, "share", None)
        if split is None:
            return np.full(np.shape(depth), pair.elastic_share)
        return np.asarray(1.0 - split(pair.turned, depth))

    def uncertainty(self, pair: Pair, depth: Depths) -> Uncertainty:
        """How far off the law may be; as `ContactLaw.uncertainty`."""
        return self.law.uncertainty(pair.turned, depth)

    def warn_outside(self, pair: Pairs, depth: Depths) -> None:
        """Warn where the law itself would."""
        one = isinstance(pair, Pair)
        self.law.warn_outside(pair.turned if one else [p.turned for p in pair], depth)  # type: ignore[union-attr]


def as_made(law: ContactLaw, pair: Pair) -> tuple[ContactLaw, Pair]:
    """Return the law itself, and the pair as that has it: of a turned law turned back."""
    return (law.law, pair.turned) if isinstance(law, TurnedLaw) else (law, pair)


@lru_cache(maxsize=64)
def turned(law: ContactLaw) -> ContactLaw:
    """Return the law with sphere and flat in each other's place.

    A law of one solved pair stays as it is, for that pair was solved as its bodies stand; so does
    one that is turned.

    Examples
    --------
    >>> from dentscope.core import Material
    >>> from dentscope.models import LAWS
    >>> soft, hard = Material(E=200e9, nu=0.3, Sy=4e8), Material(E=200e9, nu=0.3, Sy=2e9)
    >>> law, pair = LAWS["fitted"], Pair(soft, hard, 5e-3)
    >>> float(turned(law).loading(pair.turned, 1e-5) / law.loading(pair, 1e-5))
    1.0
    """
    if isinstance(law, AnchoredLaw | TableLaw | TurnedLaw):
        return law
    regime = _REGIMES.get(law.regime, law.regime)
    return TurnedLaw(**{**law.about, "regime": regime}, law=law)


@lru_cache(maxsize=64)
def _kernels(own: Kernels) -> Kernels:
    residual: Any = own.residual

    @njit(RESIDUAL_SIGNATURE, _nrt=False)
    def other_residual(par, peak):  # type: ignore[no-untyped-def]
        sphere, flat = residual(par, peak)
        return flat, sphere

    return own._replace(residual=other_residual)


@dataclass(frozen=True, kw_only=True, repr=False)
class SimilarLaw(ContactLaw):
    """Another law at its sphere's own radius, `ratio` times R of the pair."""

    law: ClosedForm | HardeningLaw
    ratio: float

    @property
    def kernels(self) -> Kernels:
        """Those of the law between depths of another scale."""
        return _similar_kernels(self.law.kernels)

    def scale(self, pair: Pair) -> float:
        """How much larger the law is taken, s: `ratio` where its sphere is the weaker, else 1."""
        apart = math.log(pair.Sy_ratio) if 0.0 < pair.Sy_ratio < math.inf else 0.0
        flat = 1.0 if math.isinf(pair.Sy_ratio) else apart / math.log(_FLAT_ALONE)
        return 1.0 + (self.ratio - 1.0) * (1.0 - min(max(flat, 0.0), 1.0))

    def alike(self, pair: Pair) -> tuple[Pair, float]:
        """The pair as the law is asked for it, and s."""
        s = self.scale(pair)
        return Pair(_stiffer(pair.sphere, s), _stiffer(pair.flat, s), s * pair.R), s

    @property
    def turn(self) -> float:
        """Weight of the split between the bodies as the other one has it: a half of equal spheres.

        Neither is the flat there. As (2 R/R_2)^4 it is what finite elements ask for at R_2 = 2 R_1.
        """
        return 0.5 * (2.0 * max(1.0 - 1.0 / self.ratio, 0.0)) ** 4

    def parameters(self, pair: Pair) -> Array:
        """The law's numbers of that pair and of it turned, `turn`, and s of both, shape (n,)."""
        (here, s), (there, t) = self.alike(pair), self.alike(pair.turned)
        both = (self.law.parameters(one) for one in (here, there))
        return np.concatenate([*both, [self.turn, t, s]])

    def share(self, pair: Pair, depth: Depths) -> Array:
        """delta_s*, shape (...)."""
        here, there = (
            self.law.share(other, np.asarray(depth) / s)
            for other, s in map(self.alike, (pair, pair.turned))
        )
        return np.asarray((1.0 - self.turn) * here + self.turn * (1.0 - there))

    def uncertainty(self, pair: Pair, depth: Depths) -> Uncertainty:
        """How far off the law may be; as `ContactLaw.uncertainty`."""
        other, s = self.alike(pair)
        return self.law.uncertainty(other, np.asarray(depth) / s)

    def warn_outside(self, pair: Pairs, depth: Depths) -> None:
        """Warn where the law itself would."""
        found = [self.alike(p) for p in ([pair] if isinstance(pair, Pair) else pair)]
        # of many the deepest, by the least s
        least = min(s for _, s in found)
        self.law.warn_outside([other for other, _ in found], np.asarray(depth) / least)


@lru_cache(maxsize=64)
def similar(law: ContactLaw, ratio: float) -> ContactLaw:
    """Return the law with a sphere of `ratio` times the radius R of the pair, 1/R that of both.

    Published laws are left as their authors use them, by R alone, and so is a law of one solved
    pair.
    """
    if ratio == 1.0 or not isinstance(law, ClosedForm | HardeningLaw):
        return law
    return SimilarLaw(**law.about, law=law, ratio=ratio)


def _stiffer(body: Material, s: float) -> Material:
    """The body s times as stiff, that hardens in strains 1/s as large."""
    flow = body.flow
    if flow is not None and flow.curve is not None:
        flow = replace(flow, curve=flow.curve.drawn_together(s))
    return body if body.rigid else body.with_(E=s * body.E, flow=flow)


@lru_cache(maxsize=64)
def _similar_kernels(own: Kernels) -> Kernels:
    loading, radius, unloading, residual = own

    @njit(LOADING_SIGNATURE, _nrt=False)
    def similar_loading(par, depth):  # type: ignore[no-untyped-def]
        return loading(par[: (len(par) - 3) // 2], depth / par[-1])

    @njit(BRANCH_SIGNATURE, _nrt=False)
    def similar_radius(par, depth, peak):  # type: ignore[no-untyped-def]
        return radius(par[: (len(par) - 3) // 2], depth / par[-1], peak / par[-1])

    @njit(BRANCH_SIGNATURE, _nrt=False)
    def similar_unloading(par, depth, peak):  # type: ignore[no-untyped-def]
        return unloading(par[: (len(par) - 3) // 2], depth / par[-1], peak / par[-1])

    @njit(RESIDUAL_SIGNATURE, _nrt=False)
    def similar_residual(par, peak):  # type: ignore[no-untyped-def]
        n, turn = (len(par) - 3) // 2, par[-3]
        sphere, flat = residual(par[:n], peak / par[-1])
        whole = sphere + flat
        other_flat, other_sphere = residual(par[n : 2 * n], peak / par[-2])
        there = other_sphere + other_flat
        if there > 0.0:
            sphere += turn * (other_sphere / there * whole - sphere)
        return par[-1] * sphere, par[-1] * (whole - sphere)

    return Kernels(similar_loading, similar_radius, similar_unloading, similar_residual)
