"""GMRES with the factors of an earlier matrix on the left, which are in single precision."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from ..core.unowned import unowned
from .factors import backward, forward

_FAST = {"contract", "reassoc"}


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _precondition(v, out, single, known):
    """Solution by the factors for a vector of the order of one."""
    start, rows, begin, factors, sums = known
    for i in range(v.shape[0]):
        single[i] = v[i]
    forward(single, start, rows, begin, factors, sums)
    backward(single, start, rows, begin, factors, sums)
    for i in range(v.shape[0]):
        out[i] = single[i]


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _product(matrix, x, y):
    """Product of the matrix, (indptr, indices, data) by columns, and a vector."""
    indptr, indices, data = matrix
    y[:] = 0.0
    for j in range(x.shape[0]):
        a = x[j]
        for p in range(indptr[j], indptr[j + 1]):
            y[indices[p]] += data[p] * a


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _dot(x, y):
    total = 0.0
    for i in range(x.shape[0]):
        total += x[i] * y[i]
    return total


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _rotated(H, c, s, g, k, below):
    """Make column k of H triangular by Givens's rotations; what is left of the right-hand side."""
    for i in range(k):
        H[i, k], H[i + 1, k] = (
            c[i] * H[i, k] + s[i] * H[i + 1, k],
            c[i] * H[i + 1, k] - s[i] * H[i, k],
        )
    size = math.sqrt(H[k, k] ** 2 + below**2)
    c[k], s[k] = H[k, k] / size, below / size
    H[k, k] = size
    g[k], g[k + 1] = c[k] * g[k], -s[k] * g[k]
    return abs(g[k + 1])


@njit(cache=True, error_model="numpy")
def _solve_upper(H, g, k):
    """Solve the triangle that the rotations left, in place."""
    for i in range(k - 1, -1, -1):
        for j in range(i + 1, k):
            g[i] -= H[i, j] * g[j]
        g[i] /= H[i, i]


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def _left_over(product, rhs):
    """Sum of the residual over that of the right-hand side."""
    left, size = 0.0, 0.0
    for i in range(rhs.shape[0]):
        left += abs(product[i] - rhs[i])
        size += abs(rhs[i])
    return left / size


@njit(cache=True, error_model="numpy", fastmath=_FAST)
def gmres(matrix, rhs, known, room, rtol, most):
    """Solve K x = rhs by steps of Gram and Schmidt.

    The method is that of Saad and Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856. The criterion
    is one on the correction itself; a residual would be ruled by the stiff contact.

    - `matrix`: (indptr, indices, data) by columns.
    - `rhs`: (n,).
    - `known`: `Fronts.known`.
    - `room`: working arrays: (n,) of single precision, (n,), (most + 1, n), and (n,) for the
      solution.
    - `rtol`: size of the preconditioned residual that may be left over, relative.
    - `most`: steps.

    Returned: steps taken, negative if they were not enough, and the sum of the residual over that
    of rhs.
    """
    matrix, rhs, known, room = unowned(matrix), unowned(rhs), unowned(known), unowned(room)
    single, y, V, x = room
    n = rhs.shape[0]
    x[:] = 0.0
    scale = np.abs(rhs).max()
    if scale == 0.0:
        return 0, 0.0
    for i in range(n):
        y[i] = rhs[i] / scale
    _precondition(y, V[0], single, known)
    beta = math.sqrt(_dot(V[0], V[0]))
    H, c, s, g = np.zeros((most, most)), np.zeros(most), np.zeros(most), np.zeros(most + 1)
    g[0] = beta
    if not beta > 0.0:
        return -1, 1.0
    V[0] /= beta
    k, left = 0, beta
    while k < most and left > rtol * beta:
        v = V[k + 1]
        _product(matrix, V[k], y)
        _precondition(y, v, single, known)
        for i in range(k + 1):
            h = _dot(v, V[i])
            H[i, k] = h
            for j in range(n):
                v[j] -= h * V[i, j]
        below = math.sqrt(_dot(v, v))
        left = _rotated(H, c, s, g, k, below)
        k += 1
        if below > 0.0:
            for j in range(n):
                v[j] /= below
    _solve_upper(H, g, k)
    for i in range(k):
        a = g[i] * scale
        for j in range(n):
            x[j] += a * V[i, j]
    _product(matrix, x, y)
    return (k if left <= rtol * beta else -k), _left_over(y, rhs)
