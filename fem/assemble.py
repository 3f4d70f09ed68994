"""Internal forces and tangent of the bulk, and the update of the material state.

Four-node quadrilaterals with mean dilatation: the pressure of an element is p = K ln(theta)/theta
with theta the mean of J over its reference volume, the deviator is taken at each of the 2 x 2
points. Both derive from one potential, so the elastic tangent is symmetric; the tangent of the
exact stress update is not, and the full matrix is assembled. The basis values, the quadrature and
the degrees of freedom come from scikit-fem; this file only sums them up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from .material import (
    deviatoric_pk1,
    deviatoric_tangent,
    elastic_deviator,
    exponential,
)

Floats = npt.NDArray[np.float64]

_SMALLEST_DETERMINANT = 0.02  # below this an element is inverted or about to be

DISTORTED = -1
"""Returned by `bulk_forces` when an element has turned inside out."""


@dataclass(frozen=True)
class Elements:
    """Everything about the elements that does not change during a solve (R = 1, E' = 1).

    Parameters
    ----------
    conn
        Node numbers, shape (n_elements, 4).
    grad
        Reference gradients of the basis functions, shape (n_elements, 4, 4, 2): element, point,
        node, direction.
    value
        Basis functions at the points, shape (4, 4): point, node.
    r
        Reference radius of the points, shape (n_elements, 4).
    dV
        Reference volume of the points (2 pi r dA), shape (n_elements, 4).
    volume
        Reference volume of the elements, shape (n_elements,).
    G, K
        Shear and bulk modulus, shape (n_elements,).
    radius
        sqrt(2/3) Sy / (2 G), shape (n_elements,); `inf` where elastic.
    stiffness
        Constant stiffness matrices of linear elements, shape (n_linear, 8, 8) [E' R].
    linear
        Row of `stiffness` of each element, -1 for those of finite strain, shape (n_elements,).
    """

    conn: npt.NDArray[np.int64]
    grad: Floats
    value: Floats
    r: Floats
    dV: Floats
    volume: Floats
    G: Floats
    K: Floats
    radius: Floats
    stiffness: Floats
    linear: npt.NDArray[np.int64]


@dataclass(frozen=True)
class State:
    """Material state at the last accepted step.

    Parameters
    ----------
    F
        Deformation gradient (rr, rz, zr, zz, tt), shape (n_elements, 4, 5).
    b
        Elastic left Cauchy-Green tensor (rr, zz, rz, tt), shape (n_elements, 4, 4).
    strain
        Deviator of the elastic logarithmic strain 1/2 ln b, shape (n_elements, 4, 4).
    peeq
        Equivalent plastic strain, shape (n_elements, 4).
    dissipated
        Plastic work so far, summed over the mesh.
    """

    F: Floats
    b: Floats
    strain: Floats
    peeq: Floats
    dissipated: float

    @classmethod
    def virgin(cls, n_elements: int) -> State:
        """Undeformed, unstressed state."""
        F = np.zeros((n_elements, 4, 5))
        F[..., [0, 3, 4]] = 1.0
        b = np.zeros((n_elements, 4, 4))
        b[..., [0, 1, 3]] = 1.0
        return cls(
            F=F,
            b=b,
            strain=np.zeros_like(b),
            peeq=np.zeros((n_elements, 4)),
            dissipated=0.0,
        )


@njit(cache=True)
def _gradient(conn, grad, value, r, u, e, q, F):
    """Write the deformation gradient at point q of element e into `F` (5,)."""
    f0 = 1.0
    f1 = 0.0
    f2 = 0.0
    f3 = 1.0
    hoop = 0.0
    for a in range(4):
        i = 2 * conn[e, a]
        gr = grad[e, q, a, 0]
        gz = grad[e, q, a, 1]
        f0 += u[i] * gr
        f1 += u[i] * gz
        f2 += u[i + 1] * gr
        f3 += u[i + 1] * gz
        hoop += u[i] * value[q, a]
    F[0] = f0
    F[1] = f1
    F[2] = f2
    F[3] = f3
    F[4] = 1.0 + hoop / r[e, q]


@njit(cache=True)
def _linear_element(nodes, K, u, force):
    for a in range(8):
        total = 0.0
        for b in range(8):
            total += K[a, b] * u[2 * nodes[b // 2] + b % 2]
        force[2 * nodes[a // 2] + a % 2] += total


@njit(cache=True)
def _assemble(
    conn, grad, value, r, dV, volume, G, K, radius, stiffness, linear, u, Fn, bn, en, rule,
    with_tangent, force, tangent,
):  # fmt: skip
    F = np.empty((4, 5))
    P = np.empty(5)
    A = np.empty((5, 5))
    work = np.empty((6, 4))
    row0 = np.empty(5)
    row1 = np.empty(5)
    g = np.empty(8)
    fe = np.empty(8)
    n_plastic = 0
    for e in range(conn.shape[0]):
        if linear[e] >= 0:
            _linear_element(conn[e], stiffness[linear[e]], u, force)
            if with_tangent:
                tangent[e] = stiffness[linear[e]]
            continue
        J_sum = 0.0
        for q in range(4):
            _gradient(conn, grad, value, r, u, e, q, F[q])
            det = F[q, 0] * F[q, 3] - F[q, 1] * F[q, 2]
            if not (det > _SMALLEST_DETERMINANT and F[q, 4] > _SMALLEST_DETERMINANT):
                return DISTORTED
            J_sum += det * F[q, 4] * dV[e, q]
        theta = J_sum / volume[e]
        p = K[e] * math.log(theta) / theta
        for k in range(8):
            g[k] = 0.0
            fe[k] = 0.0
        if with_tangent:
            for i in range(8):
                for j in range(8):
                    tangent[e, i, j] = 0.0
        for q in range(4):
            Fq = F[q]
            point = (Fq, Fn[e, q], bn[e, q], en[e, q], G[e], radius[e], rule, P)
            if with_tangent:
                n_plastic += deviatoric_tangent(*point, work, A)
            else:
                n_plastic += deviatoric_pk1(*point)
            c0 = Fq[3] * Fq[4]
            c1 = -Fq[2] * Fq[4]
            c2 = -Fq[1] * Fq[4]
            c3 = Fq[0] * Fq[4]
            c4 = Fq[0] * Fq[3] - Fq[1] * Fq[2]
            w = dV[e, q]
            for a in range(4):
                gr = grad[e, q, a, 0] * w
                gz = grad[e, q, a, 1] * w
                h = value[q, a] / r[e, q] * w
                v0 = c0 * gr + c1 * gz + c4 * h
                v1 = c2 * gr + c3 * gz
                g[2 * a] += v0
                g[2 * a + 1] += v1
                fe[2 * a] += P[0] * gr + P[1] * gz + P[4] * h + p * v0
                fe[2 * a + 1] += P[2] * gr + P[3] * gz + p * v1
            if not with_tangent:
                continue
            # second derivative of J, times the pressure
            A[0, 3] += p * Fq[4]
            A[3, 0] += p * Fq[4]
            A[1, 2] -= p * Fq[4]
            A[2, 1] -= p * Fq[4]
            A[0, 4] += p * Fq[3]
            A[4, 0] += p * Fq[3]
            A[3, 4] += p * Fq[0]
            A[4, 3] += p * Fq[0]
            A[1, 4] -= p * Fq[2]
            A[4, 1] -= p * Fq[2]
            A[2, 4] -= p * Fq[1]
            A[4, 2] -= p * Fq[1]
            for a in range(4):
                gr = grad[e, q, a, 0] * w
                gz = grad[e, q, a, 1] * w
                h = value[q, a] / r[e, q] * w
                for j in range(5):
                    row0[j] = gr * A[0, j] + gz * A[1, j] + h * A[4, j]
                    row1[j] = gr * A[2, j] + gz * A[3, j]
                for b in range(4):
                    br = grad[e, q, b, 0]
                    bz = grad[e, q, b, 1]
                    bh = value[q, b] / r[e, q]
                    tangent[e, 2 * a, 2 * b] += row0[0] * br + row0[1] * bz + row0[4] * bh
                    tangent[e, 2 * a, 2 * b + 1] += row0[2] * br + row0[3] * bz
                    tangent[e, 2 * a + 1, 2 * b] += row1[0] * br + row1[1] * bz + row1[4] * bh
                    tangent[e, 2 * a + 1, 2 * b + 1] += row1[2] * br + row1[3] * bz
        for a in range(4):
            i = 2 * conn[e, a]
            force[i] += fe[2 * a]
            force[i + 1] += fe[2 * a + 1]
        if with_tangent:
            k = K[e] * (1.0 - math.log(theta)) / (theta * theta * volume[e])
            for i in range(8):
                for j in range(8):
                    tangent[e, i, j] += k * g[i] * g[j]
    return n_plastic


@njit(cache=True)
def _advance(
    conn, grad, value, r, dV, volume, G, K, radius, u, Fn, bn, en, peeq, rule,
    F, b, strain, peeq_new,
):  # fmt: skip
    dissipated = 0.0
    stored = 0.0
    for e in range(conn.shape[0]):
        J_sum = 0.0
        for q in range(4):
            _gradient(conn, grad, value, r, u, e, q, F[e, q])
            Fq = F[e, q]
            J = (Fq[0] * Fq[3] - Fq[1] * Fq[2]) * Fq[4]
            J_sum += J * dV[e, q]
            e0, e1, e2, e3, m, _, slip = elastic_deviator(
                Fq, Fn[e, q], bn[e, q], en[e, q], radius[e], rule
            )
            b0, b1, b2, b3 = exponential(e0 + m, e1 + m, e2, e3 + m)
            b[e, q, 0] = b0
            b[e, q, 1] = b1
            b[e, q, 2] = b2
            b[e, q, 3] = b3
            strain[e, q, 0] = e0
            strain[e, q, 1] = e1
            strain[e, q, 2] = e2
            strain[e, q, 3] = e3
            peeq_new[e, q] = peeq[e, q] + math.sqrt(2.0 / 3.0) * slip
            norm = math.sqrt(e0 * e0 + e1 * e1 + e3 * e3 + 2.0 * e2 * e2)
            dissipated += 2.0 * G[e] * norm * slip * dV[e, q]
            stored += G[e] * norm * norm * dV[e, q]
        log_theta = math.log(J_sum / volume[e])
        stored += 0.5 * K[e] * log_theta * log_theta * volume[e]
    return dissipated, stored


def bulk_forces(
    elements: Elements,
    u: Floats,
    *,
    state: State,
    rule: int,
    force: Floats,
    tangent: Floats | None = None,
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
    force
        Array that the forces are added to, shape (2 n_nodes,) [E' R^2].
    tangent
        Array for the element tangents, shape (n_elements, 8, 8) [E' R]; none: forces only.

    Returns
    -------
    int
        Number of plastic points, or `DISTORTED`.
    """
    x = elements
    with_tangent = tangent is not None
    room = tangent if tangent is not None else np.empty((0, 8, 8))
    return int(
        _assemble(
            x.conn, x.grad, x.value, x.r, x.dV, x.volume, x.G, x.K, x.radius, x.stiffness, x.linear,
            u, state.F, state.b, state.strain, rule, with_tangent, force, room,
        )
    )  # fmt: skip


def advance(elements: Elements, u: Floats, *, state: State, rule: int) -> tuple[State, float]:
    """Return the material state at the converged displacement `u`, and the stored energy."""
    x = elements
    F, b, peeq = np.empty_like(state.F), np.empty_like(state.b), np.empty_like(state.peeq)
    strain = np.empty_like(state.strain)
    dissipated, stored = _advance(
        x.conn, x.grad, x.value, x.r, x.dV, x.volume, x.G, x.K, x.radius,
        u, state.F, state.b, state.strain, state.peeq, rule, F, b, strain, peeq,
    )  # fmt: skip
    new = State(F=F, b=b, strain=strain, peeq=peeq, dissipated=state.dissipated + dissipated)
    return new, float(stored)


@njit(cache=True)
def deformation(conn, grad, value, r, u):
    """Deformation gradients at displacement `u`, shape (n_elements, 4, 5)."""
    F = np.empty((conn.shape[0], 4, 5))
    for e in range(conn.shape[0]):
        for q in range(4):
            _gradient(conn, grad, value, r, u, e, q, F[e, q])
    return F


def cauchy_stress(elements: Elements, state: State) -> tuple[Floats, Floats]:
    """Cauchy stress deviator (rr, zz, rz, tt) at the points and pressure of the elements.

    Returns
    -------
    tuple
        Deviator, shape (n_elements, 4, 4), and mean stress, shape (n_elements,) [E'].
    """
    J = (state.F[..., 0] * state.F[..., 3] - state.F[..., 1] * state.F[..., 2]) * state.F[..., 4]
    theta = (J * elements.dV).sum(axis=1) / elements.volume
    mean = elements.K * np.log(theta) / theta
    return 2.0 * elements.G[:, None, None] * state.strain / J[..., None], mean
