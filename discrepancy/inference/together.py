"""Responses of two mechanisms together: their own, and what they do to each other near a place.

A tensor grid over the parameters of both costs the product of their nodes, thousands of impacts
for each condition. Each mechanism's own response bends; what two do to each other is a small part
of it, and over the width of a posterior nearly straight.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from ...core.arrays import Array
from ...dynamics.mechanisms.base import Mechanism
from ..comparison.forward import Point, Simulator
from ..rules import RULES
from .grid import Grid, along_all


def split(grid: Grid, mechanisms: Sequence[Mechanism]) -> tuple[Grid, Grid]:
    """Return the grids of the first and of the second mechanism of a pair's grid."""
    n = sum(a.mechanism == mechanisms[0].name for a in grid.axes)
    return (
        Grid(grid.axes[:n], grid.window[:n]),
        Grid(grid.axes[n:], grid.window[n:]),
    )  # fmt: skip


def mutual(
    simulator: Simulator, mechanisms: Sequence[Mechanism], grid: Grid, corners: Sequence[Array],
    z: Array,
) -> Array:  # fmt: skip
    """Return what two mechanisms do to each other over the refined grid, (k, m).

    - `mechanisms`: the two.
    - `grid`: of both; beyond the corners the mutual effect is that at the nearest of them.
    - `corners`: two or three places of each axis, where it is simulated.
    - `z`: unknowns (n_z,).
    """
    first, second = split(grid, mechanisms)
    n = len(first.axes)

    def at(some: Sequence[Mechanism], of: Grid, axes: Sequence[Array]) -> Array:
        points = [Point(z, of.values(p)) for p in itertools.product(*axes)]
        return simulator.predict(some, points)

    both = at(mechanisms, grid, corners)
    alone = at(mechanisms[:1], first, corners[:n])
    rest = at(mechanisms[1:], second, corners[n:])
    m = both.shape[-1]
    table = both.reshape(len(alone), len(rest), m) - alone[:, None] - rest[None, :]
    table = (table + plain(simulator, z)).reshape(*[len(c) for c in corners], m)
    inside = [np.clip(f, c[0], c[-1]) for f, c in zip(grid.fine, corners, strict=True)]
    return np.asarray(along_all(corners, inside, table).reshape(-1, m))


def plain(simulator: Simulator, z: Array) -> Array:
    """Return the prediction without a mechanism, (m,)."""
    return np.asarray(simulator.predict((), [Point(z)])[0])


def refined(
    simulator: Simulator, mechanisms: Sequence[Mechanism], grid: Grid, z: Array, place: Array,
    here: Array,
) -> Array:  # fmt: skip
    """Return predictions over the refined grid, (k, m), from simulated nodes.

    Of two mechanisms with more than `RULES.tensor` parameters over a window, each is simulated at
    its own nodes and both at the window's corners; the sum is brought to the prediction at the
    place.

    `simulator`, `mechanisms`, `grid`, `z`: the problem, what acts, the grid of its parameters, and
    the unknowns (n_z,); `place`, `here`: a place (axes,), and the prediction there (m,).
    """
    if len(mechanisms) != 2 or len(grid.axes) <= RULES.tensor or not grid.window:
        return grid.refine(responses_at(simulator, mechanisms, grid, z))
    one, two = split(grid, mechanisms)
    n = len(one.axes)
    first = one.refine(responses_at(simulator, mechanisms[:1], one, z), grid.fine[:n])
    second = two.refine(responses_at(simulator, mechanisms[1:], two, z), grid.fine[n:])
    corners = [np.array(ends) for ends in grid.window]
    own = first[:, None, :] + second[None, :, :] - plain(simulator, z)
    fine = own.reshape(-1, own.shape[-1]) + mutual(simulator, mechanisms, grid, corners, z)
    return np.asarray(fine + (here - fine[grid.index(place)]))


def responses_at(
    simulator: Simulator, mechanisms: Sequence[Mechanism], grid: Grid, z: Array
) -> Array:
    """Return predictions at every node of the grid, shape (nodes, m)."""
    return simulator.predict(mechanisms, [Point(z, values) for values in grid.nodes()])
