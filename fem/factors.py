"""LU factors of a matrix with a symmetric pattern, in an order of elimination that stays.

The multifrontal method (Duff and Reid, ACM Trans. Math. Softw. 9 (1983) 302; Liu, SIAM Review 34
(1992) 82): unknowns with nearly the same couplings, a supernode, are eliminated together in a small
dense matrix, its front; what is left of that is added to the front of its parent in the elimination
tree. The tree, the fronts and every entry's place in them belong to the pattern and are found once.

No rows are exchanged: the tangent of two solids in contact is nearly symmetric and positive. Who
solves looks at what is left over. It stands beside SuperLU because on these patterns it takes a
third of its time, and half in a solve (tools/benchmarks/bench_fem.py, docs/performance.md).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from ..core.arrays import Array, Integers
from ..core.unowned import unowned

_NOUGHT, _ONE = np.float32(0.0), np.float32(1.0)  # others would turn sums into double precision

# limit: columns eliminated before what is right of and below them is brought up to date [-]: a
# cache's lines
_BLOCK = 16

# limit: unknowns up to which a supernode joins its parent [-]: a call costs more than the zeros
_NARROW = 8

# limit: entries of which one may become a filled zero where a wider one joins [-]: the same
_FILL = 8


@njit(cache=True)
def _tree(n, indptr, indices):
    """Parents in the elimination tree (Liu's algorithm)."""
    parent = np.full(n, -1, dtype=np.int64)
    ancestor = np.full(n, -1, dtype=np.int64)
    for j in range(n):
        for p in range(indptr[j], indptr[j + 1]):
            i = indices[p]
            if i >= j:
                break
            while ancestor[i] != -1 and ancestor[i] != j:
                above = ancestor[i]
                ancestor[i] = j
                i = above
            if ancestor[i] == -1:
                ancestor[i] = j
                parent[i] = j
    return parent


@njit(cache=True)
def _postorder(parent):
    """Nodes of the tree, each after all of its children."""
    n = parent.shape[0]
    first = np.full(n, -1, dtype=np.int64)
    following = np.full(n, -1, dtype=np.int64)
    for j in range(n - 1, -1, -1):
        if parent[j] >= 0:
            following[j] = first[parent[j]]
            first[parent[j]] = j
    order = np.empty(n, dtype=np.int64)
    stack = np.empty(n, dtype=np.int64)
    k = 0
    for root in range(n):
        if parent[root] >= 0:
            continue
        top = 0
        stack[0] = root
        while top >= 0:
            j = stack[top]
            child = first[j]
            if child >= 0:
                first[j] = following[child]
                top += 1
                stack[top] = child
            else:
                order[k] = j
                k += 1
                top -= 1
    return order


@njit(cache=True)
def _counts(n, indptr, indices, parent):
    """Entries below the diagonal in each column of L."""
    mark = np.full(n, -1, dtype=np.int64)
    count = np.zeros(n, dtype=np.int64)
    for i in range(n):
        mark[i] = i
        for p in range(indptr[i], indptr[i + 1]):
            j = indices[p]
            if j >= i:
                break
            while mark[j] != i:
                mark[j] = i
                count[j] += 1
                j = parent[j]
    return count


@njit(cache=True)
def _supernodes(parent, count):
    """First unknowns of the supernodes, (n_supernodes + 1,)."""
    n = parent.shape[0]
    start = np.empty(n + 1, dtype=np.int64)
    zeros = np.zeros(n, dtype=np.int64)
    n_s = 0
    j = 0
    while j < n:
        end = j + 1
        while end < n and parent[end - 1] == end and count[end] == count[end - 1] - 1:
            end += 1
        start[n_s] = j
        zeros[n_s] = 0
        n_s += 1
        # join the one before, a child of this one, as long as that costs little
        while n_s > 1 and parent[start[n_s - 1] - 1] == start[n_s - 1]:
            first, middle = start[n_s - 2], start[n_s - 1]
            more = (middle - first) * (end - middle + count[end - 1] - count[middle - 1])
            extra = zeros[n_s - 2] + zeros[n_s - 1] + more
            total = (end - first) * (end - first + 2 * count[end - 1]) // 2
            if more > 0 and end - first > _NARROW and _FILL * extra > total:
                break
            n_s -= 1
            zeros[n_s - 1] = extra
        j = end
    start[n_s] = n
    return start[: n_s + 1].copy()


@njit(cache=True)
def _add_rows(found, s, last, mark, rows, k):
    """Append what of `found` lies beyond the supernode `s` and is not there yet."""
    for i in found:
        if i >= last and mark[i] != s:
            mark[i] = s
            rows[k] = i
            k += 1
    return k


@njit(cache=True)
def _structure(start, supernode, indptr, indices, count):
    """Rows below each supernode, their beginnings, and the parent of each."""
    n_s = start.shape[0] - 1
    rows = np.empty(count[start[1:] - 1].sum(), dtype=np.int64)
    begin = np.zeros(n_s + 1, dtype=np.int64)
    parent = np.full(n_s, -1, dtype=np.int64)
    child = np.full(n_s, -1, dtype=np.int64)
    sibling = np.full(n_s, -1, dtype=np.int64)
    mark = np.full(start[n_s], -1, dtype=np.int64)
    for s in range(n_s):
        k = begin[s]
        last = start[s + 1]
        for j in range(start[s], last):
            k = _add_rows(indices[indptr[j] : indptr[j + 1]], s, last, mark, rows, k)
        c = child[s]
        while c >= 0:
            k = _add_rows(rows[begin[c] : begin[c + 1]], s, last, mark, rows, k)
            c = sibling[c]
        begin[s + 1] = k
        rows[begin[s] : k].sort()
        if k > begin[s]:
            above = supernode[rows[begin[s]]]
            parent[s] = above
            sibling[s] = child[above]
            child[above] = s
    return rows, begin, parent


@njit(cache=True)
def _places(start, rows, begin, parent):
    """Places of the rows below each supernode in the front of its parent."""
    n_s = start.shape[0] - 1
    place = np.empty(rows.shape[0], dtype=np.int64)
    for s in range(n_s):
        above = parent[s]
        if above < 0:
            continue
        q = begin[above]
        wide = start[above + 1] - start[above]
        for p in range(begin[s], begin[s + 1]):
            i = rows[p]
            if i < start[above + 1]:
                place[p] = i - start[above]
            else:
                while rows[q] != i:
                    q += 1
                place[p] = wide + q - begin[above]
    return place


@njit(cache=True)
def _entries(start, supernode, rows, begin, indptr, indices):
    """Entries of the matrix by the supernode whose front takes them, and where in it."""
    n_s = start.shape[0] - 1
    n = start[n_s]
    first = np.zeros(n_s + 1, dtype=np.int64)
    for j in range(n):
        for p in range(indptr[j], indptr[j + 1]):
            first[supernode[min(indices[p], j)] + 1] += 1
    for s in range(n_s):
        first[s + 1] += first[s]
    fill = first[:-1].copy()
    entry = np.empty(indices.shape[0], dtype=np.int64)
    place = np.empty(indices.shape[0], dtype=np.int64)
    for j in range(n):
        for p in range(indptr[j], indptr[j + 1]):
            i = indices[p]
            s = supernode[min(i, j)]
            wide = start[s + 1] - start[s]
            m = wide + begin[s + 1] - begin[s]
            below = rows[begin[s] : begin[s + 1]]
            at_i = i - start[s] if i < start[s + 1] else wide + np.searchsorted(below, i)
            at_j = j - start[s] if j < start[s + 1] else wide + np.searchsorted(below, j)
            entry[fill[s]] = p
            place[fill[s]] = at_i * m + at_j
            fill[s] += 1
    return first, entry, place


@njit(cache=True, fastmath={"contract"}, inline="always")
def _minus(x, a, y):
    """Take a y off x; over slices, which the compiler finds apart in memory, in vector units."""
    for j in range(x.shape[0]):
        x[j] -= a * y[j]


@njit(cache=True, fastmath={"contract"})
def _trailing(front, panel, low, high, m, room):
    """Take the product of the columns and rows low..high off what is right of and below them."""
    n, wide = m - high, high - low
    left, right = room[: n * wide].reshape(wide, n), room[n * wide : 2 * n * wide].reshape(wide, n)
    product = room[2 * n * wide : 2 * n * wide + n * n].reshape(n, n)
    for k in range(wide):
        left[k] = panel[k, high:m]
        right[k] = front[low + k, high:m]
    np.dot(left.T, right, product)
    for i in range(n):
        f, p = front[high + i, high:m], product[i]
        for j in range(n):
            f[j] -= p[j]


@njit(cache=True, fastmath={"contract"})
def _eliminate(front, wide, m, panel, room, lu, left):
    """LU of the first `wide` columns; the pivots' inverses stand on the diagonal.

    `lu` (wide, wide) takes both factors of the pivots, `left` (wide, m - wide) what L has below.
    """
    for low in range(0, wide, _BLOCK):
        high = min(low + _BLOCK, wide)
        for i in range(low, m):
            f = front[i, low:high]
            for k in range(high - low):
                panel[k, i] = f[k]
        for k in range(low, high):
            p = panel[k - low, k:m]
            if p[0] == 0.0:
                return False
            inverse = _ONE / p[0]
            p *= inverse
            p[0] = inverse
            for j in range(k + 1 - low, high - low):
                _minus(panel[j, k + 1 : m], panel[j, k], p[1:])
        for i in range(low + 1, high):
            for k in range(low, i):
                _minus(front[i, high:m], panel[k - low, i], front[k, high:m])
        if high < m:
            _trailing(front, panel, low, high, m, room)
        for k in range(low, high):
            p = panel[k - low]
            for i in range(low, wide):
                lu[i, k] = p[i]
            left[k] = p[wide:m]
            lu[k, high:wide] = front[k, high:wide]
    return True


@njit(cache=True)
def _factorise(
    data, start, begin, place, first, entry, at, parent, work, stack, panel, room, factors
):
    """LU blocks, what L has below them and U beside them, one supernode after the other."""
    data, start, begin, place = unowned(data), unowned(start), unowned(begin), unowned(place)
    first, entry, at, parent = unowned(first), unowned(entry), unowned(at), unowned(parent)
    work, stack, panel, factors = unowned(work), unowned(stack), unowned(panel), unowned(factors)
    room = unowned(room)
    n_s = start.shape[0] - 1
    top = 0
    k = 0
    waiting = np.empty(n_s, dtype=np.int64)
    n_waiting = 0
    for s in range(n_s):
        wide = start[s + 1] - start[s]
        below = begin[s + 1] - begin[s]
        m = wide + below
        flat = work[: m * m]
        flat[:] = 0.0
        front = flat.reshape(m, m)
        for e in range(first[s], first[s + 1]):
            flat[at[e]] += data[entry[e]]
        while n_waiting > 0 and parent[waiting[n_waiting - 1]] == s:
            n_waiting -= 1
            c = waiting[n_waiting]
            size = begin[c + 1] - begin[c]
            top -= size * size
            left = stack[top : top + size * size].reshape(size, size)
            to = place[begin[c] : begin[c + 1]]
            for i in range(size):
                row, f = left[i], front[to[i]]
                for j in range(size):
                    f[to[j]] += row[j]
        lu = factors[k : k + wide * wide].reshape(wide, wide)
        k += wide * wide
        lower = factors[k : k + wide * below].reshape(wide, below)
        k += wide * below
        if not _eliminate(front, wide, m, panel, room, lu, lower):
            return False
        upper = factors[k : k + wide * below].reshape(wide, below)
        k += wide * below
        upper[:] = front[:wide, wide:]
        if below > 0:
            left = stack[top : top + below * below].reshape(below, below)
            left[:] = front[wide:, wide:]
            top += below * below
            waiting[n_waiting] = s
            n_waiting += 1
    return True


@njit(cache=True, fastmath={"contract", "reassoc"})
def forward(x, start, rows, begin, factors, t):
    """Take L off the right-hand side `x` in place; `t` holds a front's sums."""
    x, start, rows, begin = unowned(x), unowned(start), unowned(rows), unowned(begin)
    factors, t = unowned(factors), unowned(t)
    k = 0
    for s in range(start.shape[0] - 1):
        c, wide = start[s], start[s + 1] - start[s]
        below = begin[s + 1] - begin[s]
        y = x[c : c + wide]
        for i in range(1, wide):
            f = factors[k + i * wide : k + i * wide + i]
            a = _NOUGHT
            for j in range(i):
                a += f[j] * y[j]
            y[i] -= a
        k += wide * wide
        lower = factors[k : k + wide * below].reshape(wide, below)
        b = t[:below]
        b[:] = 0.0
        i = 0
        while i + 4 <= wide:
            y0, y1, y2, y3 = y[i], y[i + 1], y[i + 2], y[i + 3]
            f0, f1, f2, f3 = lower[i], lower[i + 1], lower[i + 2], lower[i + 3]
            for j in range(below):
                b[j] += f0[j] * y0 + f1[j] * y1 + f2[j] * y2 + f3[j] * y3
            i += 4
        while i < wide:
            _minus(b, -y[i], lower[i])
            i += 1
        to = rows[begin[s] : begin[s + 1]]
        for j in range(below):
            x[to[j]] -= b[j]
        k += 2 * wide * below


@njit(cache=True, fastmath={"contract", "reassoc"})
def backward(x, start, rows, begin, factors, t):
    """Take U off `x` in place, from the last supernode to the first."""
    x, start, rows, begin = unowned(x), unowned(start), unowned(rows), unowned(begin)
    factors, t = unowned(factors), unowned(t)
    k = factors.shape[0]
    for s in range(start.shape[0] - 2, -1, -1):
        c, wide = start[s], start[s + 1] - start[s]
        below = begin[s + 1] - begin[s]
        y = x[c : c + wide]
        k -= wide * below
        upper = factors[k : k + wide * below].reshape(wide, below)
        to = rows[begin[s] : begin[s + 1]]
        b = t[:below]
        for j in range(below):
            b[j] = x[to[j]]
        for i in range(wide):
            f = upper[i]
            a = _NOUGHT
            for j in range(below):
                a += f[j] * b[j]
            y[i] -= a
        k -= wide * below + wide * wide
        for i in range(wide - 1, -1, -1):
            f = factors[k + i * wide : k + (i + 1) * wide]
            a = y[i]
            for j in range(i + 1, wide):
                a -= f[j] * y[j]
            y[i] = a * f[i]


@njit(cache=True)
def _stack_size(below, parent):
    """Most numbers that wait at once for the fronts of their parents."""
    most = 0
    now = 0
    waiting = np.empty(below.shape[0], dtype=np.int64)
    k = 0
    for s in range(below.shape[0]):
        while k > 0 and parent[waiting[k - 1]] == s:
            k -= 1
            now -= below[waiting[k]] ** 2
        if below[s] > 0:
            now += below[s] ** 2
            waiting[k] = s
            k += 1
        most = max(most, now)
    return most


class Fronts:
    """A pattern's tree, its fronts, and the factors of the matrix that was factorised last.

    `indptr`, `indices`: columns of a structurally symmetric matrix, indices sorted, unknowns in a
    post-order of the elimination tree (`postorder`).
    """

    def __init__(self, indptr: Integers, indices: Integers) -> None:
        n = len(indptr) - 1
        tree = _tree(n, indptr, indices)
        count = _counts(n, indptr, indices, tree)
        self._start = _supernodes(tree, count)
        wide = np.diff(self._start)
        supernode = np.repeat(np.arange(len(wide)), wide)
        self._rows, self._begin, self._parent = _structure(
            self._start, supernode, indptr, indices, count
        )
        self._below = self._rows.astype(np.uint32)  # nothing is counted from the end
        self._place = _places(self._start, self._rows, self._begin, self._parent)
        self._entries = _entries(self._start, supernode, self._rows, self._begin, indptr, indices)
        below = np.diff(self._begin)
        widest = int((wide + below).max())
        self._front = np.empty(widest**2, np.float32)
        self._panel = np.empty((_BLOCK, widest), np.float32)
        self._room = np.empty(widest * (widest + 2 * _BLOCK), np.float32)
        self._sums = np.empty(widest, np.float32)
        self._stack = np.empty(_stack_size(below, self._parent), np.float32)
        self._factors = np.empty(int(np.sum(wide * (wide + 2 * below))), np.float32)

    def factorise(self, data: Array) -> bool:
        """Factorise the matrix with these entries, in the pattern's order; false: a zero pivot."""
        return bool(
            _factorise(
                data, self._start, self._begin, self._place, *self._entries, self._parent,
                self._front, self._stack, self._panel, self._room, self._factors,
            )
        )  # fmt: skip

    @property
    def known(self) -> tuple[Any, ...]:
        """What `forward` and `backward` take beside the right-hand side."""
        return self._start, self._below, self._begin, self._factors, self._sums


def postorder(indptr: Integers, indices: Integers) -> Integers:
    """Return the present numbers of the unknowns in a post-order of the elimination tree, (n,)."""
    return np.asarray(_postorder(_tree(len(indptr) - 1, indptr, indices)))
