"""Internal forces and tangent of the bulk, and the update of the material state.

Four-node quadrilaterals with mean dilatation: the pressure of an element is p = K ln(theta)/theta
with theta the mean of J over its reference volume, the deviator is taken at each of the 2 x 2
points. Both derive from one potential, so the elastic tangent is symmetric; the tangent of the
exact stress update is not, and the full matrix is assembled. The basis values, the quadrature and
the degrees of freedom come from scikit-fem; this file only sums them up.

Eight elements are taken at a time, their points in the lanes of `material.return_map`: lane 8 q + k
is point q of element k.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from ..core.arrays import Array, Integers
from ..core.unowned import unowned
from .elements import Elements, State
from .material import EXACT, exponential
from .material.flow import law_at
from .material.return_map import (
    B0,
    E0,
    E1,
    E2,
    E3,
    F0,
    F1,
    F2,
    F3,
    F4,
    FAST,
    FLOWS,
    G2,
    LAW,
    O0,
    OTHERS,
    P0,
    P1,
    P2,
    P3,
    P4,
    R0,
    SLIP,
    STRAIN,
    TANGENT,
    WORK,
    WORKED,
    L,
    M,
    stresses,
    tangents,
)
from .material.tensor import dot

# limit: determinant of the deformation gradient below which an element is as good as inverted [-]
_SMALLEST_DETERMINANT = 0.02


_ELASTIC = 1e30  # radius of the yield circle of what never yields

DISTORTED = -1
"""Returned by `bulk_forces` when an element has turned inside out."""

_BLOCK = L // 4  # elements

# rows beside those of the points: gradients of the four basis functions by r and z, their values
# over r, volume, pressure, in-plane determinant, gradient of the volume, forces on the nodes
_GR, _GZ, _H, _DV, _PRESSURE, _DET, _V, _FORCE, _K = (
    OTHERS + L * k for k in (0, 4, 8, 12, 13, 14, 15, 23, 31)
)
# the last ones are the elements' tangents, (8, 8, elements)
_NUMBERS = _K + 64 * _BLOCK


class _Room(NamedTuple):
    """Working arrays, which a kernel may not own itself (`unowned`)."""

    rows: Array
    volume: Array  # gradient of the elements' volumes, (8, elements)
    force: Array  # on their nodes, (8, elements)
    theta: Array  # their mean J
    block: Integers  # their numbers

    @classmethod
    def new(cls) -> _Room:
        rows, of_elements = np.zeros(_NUMBERS), np.zeros((2, 8, _BLOCK))
        block = np.zeros(_BLOCK, np.int64)
        return cls(rows, of_elements[0], of_elements[1], np.zeros(_BLOCK), block)


@njit(cache=True, inline="always")
def _linear_element(nodes, K, u, force):
    for a in range(8):
        total = 0.0
        for b in range(8):
            total += K[a, b] * u[2 * nodes[b // 2] + b % 2]
        force[2 * nodes[a // 2] + a % 2] += total


@njit(cache=True)
def _gather(x, u, old, block, w):
    """Fill the given rows of the points of the elements `block`, and those of the elements."""
    for k in range(_BLOCK):
        e = block[k]
        law = x.law[e]
        for q in range(4):
            at = q * _BLOCK + k
            f0, f1, f2, f3, f4 = 1.0, 0.0, 0.0, 1.0, 1.0
            inverse = 1.0 / x.r[e, q]
            for a in range(4):
                i = 2 * x.conn[e, a]
                gr, gz, h = x.grad[e, q, a, 0], x.grad[e, q, a, 1], x.value[q, a] * inverse
                f0 += u[i] * gr
                f1 += u[i] * gz
                f2 += u[i + 1] * gr
                f3 += u[i + 1] * gz
                f4 += u[i] * h
                w[_GR + a * L + at], w[_GZ + a * L + at], w[_H + a * L + at] = gr, gz, h
            w[F0 + at], w[F1 + at], w[F2 + at], w[F3 + at], w[F4 + at] = f0, f1, f2, f3, f4
            for i in range(5):
                w[O0 + i * L + at] = old.F[e, q, i]
            for i in range(4):
                w[B0 + i * L + at] = old.b[e, q, i]
                w[E0 + i * L + at] = old.strain[e, q, i]
            w[_DV + at] = x.dV[e, q]
            w[G2 + at] = 2.0 * x.G[e]
            w[R0 + at] = min(x.radius[e], _ELASTIC)
            w[LAW + at] = law + 1.0
            if law >= 0:
                strain, work = old.peeq[e, q], old.work[e, q]
                w[STRAIN + at], w[WORK + at] = strain, work
                _, w[R0 + at] = law_at(x.laws, law, strain, work, 0.0, math.inf)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _determinants(w):
    """Fill the row of in-plane determinants; whether no point has turned inside out."""
    sound = 0.0
    for at in range(L):
        det = w[F0 + at] * w[F3 + at] - w[F1 + at] * w[F2 + at]
        w[_DET + at] = det
        whole = (det > _SMALLEST_DETERMINANT) & (w[F4 + at] > _SMALLEST_DETERMINANT)
        sound += 1.0 if whole else 0.0
    return sound == L


@njit(cache=True)
def _pressures(x, block, w, theta):
    for k in range(_BLOCK):
        e = block[k]
        J = 0.0
        for at in range(k, L, _BLOCK):
            J += w[_DET + at] * w[F4 + at] * w[_DV + at]
        theta[k] = J / x.volume[e]
        p = x.K[e] * math.log(theta[k]) / theta[k]
        for at in range(k, L, _BLOCK):
            w[_PRESSURE + at] = p


@njit(forceinline=True, error_model="numpy", fastmath=FAST)
def _node_forces(w, a):
    """What each point adds to the volume's gradient and to the forces at node a."""
    for at in range(L):
        dV, p, f4 = w[_DV + at], w[_PRESSURE + at], w[F4 + at]
        gr, gz, h = w[_GR + a * L + at] * dV, w[_GZ + a * L + at] * dV, w[_H + a * L + at] * dV
        v0 = w[F3 + at] * f4 * gr - w[F2 + at] * f4 * gz + w[_DET + at] * h
        v1 = w[F0 + at] * f4 * gz - w[F1 + at] * f4 * gr
        w[_V + 2 * a * L + at], w[_V + (2 * a + 1) * L + at] = v0, v1
        w[_FORCE + 2 * a * L + at] = w[P0 + at] * gr + w[P1 + at] * gz + w[P4 + at] * h + p * v0
        w[_FORCE + (2 * a + 1) * L + at] = w[P2 + at] * gr + w[P3 + at] * gz + p * v1


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _forces(w):
    _node_forces(w, 0)
    _node_forces(w, 1)
    _node_forces(w, 2)
    _node_forces(w, 3)


@njit(forceinline=True)
def _entry(i, j):
    """Row of dP_i/dF_j."""
    return TANGENT + (5 * j + i) * L


@njit(forceinline=True, fastmath=FAST)
def _add_both(w, at, i, j, more):
    w[_entry(i, j) + at] += more
    w[_entry(j, i) + at] += more


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _add_pressure(w):
    """Add p d2J/dF2."""
    for at in range(L):
        p = w[_PRESSURE + at]
        _add_both(w, at, 0, 3, p * w[F4 + at])
        _add_both(w, at, 1, 2, -p * w[F4 + at])
        _add_both(w, at, 0, 4, p * w[F3 + at])
        _add_both(w, at, 3, 4, p * w[F0 + at])
        _add_both(w, at, 1, 4, -p * w[F2 + at])
        _add_both(w, at, 2, 4, -p * w[F1 + at])


@njit(forceinline=True, error_model="numpy", fastmath=FAST)
def _by_u(w, at, i, g):
    """Change of P_i with the displacements (r, z) of a node of the gradients (r, z, hoop) `g`."""
    return (
        w[_entry(i, 0) + at] * g[0] + w[_entry(i, 1) + at] * g[1] + w[_entry(i, 4) + at] * g[2],
        w[_entry(i, 2) + at] * g[0] + w[_entry(i, 3) + at] * g[1],
    )


@njit(forceinline=True, error_model="numpy", fastmath=FAST)
def _couple(w, a, b, at, k, A0, A1, A2, A3, A4):
    gr, gz, h = w[_GR + a * L + at], w[_GZ + a * L + at], w[_H + a * L + at]
    for j in range(2):
        to = _K + (16 * a + 2 * b + j) * _BLOCK + k
        w[to] += gr * A0[j] + gz * A1[j] + h * A4[j]
        w[to + 8 * _BLOCK] += gr * A2[j] + gz * A3[j]


@njit(forceinline=True, error_model="numpy", fastmath=FAST)
def _node_couplings(w, b, q):
    """Add B^T A B of point q, the columns of node b."""
    for k in range(_BLOCK):
        at = q * _BLOCK + k
        dV = w[_DV + at]
        g = (w[_GR + b * L + at] * dV, w[_GZ + b * L + at] * dV, w[_H + b * L + at] * dV)
        A0, A1, A2 = _by_u(w, at, 0, g), _by_u(w, at, 1, g), _by_u(w, at, 2, g)
        A3, A4 = _by_u(w, at, 3, g), _by_u(w, at, 4, g)
        _couple(w, 0, b, at, k, A0, A1, A2, A3, A4)
        _couple(w, 1, b, at, k, A0, A1, A2, A3, A4)
        _couple(w, 2, b, at, k, A0, A1, A2, A3, A4)
        _couple(w, 3, b, at, k, A0, A1, A2, A3, A4)


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _couplings(w):
    for i in range(64 * _BLOCK):
        w[_K + i] = 0.0
    for q in range(4):
        _node_couplings(w, 0, q)
        _node_couplings(w, 1, q)
        _node_couplings(w, 2, q)
        _node_couplings(w, 3, q)


@njit(cache=True, fastmath=FAST)
def _sum_points(w, first, sums):
    """Sum eight rows over the four points of each element."""
    for i in range(8):
        f = first + i * L
        for k in range(_BLOCK):
            one = w[f + k] + w[f + _BLOCK + k]
            sums[i, k] = one + w[f + 2 * _BLOCK + k] + w[f + 3 * _BLOCK + k]


@njit(cache=True)
def _put_forces(x, block, m, sums, force):
    for k in range(m):
        e = block[k]
        for a in range(4):
            i = 2 * x.conn[e, a]
            force[i] += sums[2 * a, k]
            force[i + 1] += sums[2 * a + 1, k]


@njit(cache=True, error_model="numpy")
def _put_tangents(x, block, m, theta, g, w, tangent):
    for k in range(m):
        e = block[k]
        stiff = x.K[e] * (1.0 - math.log(theta[k])) / (theta[k] * theta[k] * x.volume[e])
        T = tangent[e]
        for i in range(8):
            gi = stiff * g[i, k]
            for j in range(8):
                T[i, j] = w[_K + (8 * i + j) * _BLOCK + k] + gi * g[j, k]


@njit(cache=True)
def _assemble(x, u, old, rule, seconds, with_tangent, force, tangent, room):
    x, old, room = unowned(x), unowned(old), unowned(room)
    u, force, tangent = unowned(u), unowned(force), unowned(tangent)
    w, block = room.rows, room.block
    exact = 1.0 if rule == EXACT else 0.0
    n_plastic = 0.0
    n, m = x.conn.shape[0], 0
    for e in range(n + 1):
        if e < n and x.linear[e] >= 0:
            _linear_element(x.conn[e], x.stiffness[x.linear[e]], u, force)
            if with_tangent:
                tangent[e] = x.stiffness[x.linear[e]]
        elif e < n:
            block[m:] = e  # the last block is filled up with its last element, which counts once
            m += 1
        if m == _BLOCK or (e == n and m > 0):
            _gather(x, u, old, block, w)
            if not _determinants(w):
                return DISTORTED
            _pressures(x, block, w, room.theta)
            flows = stresses(w, exact, x.laws, seconds)
            if m < _BLOCK:
                flows = 0.0
                for k in range(m):
                    for at in range(k, L, _BLOCK):
                        flows += w[FLOWS + at]
            n_plastic += flows
            _forces(w)
            _sum_points(w, _V, room.volume)
            _sum_points(w, _FORCE, room.force)
            _put_forces(x, block, m, room.force, force)
            if with_tangent:
                tangents(w)
                _add_pressure(w)
                _couplings(w)
                _put_tangents(x, block, m, room.theta, room.volume, w, tangent)
            m = 0
    return int(n_plastic)


@njit(cache=True)
def _advance(x, u, old, rule, seconds, new, room):
    """Fill the arrays of the state `new`; plastic work of the step and stored energy."""
    x, u, old, new, room = unowned(x), unowned(u), unowned(old), unowned(new), unowned(room)
    w, block = room.rows, room.block
    dissipated, stored = 0.0, 0.0
    n = x.conn.shape[0]
    for first in range(0, n, _BLOCK):
        m = min(_BLOCK, n - first)
        for k in range(_BLOCK):
            block[k] = first + min(k, m - 1)
        _gather(x, u, old, block, w)
        stresses(w, 1.0 if rule == EXACT else 0.0, x.laws, seconds)
        for k in range(m):
            e = block[k]
            J = 0.0
            for q in range(4):
                at = q * _BLOCK + k
                for i in range(5):
                    new.F[e, q, i] = w[F0 + i * L + at]
                J += (w[F0 + at] * w[F3 + at] - w[F1 + at] * w[F2 + at]) * w[F4 + at] * w[_DV + at]
                s = (w[E0 + at], w[E1 + at], w[E2 + at], w[E3 + at])
                b = exponential(s, w[M + at])
                for i in range(4):
                    new.b[e, q, i] = b[i]
                    new.strain[e, q, i] = s[i]
                work = w[G2 + at] * w[WORKED + at] * w[SLIP + at]
                new.peeq[e, q] = old.peeq[e, q] + math.sqrt(2.0 / 3.0) * w[SLIP + at]
                new.work[e, q] = old.work[e, q] + work
                dissipated += work * w[_DV + at]
                stored += 0.5 * w[G2 + at] * dot(s, s) * w[_DV + at]
            log_theta = math.log(J / x.volume[e])
            stored += 0.5 * x.K[e] * log_theta * log_theta * x.volume[e]
    return dissipated, stored


def bulk_forces(
    elements: Elements,
    u: Array,
    *,
    state: State,
    rule: int,
    force: Array,
    tangent: Array | None = None,
    seconds: float = math.inf,
) -> int:
    """Add the internal forces at displacement `u` to `force`, and fill the element tangents.

    - `elements`: the mesh's constants.
    - `u`: displacements (r, z) node by node, shape (2 n_nodes,) [R].
    - `state`: material state at the last accepted step.
    - `rule`: stress update, `material.RADIAL` or `material.EXACT`.
    - `seconds`: time since the last accepted step, for what feels the rate [s]; `inf`: slow.
    - `force`: array that the forces are added to, shape (2 n_nodes,) [E' R^2].
    - `tangent`: array for the element tangents, shape (n_elements, 8, 8) [E' R]; none: forces only.

    Returned: number of plastic points, or `DISTORTED`.
    """
    into = tangent if tangent is not None else np.empty((0, 8, 8))
    code = _assemble(
        elements, u, state, rule, seconds, tangent is not None, force, into, _Room.new()
    )
    return int(code)


def advance(
    elements: Elements, u: Array, *, state: State, rule: int, seconds: float = math.inf
) -> tuple[State, float]:
    """Return the material state at the converged displacement `u`, and the stored energy."""
    new = state.room()
    dissipated, stored = _advance(elements, u, state, rule, seconds, new, _Room.new())
    return new._replace(dissipated=state.dissipated + dissipated), float(stored)
