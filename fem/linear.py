"""The sparse linear system of a Newton step: a pattern that is reused, and its factorisation.

The pattern holds the element couplings and, near the contact, more couplings between the two
surfaces than are active at the moment, so that the points may slide without a new pattern. The
unknowns are numbered once a pattern by a fill-reducing order; every later factorisation takes that
order as it is, which saves the search for it.

The factors of an earlier tangent precondition a few GMRES steps; only when these become many is the
present one factorised. A Newton direction needs no more digits than the next one keeps, and a solve
costs a twelfth of a factorisation.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as sparse_linalg
from numba import njit

from ..core.arrays import Array, Integers
from .contact import ContactState, Surfaces, Triplets
from .factors import Fronts, postorder
from .krylov import gmres
from .rules import RULES

# limit: most steps of GMRES with old factors [-]
_KRYLOV = 12

Solve = Callable[[Array], Array]


def superlu(matrix: sparse.csc_matrix) -> Solve:
    """Factorise with scipy's SuperLU, exchanging rows; the order reduces fill already."""
    factors = sparse_linalg.splu(
        matrix,
        permc_spec="NATURAL",
        diag_pivot_thresh=0.01,
        relax=1,
        panel_size=1,
        options={"SymmetricMode": True},
    )
    return cast(Solve, factors.solve)


def _distinct(keys: Integers) -> Integers:
    """Sorted distinct keys; numpy's own way, by hashing, takes three times as long on so many."""
    keys = np.sort(keys)
    return np.asarray(keys[np.concatenate([[True], keys[1:] != keys[:-1]])])


def _arrays(matrix: sparse.csc_matrix) -> tuple[Integers, Integers]:
    return matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64)


@njit(cache=True)
def _scatter(data, position, tangent):
    for k in range(position.shape[0]):
        if position[k] >= 0:
            data[position[k]] += tangent[k]


@njit(cache=True)
def _scatter_triplets(data, indptr, indices, number, row, col, value, n, places):
    """Add the triplets; `places` keeps each one's row, column and place for the next time.

    False: one lies outside of the pattern. What is held has no place.
    """
    for k in range(n):
        if places[k, 0] != row[k] or places[k, 1] != col[k]:
            i, j = number[row[k]], number[col[k]]
            at = -1
            if i >= 0 and j >= 0:
                at = indptr[j] + np.searchsorted(indices[indptr[j] : indptr[j + 1]], i)
                if at == indptr[j + 1] or indices[at] != i:
                    return False
            places[k, 0], places[k, 1], places[k, 2] = row[k], col[k], at
        if places[k, 2] >= 0:
            data[places[k, 2]] += value[k]
    return True


class LinearSystem:
    """Tangent matrix of the free degrees of freedom.

    `element_dofs`: degrees of freedom of the elements, shape (n_elements, 8); `free`: free degrees
    of freedom, in increasing order; `n_dofs`: all degrees of freedom.
    """

    def __init__(self, element_dofs: Integers, *, free: Integers, n_dofs: int) -> None:
        self.free = free
        self.n = len(free)
        self.n_patterns = 0
        self.n_factorisations = 0
        self._room = (
            np.empty(self.n, np.float32),
            np.empty(self.n),
            np.empty((_KRYLOV + 1, self.n)),
        )
        self._n_last = _KRYLOV  # as if GMRES had been slow: there are no factors yet
        self._element_dofs = element_dofs
        self._plain = np.full(n_dofs, -1, dtype=np.int64)
        self._plain[free] = np.arange(self.n)
        self._element_keys = self._keys(
            np.repeat(element_dofs, 8, axis=1).ravel(), np.tile(element_dofs, (1, 8)).ravel()
        )

    def _keys(self, rows: Integers, cols: Integers) -> Integers:
        i, j = self._plain[rows], self._plain[cols]
        inside = (i >= 0) & (j >= 0)
        return _distinct(j[inside] * self.n + i[inside])

    def fill(
        self,
        tangent: Array,
        *,
        triplets: Triplets,
        n_triplets: int,
        surfaces: Surfaces,
        contact: ContactState,
    ) -> None:
        """Set the matrix from the element tangents (n_elements, 8, 8) and the contact triplets."""
        if self.n_patterns == 0 or not self._fill(tangent, triplets, n_triplets):
            self._new_pattern(surfaces, contact)
            self._places = np.full((len(triplets.row), 3), -1, np.int32)
            if not self._fill(tangent, triplets, n_triplets):
                raise AssertionError("contact couplings outside a fresh pattern")

    def _fill(self, tangent: Array, triplets: Triplets, n: int) -> bool:
        m = self._matrix
        m.data[:] = 0.0
        _scatter(m.data, self._position, tangent.ravel())
        return bool(
            _scatter_triplets(
                m.data, m.indptr, m.indices, self._number,
                triplets.row, triplets.col, triplets.value, n, self._places,
            )
        )  # fmt: skip

    def _new_pattern(self, surfaces: Surfaces, contact: ContactState) -> None:
        self.n_patterns += 1
        self._n_last = _KRYLOV
        keys = _distinct(
            np.concatenate([self._element_keys, self._contact_keys(surfaces, contact)])
        )
        cols, rows = np.divmod(keys, self.n)
        pattern = sparse.csc_matrix((np.ones(len(keys)), (rows, cols)), shape=(self.n, self.n))
        # a diagonally dominant stand-in with this pattern gives the order; incomplete factors of
        # it cost a quarter of whole ones
        stand_in = pattern + sparse.eye(self.n, format="csc") * (4.0 * pattern.sum(axis=0).max())
        order = sparse_linalg.spilu(
            stand_in, drop_tol=1.0, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}
        ).perm_c.astype(np.int64)
        pattern = sparse.csc_matrix((pattern.data, (order[rows], order[cols])), shape=pattern.shape)
        pattern.sort_indices()
        place = np.empty(self.n, dtype=np.int64)
        place[postorder(*_arrays(pattern))] = np.arange(self.n)
        self._order = order = place[order]
        self._number = np.where(self._plain >= 0, order[self._plain], -1)
        rows, cols = order[rows], order[cols]
        matrix = sparse.csc_matrix((np.zeros(len(keys)), (rows, cols)), shape=(self.n, self.n))
        matrix.sort_indices()
        self._matrix, self._fronts = matrix, Fronts(*_arrays(matrix))
        sorted_keys = np.repeat(np.arange(self.n), np.diff(matrix.indptr)) * self.n + matrix.indices
        d = self._element_dofs
        i = self._number[np.repeat(d, 8, axis=1).ravel()]
        j = self._number[np.tile(d, (1, 8)).ravel()]
        place = np.searchsorted(sorted_keys, j * self.n + i)
        self._position = np.where((i >= 0) & (j >= 0), place, -1)

    def _contact_keys(self, surfaces: Surfaces, contact: ContactState) -> Integers:
        active = np.flatnonzero(contact.pressure)
        last = min(int(1.3 * (active[-1] if len(active) else 0)) + 10, len(surfaces.slave) - 1)
        rows, cols = [], []
        for a in range(last + 1):
            edges = contact.segment[max(a - 1, 0) : a + 1]
            low = max(int(edges.min()) - 1 - RULES.pattern_reach, 0)
            high = int(edges.max()) + 3 + RULES.pattern_reach
            nodes = np.concatenate(
                [surfaces.slave[max(a - 2, 0) : a + 3], surfaces.master[low:high]]
            )
            dofs = np.concatenate([2 * nodes, 2 * nodes + 1])
            rows.append(np.repeat(dofs, len(dofs)))
            cols.append(np.tile(dofs, len(dofs)))
        return self._keys(np.concatenate(rows), np.concatenate(cols))

    def solve(self, rhs: Array) -> Array:
        """Solution of K x = rhs over the free degrees of freedom, in their own order."""
        permuted = np.empty(self.n)
        permuted[self._order] = rhs
        x = self._iterate(permuted) if self._n_last <= RULES.refactor_after else None
        if x is None:
            x = self._factorised(permuted)
        return np.asarray(x[self._order])

    def _factorised(self, rhs: Array) -> Array:
        """Solve with fresh factors; by SuperLU where rows have to be exchanged."""
        self.n_factorisations += 1
        x = self._iterate(rhs) if self._fronts.factorise(self._matrix.data) else None
        self._n_last = 0 if x is not None else _KRYLOV
        return x if x is not None else np.asarray(superlu(self._matrix)(rhs))

    def _iterate(self, rhs: Array) -> Array | None:
        """Solve with the factors that there are as preconditioner; none: not good enough.

        Factors that have become wrong can make GMRES's criterion blind, so the residual must have
        fallen too.
        """
        matrix, x = self._matrix, np.empty(self.n)
        parts = (matrix.indptr, matrix.indices.view(np.uint32), matrix.data)
        room = (*self._room, x)
        steps, left = gmres(parts, rhs, self._fronts.known, room, RULES.forcing, _KRYLOV)
        self._n_last = abs(steps)
        return None if steps < 0 or not left <= RULES.krylov_residual else x
