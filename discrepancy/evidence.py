"""The algebra of a comparison that is linear in the nuisances and exact in the mechanism.

With r the residual at the prior mean, J the cells' derivatives by the standardised unknowns, N the
covariance of the measurements and C the components of what a mechanism's textbook form may be off,
Sigma = N + J J^T + C C^T; then ln N(r - D(u); 0, Sigma) is the
likelihood of the mechanism's parameters u with nuisances and law error integrated out, where D(u)
is the mechanism's simulated effect. The evidence is its mean over the prior of u.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.linalg import cho_solve, solve_triangular
from scipy.special import logsumexp

from .mechanisms.base import Parameter

Array = NDArray[np.float64]

FINE = {1: 241, 2: 49, 3: 17, 4: 11}
"""Points per parameter of the refined grid, by the number of parameters."""
IN_WINDOW = {1: 5, 2: 5, 3: 3}
"""Least nodes per parameter of a grid over a part of the prior, by the number of parameters."""


@dataclass(frozen=True, eq=False)
class Linear:
    """Sigma and J at one expansion point.

    Parameters
    ----------
    noise
        (m, m) covariance of the cells.
    J
        (m, n_z) derivatives by the standardised unknowns.
    form
        (m, c) components of the error of the mechanism's form; none for the baseline.
    """

    noise: Array
    J: Array
    form: Array = field(default_factory=lambda: np.zeros((0, 0)))

    @cached_property
    def measured(self) -> Array:
        """(m, m) covariance of what neither nuisances nor the law's error can follow."""
        return self.noise + self.form @ self.form.T if self.form.size else self.noise

    @cached_property
    def total(self) -> Array:
        """Sigma, (m, m)."""
        return np.asarray(self.measured + self.J @ self.J.T)

    @cached_property
    def lower(self) -> Array:
        """Cholesky factor of Sigma."""
        return np.asarray(np.linalg.cholesky(self.total))

    @cached_property
    def log_det(self) -> float:
        """Ln det(2 pi Sigma)."""
        m = len(self.noise)
        return float(2.0 * np.sum(np.log(np.diag(self.lower))) + m * math.log(2.0 * math.pi))

    def white(self, r: Array) -> Array:
        """Return L^-1 r for residuals in the last axis, shape (..., m)."""
        flat = np.asarray(r).reshape(-1, r.shape[-1]).T
        return np.asarray(solve_triangular(self.lower, flat, lower=True).T.reshape(r.shape))

    def log_likelihood(self, r: Array) -> Array:
        """Return ln N(r; 0, Sigma), shape (...)."""
        return np.asarray(-0.5 * (np.sum(self.white(r) ** 2, axis=-1) + self.log_det))

    def unknowns(self, r: Array) -> tuple[Array, Array]:
        """Return posterior mean (n_z,) and covariance (n_z, n_z) of the unknowns given r."""
        half = solve_triangular(self.lower, self.J, lower=True)
        mean = half.T @ self.white(r)
        return np.asarray(mean), np.eye(self.J.shape[1]) - half.T @ half

    def solve(self, b: Array) -> Array:
        """Return Sigma^-1 b."""
        return np.asarray(cho_solve((self.lower, True), b))


@dataclass(frozen=True, eq=False)
class Grid:
    """A tensor grid over the mechanisms' parameters, and how to refine it.

    Parameters
    ----------
    parameters
        In the order of the axes.
    window
        Part of the prior that it covers, (low, high) within (0, 1) for each axis; all if empty.
    """

    parameters: tuple[Parameter, ...]
    window: tuple[tuple[float, float], ...] = ()

    @cached_property
    def coarse(self) -> list[Array]:
        """Places in (0, 1) of the nodes of each axis."""
        if not self.window:
            return [np.linspace(0.0, 1.0, p.nodes) for p in self.parameters]
        least = IN_WINDOW.get(len(self.parameters), 3)
        return [
            np.linspace(low, high, max(least, math.ceil((p.nodes - 1) * (high - low)) + 1))
            for p, (low, high) in zip(self.parameters, self.window, strict=True)
        ]

    @cached_property
    def fine(self) -> list[Array]:
        """Places of the refined grid: middles of equal shares of what it covers."""
        n = FINE.get(len(self.parameters), 9)
        share = (np.arange(n) + 0.5) / n
        if not self.window:
            return [share for _ in self.parameters]
        return [low + (high - low) * share for low, high in self.window]

    @property
    def log_volume(self) -> float:
        """Ln of the part of the prior that the grid covers."""
        return sum(math.log(high - low) for low, high in self.window)

    def values(self, places: Sequence[float] | Array) -> dict[str, float]:
        """Return the parameters at places in (0, 1)."""
        return {p.name: float(p.value(x)) for p, x in zip(self.parameters, places, strict=True)}

    def nodes(self) -> list[dict[str, float]]:
        """Return the parameters at every node, the last axis fastest."""
        return [self.values(places) for places in itertools.product(*self.coarse)]

    def places(self) -> Array:
        """Return the refined grid's places, shape (k, axes)."""
        return np.stack([g.ravel() for g in np.meshgrid(*self.fine, indexing="ij")], axis=-1)

    def index(self, place: Array) -> int:
        """Return the number of the refined grid's place nearest to one."""
        places = [int(np.argmin(np.abs(f - x))) for f, x in zip(self.fine, place, strict=True)]
        return int(np.ravel_multi_index(places, [len(f) for f in self.fine]))

    def refine(self, responses: Array) -> Array:
        """Interpolate responses (nodes, m) to the refined grid (k, m), by cubic splines."""
        return self.onto(responses, self.fine)

    def onto(self, responses: Array, axes: Sequence[Array]) -> Array:
        """Interpolate responses (nodes, m) to the tensor grid of `axes`, shape (k, m)."""
        m = responses.shape[-1]
        table = responses.reshape(*[len(c) for c in self.coarse], m)
        return along_all(self.coarse, axes, table).reshape(-1, m)


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


def interval(value: Array, weight: Array, level: float = 0.90) -> tuple[float, float, float]:
    """Return median and bounds of the central interval of a weighted sample."""
    order = np.argsort(value)
    x, w = value[order], weight[order]
    reach = np.cumsum(w) - 0.5 * w
    low, middle, high = np.interp([0.5 - level / 2, 0.5, 0.5 + level / 2], reach, x)
    return float(middle), float(low), float(high)


__all__ = ["Grid", "Linear", "interval", "posterior"]
