"""Arrays used without a count of references: the same numbers, and nothing lost or freed."""

import gc
import sys
from typing import NamedTuple

import numpy as np
from dentscope.core.unowned import unowned
from numba import njit


class Rows(NamedTuple):
    x: np.ndarray
    inner: tuple


@njit
def _row(x, k):
    return x[k]


@njit
def _doubled(rows, out, factor):
    rows, out = unowned(rows), unowned(out)
    for k in range(rows.x.shape[0]):
        row, to = _row(rows.x, k), out[k]
        for j in range(row.shape[0]):
            to[j] = factor * row[j] + rows.inner[0][k] + rows.inner[1]


def test_a_kernel_reads_and_writes_what_its_caller_holds():
    x, more = np.arange(12.0).reshape(4, 3), np.array([1.0, 2.0, 3.0, 4.0])
    out = np.empty((4, 3))
    _doubled(Rows(x, (more, 10)), out, 2.0)
    assert np.array_equal(out, 2.0 * x + more[:, None] + 10.0)


def test_nothing_is_kept_or_freed_too_soon():
    x, more, out = np.ones((200, 3)), np.zeros(200), np.empty((200, 3))
    held = [sys.getrefcount(array) for array in (x, more, out)]
    for _ in range(50):
        _doubled(Rows(x, (more, 1)), out, 1.0)
    assert [sys.getrefcount(array) for array in (x, more, out)] == held
    gc.collect()
    other = np.full((200, 3), 7.0)  # would take memory that was freed too soon
    assert np.all(x == 1.0)
    assert np.all(out == 2.0)
    assert np.all(other == 7.0)
