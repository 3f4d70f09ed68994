"""The algebra of a comparison that is linear in the nuisances and exact in the mechanism.

With r the residual at the prior mean, J the cells' derivatives by the unknowns and P the diagonal
of their prior variances, N the covariance of the measurements and C the components of what a
mechanism's textbook form may be off, Sigma = N + J P J^T + C C^T; then ln N(r - D(u); 0, Sigma) is
the likelihood of the mechanism's parameters u with nuisances and law error integrated out, where
D(u) is the mechanism's simulated effect. The evidence is its mean over the prior of u.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.linalg import cho_solve, solve_triangular
from scipy.special import logsumexp

from ...core.arrays import Array


@dataclass(frozen=True, eq=False)
class Linear:
    """Sigma and J at one expansion point.

    - `noise`: (m, m) covariance of the cells.
    - `J`: (m, n_z) derivatives by the unknowns.
    - `form`: (m, c) components of the error of the mechanism's form; none where left out.
    - `prior`: (n_z,) prior standard deviations of the unknowns; 1 each where left out.
    """

    noise: Array
    J: Array
    form: Array = field(default_factory=lambda: np.zeros((0, 0)))
    prior: Array = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        m, n = self.J.shape
        if not self.form.size:
            object.__setattr__(self, "form", np.zeros((m, 0)))
        if not self.prior.size:
            object.__setattr__(self, "prior", np.ones(n))

    @cached_property
    def scaled(self) -> Array:
        """(m, n_z) derivatives by the unknowns in prior standard deviations."""
        return self.J * self.prior

    @cached_property
    def measured(self) -> Array:
        """(m, m) covariance of what neither nuisances nor the law's error can follow."""
        return self.noise + self.form @ self.form.T

    @cached_property
    def total(self) -> Array:
        """Sigma, (m, m)."""
        return np.asarray(self.measured + self.scaled @ self.scaled.T)

    @cached_property
    def lower(self) -> Array:
        """Cholesky factor of Sigma."""
        return np.asarray(np.linalg.cholesky(self.total))

    @cached_property
    def log_det(self) -> float:
        """Ln det(2 pi Sigma)."""
        m = len(self.noise)
        return float(2.0 * np.sum(np.log(np.diag(self.lower))) + m * math.log(2.0 * math.pi))

    @cached_property
    def whitening(self) -> Array:
        """Transpose of the inverse of Sigma's Cholesky factor, (m, m)."""
        return np.asarray(solve_triangular(self.lower, np.eye(len(self.noise)), lower=True).T)

    def white(self, r: Array) -> Array:
        """Return L^-1 r for residuals in the last axis, shape (..., m)."""
        return np.asarray(r @ self.whitening)

    def log_likelihood(self, r: Array) -> Array:
        """Return ln N(r; 0, Sigma), shape (...)."""
        return np.asarray(-0.5 * (np.sum(self.white(r) ** 2, axis=-1) + self.log_det))

    def unknowns(self, r: Array) -> tuple[Array, Array]:
        """Return posterior mean (n_z,) and covariance (n_z, n_z) of the unknowns given r."""
        half, prior = self.whitening.T @ self.scaled, self.prior
        mean = prior * (half.T @ self.white(r))
        return np.asarray(mean), (np.eye(len(prior)) - half.T @ half) * np.outer(prior, prior)

    def solve(self, b: Array) -> Array:
        """Return Sigma^-1 b."""
        return np.asarray(cho_solve((self.lower, True), b))


class Sizes(NamedTuple):
    """Factors on a model error whose size is not known, and their prior weights."""

    factors: Sequence[float]
    weights: Sequence[float]

    @classmethod
    def normal(cls, spread: float) -> Sizes:
        """Return a normal logarithm of such a spread, at the three points of Gauss and Hermite."""
        at = tuple(math.exp(k * math.sqrt(3.0) * spread) for k in (-1, 0, 1))
        return cls(at, (1 / 6, 2 / 3, 1 / 6))


ONE = Sizes((1.0,), (1.0,))
"""An error of known size."""


@dataclass(frozen=True, eq=False)
class Mixture:
    """The same algebra with model errors of several sizes, by their prior weights.

    `parts`: one for each size; `log_weight`: (sizes,) ln of the prior weights.
    """

    parts: tuple[Linear, ...]
    log_weight: Array

    @classmethod
    def of(cls, linear: Linear, fixed: int, sizes: Sizes, forms: Sizes = ONE) -> Mixture:
        """Return the algebra with model errors of several sizes.

        - `linear`: the algebra with all of size 1.
        - `fixed`: number of unknowns, the first, that are no error of the law.
        - `sizes`, `forms`: of the law's error, and of that of the mechanism's form.
        """
        n = linear.J.shape[1]
        if n <= fixed:
            sizes = ONE
        if not linear.form.any():
            forms = ONE
        parts, weights = [], []
        for (size, w), (times, v) in itertools.product(zip(*sizes, strict=True),
                                                       zip(*forms, strict=True)):  # fmt: skip
            prior = np.where(np.arange(n) < fixed, 1.0, size)
            parts.append(replace(linear, prior=prior, form=times * linear.form))
            weights.append(w * v)
        return cls(tuple(parts), np.log(weights))

    def each(self, r: Array) -> Array:
        """Return ln of weight times likelihood for each size, shape (sizes, ...)."""
        found = [w + p.log_likelihood(r) for w, p in zip(self.log_weight, self.parts, strict=True)]
        return np.stack(found)

    def log_likelihood(self, r: Array) -> Array:
        """Return ln of the likelihood over all sizes, shape (...)."""
        return np.asarray(logsumexp(self.each(r), axis=0))

    def likeliest(self, r: Array) -> Linear:
        """Return the algebra of the size that residuals (m,) speak for most."""
        return self.parts[int(np.argmax(self.each(r)))]

    def unknowns(self, r: Array) -> tuple[Array, Array]:
        """Return posterior mean (n_z,) and covariance (n_z, n_z) over all sizes."""
        each = self.each(r)
        weight = np.exp(each - logsumexp(each))
        means, covs = zip(*(p.unknowns(r) for p in self.parts), strict=True)
        mean = np.tensordot(weight, np.stack(means), 1)
        away = np.stack(means) - mean
        cov = np.tensordot(weight, np.stack(covs), 1) + (weight[:, None] * away).T @ away
        return np.asarray(mean), np.asarray(cov)

    def gain(self, r: Array, effect: Array) -> Array:
        """Return ln of r's (n, m) mean likelihood over effects (k, m), less that of none, (n,)."""
        found = []
        for weight, part in zip(self.log_weight, self.parts, strict=True):
            w, e = part.white(r), part.white(effect)
            ratio = w @ e.T - 0.5 * np.sum(e**2, axis=1)
            top = ratio.max(axis=1)
            mean = top + np.log(np.mean(np.exp(ratio - top[:, None]), axis=1))
            found.append(weight + mean - 0.5 * (np.sum(w**2, axis=1) + part.log_det))
        return np.asarray(logsumexp(np.stack(found), axis=0) - self.log_likelihood(r))
