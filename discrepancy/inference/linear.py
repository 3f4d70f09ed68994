"""The algebra of a comparison that is linear in the nuisances and exact in the mechanism.

With r the residual at the prior mean, J the cells' derivatives by the standardised unknowns, N the
covariance of the measurements and C the components of what a mechanism's textbook form may be off,
Sigma = N + J J^T + C C^T; then ln N(r - D(u); 0, Sigma) is the
likelihood of the mechanism's parameters u with nuisances and law error integrated out, where D(u)
is the mechanism's simulated effect. The evidence is its mean over the prior of u.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_solve, solve_triangular

Array = NDArray[np.float64]


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
