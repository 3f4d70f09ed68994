"""Coulomb friction between the surfaces: what holds the slave nodes to what they touched last.

In a body of revolution that is pressed straight down the surfaces slide along the meridian alone.
The slip of slave node A in a step is the mean of its points' moves against the place of the master
surface that each lay above when the step began, along that surface. A node sticks by a stiff spring
until its traction reaches mu times its pressure, then it slides under that traction. Places and
directions stand still during a step, so slip is linear in the displacements.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ...core.arrays import Array, Integers
from .gap import SlavePoints, curve, find_gaps, new_weights
from .point import frame_below
from .surfaces import POINTS, Surfaces

_SUPPORT = 96  # room for the degrees of freedom that the slip of a node depends on


class Grip(NamedTuple):
    """How the slave nodes held when the last step ended; a frictionless one has no nodes.

    - `dof`, `weight`: slip of a node by the moves of its degrees of freedom, shape (n_slave, 96).
    - `n_dofs`: how many of them, shape (n_slave,).
    - `x`: coordinates of all nodes then, shape (n_nodes, 2) [R].
    - `traction`: tangential traction on the reference area, shape (n_slave,) [E'].
    """

    dof: Integers
    weight: Array
    n_dofs: Integers
    x: Array
    traction: Array

    @classmethod
    def none(cls) -> Grip:
        """No friction."""
        return cls(
            np.empty((0, 0), np.int64), np.empty((0, 0)), np.empty(0, np.int64),
            np.empty((0, 2)), np.empty(0),
        )  # fmt: skip


def take_hold(surfaces: Surfaces, x: Array, traction: Array) -> Grip:
    """Return the grip at coordinates `x` (n_nodes, 2) and nodal tractions (n_slave,)."""
    if surfaces.friction == 0.0:
        return Grip.none()
    n = len(surfaces.slave)
    points = SlavePoints.room(n - 1)
    grip = Grip(
        np.empty((n, _SUPPORT), np.int64), np.zeros((n, _SUPPORT)), np.zeros(n, np.int64),
        x.copy(), traction.copy(),
    )  # fmt: skip
    xm = x[surfaces.master]
    if find_gaps(surfaces, x[surfaces.slave], xm, points):
        _hold(surfaces, xm, points, grip)
    return grip


@njit(cache=True)
def _add(grip, A, dof, weight):
    for j in range(grip.n_dofs[A]):
        if grip.dof[A, j] == dof:
            grip.weight[A, j] += weight
            return
    j = grip.n_dofs[A]
    grip.dof[A, j] = dof
    grip.weight[A, j] = weight
    grip.n_dofs[A] += 1


@njit(cache=True)
def _hold(s, xm, points, grip):
    """Fill the slip's weights: on both bodies those of the straight segments, as for pressures."""
    w = new_weights()
    for e in range(len(s.slave) - 1):
        for q in range(3):
            k = points.segment[e, q]
            curve(points.position[e, q], s.master_shape[k], w)
            frame = frame_below(k, points.radius[e, q], xm, w)
            part = 0.5 * (1.0 + POINTS[q])
            for side in range(2):
                A = e + side
                N = (part if side == 1 else 1.0 - part) * s.weight[e, q] / s.mass[A]
                for end in range(2):
                    on_slave = N * (part if end == 1 else 1.0 - part)
                    on_master = -N * (frame.tau if end == 1 else 1.0 - frame.tau)
                    for node, share in (
                        (s.slave[e + end], on_slave),
                        (s.master[k + end], on_master),
                    ):
                        _add(grip, A, 2 * node, share)
                        _add(grip, A, 2 * node + 1, share * frame.slope)


@njit(cache=True)
def slip_of(A, grip, x):
    """Slip of slave node A since the grip was taken."""
    slip = 0.0
    for j in range(grip.n_dofs[A]):
        node, axis = divmod(grip.dof[A, j], 2)
        slip += grip.weight[A, j] * (x[node, axis] - grip.x[node, axis])
    return slip


@njit(cache=True)
def rub(s, grip, x, pressure, traction, force):
    """Fill the nodal tractions and add their forces.

    Vertical force on the sphere, energy of the springs, work lost in sliding.
    """
    total = 0.0
    energy = 0.0
    lost = 0.0
    for A in range(len(traction)):
        traction[A] = 0.0
        if pressure[A] <= 0.0:
            continue
        slip = slip_of(A, grip, x)
        limit = s.friction * pressure[A]
        held = grip.traction[A] + s.stiffness[A] * slip
        traction[A] = min(max(held, -limit), limit)
        sprung = (traction[A] - grip.traction[A]) / s.stiffness[A]
        lost += s.mass[A] * traction[A] * (slip - sprung)
        energy += 0.5 * s.mass[A] * traction[A] ** 2 / s.stiffness[A]
        for j in range(grip.n_dofs[A]):
            dof = grip.dof[A, j]
            f = s.mass[A] * traction[A] * grip.weight[A, j]
            force[dof] += f
            # the slave's part of a node's slip has the sign of its weight on r
            if dof % 2 == 1 and _is_slave(s, A, dof // 2):
                total -= s.sign * f
    return total, energy, lost


@njit(cache=True)
def _is_slave(s, A, node):
    for B in range(max(A - 1, 0), min(A + 2, len(s.slave))):
        if s.slave[B] == node:
            return True
    return False
