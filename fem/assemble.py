"""Internal forces and tangent of the bulk, and the update of the material state.

Four-node quadrilaterals with mean dilatation: the pressure of an element is p = K ln(theta)/theta
with theta the mean of J over its reference volume, the deviator is taken at each of the 2 x 2
points. Both derive from one potential, so the elastic tangent is symmetric; the tangent of the
exact stress update is not, and the full matrix is assembled. The basis values, the quadrature and
the degrees of freedom come from scikit-fem; this file only sums them up.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from ..core.arrays import Array
from ..core.unowned import unowned
from .elements import Elements, State, gradient
from .material import (
    NO_LAW,
    MaterialStep,
    deviatoric_pk1,
    deviatoric_tangent,
    elastic_deviator,
    exponential,
    hardened,
    law_of,
)
from .material.tensor import norm
from .rules import RULES

_SMALLEST_DETERMINANT = RULES.least_determinant

_KEEPS = RULES.tangent_kept

DISTORTED = -1
"""Returned by `bulk_forces` when an element has turned inside out."""


class _Room(NamedTuple):
    """Working arrays of one element, which a kernel may not own itself (`unowned`)."""

    F: Array  # deformation gradients
    P: Array  # stress of a point
    A: Array  # and its tangent
    g: Array  # gradient of the element's volume
    fe: Array  # forces on its nodes
    curve: Array  # of a body that does not harden

    @classmethod
    def new(cls) -> _Room:
        shapes = ((4, 5), 5, (5, 5), 8, 8, (3, 0))
        return cls(*(np.empty(shape) for shape in shapes))


@njit(cache=True, inline="always")
def _linear_element(nodes, K, u, force):
    for a in range(8):
        total = 0.0
        for b in range(8):
            total += K[a, b] * u[2 * nodes[b // 2] + b % 2]
        force[2 * nodes[a // 2] + a % 2] += total


@njit(cache=True, inline="always")
def _mean_dilatation(x, u, e, F):
    """Mean of J over element e, the deformation gradients going to `F`; -1 if turned inside out."""
    J_sum = 0.0
    for q in range(4):
        gradient(x, u, e, q, F[q])
        det = F[q, 0] * F[q, 3] - F[q, 1] * F[q, 2]
        if not (det > _SMALLEST_DETERMINANT and F[q, 4] > _SMALLEST_DETERMINANT):
            return -1.0
        J_sum += det * F[q, 4] * x.dV[e, q]
    return J_sum / x.volume[e]


@njit(cache=True, inline="always")
def _step(x, old, rule, e, q, F):
    # tuples of numbers: arrays in them would be counted at every call
    G, b, s = old.F[e, q], old.b[e, q], old.strain[e, q]
    return MaterialStep(
        (F[0], F[1], F[2], F[3], F[4]),
        (G[0], G[1], G[2], G[3], G[4]),
        (b[0], b[1], b[2], b[3]),
        (s[0], s[1], s[2], s[3]),
        x.radius[e],
        rule,
        False,
        NO_LAW,
    )


@njit(cache=True, inline="always")
def _add_point_forces(x, e, q, F, P, p, g, fe):
    """Add the forces of one point to `fe` (8,), and the gradient of its volume to `g` (8,)."""
    c0 = F[3] * F[4]
    c1 = -F[2] * F[4]
    c2 = -F[1] * F[4]
    c3 = F[0] * F[4]
    c4 = F[0] * F[3] - F[1] * F[2]
    w = x.dV[e, q]
    for a in range(4):
        gr = x.grad[e, q, a, 0] * w
        gz = x.grad[e, q, a, 1] * w
        h = x.value[q, a] / x.r[e, q] * w
        v0 = c0 * gr + c1 * gz + c4 * h
        v1 = c2 * gr + c3 * gz
        g[2 * a] += v0
        g[2 * a + 1] += v1
        fe[2 * a] += P[0] * gr + P[1] * gz + P[4] * h + p * v0
        fe[2 * a + 1] += P[2] * gr + P[3] * gz + p * v1


@njit(cache=True, inline="always")
def _add_point_tangent(x, e, q, F, p, A, K):
    """Add B^T (A + p d2J/dF2) B of one point to the element tangent `K` (8, 8)."""
    A[0, 3] += p * F[4]
    A[3, 0] += p * F[4]
    A[1, 2] -= p * F[4]
    A[2, 1] -= p * F[4]
    A[0, 4] += p * F[3]
    A[4, 0] += p * F[3]
    A[3, 4] += p * F[0]
    A[4, 3] += p * F[0]
    A[1, 4] -= p * F[2]
    A[4, 1] -= p * F[2]
    A[2, 4] -= p * F[1]
    A[4, 2] -= p * F[1]
    w = x.dV[e, q]
    for a in range(4):
        gr = x.grad[e, q, a, 0] * w
        gz = x.grad[e, q, a, 1] * w
        h = x.value[q, a] / x.r[e, q] * w
        # rows of (r, z) at node a: the columns of the gradient, then of the hoop strain
        r0 = gr * A[0, 0] + gz * A[1, 0] + h * A[4, 0]
        r1 = gr * A[0, 1] + gz * A[1, 1] + h * A[4, 1]
        r2 = gr * A[0, 2] + gz * A[1, 2] + h * A[4, 2]
        r3 = gr * A[0, 3] + gz * A[1, 3] + h * A[4, 3]
        r4 = gr * A[0, 4] + gz * A[1, 4] + h * A[4, 4]
        z0 = gr * A[2, 0] + gz * A[3, 0]
        z1 = gr * A[2, 1] + gz * A[3, 1]
        z2 = gr * A[2, 2] + gz * A[3, 2]
        z3 = gr * A[2, 3] + gz * A[3, 3]
        z4 = gr * A[2, 4] + gz * A[3, 4]
        for b in range(4):
            br = x.grad[e, q, b, 0]
            bz = x.grad[e, q, b, 1]
            bh = x.value[q, b] / x.r[e, q]
            K[2 * a, 2 * b] += r0 * br + r1 * bz + r4 * bh
            K[2 * a, 2 * b + 1] += r2 * br + r3 * bz
            K[2 * a + 1, 2 * b] += z0 * br + z1 * bz + z4 * bh
            K[2 * a + 1, 2 * b + 1] += z2 * br + z3 * bz


@njit(cache=True, inline="always")
def _near(F, at):
    """Whether deformation gradients (4, 5) are within `_KEEPS` of those at the kept tangent."""
    for q in range(4):
        for i in range(5):
            if not abs(F[q, i] - at[q, i]) <= _KEEPS:
                return False
    return True


@njit(cache=True, inline="always")
def _clear(g, fe):
    for i in range(8):
        g[i] = 0.0
        fe[i] = 0.0


@njit(cache=True, inline="always")
def _add_element(nodes, fe, force):
    for a in range(4):
        i = 2 * nodes[a]
        force[i] += fe[2 * a]
        force[i + 1] += fe[2 * a + 1]


@njit(cache=True)
def _assemble(x, u, old, rule, seconds, with_tangent, force, tangent, at, room):
    x, old, room = unowned(x), unowned(old), unowned(room)
    u, force, tangent, at = unowned(u), unowned(force), unowned(tangent), unowned(at)
    F, P, A, g, fe = room.F, room.P, room.A, room.g, room.fe
    laws = x.laws
    law = NO_LAW
    curve = room.curve
    n_plastic = 0
    for e in range(x.conn.shape[0]):
        if x.linear[e] >= 0:
            _linear_element(x.conn[e], x.stiffness[x.linear[e]], u, force)
            if with_tangent:
                tangent[e] = x.stiffness[x.linear[e]]
            continue
        theta = _mean_dilatation(x, u, e, F)
        if theta < 0.0:
            return DISTORTED
        p = x.K[e] * math.log(theta) / theta
        hard = x.law[e] >= 0
        if hard:
            law = law_of(laws, x.law[e], 2.0 * x.G[e], seconds)
            curve = laws.curve[x.law[e]]
        flowed = 0
        if not with_tangent or _near(F, at[e]):
            _clear(g, fe)
            for q in range(4):
                step = _step(x, old, rule, e, q, F[q])
                if hard:
                    step = hardened(step, law, curve, old.peeq[e, q], old.work[e, q])
                flowed += deviatoric_pk1(step, curve, x.G[e], P)
                if with_tangent and flowed:
                    break
                _add_point_forces(x, e, q, F[q], P, p, g, fe)
            if not (with_tangent and flowed):
                n_plastic += flowed
                _add_element(x.conn[e], fe, force)
                continue
        flowed = 0
        _clear(g, fe)
        tangent[e] = 0.0
        for q in range(4):
            step = _step(x, old, rule, e, q, F[q])
            if hard:
                step = hardened(step, law, curve, old.peeq[e, q], old.work[e, q])
            flowed += deviatoric_tangent(step, curve, x.G[e], P, A)
            _add_point_forces(x, e, q, F[q], P, p, g, fe)
            _add_point_tangent(x, e, q, F[q], p, A, tangent[e])
        _add_element(x.conn[e], fe, force)
        k = x.K[e] * (1.0 - math.log(theta)) / (theta * theta * x.volume[e])
        for i in range(8):
            for j in range(8):
                tangent[e, i, j] += k * g[i] * g[j]
        n_plastic += flowed
        at[e] = F
        if flowed:
            at[e] = math.nan
    return n_plastic


@njit(cache=True)
def _advance(x, u, old, rule, seconds, new, room):
    """Fill the arrays of the state `new`; plastic work of the step and stored energy."""
    x, u, old, new, room = unowned(x), unowned(u), unowned(old), unowned(new), unowned(room)
    dissipated = 0.0
    stored = 0.0
    laws = x.laws
    law = NO_LAW
    curve = room.curve
    for e in range(x.conn.shape[0]):
        J_sum = 0.0
        hard = x.law[e] >= 0
        if hard:
            law = law_of(laws, x.law[e], 2.0 * x.G[e], seconds)
            curve = laws.curve[x.law[e]]
        for q in range(4):
            F = new.F[e, q]
            gradient(x, u, e, q, F)
            J = (F[0] * F[3] - F[1] * F[2]) * F[4]
            J_sum += J * x.dV[e, q]
            step = _step(x, old, rule, e, q, F)
            if hard:
                step = hardened(step, law, curve, old.peeq[e, q], old.work[e, q])
            done = elastic_deviator(step, curve)
            s = done.e
            b = exponential(s, done.mean)
            for i in range(4):
                new.b[e, q, i] = b[i]
                new.strain[e, q, i] = s[i]
            new.peeq[e, q] = old.peeq[e, q] + math.sqrt(2.0 / 3.0) * done.slip
            work = 2.0 * x.G[e] * done.worked * done.slip
            new.work[e, q] = old.work[e, q] + work
            dissipated += work * x.dV[e, q]
            size = norm(s)
            stored += x.G[e] * size * size * x.dV[e, q]
        log_theta = math.log(J_sum / x.volume[e])
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
    tangent_at: Array | None = None,
    seconds: float = math.inf,
) -> int:
    """Add the internal forces at displacement `u` to `force`, and fill the element tangents.

    Parameters
    ----------
    elements
        The mesh's constants.
    u
        Displacements (r, z) node by node, shape (2 n_nodes,) [R].
    state
        Material state at the last accepted step.
    rule
        Stress update, `material.RADIAL` or `material.EXACT`.
    seconds
        Time since the last accepted step, for what feels the rate [s]; `inf`: slow.
    force
        Array that the forces are added to, shape (2 n_nodes,) [E' R^2].
    tangent
        Array for the element tangents, shape (n_elements, 8, 8) [E' R]; none: forces only.
    tangent_at
        Deformation gradients at which the tangents of elastic elements in `tangent` were found,
        shape (n_elements, 4, 5), `nan` where there is none; elastic elements still near them keep
        their tangent, the others change both arrays. None: all tangents are those at `u`.

    Returns
    -------
    int
        Number of plastic points, or `DISTORTED`.
    """
    n = len(elements.conn)
    into = tangent if tangent is not None else np.empty((0, 8, 8))
    at = tangent_at if tangent_at is not None else np.full((n, 4, 5), np.nan)
    code = _assemble(
        elements, u, state, rule, seconds, tangent is not None, force, into, at, _Room.new()
    )
    return int(code)


def advance(
    elements: Elements, u: Array, *, state: State, rule: int, seconds: float = math.inf
) -> tuple[State, float]:
    """Return the material state at the converged displacement `u`, and the stored energy."""
    new = state.room()
    dissipated, stored = _advance(elements, u, state, rule, seconds, new, _Room.new())
    return new._replace(dissipated=state.dissipated + dissipated), float(stored)
