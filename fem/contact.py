"""Frictionless contact of the two deforming surfaces by node-weighted (mortar) gaps.

The surface of the weaker body is the slave side, the other's the master side: the other way round,
steps fail and take twice the iterations. For the gap both are smoothed to C1 curves of cubic
segments through their nodes, whose slopes at the nodes are those of parabolas through three
neighbours; the first node has its mirror image beyond the axis. The gap at a slave point is
vertical, g = z_sphere(r) - z_flat(r) at equal current r.

The gap of slave node A is the mean G_A = int N_A g dA / int N_A dA over the reference area
2 pi R dR, its pressure p_A = max(0, -eps_A G_A), so the sum of the pressures is the vertical force
exactly. The force of a point acts normal to the master curve; on each body it goes to the two nodes
of the straight segment, as the elements' own functions have it: a uniform pressure then gives both
bodies the loads of a uniform pressure, whatever the size of their elements, which the weights of
the smooth curves would not. The tangent is therefore not symmetric.
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
_LOCAL = 16  # degrees of freedom that a slave point's gap depends on
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
    sign
        1 if the sphere is the slave side, -1 if the flat is.
    slave_shape, master_shape
        How the slopes at the ends of a segment, in units of its length, follow from the differences
        between its four nodes, shape (n_slave - 1, 4) and (n_master - 1, 4).
    """

    slave: Integers
    master: Integers
    weight: Floats
    mass: Floats
    stiffness: Floats
    slave_shape: Floats
    master_shape: Floats
    sign: float = 1.0

    @property
    def sphere(self) -> Integers:
        """Surface nodes of the sphere."""
        return self.slave if self.sign > 0.0 else self.master

    @property
    def flat(self) -> Integers:
        """Surface nodes of the flat."""
        return self.master if self.sign > 0.0 else self.slave

    @classmethod
    def build(
        cls,
        points: Floats,
        *,
        sphere: Integers,
        flat: Integers,
        penalty: float,
        flat_is_slave: bool,
    ) -> Surfaces:
        """Set up the two surfaces.

        Parameters
        ----------
        points
            Node coordinates, shape (n_nodes, 2) [R].
        sphere, flat
            Their surface nodes from the axis outwards.
        penalty
            Contact stiffness in E' over the edge length.
        flat_is_slave
            Which side is which.
        """
        slave, master = (flat, sphere) if flat_is_slave else (sphere, flat)
        if flat_is_slave:  # as far as the sphere's surface lies above it
            slave = slave[points[slave, 0] < 0.98 * points[master[-1], 0]]
        r = points[slave, 0]
        length = np.diff(r)
        s = 0.5 * (1.0 + POINTS)
        weight = 2.0 * math.pi * (r[:-1, None] + length[:, None] * s) * length[:, None] * WEIGHTS
        mass = np.zeros(len(r))
        mass[:-1] += (weight * (1.0 - s)).sum(axis=1)
        mass[1:] += (weight * s).sum(axis=1)
        edge = np.maximum(np.append(length, 0.0), np.insert(length, 0, 0.0))
        slave_shape, master_shape = _slopes(r), _slopes(points[master, 0])
        sign = -1.0 if flat_is_slave else 1.0
        return cls(slave, master, weight, mass, penalty / edge, slave_shape, master_shape, sign)


def _slopes(r: Floats) -> Floats:
    """Weights of the node differences in the segments' end slopes: exact for a parabola in r."""
    length = np.diff(r)
    before = np.insert(length[:-1], 0, length[0])  # the mirror image beyond the axis
    after = np.append(length[1:], length[-1])
    shape = np.stack(
        [
            length**2 / (before * (before + length)),
            before / (before + length),
            after / (length + after),
            length**2 / (after * (length + after)),
        ],
        axis=1,
    )
    shape[-1, 2:] = 1.0, 0.0  # no node beyond the last
    return shape


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
def _curve(t, shape, W, W1, W2):
    """Weights of the four nodes about a master segment at t, with first and second derivative."""
    # cubic Hermite functions of the two ends' slopes, and the rest is H(end) = 1 - H(start)
    t2 = t * t
    t3 = t2 * t
    end = 3.0 * t2 - 2.0 * t3
    end1 = 6.0 * (t - t2)
    end2 = 6.0 - 12.0 * t
    near = t3 - 2.0 * t2 + t
    near1 = 3.0 * t2 - 4.0 * t + 1.0
    near2 = 6.0 * t - 4.0
    far = t3 - t2
    far1 = 3.0 * t2 - 2.0 * t
    far2 = 6.0 * t - 2.0
    a, b, c, d = shape
    W[0] = -a * near
    W[1] = 1.0 - end + (a - b) * near - c * far
    W[2] = end + b * near + (c - d) * far
    W[3] = d * far
    W1[0] = -a * near1
    W1[1] = -end1 + (a - b) * near1 - c * far1
    W1[2] = end1 + b * near1 + (c - d) * far1
    W1[3] = d * far1
    W2[0] = -a * near2
    W2[1] = -end2 + (a - b) * near2 - c * far2
    W2[2] = end2 + b * near2 + (c - d) * far2
    W2[3] = d * far2


@njit(cache=True)
def _gaps(xs, xm, shape_s, shape, sign, segment, position, gap, radius):
    """Gap of every slave point; False when a point has left the master surface."""
    W = np.empty(4)
    W1 = np.empty(4)
    W2 = np.empty(4)
    last = xm.shape[0] - 2
    k = 0
    for e in range(xs.shape[0] - 1):
        for q in range(3):
            _curve(0.5 * (1.0 + POINTS[q]), shape_s[e], W, W1, W2)
            r = -W[0] * xs[1, 0] if e == 0 else W[0] * xs[e - 1, 0]
            z = W[0] * xs[1 if e == 0 else e - 1, 1]
            for j in range(1, 4):
                node = min(e - 1 + j, xs.shape[0] - 1)
                r += W[j] * xs[node, 0]
                z += W[j] * xs[node, 1]
            while k < last and xm[k + 1, 0] < r:
                k += 1
            while k > 0 and xm[k, 0] > r:
                k -= 1
            if xm[k + 1, 0] < r:
                return False
            r0 = -xm[1, 0] if k == 0 else xm[k - 1, 0]
            z0 = xm[1, 1] if k == 0 else xm[k - 1, 1]
            n = min(k + 2, last + 1)  # beyond the last node the weight is zero
            t = (r - xm[k, 0]) / (xm[k + 1, 0] - xm[k, 0])
            for _ in range(30):
                _curve(t, shape[k], W, W1, W2)
                f = W[0] * r0 + W[1] * xm[k, 0] + W[2] * xm[k + 1, 0] + W[3] * xm[n, 0] - r
                d = W1[0] * r0 + W1[1] * xm[k, 0] + W1[2] * xm[k + 1, 0] + W1[3] * xm[n, 0]
                t -= f / d
                if abs(f) < 1e-15 * r:
                    break
            _curve(t, shape[k], W, W1, W2)
            segment[e, q] = k
            position[e, q] = t
            gap[e, q] = sign * (
                z - (W[0] * z0 + W[1] * xm[k, 1] + W[2] * xm[k + 1, 1] + W[3] * xm[n, 1])
            )
            radius[e, q] = r
    return True


@njit(cache=True)
def _point_derivatives(
    e, q, k, t, r, xs, xm, shape_s, shape, slave, master, W, W1, W2, dof, dg, b, db
):  # fmt: skip
    """Change of the gap and of the directions of force at one slave point.

    The point depends on 16 degrees of freedom `dof`: r and z of four slave and four master nodes.
    dg is the gradient of the gap (16,), b the share of the point's force that each takes (16,), and
    db the derivative of b (16, 16).
    """
    s = 0.5 * (1.0 + POINTS[q])
    _curve(t, shape[k], W, W1, W2)
    mirrored = k == 0
    first = 1 if mirrored else k - 1
    sign = -1.0 if mirrored else 1.0
    r1 = sign * W1[0] * xm[first, 0]
    r2 = sign * W2[0] * xm[first, 0]
    z1 = W1[0] * xm[first, 1]
    z2 = W2[0] * xm[first, 1]
    for j in range(1, 4):
        node = min(k - 1 + j, xm.shape[0] - 1)
        r1 += W1[j] * xm[node, 0]
        r2 += W2[j] * xm[node, 0]
        z1 += W1[j] * xm[node, 1]
        z2 += W2[j] * xm[node, 1]
    slope = z1 / r1
    bend = (z2 - slope * r2) / r1
    length = xm[k + 1, 0] - xm[k, 0]
    tau = (r - xm[k, 0]) / length
    dslope = np.zeros(_LOCAL)
    dtau = np.zeros(_LOCAL)
    for i in range(_LOCAL):
        b[i] = 0.0
        for j in range(_LOCAL):
            db[i, j] = 0.0
    for j in range(4):
        node = first if j == 0 else min(k - 1 + j, xm.shape[0] - 1)
        sg = sign if j == 0 else 1.0
        i = 8 + 2 * j
        dof[i] = 2 * master[node]
        dof[i + 1] = dof[i] + 1
        dg[i] = slope * sg * W[j]
        dg[i + 1] = -W[j]
        dslope[i] = sg * (-slope * W1[j] - bend * W[j]) / r1
        dslope[i + 1] = W1[j] / r1
    _curve(s, shape_s[e], W, W1, W2)
    for j in range(4):
        node = 1 if j == 0 and e == 0 else min(e - 1 + j, xs.shape[0] - 1)
        sg = -1.0 if j == 0 and e == 0 else 1.0
        i = 2 * j
        dof[i] = 2 * slave[node]
        dof[i + 1] = dof[i] + 1
        dg[i] = -slope * sg * W[j]
        dg[i + 1] = W[j]
        dslope[i] = bend * sg * W[j] / r1
        dtau[i] = sg * W[j] / length
    dtau[10] = -(1.0 - tau) / length
    dtau[12] = -tau / length
    for n in range(2):
        N = s if n == 1 else 1.0 - s
        L = tau if n == 1 else 1.0 - tau
        turn = 1.0 if n == 1 else -1.0
        i = 2 + 2 * n
        m = 10 + 2 * n
        b[i] = -slope * N
        b[i + 1] = N
        b[m] = slope * L
        b[m + 1] = -L
        for j in range(_LOCAL):
            db[i, j] = -N * dslope[j]
            db[m, j] = L * dslope[j] + slope * turn * dtau[j]
            db[m + 1, j] = -turn * dtau[j]


@njit(cache=True)
def _evaluate(
    xs, xm, slave, master, shape_s, shape, sign, weight, mass, stiffness,
    segment, position, gap, radius, pressure, force, with_tangent, row, col, value,
):  # fmt: skip
    if not _gaps(xs, xm, shape_s, shape, sign, segment, position, gap, radius):
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
    db = np.empty((_LOCAL, _LOCAL))
    dofs = np.empty((n_edges, 3, _LOCAL), np.int64)
    dgs = np.empty((n_edges, 3, _LOCAL))
    bs = np.empty((n_edges, 3, _LOCAL))
    n = 0
    for e in range(n_edges):
        if pressure[e] == 0.0 and pressure[e + 1] == 0.0:
            continue
        for q in range(3):
            dof = dofs[e, q]
            b = bs[e, q]
            _point_derivatives(
                e, q, segment[e, q], position[e, q], radius[e, q], xs, xm, shape_s, shape,
                slave, master, W, W1, W2, dof, dgs[e, q], b, db,
            )  # fmt: skip
            for i in range(_LOCAL):
                dgs[e, q, i] *= sign
                b[i] *= sign
            s = 0.5 * (1.0 + POINTS[q])
            p = ((1.0 - s) * pressure[e] + s * pressure[e + 1]) * weight[e, q]
            for i in range(_LOCAL):
                force[dof[i]] -= p * b[i]
            if with_tangent:
                for i in range(_LOCAL):
                    for j in range(_LOCAL):
                        if db[i, j] != 0.0:
                            row[n] = dof[i]
                            col[n] = dof[j]
                            value[n] = -p * sign * db[i, j]
                            n += 1
    if not with_tangent:
        return total, energy, 0
    support = np.empty(_SUPPORT, np.int64)
    dG = np.empty(_SUPPORT)
    B = np.empty(_SUPPORT)
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
                        B[m] = 0.0
                        m += 1
                    dG[found] += N * dgs[e, q, i]
                    B[found] += N * bs[e, q, i]
        k = stiffness[A] * mass[A]
        for i in range(m):
            if B[i] == 0.0:
                continue
            for j in range(m):
                row[n] = support[i]
                col[n] = support[j]
                value[n] = k * B[i] * dG[j]
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
        surfaces.slave_shape, surfaces.master_shape, surfaces.sign,
        surfaces.weight, surfaces.mass, surfaces.stiffness,
        segment, position, gap, radius, pressure, force,
        tangent is not None, room.row, room.col, room.value,
    )  # fmt: skip
    if n < 0:
        return None, 0
    return ContactState(pressure, gap, radius, segment, float(total), float(energy)), n
