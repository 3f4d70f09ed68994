"""The factors of a tangent against SuperLU's, which share nothing with them."""

import numpy as np
import pytest
import scipy.sparse as sparse
import scipy.sparse.linalg as sparse_linalg
from dentscope.fem.factors import Fronts, postorder
from dentscope.fem.krylov import gmres


def grid(nx: int, ny: int, rng: np.random.Generator) -> sparse.csc_matrix:
    """Couple two unknowns a point with those of all eight neighbours, by unequal numbers."""
    number = np.arange(nx * ny).reshape(nx, ny)
    pairs = [
        (number[max(-a, 0) : nx - max(a, 0), max(-b, 0) : ny - max(b, 0)].ravel(),
         number[max(a, 0) : nx + min(a, 0), max(b, 0) : ny + min(b, 0)].ravel())
        for a in (-1, 0, 1) for b in (-1, 0, 1)
    ]  # fmt: skip
    rows = np.concatenate([p for p, _ in pairs])
    cols = np.concatenate([q for _, q in pairs])
    rows, cols = (
        np.concatenate([2 * v + k for k in ks])
        for v, ks in ((rows, (0, 0, 1, 1)), (cols, (0, 1, 0, 1)))
    )
    n = 2 * nx * ny
    matrix = sparse.csc_matrix((rng.normal(size=len(rows)), (rows, cols)), shape=(n, n))
    return (matrix + sparse.diags(rng.uniform(20.0, 30.0, n))).tocsc()


def in_postorder(matrix: sparse.csc_matrix) -> sparse.csc_matrix:
    matrix.sort_indices()
    order = postorder(matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64))
    assert np.array_equal(np.sort(order), np.arange(matrix.shape[0]))
    matrix = matrix[order][:, order].tocsc()
    matrix.sort_indices()
    return matrix


def solved(fronts: Fronts, matrix: sparse.csc_matrix, rhs: np.ndarray) -> np.ndarray:
    """By factors in single precision and GMRES down to their round-off."""
    n = len(rhs)
    room = (np.empty(n, np.float32), np.empty(n), np.empty((13, n)), np.empty(n))
    parts = (matrix.indptr, matrix.indices.view(np.uint32), matrix.data)
    steps, left = gmres(parts, rhs, fronts.known, room, 1e-6, 12)
    assert 0 < steps <= 3
    assert left < 1e-5
    return room[-1]


def fronts_of(matrix: sparse.csc_matrix) -> Fronts:
    return Fronts(matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64))


@pytest.mark.parametrize("shape", [(1, 1), (1, 40), (3, 3), (17, 5), (31, 33), (60, 70)])
def test_solutions_are_those_of_superlu(shape: tuple[int, int]) -> None:
    rng = np.random.default_rng(shape)
    matrix = grid(*shape, rng)
    fill = sparse_linalg.splu(matrix, permc_spec="MMD_AT_PLUS_A").perm_c
    matrix = in_postorder(matrix[np.argsort(fill)][:, np.argsort(fill)].tocsc())
    fronts = fronts_of(matrix)
    for scale in (1.0, 3.0):  # the same pattern, other numbers
        again = matrix.copy()
        again.data *= scale * rng.uniform(0.9, 1.1, again.data.size)
        assert fronts.factorise(again.data)
        rhs = rng.normal(size=again.shape[0])
        expected = sparse_linalg.spsolve(again, rhs)
        assert np.abs(solved(fronts, again, rhs) - expected).max() < 1e-5 * np.abs(expected).max()


def test_any_order_and_bodies_that_do_not_touch() -> None:
    """A random order fills in much; two blocks have two roots."""
    rng = np.random.default_rng(3)
    matrix = sparse.block_diag([grid(6, 7, rng), grid(4, 9, rng)]).tocsc()
    mixed = rng.permutation(matrix.shape[0])
    matrix = in_postorder(matrix[mixed][:, mixed].tocsc())
    fronts = fronts_of(matrix)
    assert fronts.factorise(matrix.data)
    rhs = rng.normal(size=matrix.shape[0])
    assert np.allclose(matrix @ solved(fronts, matrix, rhs), rhs, rtol=0.0, atol=1e-5)


def test_a_zero_pivot_is_told() -> None:
    matrix = in_postorder(grid(5, 5, np.random.default_rng(1)))
    matrix.data[:] = 0.0
    assert not fronts_of(matrix).factorise(matrix.data)


def test_where_gmres_breaks_down_its_steps_were_not_enough() -> None:
    """Of a matrix of noughts nothing is left after a step; who asks turns to SuperLU."""
    matrix = in_postorder(grid(5, 5, np.random.default_rng(1)))
    fronts, n = fronts_of(matrix), matrix.shape[0]
    assert fronts.factorise(matrix.data)
    room = (np.empty(n, np.float32), np.empty(n), np.empty((13, n)), np.empty(n))
    parts = (matrix.indptr, matrix.indices.view(np.uint32), np.zeros_like(matrix.data))
    steps, _ = gmres(parts, np.ones(n), fronts.known, room, 1e-3, 12)
    assert steps < 0
