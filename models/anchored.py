"""The law of one's own metal: exact at the stated numbers, with the fitted law's slopes beside.

A flow curve or finite elements of the very pair say what the contact does at the stated moduli and
strength, slowly. Around them (a modulus off by its error, a strength that a mechanism raises) the
fitted law says how the answer changes. So every column of the fitted law's table gets the distance
at the stated numbers, over ln(depth/R): of ln F, ln a, what recovers, the sphere's part (odds) and
the exponent of unloading.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..core.arrays import Array
from ..core.material import Material, Pair
from .base import ContactLaw, Domain, Standing, unwarned
from .closed_form import contact
from .driver import Depths, depths_of
from .fitted import ClosedForm, bodies_of
from .kernel import common_parameters, critical_depth
from .rules import RULES
from .table import packed_columns, recovery_exponent
from .table_kernels import TABLE_KERNELS
from .uncertainty import Uncertainty


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class AnchoredLaw(ContactLaw):
    """The fitted law, shifted onto another law at one pair.

    - `fitted`: says how the contact changes with the two bodies.
    - `anchor`, `at`: says what the contact is at this pair.
    - `stated`: the same pair to the fitted law: perfectly plastic.
    - `deepest`: Delta/R to which the anchor is known; beyond, the distance stays.
    - `hardens`: whether the anchor follows the flow curve of the body that yields first.
    """

    fitted: ClosedForm
    anchor: ContactLaw
    at: Pair
    stated: Pair
    deepest: float
    hardens: bool

    kernels = TABLE_KERNELS

    def parameters(self, pair: Pair) -> Array:
        """Common numbers, then the table of the pair; shape (n,)."""
        x = _grid(pair, RULES.law_last)
        force, radius, recovers, part, exponent = (
            np.interp(x, self._distance[0], shift) for shift in self._distance[1]
        )
        at = contact(np.exp(x), self.fitted.numbers(bodies_of([pair])))
        # a strength far from the stated one could turn a shifted curve back
        F = np.maximum.accumulate(np.log(at.F) + force)
        a = np.maximum.accumulate(np.log(at.a) + radius)
        left = np.clip(1.0 - (1.0 - at.left) * np.exp(recovers), 0.0, 0.999)
        odds = at.phi * np.exp(part)
        power = recovery_exponent(x, F, left, (at.N + 1.0) * np.exp(exponent) - 1.0)
        columns = (F, a, left, odds / (odds + 1.0 - at.phi), power)
        return np.concatenate([common_parameters(pair), packed_columns(x, columns)])

    def metal(self, pair: Pair) -> Pair:
        """Return a pair near the stated one with the flow curves that the anchor follows."""

        def body(plain: Material, stated: Material, known: Material) -> Material:
            if known.flow is None or known.flow.curve is None:
                return plain
            stronger = known.flow.curve.scaled(plain.Sy / stated.Sy)
            return plain.with_(Sy=stronger.strength, flow=replace(known.flow, curve=stronger))

        return Pair(
            body(pair.sphere, self.stated.sphere, self.at.sphere),
            body(pair.flat, self.stated.flat, self.at.flat), pair.R,
        )  # fmt: skip

    def uncertainty(self, pair: Pair, depth: Depths) -> Uncertainty:
        """What the anchor says of itself at this depth over R; see `ContactLaw.uncertainty`."""
        over = depths_of(depth) / pair.R
        return self.anchor.uncertainty(self.at, over * self.at.R)

    @cached_property
    def _distance(self) -> tuple[Array, Array]:
        """ln(Delta/R), shape (n,), and the shifts of the five columns there, (5, n)."""
        x = _grid(self.at, self.deepest)
        here = _columns(self.anchor, self.at, np.exp(x))
        fitted = contact(np.exp(x), self.fitted.numbers(bodies_of([self.stated])))
        base = (fitted.F, fitted.a, fitted.left, fitted.phi, fitted.N)
        F, a, left, phi, N = zip(here, base, strict=True)
        return x, np.stack([
            np.log(F[0] / F[1]), np.log(a[0] / a[1]),
            np.log((1.0 - left[0]) / (1.0 - left[1])),
            _log_odds(phi[0]) - _log_odds(phi[1]), np.log((N[0] + 1.0) / (N[1] + 1.0)),
        ])  # fmt: skip


def anchored(
    fitted: ClosedForm, anchor: ContactLaw, *, at: Pair, stated: Pair,
    deepest: float = RULES.law_last, hardens: bool,
) -> AnchoredLaw:  # fmt: skip
    """Return `fitted`, shifted onto `anchor` at a pair; parameters as in `AnchoredLaw`."""
    return AnchoredLaw(
        name=f"{fitted.name}, at {anchor.name}",
        title=f"{fitted.title}; at the stated pair {anchor.title}",
        source=f"{fitted.source}; {anchor.source}",
        equations="no form: a table",
        standing=Standing.OWN_SOURCE,
        domain=Domain(note=f"near the stated pair, Delta_over_R to {deepest:.3g}"),
        breaks=fitted.breaks,
        fitted=fitted, anchor=anchor, at=at, stated=stated, deepest=deepest, hardens=hardens,
    )  # fmt: skip


def _grid(pair: Pair, last: float) -> Array:
    """ln(Delta/R) from far below first yield, evenly."""
    onset = critical_depth(pair) / pair.R
    first = min(RULES.law_first * onset, 0.1 * last) if math.isfinite(onset) else 1e-7
    return np.linspace(math.log(first), math.log(last), RULES.points)


def _columns(law: ContactLaw, pair: Pair, D: Array) -> tuple[Array, ...]:
    """F/(E' R^2), a/R, permanent part, the sphere's part of it, exponent of unloading at D."""
    depth = D * pair.R
    # the grid begins and ends outside of what impacts ask for
    with unwarned():
        force = law.loading(pair, depth)
    sphere, flat = law.residual(pair, depth)
    rest = sphere + flat
    half = law.unloading(pair, 0.5 * (rest + depth), depth)
    part = np.divide(sphere, rest, out=np.full_like(rest, 0.5), where=rest > 0.0)
    return (
        force / (pair.E_reduced * pair.R**2), law.contact_radius(pair, depth) / pair.R,
        rest / depth, part, -np.log2(half / force),
    )  # fmt: skip


def _log_odds(part: Array) -> Array:
    inside = np.clip(part, 1e-9, 1.0 - 1e-9)
    return np.asarray(np.log(inside / (1.0 - inside)))
