"""One slave point: how its gap and the directions of its force change with the nodes.

The point depends on 16 degrees of freedom: r and z of four slave and four master nodes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ...core.arrays import Array, Integers
from .gap import Weights, curve, new_weights, weighted
from .surfaces import POINTS

LOCAL = 16
"""Degrees of freedom that a slave point's gap depends on."""


class Changes(NamedTuple):
    """What one slave point's force depends on.

    `dof`: its degrees of freedom, shape (16,); `dg`: gradient of the gap, shape (16,); `b`: share
    of the point's force that each takes, shape (16,).
    """

    dof: Integers
    dg: Array
    b: Array


class Room(NamedTuple):
    """Working arrays: weights, changes of the slope and of the place on the master segment (16,),
    and the derivative of the shares `b` (16, 16).
    """  # noqa: D205

    w: Weights
    dslope: Array
    dtau: Array
    db: Array


class _Frame(NamedTuple):
    """The master curve below a point: dr/dt, slope dz/dr, its change with r times dr/dt, length of
    the straight segment and the place on it.
    """  # noqa: D205

    r1: float
    slope: float
    bend: float
    length: float
    tau: float


@njit(cache=True)
def new_room():
    """Room for the derivatives of one point."""
    return Room(new_weights(), np.empty(LOCAL), np.empty(LOCAL), np.empty((LOCAL, LOCAL)))


@njit(cache=True)
def frame_below(k, r, xm, w):
    """Return the master curve's frame on segment k at radius r; `w` are its weights there."""
    r1, z1 = weighted(k, xm, w.first)
    r2, z2 = weighted(k, xm, w.second)
    slope = z1 / r1
    bend = (z2 - slope * r2) / r1
    length = xm[k + 1, 0] - xm[k, 0]
    return _Frame(r1, slope, bend, length, (r - xm[k, 0]) / length)


@njit(cache=True)
def _master_gradient(k, surfaces, frame, room, out):
    """Gradient of gap and slope by the four master nodes, whose weights are in `room`."""
    r1, slope, bend, length, tau = frame
    w = room.w
    for j in range(4):
        mirrored = j == 0 and k == 0
        node = 1 if mirrored else min(k - 1 + j, len(surfaces.master) - 1)
        sg = -1.0 if mirrored else 1.0
        i = 8 + 2 * j
        out.dof[i] = 2 * surfaces.master[node]
        out.dof[i + 1] = out.dof[i] + 1
        out.dg[i] = slope * sg * w.value[j]
        out.dg[i + 1] = -w.value[j]
        room.dslope[i] = sg * (-slope * w.first[j] - bend * w.value[j]) / r1
        room.dslope[i + 1] = w.first[j] / r1
    room.dtau[10] = -(1.0 - tau) / length
    room.dtau[12] = -tau / length


@njit(cache=True)
def _slave_gradient(e, surfaces, frame, room, out):
    """Gradient of gap, slope and place by the four slave nodes, whose weights are in `room`."""
    r1, slope, bend, length, _ = frame
    w = room.w
    for j in range(4):
        mirrored = j == 0 and e == 0
        node = 1 if mirrored else min(e - 1 + j, len(surfaces.slave) - 1)
        sg = -1.0 if mirrored else 1.0
        i = 2 * j
        out.dof[i] = 2 * surfaces.slave[node]
        out.dof[i + 1] = out.dof[i] + 1
        out.dg[i] = -slope * sg * w.value[j]
        out.dg[i + 1] = w.value[j]
        room.dslope[i] = bend * sg * w.value[j] / r1
        room.dtau[i] = sg * w.value[j] / length


@njit(cache=True)
def _shares(s, frame, room, out):
    """Shares of the force by the straight segments, and their derivative."""
    slope = frame.slope
    tau = frame.tau
    for i in range(LOCAL):
        out.b[i] = 0.0
        for j in range(LOCAL):
            room.db[i, j] = 0.0
    for n in range(2):
        N = s if n == 1 else 1.0 - s
        L = tau if n == 1 else 1.0 - tau
        turn = 1.0 if n == 1 else -1.0
        i = 2 + 2 * n
        m = 10 + 2 * n
        out.b[i] = -slope * N
        out.b[i + 1] = N
        out.b[m] = slope * L
        out.b[m + 1] = -L
        for j in range(LOCAL):
            room.db[i, j] = -N * room.dslope[j]
            room.db[m, j] = L * room.dslope[j] + slope * turn * room.dtau[j]
            room.db[m + 1, j] = -turn * room.dtau[j]


@njit(cache=True)
def point_changes(e, q, surfaces, xm, points, room, out):
    """Fill `out`, and the derivative `room.db` of its shares, for point q of slave edge e."""
    k = points.segment[e, q]
    for i in range(LOCAL):
        room.dslope[i] = 0.0
        room.dtau[i] = 0.0
    curve(points.position[e, q], surfaces.master_shape[k], room.w)
    frame = frame_below(k, points.radius[e, q], xm, room.w)
    _master_gradient(k, surfaces, frame, room, out)
    s = 0.5 * (1.0 + POINTS[q])
    curve(s, surfaces.slave_shape[e], room.w)
    _slave_gradient(e, surfaces, frame, room, out)
    _shares(s, frame, room, out)
