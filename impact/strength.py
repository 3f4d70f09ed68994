"""A strength that varies with depth, as factors on a law's loading force and elastic recovery.

A law knows one yield strength. Where the metal's strength at the depth delta is h(delta) times the
stated one, the force is taken from the law of a pair of that strength at that depth, and so is the
recovery: both bodies' strengths are scaled, so that their ratio and with it the law's blend stay.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..core.material import Pair
from ..models.base import ContactLaw, DomainWarning
from .force import LOG_DEPTH_FIRST, LOG_DEPTH_LAST

Array = NDArray[np.float64]

NODES = 41
"""Nodes of the table over ln(depth / R)."""

_LEVELS = np.log(np.array([0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 10.0]))
UNIT = int(np.searchsorted(_LEVELS, -1e-9))
"""Row of a table at the stated strength."""


@njit(cache=True)
def _factors(strength, log_force, log_recovery):  # type: ignore[no-untyped-def]
    n = len(strength)
    out = np.empty(2 * n)
    last = len(_LEVELS) - 2
    for k in range(n):
        level = min(max(math.log(max(strength[k], 1e-9)), _LEVELS[0]), _LEVELS[-1])
        i = 0
        while i < last and level > _LEVELS[i + 1]:
            i += 1
        t = (level - _LEVELS[i]) / (_LEVELS[i + 1] - _LEVELS[i])
        for half, table in enumerate((log_force, log_recovery)):
            here = (1.0 - t) * table[i, k] + t * table[i + 1, k]
            out[half * n + k] = math.exp(here - table[UNIT, k])
    return out


@dataclass(frozen=True, eq=False)
class StrengthTable:
    """What a law says of a pair at several strengths, over the depth nodes.

    Parameters
    ----------
    depth, radius
        (NODES,) depth and contact radius at the stated strength [m].
    log_force, log_recovery
        (levels, NODES) logarithm of loading force [N] and of elastic recovery [m].
    work
        (NODES,) work of loading up to each depth [J].
    """

    depth: Array
    radius: Array
    log_force: Array
    log_recovery: Array
    work: Array

    def factors(self, strength: Array) -> Array:
        """Return factors on loading force, then on recovery, (2 NODES,), for relative strengths."""
        return np.asarray(_factors(strength, self.log_force, self.log_recovery))

    def peak(self, energy: float) -> float:
        """Depth [m] at which the loading has taken up `energy` [J]."""
        return float(np.exp(np.interp(math.log(energy), self._log_work, self.log_depth)))

    @cached_property
    def log_depth(self) -> Array:
        """(NODES,) logarithm of `depth`."""
        return np.log(self.depth)

    @cached_property
    def _log_work(self) -> Array:
        return np.log(np.maximum(self.work, 1e-300))


_TABLES: dict[tuple[int, Pair], tuple[ContactLaw, StrengthTable]] = {}


def strength_table(law: ContactLaw, pair: Pair) -> StrengthTable:
    """Return the table of one law and pair; the latest answers are kept."""
    key = (id(law), pair)
    known = _TABLES.get(key)
    if known is None:
        if len(_TABLES) > 2000:
            _TABLES.clear()
        # the law is kept beside its table, so that its id stays its own
        known = _TABLES[key] = law, _tabulated(law, pair)
    return known[1]


def _tabulated(law: ContactLaw, pair: Pair) -> StrengthTable:
    depth = pair.R * np.exp(np.linspace(LOG_DEPTH_FIRST, LOG_DEPTH_LAST, NODES))
    pairs = [_stronger(pair, math.exp(level)) for level in _LEVELS]
    grid = np.broadcast_to(depth, (len(pairs), NODES))
    with warnings.catch_warnings():
        # the table's ends reach beyond what an impact will ask for
        warnings.simplefilter("ignore", DomainWarning)
        force = law.loading(pairs, grid)
    sphere, flat = law.residual(pairs, grid)
    recovery = np.maximum(grid - sphere - flat, 1e-9 * grid)
    f = force[UNIT]
    # exact for a power law between the nodes
    power = np.diff(np.log(f)) / np.diff(np.log(depth))
    step = (f[1:] * depth[1:] - f[:-1] * depth[:-1]) / (power + 1.0)
    work = np.concatenate([[0.4 * f[0] * depth[0]], 0.4 * f[0] * depth[0] + np.cumsum(step)])
    return StrengthTable(
        depth, law.contact_radius(pair, depth), np.log(force), np.log(recovery), work
    )


def _stronger(pair: Pair, factor: float) -> Pair:
    bodies = (
        body if body.rigid else body.with_(Sy=body.Sy * factor) for body in (pair.sphere, pair.flat)
    )
    sphere, flat = bodies
    return replace(pair, sphere=sphere, flat=flat)
