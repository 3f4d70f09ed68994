"""Meshes of the explicit family: a round-ended bar above a block, graded towards the contact."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ....core.arrays import Array, Integers


@dataclass(frozen=True)
class Mesh:
    """Quadrilaterals of bar and block in the half-plane (r, z).

    Parameters
    ----------
    x
        (n, 2) nodes, r and z [m]; the block's top is z = 0, the tip touches it at r = 0.
    quads
        (m, 4) corners, counter-clockwise.
    body
        (m,) 0 bar, 1 block, 2 pad under the block.
    tip, top
        Nodes of the bar's lower and of the block's upper surface, from the axis outward.
    held
        Nodes that do not move.
    """

    x: Array
    quads: Integers
    body: Integers
    tip: Integers
    top: Integers
    held: Integers


def graded(fine: float, flat: float, end: float, growth: float) -> Array:
    """Places from 0 to `end`: steps `fine` up to `flat`, then growing by `growth` each."""
    places = list(np.arange(0.0, flat + 0.5 * fine, fine))
    step = fine
    while places[-1] < end:
        step *= growth
        places.append(places[-1] + step)
    grid = np.array(places)
    keep = grid < end - 0.6 * step
    return np.append(grid[keep], end)


def _grid(r: Array, z: Array) -> tuple[Array, Integers]:
    nr, nz = len(r), len(z)
    x = np.stack(np.meshgrid(r, z, indexing="xy"), axis=-1).reshape(-1, 2)
    i, j = np.meshgrid(np.arange(nr - 1), np.arange(nz - 1), indexing="xy")
    first = (j * nr + i).ravel()
    quads = np.stack([first, first + 1, first + 1 + nr, first + nr], axis=1)
    return x, quads


def make_mesh(
    *, tip_radius: float, bar_radius: float, bar_length: float, tip_flat: float,
    block_radius: float, block_thickness: float, pad: float, fine: float, reach: float,
    hold: str = "bottom",
) -> Mesh:  # fmt: skip
    """Mesh bar and block.

    Parameters
    ----------
    tip_radius, bar_radius, bar_length
        Round end, shank and length from tip to back face [m].
    tip_flat
        Radius of a flat on the tip [m].
    block_radius, block_thickness, pad
        Block, and the elastic pad glued under it (0 for none) [m].
    fine
        Element size at the contact [m].
    reach
        How far the fine elements go [m].
    hold
        What is held: the block's `bottom`, or its `rim` (a plate).
    """
    r = graded(fine, reach, block_radius, 1.22)
    down = graded(fine, 1.1 * reach, block_thickness, 1.25)
    x1, q1 = _grid(r, -down[::-1])
    nr, n1 = len(r), len(x1)
    top = np.arange(n1 - nr, n1)
    if pad > 0.0:
        layers = -block_thickness - pad * np.array([1.0, 0.5])
        x1, q1 = _grid(r, np.concatenate([layers, -down[::-1]]))
        n1 = len(x1)
        top = np.arange(n1 - nr, n1)
    body1 = np.ones(len(q1), dtype=np.int64)
    if pad > 0.0:
        body1[: 2 * (nr - 1)] = 2
    rb = graded(fine, reach, bar_radius, 1.25)
    up = graded(fine, 1.0 * reach, bar_length, 1.3)
    coarse = 0.5 * bar_radius
    while np.diff(up).max() > 1.5 * coarse:
        k = int(np.argmax(np.diff(up)))
        up = np.insert(up, k + 1, 0.5 * (up[k] + up[k + 1]))
    x2, q2 = _grid(rb, up)
    x2 = x2.copy()
    sag = _profile(x2[:, 0], tip_radius, tip_flat)
    # the round end fades out along the bar so that its back face is flat
    x2[:, 1] += sag * np.clip(1.0 - x2[:, 1] / bar_length, 0.0, 1.0)
    tip = n1 + np.arange(len(rb))
    held = np.arange(nr) if hold == "bottom" else np.arange(nr - 1, n1, nr)
    return Mesh(
        x=np.concatenate([x1, x2]), quads=np.concatenate([q1, q2 + n1]),
        body=np.concatenate([body1, np.zeros(len(q2), dtype=np.int64)]),
        tip=tip, top=top, held=held,
    )  # fmt: skip


def _profile(r: Array, R: float, flat: float) -> Array:
    full: Array = R - np.sqrt(R * R - r * r)
    return np.maximum(full - (R - math.sqrt(R * R - flat * flat)), 0.0)
