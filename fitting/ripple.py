"""The ripple of finite-element forces and radii, which no smooth law can follow.

With an imposed approach, F and a of a mesh ripple with the period of a surface element once the
contact is plastic. A local cubic in ln Delta over the neighbouring depths shows how much.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from ..core.arrays import Array
from .rules import RULES
from .table import Table


@lru_cache(maxsize=1)
def without_ripple(table: Table) -> Table:
    """Return the rows with ln F and ln a replaced by local cubics in ln Delta."""
    both = np.stack([np.log(table.force), np.log(table.radius)], axis=1)
    force, radius = np.exp(_smoothed(table, both)).T
    return replace(table, force=force, radius=radius)


def ripple_of(table: Table) -> tuple[Array, Array]:
    """Rms ripple of ln F and ln a of each row's case beyond first yield, shape (n,) each."""
    smooth = without_ripple(table)
    yielding = (table.w >= 1.0) & table.edge_seen

    def of(off: Array) -> Array:
        rms = np.zeros(len(table.pairs))
        for number in range(len(table.pairs)):
            m = yielding & (table.case == number)
            rms[number] = np.sqrt(np.mean(off[m] ** 2)) if m.any() else 0.0
        return rms[table.case]

    return of(np.log(table.force / smooth.force)), of(np.log(table.radius / smooth.radius))


def _smoothed(table: Table, value: Array) -> Array:
    """Values of the rows, shape (n, k), each by the local cubic of its case."""
    out = value.copy()
    x = np.log(table.D)
    for number in range(len(table.pairs)):
        rows = np.flatnonzero((table.case == number) & table.edge_seen)
        for k in rows:
            near = rows[np.abs(x[rows] - x[k]) <= RULES.smooth_reach]
            if len(near) >= RULES.smooth_points:
                out[k] = np.polyfit(x[near] - x[k], value[near], 3)[-1]
    return out
