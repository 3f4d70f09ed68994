"""Small axisymmetric problems of one body, solved with the production element and stress update."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as sparse_linalg
import skfem

from ...core.arrays import Array, Integers
from ...fem.assemble import advance, bulk_forces
from ...fem.discretise import geometry_of
from ...fem.elements import Elements, State
from ...fem.material import EXACT, no_laws

_MOST_ITERATIONS = 30


@dataclass(frozen=True)
class Block:
    """A meshed body of one material with E = 1.

    `mesh`: quadrilaterals; coordinates (r, z); `elements`: constants of the production elements on
    it.
    """

    mesh: skfem.MeshQuad
    elements: Elements

    @property
    def points(self) -> Array:
        """Node coordinates, shape (n_nodes, 2)."""
        return np.ascontiguousarray(self.mesh.p.T)

    @property
    def dofs(self) -> Integers:
        """Degrees of freedom of the elements, shape (n_elements, 8)."""
        conn = self.elements.conn
        return np.stack([2 * conn, 2 * conn + 1], axis=2).reshape(len(conn), 8)


def block(mesh: skfem.MeshQuad, *, nu: float, yield_strain: float = math.inf) -> Block:
    """Set up a body with E = 1 and Sy = `yield_strain`."""
    n = mesh.t.shape[1]
    shear = 0.5 / (1.0 + nu)
    return Block(
        mesh=mesh,
        elements=Elements(
            **geometry_of(mesh),
            G=np.full(n, shear),
            K=np.full(n, 1.0 / (3.0 * (1.0 - 2.0 * nu))),
            radius=np.full(n, math.sqrt(2.0 / 3.0) * yield_strain / (2.0 * shear)),
            law=np.full(n, -1),
            laws=no_laws(),
        ),
    )


def rectangle(r: Array, z: Array, *, distortion: float = 0.0) -> skfem.MeshQuad:
    """Rectangle with the given grid lines; `distortion` moves the inner nodes by a smooth field."""
    mesh = skfem.MeshQuad.init_tensor(r, z)
    p = mesh.p.copy()
    x = (p[0] - r[0]) / (r[-1] - r[0])
    y = (p[1] - z[0]) / (z[-1] - z[0])
    bump = distortion * np.sin(math.pi * x) * np.sin(math.pi * y)
    p[0] += bump * np.cos(3.0 * y + 1.0) * (r[-1] - r[0])
    p[1] += bump * np.sin(3.0 * x) * (z[-1] - z[0])
    return skfem.MeshQuad(p, mesh.t)


def stiffness(body: Block, u: Array, *, state: State) -> tuple[Array, sparse.csr_matrix]:
    """Internal forces and tangent at displacement `u`, shapes (n_dofs,) and (n_dofs, n_dofs)."""
    force, tangent = np.zeros(u.size), np.empty((len(body.elements.conn), 8, 8))
    bulk_forces(body.elements, u, state=state, rule=EXACT, force=force, tangent=tangent)
    dofs = body.dofs
    rows, cols = np.repeat(dofs, 8, axis=1), np.tile(dofs, (1, 8))
    matrix = sparse.csr_matrix(
        (tangent.ravel(), (rows.ravel(), cols.ravel())), shape=(u.size, u.size)
    )
    return force, matrix


def equilibrium(body: Block, guess: Array, *, fixed: Integers, state: State) -> Array:
    """Displacements in equilibrium, those of `fixed` as they are in `guess`.

    Raises `ArithmeticError`: Newton's method does not converge.
    """
    u = guess.copy()
    free = np.setdiff1d(np.arange(u.size), fixed)
    for _ in range(_MOST_ITERATIONS):
        force, matrix = stiffness(body, u, state=state)
        if np.abs(force[free]).max() < 1e-11 * np.abs(force).max():
            return u
        u[free] -= sparse_linalg.spsolve(matrix[free][:, free], force[free])
    raise ArithmeticError("no equilibrium of a verification problem")


def walk(
    body: Block,
    steps: Array,
    *,
    fixed: Integers,
    imposed: Callable[[float], Array],
) -> list[tuple[Array, Array, State]]:
    """Displacements, forces and state after each step of an imposed displacement field.

    `body`: the body; `steps`: increasing load factors, shape (n,); `fixed`: degrees of freedom that
    are imposed; `imposed`: gives all displacements at a load factor; those of `fixed` are used.
    """
    u = np.zeros(2 * body.mesh.p.shape[1])
    state = State.virgin(len(body.elements.conn))
    out = []
    for step in steps:
        u[fixed] = imposed(float(step))[fixed]
        u = equilibrium(body, u, fixed=fixed, state=state)
        force, _ = stiffness(body, u, state=state)
        state, _ = advance(body.elements, u, state=state, rule=EXACT)
        out.append((u.copy(), force, state))
    return out
