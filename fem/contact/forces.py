"""Pressures, tractions, forces and tangent of the contact at given positions of the nodes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit

from ...core.arrays import Array, Integers, Mask
from ...core.unowned import unowned
from .friction import Grip, rub, slip_of
from .gap import SlavePoints, find_gaps
from .point import LOCAL, Changes, new_room, point_changes
from .surfaces import POINTS, Surfaces

_SUPPORT = 96  # room for the degrees of freedom that a node's weighted gap depends on


@dataclass(frozen=True)
class ContactState:
    """What one evaluation of the contact gives.

    - `pressure`: nodal pressures p_A on the reference area, shape (n_slave,) [E'].
    - `gap`, `r`: gap and current radius of the slave points, shape (n_edges, 3) [R].
    - `segment`: master segment under each slave point, shape (n_edges, 3).
    - `force`: vertical contact force [E' R^2].
    - `energy`: penalty energy [E' R^3].
    - `traction`: nodal tangential tractions on the reference area, shape (n_slave,) [E'].
    - `rubbed`: work lost in sliding since the last accepted step [E' R^3].
    """

    pressure: Array
    gap: Array
    r: Array
    segment: Integers
    force: float
    energy: float
    traction: Array
    rubbed: float


class Triplets(NamedTuple):
    """Room for the contact tangent as (row, column, value)."""

    row: Integers
    col: Integers
    value: Array

    @classmethod
    def room(cls, n: int) -> Triplets:
        """Allocate so many."""
        return cls(np.empty(n, np.int64), np.empty(n, np.int64), np.empty(n))

    @classmethod
    def for_surfaces(cls, surfaces: Surfaces) -> Triplets:
        """Allocate enough for every slave node in contact."""
        return cls.room(len(surfaces.slave) * (1500 if surfaces.friction == 0.0 else 3000))


@njit(cache=True)
def _find_pressures(s, gap, closed, pressure):
    """Fill the nodal pressures from the gaps; total force and energy."""
    n_edges = gap.shape[0]
    pressure[:] = 0.0
    for e in range(n_edges):
        for q in range(3):
            part = 0.5 * (1.0 + POINTS[q])
            pressure[e] += (1.0 - part) * s.weight[e, q] * gap[e, q]
            pressure[e + 1] += part * s.weight[e, q] * gap[e, q]
    energy = 0.0
    total = 0.0
    for A in range(n_edges + 1):
        p = -s.stiffness[A] * pressure[A] / s.mass[A]
        pressure[A] = p if closed[A] else max(0.0, p)
        energy += 0.5 * s.mass[A] * pressure[A] ** 2 / s.stiffness[A]
        total += s.mass[A] * pressure[A]
    return total, energy


@njit(cache=True)
def _of(changes, e, q):
    return Changes(changes.dof[e, q], changes.dg[e, q], changes.b[e, q])


@njit(cache=True)
def _add_forces(s, xm, points, pressure, force, changes, with_tangent, out):
    """Add the forces of the points; the tangent of their directions goes to `out`; how many."""
    room = new_room()
    n = 0
    for e in range(len(pressure) - 1):
        if pressure[e] == 0.0 and pressure[e + 1] == 0.0:
            continue
        for q in range(3):
            here = _of(changes, e, q)
            point_changes(e, q, s, xm, points, room, here)
            part = 0.5 * (1.0 + POINTS[q])
            p = ((1.0 - part) * pressure[e] + part * pressure[e + 1]) * s.weight[e, q]
            for i in range(LOCAL):
                here.dg[i] *= s.sign
                here.b[i] *= s.sign
                force[here.dof[i]] -= p * here.b[i]
            if not with_tangent:
                continue
            for i in range(LOCAL):
                for j in range(LOCAL):
                    if room.db[i, j] != 0.0:
                        out.row[n] = here.dof[i]
                        out.col[n] = here.dof[j]
                        out.value[n] = -p * s.sign * room.db[i, j]
                        n += 1
    return n


@njit(cache=True)
def _gather(A, s, changes, sums):
    """Sum what the weighted gap of node A depends on over its points; how many entries."""
    m = 0
    for e in range(max(A - 1, 0), min(A + 1, len(s.slave) - 1)):
        for q in range(3):
            part = 0.5 * (1.0 + POINTS[q])
            N = (part if e == A - 1 else 1.0 - part) * s.weight[e, q] / s.mass[A]
            here = _of(changes, e, q)
            for i in range(LOCAL):
                found = -1
                for j in range(m):
                    if sums.dof[j] == here.dof[i]:
                        found = j
                        break
                if found < 0:
                    found = m
                    sums.dof[m] = here.dof[i]
                    sums.dg[m] = 0.0
                    sums.b[m] = 0.0
                    m += 1
                sums.dg[found] += N * here.dg[i]
                sums.b[found] += N * here.b[i]
    return m


@njit(cache=True)
def _add_friction(A, s, grip, x, pressure, sums, m, out, n):
    """Append the tangent of a node's traction, whose pressure depends on the `m` of `sums`."""
    limit = s.friction * pressure[A]
    held = grip.traction[A] + s.stiffness[A] * slip_of(A, grip, x)
    k = s.stiffness[A] * s.mass[A]
    sticks = abs(held) <= limit
    pull = -k * s.friction * (1.0 if held > 0.0 else -1.0)
    for i in range(grip.n_dofs[A]):
        t = grip.weight[A, i]
        for j in range(grip.n_dofs[A] if sticks else m):
            out.row[n] = grip.dof[A, i]
            out.col[n] = grip.dof[A, j] if sticks else sums.dof[j]
            out.value[n] = k * t * grip.weight[A, j] if sticks else pull * t * sums.dg[j]
            n += 1
    return n


@njit(cache=True)
def _add_stiffness(s, grip, x, pressure, changes, out, n):
    """Append the tangent of pressures and tractions to the `n` triplets in `out`; how many now."""
    sums = Changes(np.empty(_SUPPORT, np.int64), np.empty(_SUPPORT), np.empty(_SUPPORT))
    for A in range(len(pressure)):
        if pressure[A] == 0.0:
            continue
        m = _gather(A, s, changes, sums)
        k = s.stiffness[A] * s.mass[A]
        for i in range(m):
            if sums.b[i] == 0.0:
                continue
            for j in range(m):
                out.row[n] = sums.dof[i]
                out.col[n] = sums.dof[j]
                out.value[n] = k * sums.b[i] * sums.dg[j]
                n += 1
        if len(grip.n_dofs) > 0 and pressure[A] > 0.0:
            n = _add_friction(A, s, grip, x, pressure, sums, m, out, n)
    return n


@njit(cache=True)
def _evaluate(s, grip, x, closed, points, pressure, traction, force, with_tangent, out):
    """Fill points, pressures and tractions, add forces, write triplets.

    Force, energy, work lost in sliding, how many triplets.
    """
    s, grip, points, out = unowned(s), unowned(grip), unowned(points), unowned(out)
    x, pressure, traction, force = (
        unowned(x),
        unowned(pressure),
        unowned(traction),
        unowned(force),
    )
    xm = x[s.master]
    if not find_gaps(s, x[s.slave], xm, points):
        return 0.0, 0.0, 0.0, -1
    total, energy = _find_pressures(s, points.gap, closed, pressure)
    n_edges = len(pressure) - 1
    changes = Changes(
        np.empty((n_edges, 3, LOCAL), np.int64),
        np.empty((n_edges, 3, LOCAL)),
        np.empty((n_edges, 3, LOCAL)),
    )
    n = _add_forces(s, xm, points, pressure, force, changes, with_tangent, out)
    traction[:] = 0.0
    lost = 0.0
    if len(grip.n_dofs) > 0:
        lift, sprung, lost = rub(s, grip, x, pressure, traction, force)
        total += lift
        energy += sprung
    if with_tangent:
        n = _add_stiffness(s, grip, x, pressure, changes, out, n)
    return total, energy, lost, n


def contact_forces(
    surfaces: Surfaces,
    x: Array,
    *,
    force: Array,
    tangent: Triplets | None = None,
    grip: Grip | None = None,
    closed: Mask | None = None,
) -> tuple[ContactState | None, int]:
    """Add the contact forces at the current coordinates `x` (n_nodes, 2) to `force`.

    With a `grip`, those of friction too. Slave nodes that are `closed`, shape (n_slave,), hold the
    other surface even where that takes a pull: a pressure below 0.

    Returned: the contact's state, none when a slave point has left the master surface, and the
    number of triplets written into `tangent`.
    """
    points = SlavePoints.room(len(surfaces.slave) - 1)
    pressure = np.empty(len(surfaces.slave))
    traction = np.empty(len(surfaces.slave))
    room = Triplets.room(0) if tangent is None else tangent
    if closed is None:
        closed = np.zeros(len(pressure), np.bool_)
    total, energy, lost, n = _evaluate(
        surfaces, grip or Grip.none(), x, closed, points, pressure, traction, force,
        tangent is not None, room,
    )  # fmt: skip
    if n < 0:
        return None, 0
    gap, r, segment = points.gap, points.radius, points.segment
    return ContactState(
        pressure, gap, r, segment, float(total), float(energy), traction, float(lost)
    ), n
