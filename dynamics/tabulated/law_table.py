"""A contact law of one pair as a table: the same answers at a hundredth of a microsecond.

F/depth^(3/2), a/depth^(1/2), both residual depths over the peak depth and the exponent of the
recovery are polynomials over cells that are halved until the stated error holds; borders of a
published law become borders of cells. A cell is found, and the polynomial taken, by the place of
the depth: its binary exponent and fraction, read off its bits as one number. That grows like
log2(depth), straight within each octave, and needs no logarithm. The table stands in the
parameter vector behind the pair's common numbers, so that whatever takes a law's kernels takes
these.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numba import int64, njit, types

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.material import Pair
from ...models.base import ContactLaw, Kernels
from ...models.driver import Depths, Pairs
from ...models.kernel import (
    BRANCH,
    LOADING,
    N_COMMON,
    SPLIT,
    VECTOR,
    common_parameters,
    kernel,
    power_recovery,
)
from ..rules import RULES
from .bits import bits_of
from .cells import BINS, GUIDE, TableCells, cells_of, column_in

# limit: tables that are kept [-]; memory
TABLES_KEPT = 200

ERROR = RULES.table_error
"""Error of a table: of F and a over their own, of residual depths over the peak, of the power."""

# limit: depths between which a law is tabulated, whole octaves [R]; beyond, it goes on as Hertz's
SHALLOWEST, DEEPEST = 1e-9, 1.0

_FORCE, _RADIUS, _SPHERE, _FLAT, _EXPONENT = range(5)
_COLUMNS = 5

_OCTAVE, _OCTAVES = N_COMMON, N_COMMON + 1
_TABLE = N_COMMON + 2
"""Behind the common numbers: the first octave's bits and how many octaves there are, then cells."""
_BIN = 52 - 4
"""A bin of the cells' guide is a sixteenth of an octave: what the bits say beyond this one."""


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _found(par, depth):
    """Cell of a depth, and its place in octaves from the begin of the table."""
    ahead = bits_of(depth) - int64(par[_OCTAVE])
    ahead = min(max(ahead, 0), int64(par[_OCTAVES]) * (1 << 52) - 1)
    x = ahead * 2.0**-52
    cell = int64(par[_TABLE + GUIDE + (ahead >> _BIN)])
    first = _TABLE + GUIDE + int64(par[_TABLE + BINS])
    while x >= par[first + cell + 1]:
        cell += 1
    return cell, x


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _column(par, column, depth):
    cell, x = _found(par, depth)
    return column_in(par, _TABLE, cell, column, x)


@kernel
def _loading(par, depth):
    return depth * math.sqrt(depth) * _column(par, _FORCE, depth)


@kernel
def _radius(par, depth, _peak):
    return math.sqrt(depth) * _column(par, _RADIUS, depth)


@kernel
def _residual(par, peak):
    cell, x = _found(par, peak)
    sphere = column_in(par, _TABLE, cell, _SPHERE, x)
    return max(sphere, 0.0) * peak, max(column_in(par, _TABLE, cell, _FLAT, x), 0.0) * peak


@kernel
def _unloading(par, depth, peak):
    sphere, flat = _residual(par, peak)
    exponent = _column(par, _EXPONENT, peak)
    return power_recovery(_loading(par, peak), depth, peak, sphere + flat, exponent)


_KERNELS = Kernels(_loading, _radius, _unloading, _residual)


@dataclass(frozen=True, kw_only=True)
class TabulatedLaw(ContactLaw):
    """Another law from a table for each pair, made at its first use and kept.

    Its recovery is a power of the depth above the residual depth, and its contact radius one of the
    depth alone.
    """

    law: ContactLaw

    @property
    def kernels(self) -> Kernels:
        """The compiled functions, the same for every law."""
        return _KERNELS

    def parameters(self, pair: Pair) -> Array:
        """Common numbers, begin and length of the range, then the table, shape (n,)."""
        bits = np.float64(_first_octave(pair.R)).view(np.int64)
        head = [float(bits), float(_octaves(pair.R))]
        return np.concatenate([common_parameters(pair), head, self.table(pair).vector])

    def warn_outside(self, pair: Pairs, depth: Depths) -> None:
        """Warn where the law itself would."""
        self.law.warn_outside(pair, depth)

    def table(self, pair: Pair) -> TableCells:
        """Return the pair's table; refuse a law that recovers otherwise, jumps or oscillates."""
        name, par = self.law.name, np.asarray(self.law.parameters(pair), dtype=float)
        found = _table(name, self.law.kernels, par.tobytes(), pair.R)
        if not found.outcome.completed:
            raise InputError(
                f"{name} cannot be tabulated: {found.outcome.message}",
                key="law",
                allowed="a law without jumps",
            )
        return found


def tabulated(law: ContactLaw) -> TabulatedLaw:
    """Return a law that answers from a table within `ERROR` of `law`.

    Examples
    --------
    >>> from dentscope.core import Material, Pair
    >>> from dentscope.models.published.jackson_green import JACKSON_GREEN
    >>> steel = Material(E=200e9, nu=0.3, Sy=760e6)
    >>> pair = Pair(steel, steel, 5e-3)
    >>> table = tabulated(JACKSON_GREEN)
    >>> off = table.loading(pair, [1e-6, 3e-5]) / JACKSON_GREEN.loading(pair, [1e-6, 3e-5]) - 1
    >>> bool(abs(off).max() < 1e-8)
    True
    """
    if isinstance(law, TabulatedLaw):
        law = law.law
    return TabulatedLaw(**law.about, law=law)


@lru_cache(maxsize=TABLES_KEPT)
def _table(name: str, kernels: Kernels, numbers: bytes, R: float) -> TableCells:
    par = np.frombuffer(bytearray(numbers))
    if not _recovers_by_power(kernels.unloading, kernels.residual, par, R):
        raise InputError(
            f"{name} recovers otherwise than by a power of the depth",
            key="law",
            allowed="a force that falls as a power of the depth above the residual depth",
        )

    first, count = _first_octave(R), _octaves(R)

    def columns(x: Array) -> Array:
        octave = np.minimum(np.floor(x), count - 1)
        depth = np.ldexp(first * (1.0 + (x - octave)), octave.astype(int))
        out = np.empty((len(x), _COLUMNS))
        try:
            _ask(*kernels, par, depth, out)
        except ZeroDivisionError:  # beyond what the law has a number for
            out[:] = np.nan
        return out

    return cells_of(
        columns, 0.0, float(count), tolerance=ERROR, start=count, relative=(_FORCE, _RADIUS),
        bins=16 * count,
    )  # fmt: skip


def _first_octave(R: float) -> float:
    """Power of two at or below the shallowest depth."""
    return math.ldexp(0.5, math.frexp(SHALLOWEST * R)[1])


def _octaves(R: float) -> int:
    return math.ceil(math.log2(DEEPEST * R / _first_octave(R)))


@njit(
    types.void(LOADING, BRANCH, BRANCH, SPLIT, VECTOR, VECTOR, types.float64[:, ::1]),
    cache=True, _nrt=False,
)  # fmt: skip
def _ask(loading, radius, unloading, residual, par, depths, out):
    """Fill the columns at some depths."""
    for i in range(len(depths)):
        depth = depths[i]
        sphere, flat = residual(par, depth)
        out[i, 0] = loading(par, depth) / (depth * math.sqrt(depth))
        out[i, 1] = radius(par, depth, depth) / math.sqrt(depth)
        out[i, 2], out[i, 3] = sphere / depth, flat / depth
        rest = sphere + flat
        out[i, 4] = 1.5
        # a contact that gives nothing back has no exponent
        if depth - rest > 1e-9 * depth:
            half = unloading(par, rest + 0.5 * (depth - rest), depth)
            out[i, 4] = -math.log(half / unloading(par, depth, depth)) / math.log(2.0)


@njit(types.boolean(BRANCH, SPLIT, VECTOR, types.float64), cache=True, _nrt=False)
def _recovers_by_power(unloading, residual, par, R):
    for decade in range(1, 9):
        peak = R * 10.0**-decade
        sphere, flat = residual(par, peak)
        rest = sphere + flat
        top = unloading(par, peak, peak)
        if peak - rest <= 1e-9 * peak or top <= 0.0:
            continue
        half = unloading(par, rest + 0.5 * (peak - rest), peak) / top
        n = -math.log(half) / math.log(2.0)
        for share in (0.1, 0.3, 0.8):
            there = unloading(par, rest + share * (peak - rest), peak) / top
            if abs(there - share**n) > 1e-9:
                return False
    return True
