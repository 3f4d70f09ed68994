"""The one driver of all laws: it broadcasts over depths and pairs, an open contact being zero."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import float64, njit, types

from ..core.arrays import Array, Integers, numbers
from ..core.errors import InputError
from ..core.material import Pair
from .kernel import BRANCH, LOADING, SPLIT, VECTOR, R

Depths = npt.ArrayLike
Pairs = Pair | Sequence[Pair]

# vectors of the pairs, which of them, depths
_GIVEN = (float64[:, ::1], types.int64[::1], VECTOR)


@njit(types.void(LOADING, *_GIVEN, VECTOR), cache=True, _nrt=False)
def map_loading(kernel, par, row, depth, out):
    """Fill `out` with a loading kernel's answers."""
    for i in range(depth.size):
        if depth[i] > 0.0:
            out[i] = kernel(par[row[i]], depth[i])


@njit(types.void(BRANCH, *_GIVEN, VECTOR, VECTOR), cache=True, _nrt=False)
def map_branch(kernel, par, row, depth, peak, out):
    """Fill `out` with the answers of a radius or unloading kernel."""
    for i in range(depth.size):
        if depth[i] > 0.0:
            out[i] = kernel(par[row[i]], depth[i], peak[i])


@njit(types.void(SPLIT, *_GIVEN, VECTOR, VECTOR), cache=True, _nrt=False)
def map_residual(kernel, par, row, peak, sphere, flat):
    """Fill both with a residual kernel's answers."""
    for i in range(peak.size):
        if peak[i] > 0.0:
            s, f = kernel(par[row[i]], peak[i])
            sphere[i] = s
            flat[i] = f


def depths_of(given: Depths) -> Array:
    """Return approaches as finite numbers [m], of their own shape; refuse text such as "20 um"."""
    d = numbers(given, key="depth", allowed="depths in m")
    if not np.all(np.isfinite(d)):
        raise InputError("a depth is not a number", key="depth", allowed="finite depths in m")
    return d


class Rows(NamedTuple):
    """A call taken apart: what each entry of the answer needs."""

    table: Array  # vectors of the pairs, shape (n_pairs, n)
    row: Integers  # which of them, shape (n,)
    depth: Array  # shape (n,) [m]
    shape: tuple[int, ...]  # of the answer

    def shaped(self, out: Array) -> Array:
        """Return an answer (n,) in its shape; refuse a depth at which the law has no number."""
        if not np.all(np.isfinite(out)):
            first = int(np.argmin(np.isfinite(out)))
            depth, radius = self.depth[first], self.table[self.row[first], R]
            raise InputError(
                f"{depth:g} m, {depth / radius:.2g} radii: the law has no number there",
                key="depth", allowed=f"a part of the radius, {radius:g} m",
            )  # fmt: skip
        return out.reshape(self.shape)


def rows_of(parameters: Callable[[Pair], Array], pair: Pairs, depth: Depths) -> Rows:
    """Take a call apart; `parameters` is the law's own method of that name."""
    d = depths_of(depth)
    if isinstance(pair, Pair):
        table = parameters(pair)[None, :]
        row = np.zeros(d.size, dtype=np.int64)
    else:
        if not (isinstance(pair, Iterable) and all(isinstance(p, Pair) for p in pair)):
            raise InputError(repr(pair), key="pair", allowed="a Pair, or one for each depth")
        table = np.stack([parameters(p) for p in pair])
        if d.ndim == 0:
            d = np.broadcast_to(d, len(table))
        elif d.shape[0] != len(table):
            raise InputError(
                f"{d.shape[0]} depths of {len(table)} pairs", key="depth",
                allowed="one pair, or one for each entry of the first axis",
            )  # fmt: skip
        row = np.repeat(np.arange(len(table)), d.size // len(table))
    return Rows(np.ascontiguousarray(table), row, np.ascontiguousarray(d.ravel()), d.shape)
