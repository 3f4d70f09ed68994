"""Our fitted law for metals with a flow curve: a mean flow stress under the contact, corrected.

Strains under a contact of radius a run from nothing at the elastic border to several times Tabor's
0.2 (a - a_c)/R, a_c the radius at first yield. The mean of the flow curve over them, `_under`, is a
body's flow stress: a plateau governs the outer part while the inner one has hardened. Each body has
of the strain what it has of the plastic flow and is taken as perfectly plastic at that stress: the
body that flows the more hardens and leaves flow to the other. The mean pressure is that of these
perfectly plastic bodies at the same radius; far beyond yield, that at the flow stress of Tabor's
strain, as the similarity solution of power laws has it (B. Storakers, S. Biwa and P.-L. Larsson,
Int. J. Solids Structures 34 (1997) 3061). How deep they then are differs, for what hardens sinks
in where the other piles up. The square of the radius over R Delta is one in an elastic contact,
whatever the exponent n of the mean flow stress, and goes with n between its plastic value at n = 0
and one at n = 1: its logarithm is taken to fall as 1 - n, which meets both ends.

So far nothing is fitted. What finite elements of metals that harden differ from it by is a
polynomial for each body, times what that body has of the flow, how far the contact has yielded, and
its exponent (second degree) or the bend of its curve, the change of the exponent with the strain
(first degree): see `features_of`. Without hardening, and before yield, it is nothing. The force is
never below that of perfectly plastic bodies at the lowest stress under the contact.

D. Tabor, The Hardness of Metals (1951). K. L. Johnson, Contact Mechanics (1985), 6.3.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from ..core.arrays import Array
from ..core.flow import FlowCurve
from ..core.material import Material, Pair
from .base import ContactLaw, Standing
from .closed_form import Bodies, PairNumbers, contact, plastic_depth
from .driver import Depths, Pairs, depths_of
from .fitted import ClosedForm, bodies_of
from .kernel import common_parameters, critical_depth
from .rules import RULES
from .table import packed_columns, recovery_exponent
from .table_kernels import TABLE_KERNELS
from .uncertainty import LEAST, Uncertainty

REPRESENTATIVE = 0.2
"""Plastic strain that stands for all of them, over a/R [-] (Tabor 1951)."""

CORRECTED = ("depth", "force", "share", "part", "recovered", "exponent")
"""What is corrected: logarithms of Delta, F, the part of Delta that recovers and N + 1; the
sphere's share of the approach and its part of the permanent depth by the logarithm of the odds."""
_COORDINATES = 5


class Under(NamedTuple):
    """A body's flow under the contact, by the representative strain; arrays of shape (n,)."""

    S: Array  # mean flow stress [Pa]
    n: Array  # its exponent, d ln S/d ln p
    bend: Array  # by how much the exponent rises with the strain
    lowest: Array  # lowest stress [Pa]


class Equivalent(NamedTuple):
    """Points of a path, taken as perfectly plastic at their flow stresses; arrays of shape (n,)."""

    D: Array  # Delta/R of the metal that hardens, not corrected
    at: Any  # the `Contact` of the perfectly plastic bodies
    deeper: Array  # D over theirs
    numbers: PairNumbers  # of the fitted law
    y: Array  # their depth beyond first yield
    sphere: Under
    flat: Under
    weakest: PairNumbers  # of bodies at the lowest stress under the contact


@dataclass(frozen=True)
class HardeningCorrection:
    """What finite elements add to the equivalence.

    - `low`, `high`: bounds of the coordinates in the data, shape (5,); beyond them the correction
      fades.
    - `weights`: of the features for each of `CORRECTED`, shape (n_features, 6).
    - `spread`: how far pairs left out of the fit lay away beside the fitted law's own errors, by
      the names of `Uncertainty`.
    """

    low: Array
    high: Array
    weights: Array
    spread: Mapping[str, float]


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class HardeningLaw(ContactLaw):
    """The fitted law at the mean flow stress of each body.

    `fitted`: the law of perfectly plastic bodies; `correction`: what is added to that; none:
    nothing is fitted.
    """

    fitted: ClosedForm
    correction: HardeningCorrection | None = None

    kernels = TABLE_KERNELS

    def parameters(self, pair: Pair) -> Array:
        """Common numbers, then the table of the pair; shape (n,)."""
        return np.concatenate([common_parameters(pair), _columns(self, pair)])

    def share(self, pair: Pair, depth: Depths) -> Array:
        """delta_s*, shape (...); the elastic share where the contact is open."""
        x, at, *_ = _path(self, pair)
        d = depths_of(depth)
        inside = np.interp(np.log(np.maximum(d / pair.R, 1e-300)), x, at.share)
        return np.where(d > 0.0, inside, pair.elastic_share)

    def uncertainty(self, pair: Pair, depth: Depths) -> Uncertainty:
        """How far off the law may be, as pairs left out of the fit were; see `ContactLaw`."""
        x, _, sizes, _ = _path(self, pair)
        if sizes is None:
            return super().uncertainty(pair, depth)
        d = depths_of(depth)
        place = np.log(np.maximum(d / pair.R, 1e-300))
        return Uncertainty(*(np.where(d > 0.0, np.interp(place, x, size), LEAST) for size in sizes))

    def warn_outside(self, pair: Pairs, depth: Depths) -> None:
        """Warn as the fitted law does, by the strengths at first yield."""
        pairs = [pair] if isinstance(pair, Pair) else pair
        plain = [Pair(p.sphere.with_(flow=None), p.flat.with_(flow=None), p.R) for p in pairs]
        self.fitted.warn_outside(plain, depth)


def hardening_law(fitted: ClosedForm, correction: HardeningCorrection | None) -> HardeningLaw:
    """Return the law that follows flow curves with `fitted`."""
    return HardeningLaw(
        name="hardening",
        title="dentscope, fitted at the mean flow stress",
        source="data/coefficients/fitted.json; Tabor, The Hardness of Metals (1951)",
        equations="docs/closed-form.md",
        standing=Standing.OWN_SOURCE,
        domain=fitted.domain,
        breaks=fitted.breaks,
        fitted=fitted,
        correction=correction,
    )


def representative_strain(a: Array, yields_at: float) -> Array:
    """Plastic strain that stands for those under a contact of radius a/R, first yield at another.

    Both over R, shape (...).
    """
    return np.asarray(REPRESENTATIVE * np.maximum(a - yields_at, 0.0))


def mean_over_strains(n: float) -> float:
    """Mean of the n-th power of the strains under a contact, over that of the representative one.

    Examples
    --------
    >>> mean_over_strains(0.0), round(mean_over_strains(0.3), 3)
    (1.0, 0.921)
    """
    return float(RULES.mean_span**n / (1.0 + RULES.mean_fall * n))


def equivalent(fitted: ClosedForm, pair: Pair, *, points: int) -> Equivalent:
    """Return the path of a pair through perfectly plastic bodies, from far below first yield on."""
    onset = critical_depth(pair) / pair.R
    first = RULES.law_first * onset if math.isfinite(onset) else 1e-7
    D = np.geomspace(min(first, 0.1 * RULES.law_last), RULES.law_last, points)
    yields_at = math.sqrt(onset) if math.isfinite(onset) else math.inf
    bodies, sphere, flat = bodies_of([pair]), _flow(pair.sphere), _flow(pair.flat)

    def taken(part: Array, a: Array) -> Equivalent:
        """The points if the sphere has `part` of the strain, from a first radius on."""
        for _ in range(RULES.radius_rounds):
            p = representative_strain(a, yields_at)
            s, f = sphere(part * p), flat(p - part * p)
            numbers = fitted.numbers(_with_strengths(bodies, s.S, f.S))
            at = contact(D, numbers)
            a = 0.5 * (a + at.a)
        n = at.share * s.n + (1.0 - at.share) * f.n
        deeper = np.maximum(at.a**2 / D, 1.0) ** n
        y = plastic_depth(numbers.W * D)
        return Equivalent(D * deeper, at, deeper, numbers, y, s, f, numbers)

    # the more the sphere flows the stronger it gets, the less of the flow is its own: what it has
    # of the strain and of the flow meet once (false position; Dowell, Jarratt, BIT 11 (1971) 168)
    low, high = np.zeros_like(D), np.ones_like(D)
    found = taken(low, np.sqrt(D))
    at_low = found.at.phi - low
    at_high = taken(high, found.at.a).at.phi - high
    side = np.zeros_like(D)
    for _ in range(RULES.flow_rounds):
        part = low + (high - low) * at_low / np.maximum(at_low - at_high, 1e-300)
        found = taken(part, found.at.a)
        off = found.at.phi - part
        up = off > 0.0
        # an end that stays a second time counts half, so that it moves too
        at_high = np.where(up, np.where(side > 0.0, 0.5 * at_high, at_high), off)
        at_low = np.where(up, off, np.where(side < 0.0, 0.5 * at_low, at_low))
        low, high = np.where(up, part, low), np.where(up, high, part)
        side = np.where(up, 1.0, -1.0)
    lowest = _with_strengths(bodies, found.sphere.lowest, found.flat.lowest)
    at = found.at._replace(F=found.at.F * _fuller(found))
    return found._replace(at=at, weakest=fitted.numbers(lowest))


def _fuller(e: Equivalent) -> Array:
    """Mean pressure far beyond yield over that at the mean flow stress.

    There it is the one at Tabor's strain: of a power law the mean is span^n/(1 + fall n) of that.
    """
    phi = e.at.phi
    n = phi * e.sphere.n + (1.0 - phi) * e.flat.n
    return np.asarray(((1.0 + RULES.mean_fall * n) / RULES.mean_span**n) ** (e.y / (1.0 + e.y)))


def coordinates_of(e: Equivalent) -> tuple[Array, Array]:
    """Coordinates of the points for the sphere and for the flat, shape (n, 5) each.

    Contact radius, exponent, logarithm of E' over the flow stress, elastic share of the body, and
    logarithm of the depth beyond yield, each about one wide.
    """
    numbers, a, far = e.numbers, e.at.a / 0.3, np.log1p(e.y) / 2.5 - 1.0

    def of(n: Array, stiff: Array, share: Array) -> Array:
        return np.stack(
            [a, (n - 0.2) / 0.15, (np.log(stiff) - 5.0) / 1.2, (share - 0.5) / 0.22, far], axis=-1
        )

    return (of(e.sphere.n, numbers.j_s, numbers.x_s), of(e.flat.n, numbers.j_f, 1.0 - numbers.x_s))


def features_of(e: Equivalent, low: Array, high: Array) -> Array:
    """Features of the points, shape (n, 59): 21 monomials a body times its exponent, six times its
    bend, and where both flow.
    """  # noqa: D205
    yielded = e.y / (1.0 + e.y)
    n_s, n_f = e.sphere.n, e.flat.n
    columns, fades = [], []
    for flows, body, at in zip(
        (e.at.phi, 1.0 - e.at.phi), (e.sphere, e.flat), coordinates_of(e), strict=True
    ):
        inside = np.clip(at, low, high)
        within = np.exp(-0.5 * np.sum(((at - inside) / RULES.fades) ** 2, axis=1))
        size = 5.0 * flows * yielded * within
        for degree in range(RULES.correction_degree + 1):
            for which in itertools.combinations_with_replacement(range(_COORDINATES), degree):
                columns.append(size * body.n * np.prod(inside[:, list(which)], axis=1))
        columns += [size * body.bend, *(size * body.bend * x for x in inside.T)]
        fades.append(within)
    both = 4.0 * e.at.phi * (1.0 - e.at.phi) * yielded * fades[0] * fades[1]
    columns += [
        both * n_s, both * n_f, both * (n_s - n_f) ** 2, both * n_s * e.at.a, both * n_f * e.at.a,
    ]  # fmt: skip
    return np.stack(columns, axis=-1)


def corrected(e: Equivalent, shifts: Array) -> tuple[Array, Any]:
    """Return ln(Delta/R) and the `Contact` of the points with shifts of `CORRECTED`, (n, 6)."""
    depth, force, share, part, recovered, exponent = shifts.T
    recovers = (1.0 - e.at.left) / e.deeper * np.exp(recovered)
    return np.log(e.D) + depth, e.at._replace(
        F=e.at.F * np.exp(force),
        share=_moved_odds(e.at.share, share),
        phi=_moved_odds(e.at.phi, part),
        left=1.0 - np.minimum(recovers, 1.0),
        N=(e.at.N + 1.0) * np.exp(exponent) - 1.0,
    )


def least_force(e: Equivalent, x: Array) -> Array:
    """F/(E' R^2) at ln(Delta/R) = x of perfectly plastic bodies at the lowest stress under it."""
    return np.asarray(contact(np.exp(x), e.weakest).F)


def _moved_odds(share: Array, shift: Array) -> Array:
    grown = share * np.exp(shift)
    return np.asarray(grown / (grown + 1.0 - share))


@lru_cache(maxsize=64)
def _path(law: HardeningLaw, pair: Pair) -> tuple[Array, Any, Uncertainty | None, Array]:
    """A path's points: ln(Delta/R), rising, the `Contact` there, errors of both, least force."""
    e, correction = equivalent(law.fitted, pair, points=RULES.points), law.correction
    if correction is None:
        x, least = np.log(e.D), least_force(e, np.log(e.D))
        left = 1.0 - (1.0 - e.at.left) / e.deeper
        return x, e.at._replace(F=np.maximum(e.at.F, least), left=left), None, least
    shifts = features_of(e, correction.low, correction.high) @ correction.weights
    x, at = corrected(e, shifts)
    # outside the data a correction could turn a path back
    steps = np.maximum(np.diff(x), RULES.least_step)
    x = x[0] + np.concatenate([[0.0], np.cumsum(steps)])
    least = least_force(e, x)
    # the larger, rounded where the two cross: a table would undershoot at a kink
    rise, round_ = np.log(at.F / least), RULES.rounded * hardening_size(e)
    F = least * np.exp(0.5 * (rise + np.hypot(rise, round_)))
    at = at._replace(F=np.maximum.accumulate(F), left=np.maximum(at.left, 0.0))
    return x, at, _sizes(law, e, correction), least


def _sizes(law: HardeningLaw, e: Equivalent, correction: HardeningCorrection) -> Uncertainty | None:
    """Standard deviations at the points: the fitted law's, and what hardening adds."""
    if law.fitted.calibration is None:
        return None
    own = law.fitted.calibration.of(e.numbers, e.D / e.deeper)
    hardens = hardening_size(e)
    more = (correction.spread[name] * hardens for name in Uncertainty._fields)
    return Uncertainty(*(np.hypot(a, b) for a, b in zip(own, more, strict=True)))


def hardening_size(e: Equivalent) -> Array:
    """How much the points harden or their curves bend: nothing before yield, one far beyond it."""
    phi = e.at.phi
    n = np.hypot(
        phi * e.sphere.n + (1.0 - phi) * e.flat.n, phi * e.sphere.bend + (1.0 - phi) * e.flat.bend
    )
    return np.asarray(n / np.sqrt(n * n + 0.01) * e.y / (1.0 + e.y))


def _with_strengths(bodies: Bodies, sphere: Array, flat: Array) -> Bodies:
    k_s, k_f, nu_s, nu_f = (np.broadcast_to(x, sphere.shape) for x in bodies[:4])
    return Bodies(k_s, k_f, nu_s, nu_f, 1.0 / sphere, 1.0 / flat)


def _flow(body: Material) -> Callable[[Array], Under]:
    """A body's flow under the contact, by the representative strain."""
    if body.rigid or body.flow is None or body.flow.curve is None:

        def plain(p: Array) -> Under:
            S, none = np.full(p.shape, body.strength), np.zeros(p.shape)
            return Under(S, none, none, S)

        return plain
    x, table = _under(body.flow.curve)

    def of(p: Array) -> Under:
        at = np.log(np.maximum(p, 1e-300))
        return Under(*(np.interp(at, x, column) for column in table))

    return of


@lru_cache(maxsize=256)
def _under(curve: FlowCurve) -> tuple[Array, Under]:
    """Ln of representative strains, and a curve's flow there."""
    stress, last = CubicHermiteSpline(curve.strain, curve.stress, curve.slope), curve.strain[-1]
    x = np.linspace(math.log(RULES.least_strain), math.log(RULES.largest_strain), RULES.mean_table)
    shares = (
        RULES.mean_span
        * ((np.arange(RULES.mean_strains) + 0.5) / RULES.mean_strains) ** RULES.mean_fall
    )
    stresses = stress(np.minimum(np.exp(x)[:, None] * shares, last))
    S = np.mean(stresses, axis=1)
    n = np.clip(np.gradient(np.log(S), x), -1.0, 1.0)
    apart = round(RULES.bend_apart / (x[1] - x[0]))
    padded = np.pad(n, apart, mode="edge")
    lowest = np.minimum.accumulate(np.minimum(np.min(stresses, axis=1), curve.strength))
    return x, Under(S, n, padded[2 * apart :] - padded[: -2 * apart], lowest)


@lru_cache(maxsize=64)
def _columns(law: HardeningLaw, pair: Pair) -> Array:
    x, at, _, least = _path(law, pair)
    grid = np.linspace(x[0], x[-1], RULES.points)
    F, a, left, phi, N = (
        PchipInterpolator(x, values)(grid)
        for values in (np.log(at.F), np.log(at.a), at.left, at.phi, at.N)
    )
    # between points too
    F = np.maximum(F, PchipInterpolator(x, np.log(least))(grid))
    exponent = recovery_exponent(grid, F, left, N)
    return packed_columns(grid, (F, a, left, phi, exponent))
