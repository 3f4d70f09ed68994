"""Cells that are left out, from the algebra of all: no group needs a factorisation of its own.

With Q = Sigma^-1 and g = Q r, the cells t miss what the others foretell by Q_tt^-1 g_t, with the
covariance Q_tt^-1, so that the others' r^T Sigma^-1 r is r^T g less g_t^T Q_tt^-1 g_t.

References
----------
C. E. Rasmussen, C. K. I. Williams, Gaussian Processes for Machine Learning (MIT Press 2006), 5.4.2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array, Mask
from .linear import Linear


@dataclass(frozen=True, eq=False)
class Whole:
    """All cells of residuals (k, m), for one algebra.

    `precision`: Q, (m, m); `solved`: Q r, (k, m); `squares`: r^T Q r, (k,).
    """

    precision: Array
    solved: Array
    squares: Array

    @classmethod
    def of(cls, linear: Linear, residuals: Array) -> Whole:
        """Factorise once."""
        white = linear.whitening
        precision = white @ white.T
        solved = residuals @ precision
        return cls(precision, solved, np.sum(residuals * solved, axis=1))

    def missed(self, out: Mask) -> tuple[Array, Array, Array]:
        """Return data minus prediction of the left-out cells by the others, (k, left out).

        And r^T Sigma^-1 r of the others, and the left-out cells' ln density given them, (k,).
        """
        g, precision = self.solved[:, out], self.precision[np.ix_(out, out)]
        miss = np.linalg.solve(precision, g.T).T
        squares = np.sum(g * miss, axis=1)
        flat = np.linalg.slogdet(precision)[1] - len(precision) * math.log(2.0 * math.pi)
        return np.asarray(miss), np.asarray(self.squares - squares), 0.5 * (flat - squares)
