"""A strength that varies with depth, as factors on all that a law says of a contact.

A law knows one yield strength. Where the metal's strength at the depth delta is h(delta) times the
stated one, force and contact radius at that depth are those of a pair of that strength, and so are
recovery, its exponent and the bodies' parts of the dent where a peak lies there. Both bodies'
strengths are scaled, so that their ratio and with it the law's blend stay.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.interpolate import PchipInterpolator

from ..core.arrays import Array
from ..core.material import Pair
from ..models.base import ContactLaw, remembering, unwarned
from ..models.kernel import cubic
from .force import F_FORCE, LOG_DEPTH_FIRST, LOG_DEPTH_LAST
from .rules import RULES

NODES = RULES.strength_nodes
"""Nodes of the table over ln(depth / R)."""

_LEVELS = np.log([
    0.1, 0.17, 0.25, 0.35, 0.5, 0.6, 0.7, 0.85, 1.0,
    1.2, 1.5, 1.9, 2.4, 3.1, 3.6, 4.2, 5.0, 5.9, 7.0, 8.4, 10.0,
])  # fmt: skip
_FAR = np.log([*np.geomspace(1e-3, 0.085, 18), *np.exp(_LEVELS), *np.geomspace(12.0, 1e3, 20)])
"""Levels of a strength that leaves those: a factor of 10 is more than nearly all ask for."""


@njit(cache=True)
def _factors(strength, levels, logs, slopes):  # type: ignore[no-untyped-def]
    columns, _, n = logs.shape
    out = np.empty((columns, n))
    last = len(levels) - 2
    for k in range(n):
        level = min(max(math.log(max(strength[k], 1e-9)), levels[0]), levels[-1])
        i = 0
        while i < last and level > levels[i + 1]:
            i += 1
        wide = levels[i + 1] - levels[i]
        t = (level - levels[i]) / wide
        for column in range(columns):
            low, high = logs[column, i, k], logs[column, i + 1, k]
            m0, m1 = wide * slopes[column, i, k], wide * slopes[column, i + 1, k]
            out[column, k] = math.exp(cubic(t, low, high, m0, m1))
    return out


class Logs(NamedTuple):
    """Logarithms of what a law says of a pair, over the depth nodes; (levels, NODES) each.

    In the order of the factors of `dynamics.force`.
    """

    force: Array  # [N], of loading
    recovery: Array  # [m]
    radius: Array  # [m]
    odds: Array  # of the sphere's share of what stays
    power: Array  # exponent of the recovery


@dataclass(frozen=True, eq=False)
class StrengthTable:
    """What a law says of a pair, over the depth nodes, as stated and at other strengths."""

    law: ContactLaw
    pair: Pair

    @cached_property
    def depth(self) -> Array:
        """(NODES,) [m]."""
        return self.pair.R * np.exp(np.linspace(LOG_DEPTH_FIRST, LOG_DEPTH_LAST, NODES))

    @cached_property
    def stated(self) -> Logs:
        """What the law says at the stated strength, (NODES,) each."""
        return Logs(*(rows[0] for rows in _logs(self.law, [self.pair], self.depth)))

    @cached_property
    def work(self) -> Array:
        """(NODES,) work of loading up to each depth at the stated strength [J]."""
        return self._work_of(self.stated.force)

    @cached_property
    def radius(self) -> Array:
        """(NODES,) contact radius at the stated strength [m]."""
        return np.exp(self.stated.radius)

    @cached_property
    def log_depth(self) -> Array:
        """(NODES,) logarithm of `depth`."""
        return np.log(self.depth)

    def factors(self, strength: Array) -> Array:
        """Return the factors of `dynamics.force`, (N_FACTORS, NODES), for relative strengths."""
        near = np.exp(_LEVELS[0]) <= np.min(strength) and np.max(strength) <= np.exp(_LEVELS[-1])
        return np.asarray(_factors(strength, *(self._near if near else self._far)))

    def peak(self, energy: float, strength: Array | None = None) -> float:
        """Depth [m] at which loading has taken up `energy` [J], at relative strengths or stated."""
        work = self.work
        if strength is not None:
            work = self._work_of(self.stated.force + np.log(self.factors(strength)[F_FORCE]))
        log_work = np.log(np.maximum(work, 1e-300))
        return float(np.exp(np.interp(math.log(energy), log_work, self.log_depth)))

    def _work_of(self, log_force: Array) -> Array:
        d, f = self.depth, np.exp(log_force)
        # exact for a power law between the nodes
        power = np.diff(log_force) / np.diff(self.log_depth)
        step = (f[1:] * d[1:] - f[:-1] * d[:-1]) / (power + 1.0)
        return np.cumsum(np.concatenate([[0.4 * f[0] * d[0]], step]))

    @cached_property
    def _near(self) -> tuple[Array, Array, Array]:
        return self._at(_LEVELS)

    @cached_property
    def _far(self) -> tuple[Array, Array, Array]:
        return self._at(_FAR)

    def _at(self, levels: Array) -> tuple[Array, Array, Array]:
        """Levels, logarithms over those as stated, (N_FACTORS, levels, NODES), and slopes."""
        pairs = [stronger(self.pair, math.exp(level)) for level in levels]
        logs = np.stack(_logs(self.law, pairs, self.depth))
        unit = int(np.searchsorted(levels, -1e-9))  # the stated strength
        logs -= logs[:, unit : unit + 1]
        # a law may have no number where next to nothing is left of the strength
        known = np.isfinite(logs).all(axis=(0, 2))
        levels, logs = levels[known], np.ascontiguousarray(logs[:, known])
        return levels, logs, PchipInterpolator(levels, logs, axis=1).derivative()(levels)


_TABLES: dict[tuple[int, Pair], tuple[ContactLaw, StrengthTable]] = {}


def strength_table(law: ContactLaw, pair: Pair) -> StrengthTable:
    """Return the table of one law and pair; the latest answers are kept."""
    key = (id(law), pair)
    known = _TABLES.get(key)
    if known is None:
        if len(_TABLES) > 2000:
            _TABLES.clear()
        # the law is kept beside its table, so that its id stays its own
        known = _TABLES[key] = law, StrengthTable(remembering(law), pair)
    return known[1]


def _logs(law: ContactLaw, pairs: Sequence[Pair], depth: Array) -> Logs:
    grid = np.tile(depth, (len(pairs), 1))
    # the table's ends reach beyond what an impact will ask for
    with unwarned():
        force = law.loading(pairs, grid)
    sphere, flat = law.residual(pairs, grid)
    rest = sphere + flat
    recovery = np.maximum(grid - rest, 1e-9 * grid)
    half = law.unloading(pairs, 0.5 * (grid + rest), grid)
    power = np.clip(-np.log2(np.maximum(half, 1e-300) / force), 1.0, 3.0)
    part = np.divide(sphere, rest, out=np.full_like(rest, 0.5), where=rest > 0.0)
    part = np.clip(part, 1e-9, 1.0 - 1e-9)
    return Logs(
        np.log(force), np.log(recovery), _log_radius(depth, law.contact_radius(pairs, grid)),
        np.log(part / (1.0 - part)), np.log(power),
    )  # fmt: skip


def _log_radius(depth: Array, radius: Array) -> Array:
    """Bridge depths at which a published formula has no radius above 0, for metals very soft."""
    known = radius > 0.0
    if known.all():
        return np.log(radius)
    x = np.log(depth)
    rows = zip(radius, known, strict=True)
    return np.array([np.interp(x, x[k], np.log(row[k])) for row, k in rows])


def stronger(pair: Pair, factor: float) -> Pair:
    """Return the pair with strengths times a factor; what is rigid stays so."""
    return Pair(pair.sphere.strengthened(factor), pair.flat.strengthened(factor), pair.R)
