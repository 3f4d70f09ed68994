"""Frictionless contact of the two deforming surfaces by node-weighted (mortar) gaps.

The sphere's surface is the slave side, piecewise linear; the flat's surface is the master side,
smoothed to a C1 curve by uniform Catmull-Rom segments through its nodes, with the mirror image of
the first node beyond the axis. The gap at a slave point is vertical, g = z_sphere(r) - z_flat(r) at
equal current r; because the point slides along the master curve as it moves, the contact force
comes out normal to that curve all the same.

The gap of slave node A is the mean G_A = int N_A g dA / int N_A dA over the reference area
2 pi R dR, its pressure p_A = max(0, -eps_A G_A). The forces are the derivative of
1/2 sum eps_A m_A <-G_A>^2, so the tangent is symmetric and the sum of the pressures is the vertical
force exactly.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

POINTS = np.array([-math.sqrt(0.6), 0.0, math.sqrt(0.6)])
WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18.0
_LOCAL = 12  # degrees of freedom that a slave point's gap depends on
_SUPPORT = 96  # room for those that a node's weighted gap depends on


@dataclass(frozen=True)
class Surfaces:
    """The two surfaces that may touch (constants of a solve).

    Parameters
    ----------
    slave, master
        Node numbers ordered from the axis outwards.
    weight
        Reference area of the slave points, shape (n_edges, 3).
    mass
        int N_A dA, shape (n_slave,).
    stiffness
        Penalty stiffness eps_A, shape (n_slave,) [E'/R].
    """

    slave: Integers
    master: Integers
    weight: Floats
    mass: Floats
    stiffness: Floats

    @classmethod
    def build(
        cls, points: Floats, *, slave: Integers, master: Integers, penalty: float
    ) -> Surfaces:
        """Set up from the node coordinates (n_nodes, 2); `penalty` in E' over the edge length."""
        r = points[slave, 0]
        length = np.diff(r)
        s = 0.5 * (1.0 + POINTS)
        weight = 2.0 * math.pi * (r[:-1, None] + length[:, None] * s) * length[:, None] * WEIGHTS
        mass = np.zeros(len(r))
        mass[:-1] += (weight * (1.0 - s)).sum(axis=1)
        mass[1:] += (weight * s).sum(axis=1)
        edge = np.maximum(np.append(length, 0.0), np.insert(length, 0, 0.0))
        return cls(slave, master, weight, mass, penalty / edge)


@dataclass(frozen=True)
class ContactState:
    """What one evaluation of the contact gives.

    Parameters
    ----------
    pressure
        Nodal pressures p_A on the reference area, shape (n_slave,) [E'].
    gap, r
        Gap and current radius of the slave points, shape (n_edges, 3) [R].
    segment
        Master segment under each slave point, shape (n_edges, 3).
    force
        Vertical contact force [E' R^2].
    energy
        Penalty energy [E' R^3].
    """

    pressure: Floats
    gap: Floats
    r: Floats
    segment: Integers
    force: float
    energy: float


@njit(cache=True)
def _catmull_rom(t, W, W1, W2):
    t2 = t * t
    t3 = t2 * t
    W[0] = 0.5 * (-t3 + 2.0 * t2 - t)
    W[1] = 0.5 * (3.0 * t3 - 5.0 * t2 + 2.0)
    W[2] = 0.5 * (-3.0 * t3 + 4.0 * t2 + t)
    W[3] = 0.5 * (t3 - t2)
    W1[0] = 0.5 * (-3.0 * t2 + 4.0 * t - 1.0)
    W1[1] = 0.5 * (9.0 * t2 - 10.0 * t)
    W1[2] = 0.5 * (-9.0 * t2 + 8.0 * t + 1.0)
    W1[3] = 0.5 * (3.0 * t2 - 2.0 * t)
    W2[0] = -3.0 * t + 2.0
    W2[1] = 9.0 * t - 5.0
    W2[2] = -9.0 * t + 4.0
    W2[3] = 3.0 * t - 1.0


@njit(cache=True)
def _gaps(xs, xm, segment, position, gap, radius):
    """Gap of every slave point; False when a point has left the master surface."""
    W = np.empty(4)
    W1 = np.empty(4)
    W2 = np.empty(4)
    last = xm.shape[0] - 3
    k = 0
    for e in range(xs.shape[0] - 1):
        for q in range(3):
            s = 0.5 * (1.0 + POINTS[q])
            r = (1.0 - s) * xs[e, 0] + s * xs[e + 1, 0]
            z = (1.0 - s) * xs[e, 1] + s * xs[e + 1, 1]
            while k < last and xm[k + 1, 0] < r:
                k += 1
            while k > 0 and xm[k, 0] > r:
                k -= 1
            if xm[k + 1, 0] < r:
                return False
            r0 = -xm[1, 0] if k == 0 else xm[k - 1, 0]
            z0 = xm[1, 1] if k == 0 else xm[k - 1, 1]
            t = (r - xm[k, 0]) / (xm[k + 1, 0] - xm[k, 0])
            for _ in range(30):
                _catmull_rom(t, W, W1, W2)
                f = W[0] * r0 + W[1] * xm[k, 0] + W[2] * xm[k + 1, 0] + W[3] * xm[k + 2, 0] - r
                d = W1[0] * r0 + W1[1] * xm[k, 0] + W1[2] * xm[k + 1, 0] + W1[3] * xm[k + 2, 0]
                t -= f / d
                if abs(f) < 1e-15 * r:
                    break
            _catmull_rom(t, W, W1, W2)
            segment[e, q] = k
            position[e, q] = t
            gap[e, q] = z - (
                W[0] * z0 + W[1] * xm[k, 1] + W[2] * xm[k + 1, 1] + W[3] * xm[k + 2, 1]
            )
            radius[e, q] = r
    return True


@njit(cache=True)
def _point_derivatives(e, q, k, t, xm, slave, master, W, W1, W2, dof, dg, dt, dz):
    """First derivatives of the gap at one slave point, and what its second derivative needs.

    dof, dg, dt, dz have 12 entries: degree of freedom, d gap, d t and W'_j (dz_j - slope dr_j).
    Returns the curvature term z'' - slope r''.
    """
    s = 0.5 * (1.0 + POINTS[q])
    _catmull_rom(t, W, W1, W2)
    mirrored = k == 0
    first = 1 if mirrored else k - 1
    sign = -1.0 if mirrored else 1.0
    r1 = sign * W1[0] * xm[first, 0]
    r2 = sign * W2[0] * xm[first, 0]
    z1 = W1[0] * xm[first, 1]
    z2 = W2[0] * xm[first, 1]
    for j in range(1, 4):
        r1 += W1[j] * xm[k - 1 + j, 0]
        r2 += W2[j] * xm[k - 1 + j, 0]
        z1 += W1[j] * xm[k - 1 + j, 1]
        z2 += W2[j] * xm[k - 1 + j, 1]
    slope = z1 / r1
    for n in range(2):
        N = s if n == 1 else 1.0 - s
        i = slave[e + n]
        dof[2 * n] = 2 * i
        dof[2 * n + 1] = 2 * i + 1
        dt[2 * n] = N / r1
        dt[2 * n + 1] = 0.0
        dz[2 * n] = 0.0
        dz[2 * n + 1] = 0.0
        dg[2 * n] = -slope * N
        dg[2 * n + 1] = N
    for j in range(4):
        node = first if j == 0 else k - 1 + j
        sg = sign if j == 0 else 1.0
        i = master[node]
        p = 4 + 2 * j
        dof[p] = 2 * i
        dof[p + 1] = 2 * i + 1
        dt[p] = -sg * W[j] / r1
        dt[p + 1] = 0.0
        dz[p] = -slope * sg * W1[j]
        dz[p + 1] = W1[j]
        dg[p] = slope * sg * W[j]
        dg[p + 1] = -W[j]
    return z2 - slope * r2


@njit(cache=True)
def _evaluate(
    xs, xm, slave, master, weight, mass, stiffness,
    segment, position, gap, radius, pressure, force, with_tangent, row, col, value,
):  # fmt: skip
    if not _gaps(xs, xm, segment, position, gap, radius):
        return 0.0, 0.0, -1
    n_edges = gap.shape[0]
    n_nodes = n_edges + 1
    for A in range(n_nodes):
        pressure[A] = 0.0
    for e in range(n_edges):
        for q in range(3):
            s = 0.5 * (1.0 + POINTS[q])
            pressure[e] += (1.0 - s) * weight[e, q] * gap[e, q]
            pressure[e + 1] += s * weight[e, q] * gap[e, q]
    energy = 0.0
    total = 0.0
    for A in range(n_nodes):
        pressure[A] = max(0.0, -stiffness[A] * pressure[A] / mass[A])
        energy += 0.5 * mass[A] * pressure[A] ** 2 / stiffness[A]
        total += mass[A] * pressure[A]
    W = np.empty(4)
    W1 = np.empty(4)
    W2 = np.empty(4)
    dt = np.empty(_LOCAL)
    dz = np.empty(_LOCAL)
    dofs = np.empty((n_edges, 3, _LOCAL), np.int64)
    dgs = np.empty((n_edges, 3, _LOCAL))
    n = 0
    for e in range(n_edges):
        if pressure[e] == 0.0 and pressure[e + 1] == 0.0:
            continue
        for q in range(3):
            dof = dofs[e, q]
            dg = dgs[e, q]
            curvature = _point_derivatives(
                e, q, segment[e, q], position[e, q], xm, slave, master, W, W1, W2, dof, dg, dt, dz
            )
            s = 0.5 * (1.0 + POINTS[q])
            p = ((1.0 - s) * pressure[e] + s * pressure[e + 1]) * weight[e, q]
            for i in range(_LOCAL):
                force[dof[i]] -= p * dg[i]
            if with_tangent:
                for i in range(_LOCAL):
                    for j in range(_LOCAL):
                        v = p * (dz[i] * dt[j] + dt[i] * dz[j] + curvature * dt[i] * dt[j])
                        if v != 0.0:
                            row[n] = dof[i]
                            col[n] = dof[j]
                            value[n] = v
                            n += 1
    if not with_tangent:
        return total, energy, 0
    support = np.empty(_SUPPORT, np.int64)
    dG = np.empty(_SUPPORT)
    for A in range(n_nodes):
        if pressure[A] <= 0.0:
            continue
        m = 0
        for e in range(max(A - 1, 0), min(A + 1, n_edges)):
            for q in range(3):
                s = 0.5 * (1.0 + POINTS[q])
                N = (s if e == A - 1 else 1.0 - s) * weight[e, q] / mass[A]
                for i in range(_LOCAL):
                    found = -1
                    for j in range(m):
                        if support[j] == dofs[e, q, i]:
                            found = j
                            break
                    if found < 0:
                        found = m
                        support[m] = dofs[e, q, i]
                        dG[m] = 0.0
                        m += 1
                    dG[found] += N * dgs[e, q, i]
        k = stiffness[A] * mass[A]
        for i in range(m):
            for j in range(m):
                row[n] = support[i]
                col[n] = support[j]
                value[n] = k * dG[i] * dG[j]
                n += 1
    return total, energy, n


@dataclass(frozen=True)
class Triplets:
    """Room for the contact tangent as (row, column, value)."""

    row: Integers
    col: Integers
    value: Floats

    @classmethod
    def for_surfaces(cls, surfaces: Surfaces) -> Triplets:
        """Allocate enough for every slave node in contact."""
        n = len(surfaces.slave) * 1500
        return cls(np.empty(n, np.int64), np.empty(n, np.int64), np.empty(n))


def contact_forces(
    surfaces: Surfaces, x: Floats, *, force: Floats, tangent: Triplets | None = None
) -> tuple[ContactState | None, int]:
    """Add the contact forces at the current coordinates `x` (n_nodes, 2) to `force`.

    Returns
    -------
    tuple
        The contact's state, none when a slave point has left the master surface, and the number of
        triplets written into `tangent`.
    """
    n_edges = len(surfaces.slave) - 1
    segment = np.empty((n_edges, 3), np.int64)
    position, gap, radius = (np.empty((n_edges, 3)) for _ in range(3))
    pressure = np.empty(n_edges + 1)
    room = tangent or Triplets(np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0))
    total, energy, n = _evaluate(
        x[surfaces.slave], x[surfaces.master], surfaces.slave, surfaces.master,
        surfaces.weight, surfaces.mass, surfaces.stiffness,
        segment, position, gap, radius, pressure, force,
        tangent is not None, room.row, room.col, room.value,
    )  # fmt: skip
    if n < 0:
        return None, 0
    return ContactState(pressure, gap, radius, segment, float(total), float(energy)), n
