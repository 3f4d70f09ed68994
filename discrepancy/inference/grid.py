"""A grid over the mechanisms' parameters, its refinement, and the posterior that it carries."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import logsumexp

from ...core.arrays import Array, Mask
from ...dynamics.mechanisms.base import Constants, Parameter
from ..rules import RULES

FINE = dict(RULES.grid_places)
"""Points per parameter of the refined grid, by the number of parameters; 5 for more."""
IN_WINDOW = dict(RULES.window_nodes)
"""Least nodes per parameter of a grid over a part of the prior, by the number of parameters; 2 for
more: over a window the response is nearly straight."""
ENDS = np.array([0.0, 1.0])
"""Places of what is one of two."""


class Axis(NamedTuple):
    """One parameter of one mechanism; two mechanisms may use the same word."""

    mechanism: str
    parameter: Parameter


@dataclass(frozen=True, eq=False)
class Grid:
    """A tensor grid over the mechanisms' parameters, and how to refine it.

    `axes`: whose parameter runs along each; `window`: part of the prior that it covers, (low, high)
    within (0, 1) for each axis; all if empty.
    """

    axes: tuple[Axis, ...]
    window: tuple[tuple[float, float], ...] = ()

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """Name of each parameter, after its mechanism's and a dot where two have the same."""
        names = [a.parameter.name for a in self.axes]
        return tuple(
            name if names.count(name) == 1 else f"{a.mechanism}.{name}"
            for name, a in zip(names, self.axes, strict=True)
        )

    @cached_property
    def either(self) -> Mask:
        """Which axes have two places alone, (axes,)."""
        return np.array([a.parameter.scale == "either" for a in self.axes], dtype=bool)

    @cached_property
    def coarse(self) -> list[Array]:
        """Places in (0, 1) of the nodes of each axis."""
        if not self.window:
            return [np.linspace(0.0, 1.0, a.parameter.nodes) for a in self.axes]
        least = IN_WINDOW.get(int(np.sum(~self.either)), 2)
        return [
            ENDS if one else
            np.linspace(low, high, max(least, math.ceil((p.nodes - 1) * (high - low)) + 1))
            for one, (_, p), (low, high) in zip(self.either, self.axes, self.window, strict=True)
        ]  # fmt: skip

    @cached_property
    def fine(self) -> list[Array]:
        """Places of the refined grid: middles of equal shares of what it covers."""
        n = FINE.get(int(np.sum(~self.either)), 5)
        share = (np.arange(n) + 0.5) / n
        window = self.window or [(0.0, 1.0)] * len(self.axes)
        return [
            ENDS if one else low + (high - low) * share
            for one, (low, high) in zip(self.either, window, strict=True)
        ]

    @property
    def log_volume(self) -> float:
        """Ln of the part of the prior that the grid covers."""
        return sum(math.log(high - low) for low, high in self.window)

    def values(self, places: Sequence[float] | Array) -> Constants:
        """Return every mechanism's parameters at places in (0, 1)."""
        found: dict[str, dict[str, float]] = {}
        for (mechanism, p), x in zip(self.axes, places, strict=True):
            found.setdefault(mechanism, {})[p.name] = float(p.value(x))
        return found

    def nodes(self) -> list[Constants]:
        """Return the parameters at every node, the last axis fastest."""
        return [self.values(places) for places in itertools.product(*self.coarse)]

    def places(self) -> Array:
        """Return the refined grid's places, shape (k, axes)."""
        return np.stack([g.ravel() for g in np.meshgrid(*self.fine, indexing="ij")], axis=-1)

    def marginal(self, weight: Array, axis: int) -> tuple[Array, Array]:
        """Return edges (n + 1,) of the refined cells along an axis, and the weight (n,) in them.

        A grid of many axes has few places along each: an interval whose ends were places would be
        too wide or too narrow by up to half a cell.
        """
        low, high = self.window[axis] if self.window else (0.0, 1.0)
        n = len(self.fine[axis])
        table = np.moveaxis(weight.reshape([len(f) for f in self.fine]), axis, 0)
        return np.linspace(low, high, n + 1), table.reshape(n, -1).sum(axis=1)

    def index(self, place: Array) -> int:
        """Return the number of the refined grid's place nearest to one."""
        places = [int(np.argmin(np.abs(f - x))) for f, x in zip(self.fine, place, strict=True)]
        return int(np.ravel_multi_index(places, [len(f) for f in self.fine]))

    def refine(self, responses: Array, axes: Sequence[Array] = ()) -> Array:
        """Interpolate responses (nodes, m) to the refined grid, or to that of `axes`, (k, m)."""
        m = responses.shape[-1]
        table = responses.reshape(*[len(c) for c in self.coarse], m)
        return along_all(self.coarse, axes or self.fine, table).reshape(-1, m)


def along_all(coarse: Sequence[Array], fine: Sequence[Array], table: Array) -> Array:
    """Interpolate a table (nodes of each axis..., m) from the axes `coarse` to the axes `fine`."""
    for axis, (known, wanted) in enumerate(zip(coarse, fine, strict=True)):
        table = _along(known, wanted, table, axis)
    return np.asarray(table)


def _along(coarse: Array, fine: Array, table: Array, axis: int) -> Array:
    if len(coarse) < 4:
        order = np.polynomial.polynomial.polyvander(fine, len(coarse) - 1)
        inverse = np.linalg.inv(np.polynomial.polynomial.polyvander(coarse, len(coarse) - 1))
        return np.asarray(np.moveaxis(np.tensordot(order @ inverse, table, (1, axis)), 0, axis))
    return np.asarray(CubicSpline(coarse, table, axis=axis)(fine))


def posterior(log_likelihood: Array) -> tuple[float, Array]:
    """Return ln evidence and weights (k,) of a flat prior over a refined grid."""
    total = float(logsumexp(log_likelihood))
    return total - math.log(len(log_likelihood)), np.exp(log_likelihood - total)


def interval(edges: Array, weight: Array, level: float) -> tuple[float, float, float]:
    """Return median and bounds of the central interval of a density that is flat within cells.

    `edges`: (n + 1,) of the cells; `weight`: (n,) in each of them; `level`: of the interval.
    """
    reach = np.concatenate([[0.0], np.cumsum(weight)])
    tail = 0.5 - 0.5 * level
    low, middle, high = np.interp([tail, 0.5, 1.0 - tail], reach / reach[-1], edges)
    return float(middle), float(low), float(high)
