"""Patch test, and the production assembly against plain scikit-fem forms."""

import math

import numpy as np
import pytest
import skfem
from dentscope.fem.assemble import advance, bulk_forces
from dentscope.fem.elements import Elements, State
from dentscope.fem.material import EXACT, RADIAL, no_laws
from dentscope.studies.verification.material_point import MaterialPoint
from skfem.helpers import ddot

G, K, RADIUS = 0.4, 0.9, 0.003
GAUSS = 0.5 / math.sqrt(3.0)
POINTS = np.array(
    [[0.5 - GAUSS, 0.5 + GAUSS, 0.5 + GAUSS, 0.5 - GAUSS],
     [0.5 - GAUSS, 0.5 - GAUSS, 0.5 + GAUSS, 0.5 + GAUSS]]
)  # fmt: skip


@pytest.fixture
def distorted():
    mesh = skfem.MeshQuad.init_tensor(np.linspace(0.0, 1.0, 5), np.linspace(0.0, 1.0, 4))
    p = mesh.p.copy()
    inner = (p[0] > 0.0) & (p[0] < 1.0) & (p[1] > 0.0) & (p[1] < 1.0)
    p[:, inner] += 0.06 * np.sin(7.0 * p[::-1, inner] + 1.0)
    return skfem.MeshQuad(p, mesh.t)


def elements_of(mesh, radius):
    basis = skfem.CellBasis(mesh, skfem.ElementQuad1(), quadrature=(POINTS, np.full(4, 0.25)))
    n = mesh.t.shape[1]
    r = np.asarray(basis.global_coordinates())[0]
    dV = 2.0 * math.pi * r * basis.dx
    gradients = [np.moveaxis(basis.basis[a][0].grad, 0, -1) for a in range(4)]
    values = [np.broadcast_to(np.asarray(basis.basis[a][0]), (n, 4))[0] for a in range(4)]
    return Elements(
        conn=np.ascontiguousarray(basis.element_dofs.T.astype(np.int64)),
        grad=np.ascontiguousarray(np.stack(gradients, axis=2)),
        value=np.ascontiguousarray(np.stack(values, axis=1)),
        r=r, dV=dV, volume=dV.sum(axis=1),
        G=np.full(n, G), K=np.full(n, K), radius=np.full(n, radius),
        stiffness=np.empty((0, 8, 8)), linear=np.full(n, -1),
        law=np.full(n, -1), laws=no_laws(),
    )  # fmt: skip


def dense(mesh, tangent, conn):
    n = 2 * mesh.p.shape[1]
    dofs = np.stack([2 * conn, 2 * conn + 1], axis=2).reshape(len(conn), 8)
    out = np.zeros((n, n))
    for e in range(len(conn)):
        out[np.ix_(dofs[e], dofs[e])] += tangent[e]
    return out


def assembled(mesh, elements, u, state, rule):
    force, tangent = np.zeros(u.size), np.empty((len(elements.conn), 8, 8))
    plastic = bulk_forces(elements, u, state=state, rule=rule, force=force, tangent=tangent)
    return force, dense(mesh, tangent, elements.conn), plastic


def smooth_field(mesh, size):
    r, z = mesh.p
    field = [r * (0.5 - z + 0.3 * r * z), z * (0.8 * r - 0.6) + 0.2 * r**2]
    return size * np.column_stack(field).ravel()


@pytest.mark.parametrize("radius", [np.inf, RADIUS])
def test_patch_of_uniform_strain_is_in_equilibrium(distorted, radius):
    r, z = distorted.p
    u = np.column_stack([0.01 * r, -0.03 * z]).ravel()
    elements = elements_of(distorted, radius)
    state = State.virgin(len(elements.conn))
    force, _, plastic = assembled(distorted, elements, u, state, EXACT)
    inner = np.flatnonzero((r > 0.0) & (r < 1.0) & (z > 0.0) & (z < 1.0))
    assert np.abs(force.reshape(-1, 2)[inner]).max() < 1e-10 * np.abs(force).max()
    assert (plastic == 4 * len(elements.conn)) == np.isfinite(radius)


def point_of(state, e, q, radius, rule):
    point = MaterialPoint(G, radius=radius, rule=rule)
    point.rest(state.F[e, q], state.b[e, q], state.strain[e, q])
    return point


def plain_scikit_fem(mesh, u, state, radius, rule):
    """Residual and tangent by scikit-fem forms, with the stress evaluated point by point.

    The mean dilatation enters as an element-wise constant; derivatives of the stress are central
    differences of the whole element response.
    """
    vector = skfem.ElementVector(skfem.ElementQuad1())
    quadrature = (POINTS, np.full(4, 0.25))
    basis = skfem.CellBasis(mesh, vector, quadrature=quadrature)
    weight = skfem.CellBasis(mesh, skfem.ElementQuad0(), quadrature=quadrature)
    r = np.asarray(basis.global_coordinates())[0]

    def gradient(field):
        value = basis.interpolate(field)
        g = value.grad
        return np.stack(
            [1.0 + g[0, 0], g[0, 1], g[1, 0], 1.0 + g[1, 1], 1.0 + np.asarray(value)[0] / r],
            axis=-1,
        )

    F = gradient(u)
    J = (F[..., 0] * F[..., 3] - F[..., 1] * F[..., 2]) * F[..., 4]
    volume = 2.0 * math.pi * r * basis.dx
    theta = (J * volume).sum(axis=1) / volume.sum(axis=1)
    p = (K * np.log(theta) / theta)[:, None]
    P = np.zeros((*F.shape[:2], 5))
    for e in range(F.shape[0]):
        for q in range(4):
            f = F[e, q]
            s0, s1, s2, s3 = point_of(state, e, q, radius, rule).walk(f).e
            tau = 2.0 * G * np.array([[s0, s2], [s2, s1]])
            P[e, q, :4] = (tau @ np.linalg.inv(f[:4].reshape(2, 2)).T).ravel()
            P[e, q, 4] = 2.0 * G * s3 / f[4]
    f0, f1, f2, f3, f4 = np.moveaxis(F, -1, 0)
    cof = np.stack([f3 * f4, -f2 * f4, -f1 * f4, f0 * f4, f0 * f3 - f1 * f2], axis=-1)
    P += p[..., None] * cof
    stress = np.moveaxis(P[..., :4].reshape(*P.shape[:2], 2, 2), (2, 3), (0, 1))

    @skfem.LinearForm
    def internal(v, w):
        return (ddot(w["stress"], v.grad) + w["hoop"] * v[0] / w.x[0]) * 2 * np.pi * w.x[0]

    assert weight.nelems == basis.nelems
    return internal.assemble(basis, stress=stress, hoop=P[..., 4])


@pytest.mark.parametrize(("size", "radius"), [(0.002, np.inf), (0.05, RADIUS)])
def test_residual_equals_a_plain_scikit_fem_form(distorted, size, radius):
    elements = elements_of(distorted, radius)
    begun = smooth_field(distorted, 0.3 * size)
    state, _ = advance(elements, begun, state=State.virgin(12), rule=EXACT)
    u = smooth_field(distorted, size)
    force, _, plastic = assembled(distorted, elements, u, state, EXACT)
    # scikit-fem numbers the components of a node one after the other, as we do
    reference = plain_scikit_fem(distorted, u, state, radius, EXACT)
    assert force == pytest.approx(reference, abs=1e-10 * np.abs(reference).max())
    assert (plastic > 0) == np.isfinite(radius)


@pytest.mark.parametrize("rule", [RADIAL, EXACT])
@pytest.mark.parametrize(("size", "radius"), [(0.01, np.inf), (0.05, RADIUS)])
def test_tangent_is_the_derivative_of_the_residual(distorted, size, radius, rule):
    elements = elements_of(distorted, radius)
    begun = smooth_field(distorted, 0.5 * size)
    state, _ = advance(elements, begun, state=State.virgin(12), rule=rule)
    u = smooth_field(distorted, size)
    force, tangent, _ = assembled(distorted, elements, u, state, rule)

    def moved(step):
        return assembled(distorted, elements, u + step, state, rule)[0]

    direction = np.sin(np.arange(u.size) * 1.7) * size
    remainder = [
        np.abs(moved(h * direction) - force - h * tangent @ direction).max()
        for h in (4e-3, 2e-3, 1e-3)
    ]
    slope = np.log2(np.array(remainder[:-1]) / remainder[1:])
    assert slope == pytest.approx(2.0, abs=0.1)
    # column by column, by central differences
    columns = [(moved(h) - moved(-h)) / 2e-6 for h in 1e-6 * np.eye(u.size)]
    assert tangent == pytest.approx(np.array(columns).T, abs=1e-7 * np.abs(tangent).max())
    if np.isinf(radius):
        assert tangent == pytest.approx(tangent.T, abs=1e-10 * np.abs(tangent).max())
