"""Functions of one variable as polynomials over cells of uneven width, quick to look up.

A table is one vector, so that it can travel in a contact law's parameters: a head, a guide (for
each of many equal bins the first cell that reaches into it), the cells' left ends, and for each
column and cell the seven coefficients of a polynomial about the left end. A linear cell at either
end carries each function on beyond the range.

Cells are laid from left to right, and so many are tried and no more: a function that oscillates,
or is no number, from somewhere on has a table up to there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numba import njit

from ...core.arrays import Array, Mask
from ...core.errors import COMPLETED, Ending, Outcome

# limit: cells that are tried, halved ones counted [-]; the smooth laws of this package take 1120
# at most
MOST_CELLS = 4000

_LOW, _BINS_PER_UNIT, BINS, _CELLS = range(4)
GUIDE = 4
_ORDER = 7
_NODES = 0.5 - 0.5 * np.cos(np.pi * np.arange(_ORDER) / (_ORDER - 1))
_BETWEEN = np.array([0.03, 0.15, 0.37, 0.63, 0.85, 0.97])
_FIT = np.linalg.inv(np.vander(_NODES, increasing=True))
_CHECK = np.vander(_BETWEEN, _ORDER, increasing=True)
_START, _BINS_PER_CELL = 24, 8

# limit: cells that are tried together [-]
_AT_ONCE = 256


@dataclass(frozen=True, slots=True)
class TableCells:
    """Columns over cells.

    - `vector`: the table, shape (n,).
    - `error`: largest deviation from the function that was seen between the nodes, for each column;
      cells narrower than `least`, which hold a jump, are left out.
    - `count`: number of cells; 0 where there is no table, and then no vector either.
    - `high`: where the table ends.
    - `outcome`: whether that is the end that was asked for.
    """

    vector: Array
    error: Array
    count: int
    high: float
    outcome: Outcome = COMPLETED


def cells_of(
    function: Callable[[Array], Array], low: float, high: float, *, tolerance: float,
    least: float = 1e-12, start: int = _START, relative: tuple[int, ...] = (), bins: int = 0,
) -> TableCells:  # fmt: skip
    """Return the table of a function: cells are halved until the tolerance holds in each.

    - `function`: from places, shape (n,), to columns, shape (n, columns); all of order 1.
    - `low`, `high`: range.
    - `tolerance`: largest error of any column (of those in `relative` over its own value) between
      the nodes.
    - `least`: cells are not halved below this width: what remains there is a jump.
    - `start`: cells to begin with, all of one width.
    - `bins`: bins of the guide; as many as suit the number of cells when left out.

    Examples
    --------
    >>> import numpy as np
    >>> table = cells_of(lambda x: np.stack([np.sin(x), x], axis=1), 0.0, 3.0, tolerance=1e-9)
    >>> cell = cell_at(table.vector, 0, 1.0)
    >>> bool(abs(column_in(table.vector, 0, cell, 0, 1.0) - np.sin(1.0)) < 1e-9)
    True
    """
    left = np.linspace(low, high, start + 1)[:-1]
    width = np.full(start, (high - low) / start)
    end, tried, error = high, 0, np.zeros(1)
    done: list[tuple[Array, Array, Array]] = []
    while len(left) and tried < MOST_CELLS:
        here, across = left[:_AT_ONCE], width[:_AT_ONCE]
        tried += len(here)
        own, off, known = _polynomials(function, here, across, relative)
        wide = across > least
        own[~wide, 1], own[~wide, 2:] = own[~wide, 1:].sum(axis=1), 0.0
        good = known & (~wide | (off.max(axis=1) <= tolerance))
        done.append((here[good], across[good], own[good]))
        error = np.maximum(error, off[good & wide].max(axis=0, initial=0.0))
        end = here[~wide & ~known].min(initial=end)
        halves = 0.5 * across[~good]
        pair = np.stack([here[~good], here[~good] + halves], axis=1).ravel()
        left = np.concatenate([pair, left[_AT_ONCE:]])
        width = np.concatenate([np.repeat(halves, 2), width[_AT_ONCE:]])[left < end]
        left = left[left < end]
    end = float(left.min(initial=end))
    outcome = COMPLETED
    if end < high:
        outcome = Outcome(
            Ending.STEP_LIMIT,
            f"the table ends at {end:.6g}, short of {high:.6g}, after {tried} cells.",
            "Beyond it ask the function itself.",
        )
    lefts, widths, owns = (np.concatenate(part) for part in zip(*done, strict=True))
    kept = np.argsort(lefts)[: np.count_nonzero(lefts < end)]
    vector = _packed(lefts[kept], widths[kept], owns[kept], end, bins) if len(kept) else lefts[:0]
    return TableCells(vector, error, len(kept), end, outcome)


def _polynomials(
    function: Callable[[Array], Array], left: Array, width: Array, relative: tuple[int, ...]
) -> tuple[Array, Array, Mask]:
    """Return each cell's polynomial, how far off it is in each column, whether it is a number."""
    places = left[:, None] + width[:, None] * np.concatenate([_NODES, _BETWEEN])
    # a border may lie exactly on the right end: stay inside
    places[:, _ORDER - 1] = np.nextafter(left + width, -np.inf)
    with np.errstate(all="ignore"):
        values = function(places.ravel()).reshape(len(left), len(_NODES) + len(_BETWEEN), -1)
        nodes, between = values[:, :_ORDER], values[:, _ORDER:]
        own = np.einsum("pk,nkc->npc", _FIT, nodes)
        off = np.abs(np.einsum("bp,npc->nbc", _CHECK, own) - between)
        for column in relative:
            off[..., column] /= np.abs(between[..., column])
        # a cell too narrow for its powers holds nothing
        whole = np.isfinite(_scaled(own, width)).all(axis=(1, 2))
    known = np.asarray(np.isfinite(values).all(axis=(1, 2)) & whole)
    return own, off.max(axis=1), known


def _scaled(own: Array, width: Array) -> Array:
    """Coefficients by the distance from a cell's left end, in place of parts of its width."""
    return np.asarray(own / width[:, None, None] ** np.arange(_ORDER)[None, :, None])


def _packed(left: Array, width: Array, own: Array, high: float, bins: int) -> Array:
    """Put cells, with a linear one before and one behind, into one vector."""
    scaled = _scaled(own, width)
    first, last = np.zeros((2, _ORDER, own.shape[2]))
    first[:2] = scaled[0, :2]
    last[0] = own[-1].sum(axis=0)
    last[1] = (own[-1] * np.arange(_ORDER)[:, None]).sum(axis=0) / width[-1]
    # the first cell counts from its right end, where it meets the second
    lefts = np.concatenate([left[:1], left, [high]])
    coefficients = np.concatenate([first[None], scaled, last[None]]).transpose(2, 0, 1)
    bins = bins or _BINS_PER_CELL * len(lefts)
    edges = left[0] + (high - left[0]) * np.arange(bins) / bins
    guide = np.maximum(np.searchsorted(lefts[1:], edges, side="right"), 0)
    guide[0] = 0
    head = [left[0], bins / (high - left[0]), bins, len(lefts)]
    return np.concatenate([head, guide, lefts, [np.inf], coefficients.ravel()])


@njit(cache=True, _nrt=False, error_model="numpy")
def cell_at(table, at, x):
    """Return the cell that holds `x`, of the table that begins at `at`."""
    bins = int(table[at + BINS])
    place = (x - table[at + _LOW]) * table[at + _BINS_PER_UNIT]
    # no whole number holds nan or 1e19: an index of one would point outside the table
    k = int(min(place, bins - 1.0)) if place > 0.0 else 0
    cell = int(table[at + GUIDE + k])
    first = at + GUIDE + bins
    while table[first + cell + 1] <= x < math.inf:
        cell += 1
    return cell


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def column_in(table, at, cell, column, x):
    """Return a column at `x`, which lies in `cell`."""
    first, cells = at + GUIDE + int(table[at + BINS]), int(table[at + _CELLS])
    u = x - table[first + cell]
    k = first + cells + 1 + (column * cells + cell) * _ORDER
    u2 = u * u
    low = table[k] + u * table[k + 1] + u2 * (table[k + 2] + u * table[k + 3])
    return low + u2 * u2 * (table[k + 4] + u * table[k + 5] + u2 * table[k + 6])


@njit(cache=True, _nrt=False, error_model="numpy")
def column_at(table, at, column, x):
    """Return a column at `x`."""
    return column_in(table, at, cell_at(table, at, x), column, x)
