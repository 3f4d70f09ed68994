"""Our fitted law for metals with a flow curve: Tabor's representative flow stress.

At contact radius a the plastic strain 0.2 (a - a_c)/R stands for all strains, a_c the radius at
first yield. Each body has of it what it has of the plastic flow and is taken as perfectly plastic
at the stress of its flow curve there: the body that flows the more hardens and leaves flow to the
other. The mean pressure is that of these perfectly plastic bodies at the same radius. How deep they
then are differs, for what hardens sinks in where the other piles up. The square of the radius over
R Delta is one in an elastic contact, whatever the exponent n, and goes with n between its plastic
value at n = 0 and one at n = 1: its logarithm is taken to fall as 1 - n, which meets both ends.
Nothing here is fitted.

References
----------
D. Tabor, The Hardness of Metals (1951). K. L. Johnson, Contact Mechanics (1985), 6.3.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from ..core.material import Material, Pair
from .base import ContactLaw, Domain, Kernels, Standing
from .closed_form import Bodies, contact
from .driver import Depths, Pairs
from .fitted import ClosedForm, bodies_of
from .kernel import Floats, common_parameters, critical_depth
from .table import packed_columns, recovery_exponent
from .table_kernels import TABLE_KERNELS

REPRESENTATIVE = 0.2
"""Plastic strain that stands for all of them, over a/R (Tabor)."""

_POINTS = 320  # of the table
_FIRST, _LAST = 0.01, 0.6  # equivalent depths: over the critical one, over R
_ROUNDS = 40  # bisections of the sphere's part of the flow
_SETTLING = 4  # rounds of the contact radius in each, which go on from the last


@dataclass(frozen=True, kw_only=True, eq=False)
class HardeningLaw(ContactLaw):
    """The fitted law at the representative flow stress of each body.

    Parameters
    ----------
    fitted
        The law of perfectly plastic bodies.
    """

    fitted: ClosedForm

    @property
    def kernels(self) -> Kernels:
        """The compiled functions, those of a table."""
        return TABLE_KERNELS

    def parameters(self, pair: Pair) -> Floats:
        """Common numbers, then the table of the pair; shape (n,)."""
        return np.concatenate([common_parameters(pair), _columns(self, pair)])

    def share(self, pair: Pair, depth: Depths) -> Floats:
        """delta_s*, shape (...); the elastic share where the contact is open."""
        x, at = _equivalent(self, pair)
        d = np.asarray(depth, dtype=float)
        inside = np.interp(np.log(np.maximum(d / pair.R, 1e-300)), x, at.share)
        return np.where(d > 0.0, inside, pair.elastic_share)

    def warn_outside(self, pair: Pairs, depth: Depths) -> None:
        """Warn as the fitted law does, by the strengths at first yield."""
        pairs = [pair] if isinstance(pair, Pair) else list(pair)
        self.fitted.warn_outside([_without_flow(p) for p in pairs], depth)


def hardening_law(fitted: ClosedForm) -> HardeningLaw:
    """Return the law that follows flow curves with `fitted`."""
    return HardeningLaw(
        name="hardening",
        title="dentscope, fitted at Tabor's flow stress",
        source="data/coefficients/fitted.json; Tabor, The Hardness of Metals (1951)",
        equations="docs/closed-form.md",
        standing=Standing.OWN_SOURCE,
        domain=Domain(note=fitted.domain.note),
        breaks=fitted.breaks,
        fitted=fitted,
    )


def _without_flow(pair: Pair) -> Pair:
    sphere, flat = (body.with_(flow=None) for body in (pair.sphere, pair.flat))
    return Pair(sphere, flat, pair.R)


@lru_cache(maxsize=64)
def _equivalent(law: HardeningLaw, pair: Pair) -> tuple[Floats, Any]:
    """Return ln(Delta/R) of the points of a path, and the `Contact` there, arrays of one shape."""
    onset = critical_depth(pair) / pair.R
    first = _FIRST * onset if math.isfinite(onset) else 1e-7
    D = np.geomspace(min(first, 0.1 * _LAST), _LAST, _POINTS)
    yields_at = math.sqrt(onset) if math.isfinite(onset) else math.inf
    bodies, sphere, flat = bodies_of([pair]), _flow(pair.sphere), _flow(pair.flat)
    a = np.sqrt(D)
    least, most = np.zeros_like(D), np.ones_like(D)
    for _ in range(_ROUNDS):
        part = 0.5 * (least + most)
        for _ in range(_SETTLING):
            p = REPRESENTATIVE * np.maximum(a - yields_at, 0.0)
            (S_s, n_s), (S_f, n_f) = sphere(part * p), flat(p - part * p)
            at = contact(D, law.fitted.numbers(_with_strengths(bodies, S_s, S_f)))
            a = 0.5 * (a + at.a)
        # the more the sphere flows the stronger it gets, the less of the flow is its own
        least, most = np.where(at.phi > part, part, least), np.where(at.phi > part, most, part)
    n = at.share * n_s + (1.0 - at.share) * n_f
    deeper = np.maximum(at.a**2 / D, 1.0) ** n
    left = 1.0 - (1.0 - at.left) / deeper
    return np.log(D * deeper), at._replace(left=np.maximum(left, 0.0))


def _with_strengths(bodies: Bodies, sphere: Floats, flat: Floats) -> Bodies:
    k_s, k_f, nu_s, nu_f = (np.broadcast_to(x, sphere.shape) for x in bodies[:4])
    return Bodies(k_s, k_f, nu_s, nu_f, 1.0 / sphere, 1.0 / flat)


def _flow(body: Material) -> Callable[[Floats], tuple[Floats, Floats]]:
    """Flow stress by the plastic strain, and its exponent d ln S/d ln p."""
    if body.rigid or body.flow is None or body.flow.curve is None:
        return lambda p: (np.full(p.shape, body.strength), np.zeros(p.shape))
    curve = body.flow.curve
    stress = CubicHermiteSpline(curve.strain, curve.stress, curve.slope)
    slope, last = stress.derivative(), curve.strain[-1]

    def of(p: Floats) -> tuple[Floats, Floats]:
        inside = np.minimum(p, last)
        S = stress(inside)
        return S, np.clip(np.where(p < last, slope(inside), 0.0) * p / S, 0.0, 1.0)

    return of


@lru_cache(maxsize=64)
def _columns(law: HardeningLaw, pair: Pair) -> Floats:
    x, at = _equivalent(law, pair)
    grid = np.linspace(x[0], x[-1], _POINTS)
    F, a, left, phi, N = (
        PchipInterpolator(x, values)(grid)
        for values in (np.log(at.F), np.log(at.a), at.left, at.phi, at.N)
    )
    exponent = recovery_exponent(grid, F, left, N)
    return packed_columns(grid, (F, a, left, phi, exponent))
