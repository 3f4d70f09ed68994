"""The finite elements of one's own pair as a contact law, nothing fitted between.

`dentscope case` writes the file; `law_named` takes its path. Loading and radius run monotonely
through the recorded depths in logarithms (C1; Fritsch and Carlson), and are exactly Hertz's below
first yield. Permanent depth and energy of recovery follow from those of the unloadings, between
which the elastic displacement over F/a, the bodies' parts and the exponent are interpolated.

F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17 (1980) 238.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator

from ..core.arrays import Array
from ..core.errors import InputError
from ..core.material import Pair
from .base import ContactLaw, Domain, DomainWarning, Standing
from .driver import Depths, Pairs, depths_of
from .kernel import common_parameters, critical_depth
from .rules import RULES
from .table_kernels import TABLE_KERNELS
from .uncertainty import LEAST, Uncertainty

# limit: unloadings that a law from a pair's own solve needs [-]; two ends and what bends between
FEWEST_UNLOADINGS = 3


class LoadingCurve(NamedTuple):
    """Loading of a pair, arrays of shape (n,), dimensionless, with standard deviations."""

    depth: Array  # Delta/R, rising
    force: Array  # over E' R^2
    radius: Array  # over R
    share: Array  # delta_s*
    force_std: Array  # relative
    radius_std: Array  # relative
    share_std: Array


class Turns(NamedTuple):
    """Unloadings of a pair, arrays of shape (m,), dimensionless."""

    depth: Array  # Delta/R of the turning point, rising
    left: Array  # permanent approach over the largest one
    part: Array  # the sphere's part of it
    exponent: Array  # of the power law that gives back the same energy


@dataclass(frozen=True, eq=False)
class PairTable:
    """What the finite elements say of one pair."""

    pair: Pair
    curve: LoadingCurve
    turns: Turns

    @property
    def yields_at(self) -> float:
        """Delta/R of first yield; infinite for an elastic pair."""
        return critical_depth(self.pair) / self.pair.R

    def is_of(self, pair: Pair) -> bool:
        """Whether `pair` is the same problem, whatever its size and unit of stress."""
        ours, theirs = _groups(self.pair), _groups(pair)
        return bool(np.allclose(ours, theirs, rtol=1e-6, atol=1e-12))

    @cached_property
    def numbers(self) -> Array:
        """What the kernels read behind the common numbers."""
        x, force, radius = self._loading()
        grid = np.linspace(x[0], x[-1], RULES.points)
        F, a = (PchipInterpolator(x, v)(grid) for v in (force, radius))
        return packed_columns(grid, (F, a, *self._recovery(grid, F, a)))

    def _loading(self) -> tuple[Array, Array, Array]:
        """Logarithms of depth, force and radius: Hertz's while elastic, then the data's."""
        c = self.curve
        onset = self.yields_at
        if math.isfinite(onset):
            early, seen = np.array(RULES.joining_depths) * onset, c.depth >= RULES.joined * onset
        else:
            early, seen = np.geomspace(1e-3, 0.3, 5) * c.depth[0], c.depth > 0.0
        depth = np.concatenate([early, c.depth[seen]])
        force = np.concatenate([4.0 / 3.0 * early**1.5, c.force[seen]])
        radius = np.concatenate([np.sqrt(early), c.radius[seen]])
        # a ripple of the mesh may not turn into a force that falls
        force, radius = (np.maximum.accumulate(v) for v in (force, radius))
        return np.log(depth), np.log(force), np.log(radius)

    def _recovery(self, x: Array, F: Array, a: Array) -> tuple[Array, Array, Array]:
        """Permanent part, the sphere's part of it and the exponent at x, of ln F and ln a there."""
        D, force, radius = np.exp(x), np.exp(F), np.exp(a)
        elastic = _elastic(x, F)
        onset, t = self.yields_at, self.turns
        if not math.isfinite(onset) or len(t.depth) == 0:
            return np.zeros_like(x), np.full_like(x, 0.5), elastic - 1.0
        per_force = radius * D / force
        at = np.log(np.concatenate([[onset], t.depth]))
        recovered = np.interp(at[1:], x, np.log(per_force)) + np.log(1.0 - t.left)
        first = np.interp(at[0], x, np.log(per_force))
        curve = PchipInterpolator(at, np.concatenate([[first], recovered]))
        inside = np.clip(x, at[0], at[-1])
        left = np.where(x > at[0], 1.0 - np.exp(curve(inside)) / per_force, 0.0)
        left = np.maximum(left, 0.0)
        ends = np.concatenate([[np.interp(at[0], x, elastic) - 1.0], t.exponent])
        part = PchipInterpolator(at, np.concatenate([[t.part[0]], t.part]))(inside)
        exponent = PchipInterpolator(at, ends)(inside)
        # no cycle gives back more than was spent, between two unloadings neither
        raised = recovery_exponent(x, F, left, exponent)
        yielded = np.where(x > at[0], raised, elastic - 1.0)
        return left, part, yielded


def packed_columns(grid: Array, columns: Sequence[Array]) -> Array:
    """Return what the kernels read behind the common numbers.

    `grid`: ln(Delta/R), evenly, shape (n,); `columns`: logarithms of F/(E' R^2) and a/R, permanent
    part of the approach, the sphere's part of it, exponent of the unloading; each of shape (n,).
    """
    step = grid[1] - grid[0]
    values = np.stack(columns)
    slopes = PchipInterpolator(grid, values, axis=1).derivative()(grid) * step
    rows = np.stack([values, slopes], axis=2)
    return np.concatenate([[len(grid), grid[0], step], rows.ravel()])


def recovery_exponent(x: Array, F: Array, left: Array, exponent: Array) -> Array:
    """Exponent of the unloading, raised where more would come back than was spent.

    `x`, `F`: ln(Delta/R) and ln(F/(E' R^2)) of the loading, shape (n,); `left`, `exponent`:
    permanent part of the approach, and the exponent as it is.
    """
    return np.maximum(exponent, _elastic(x, F) * (1.0 - left) - 1.0)


def _elastic(x: Array, F: Array) -> Array:
    """N + 1 of a body that gives back all that it took, by ln depth and ln force."""
    force, D = np.exp(F), np.exp(x)
    first = 0.4 * force[0] * D[0]
    # over each interval the force is a power of the depth
    power = np.diff(F) / np.diff(x) + 1.0
    panels = (np.exp(F[1:] + x[1:]) - np.exp(F[:-1] + x[:-1])) / power
    return np.asarray(force * D / np.append(first, first + np.cumsum(panels)))


def _groups(pair: Pair) -> list[float]:
    modulus = pair.E_reduced
    found = [pair.elastic_share]
    for body in (pair.sphere, pair.flat):
        strength = 0.0 if math.isinf(body.strength) else body.strength / modulus
        found += [0.0, 0.0] if body.rigid else [body.nu, strength]
    return found


@dataclass(frozen=True, kw_only=True, repr=False)
class TableLaw(ContactLaw):
    """The law of the pairs whose finite elements were given."""

    tables: tuple[PairTable, ...]

    kernels = TABLE_KERNELS

    def parameters(self, pair: Pair) -> Array:
        """Common numbers, then the table of the pair; one without a table is refused."""
        return np.concatenate([common_parameters(pair), self._table(pair).numbers])

    def share(self, pair: Pair, depth: Depths) -> Array:
        """delta_s*, shape (...); the elastic share where the contact is open."""
        c, d = self._table(pair).curve, depths_of(depth)
        x = np.log(np.maximum(d / pair.R, 1e-300))
        return np.where(d > 0.0, np.interp(x, np.log(c.depth), c.share), pair.elastic_share)

    def uncertainty(self, pair: Pair, depth: Depths) -> Uncertainty:
        """What the solve says of its own elements; see `ContactLaw.uncertainty`.

        Dent and energy of recovery, which the levels were not compared in, are off by as much as
        force and radius together.
        """
        c, d = self._table(pair).curve, depths_of(depth)
        x = np.log(np.maximum(d / pair.R, 1e-300))
        force, radius, share = (
            np.maximum(np.interp(x, np.log(c.depth), v), LEAST)
            for v in (c.force_std, c.radius_std, c.share_std)
        )
        both = np.hypot(force, radius)
        return Uncertainty(force, radius, share, both, both)

    def warn_outside(self, pair: Pairs, depth: Depths) -> None:
        """Warn with `DomainWarning` beyond the deepest recorded depth."""
        pairs = [pair] if isinstance(pair, Pair) else list(pair)
        deepest = float(np.max(depths_of(depth), initial=0.0))
        for one in pairs:
            last = float(self._table(one).curve.depth[-1])
            if deepest > last * one.R * (1.0 + 1e-9):
                told = f"Delta_over_R = {deepest / one.R:.4g} is beyond the table's {last:.4g}"
                warnings.warn(f"{self.name}: {told}", DomainWarning, stacklevel=3)
                return

    def _table(self, pair: Pair) -> PairTable:
        for table in self.tables:
            if table.is_of(pair):
                return table
        raise InputError(
            "the table is of another pair", source=self.name, key="law",
            allowed="; ".join(_told(table.pair) for table in self.tables),
        )  # fmt: skip


def _told(pair: Pair) -> str:
    return ", ".join(
        f"{name} rigid" if body.rigid else
        f"{name} E_Pa {body.E:g} nu {body.nu:g} Sy_Pa {body.Sy:g}"
        for name, body in (("sphere", pair.sphere), ("flat", pair.flat))
    )  # fmt: skip


def energy_exponent(depth: Array, force: Array, residual: float) -> float:
    """Exponent of the power law that gives back the same energy, F_m (Delta_m - Delta_r)/(N + 1).

    The unloading is no exact power law; a slope fitted to its logarithms, which look at small
    forces, gives back 3 % too little. Between neighbours the curve, shape (n,), from its peak on,
    is taken as a power law; nan where it is none. Depth and permanent approach are in one unit.
    """
    x, y = (depth - residual) / (depth[0] - residual), force / force[0]
    m = (y > 1e-9) & (x > 1e-9)
    x, y = x[m], y[m]
    if len(x) < 3 or not (np.all(np.diff(x) < 0.0) and np.all(np.diff(y) < 0.0)):
        return float("nan")
    power = np.diff(np.log(y)) / np.diff(np.log(x))
    power = np.append(power, power[-1])  # from the last point on to the residual depth
    begin, end = x * y, np.append(x[1:] * y[1:], 0.0)
    return float(1.0 / np.sum((begin - end) / (power + 1.0)) - 1.0)


def table_law(tables: Sequence[PairTable], *, name: str) -> TableLaw:
    """Return the law of these tables."""
    deepest = min(float(t.curve.depth[-1]) for t in tables)
    return TableLaw(
        name=name,
        title="dentscope, finite elements of this pair",
        source=name,
        equations="no form: a table",
        standing=Standing.OWN_SOURCE,
        domain=Domain.down_to(deepest, note=f"Delta_over_R to {deepest:.3g}"),
        tables=tuple(tables),
    )
