"""Rates of convergence: a manufactured solution for the element, Hertz for the contact."""

from __future__ import annotations

import numpy as np
import scipy.sparse.linalg as sparse_linalg
import skfem

from .... import fem
from ....core.arrays import Array
from ....fem.elements import State
from ..bench import Bench
from ..blocks import block, rectangle, stiffness
from ..pairs import R, elastic_pair, hertz_force
from ..result import Cell, Measurement, Result, Table

_DIVISIONS = (8, 16, 32, 64)
_LEVELS = (0.2, 0.1, 0.05, 0.025)
_DEPTH = 1e-4


def run(bench: Bench) -> Result:
    """Halve the elements three times and compare the errors."""
    rows: list[tuple[Cell, ...]] = []
    measurements = []
    for nu in (0.3, 0.499):
        errors = np.array([_manufactured(n, nu) for n in _DIVISIONS])
        rates = np.log2(errors[:-1] / errors[1:])
        for n, error, rate in zip(_DIVISIONS, errors, [(), *rates], strict=True):
            shown = [f"{x:.2f}" for x in rate] or ["", ""]
            rows.append((nu, n, *(f"{x:.3e}" for x in error), *shown))
        measurements += [
            Measurement(f"rate of the displacement in L2, nu = {nu:g}", float(rates[-1, 0]), "",
                        1.9, 2.1, "theory of the four-node element"),
            Measurement(f"rate of the displacement gradient, nu = {nu:g}", float(rates[-1, 1]), "",
                        0.9, None, "theory of the four-node element"),
        ]  # fmt: skip
    force, radius = np.array([_hertz(h) for h in _LEVELS]).T
    # errors against the finest, over two halvings
    orders = [float(np.log2(abs(x[0] - x[-1]) / abs(x[2] - x[-1])) / 2.0) for x in (force, radius)]
    contact = tuple(
        (h, f"{f:.6f}", f"{a:.5f}") for h, f, a in zip(_LEVELS, force, radius, strict=True)
    )
    return Result(
        title="Rates of convergence",
        about=(
            "Element: u_r = r (1 - 0.3 r^2) cos z, u_z = (1 + 0.4 r^2) sin z on distorted "
            "meshes, loads from the exact stress, linear elastic. Contact: elastic pair at "
            "Delta/R = 1e-4, elements of relative width h."
        ),
        measurements=(
            *measurements,
            Measurement("order of F in the contact, h = 0.2 to 0.05 against 0.025", orders[0], "",
                        1.0, None, "first order is what the contact edge inside an element allows"),
            Measurement("order of a in the contact, likewise", orders[1], "", 1.0, None,
                        "the same"),
            Measurement("F changes from h = 0.05 to 0.025",
                        100.0 * float(force[3] / force[2] - 1.0), "%", -0.1, 0.1, "own"),
            Measurement("a changes from h = 0.05 to 0.025",
                        100.0 * float(radius[3] / radius[2] - 1.0), "%", -0.2, 0.2, "own"),
        ),
        tables=(
            Table("Manufactured solution",
                  ("nu", "n", "error of u", "error of its gradient", "rate", "rate"), tuple(rows)),
            Table("Elastic contact", ("h/a", "F/F_Hertz", "a/a_Hertz"), contact),
        ),
    )  # fmt: skip


def _exact(x: Array) -> tuple[Array, Array]:
    """Displacement (2, ...) and gradient (rr, rz, zr, zz, tt) of the manufactured field."""
    r, z = x
    a, c = 1.0 - 0.3 * r * r, 1.0 + 0.4 * r * r
    u = np.stack([r * a * np.cos(z), c * np.sin(z)])
    grad = np.stack(
        [
            (1.0 - 0.9 * r * r) * np.cos(z),
            -r * a * np.sin(z),
            0.8 * r * np.sin(z),
            c * np.cos(z),
            a * np.cos(z),
        ]
    )
    return u, grad


def _manufactured(n: int, nu: float) -> tuple[float, float]:
    """Errors of displacement and gradient in L2 over 2 pi r dA."""
    line = np.linspace(0.0, 1.0, n + 1)
    body = block(rectangle(line, line, distortion=0.08), nu=nu)
    size = 2 * body.mesh.p.shape[1]
    _, K = stiffness(body, np.zeros(size), state=State.virgin(len(body.elements.conn)))
    lame = nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    shear = 0.5 / (1.0 + nu)
    vector = skfem.ElementVector(skfem.ElementQuad1())
    basis = skfem.CellBasis(body.mesh, vector, intorder=8)

    def load(v, w):  # type: ignore[no-untyped-def]
        _, g = _exact(w.x)
        trace = g[0] + g[3] + g[4]
        stress_rr, stress_zz, stress_tt = (lame * trace + 2.0 * shear * g[k] for k in (0, 3, 4))
        stress_rz = shear * (g[1] + g[2])
        work = stress_rr * v.grad[0, 0] + stress_rz * (v.grad[0, 1] + v.grad[1, 0])
        work += stress_zz * v.grad[1, 1] + stress_tt * v[0] / w.x[0]
        return work * 2.0 * np.pi * w.x[0]

    f = skfem.LinearForm(load).assemble(basis)
    u = _exact(body.mesh.p)[0].T.ravel()
    p = body.mesh.p
    edge = np.flatnonzero((p == 0.0).any(axis=0) | (p == 1.0).any(axis=0))
    fixed = np.concatenate([2 * edge, 2 * edge + 1])
    free = np.setdiff1d(np.arange(size), fixed)
    solution = u.copy()
    solution[free] = sparse_linalg.spsolve(
        K[free][:, free].tocsc(), f[free] - K[free][:, fixed] @ u[fixed]
    )
    found = basis.interpolate(solution)
    x = np.asarray(basis.global_coordinates())
    exact, grad = _exact(x)
    weight = 2.0 * np.pi * x[0] * basis.dx
    off = np.asarray(found) - exact
    g = found.grad
    steep = np.stack([g[0, 0], g[0, 1], g[1, 0], g[1, 1], np.asarray(found)[0] / x[0]]) - grad
    return (
        float(np.sqrt((off**2 * weight).sum())),
        float(np.sqrt((steep**2 * weight).sum())),
    )


def _hertz(h: float) -> tuple[float, float]:
    pair = elastic_pair()
    divisions = 2 * round(0.8 / h)
    accuracy = fem.Accuracy.production().with_(divisions=divisions, coarse=h, fine=h)
    c = fem.solve(fem.ContactProblem(pair, (_DEPTH,)), accuracy=accuracy).loading
    return (
        float(c.force[0]) / hertz_force(pair, _DEPTH * R),
        float(c.radius[0]) / (R * np.sqrt(_DEPTH)),
    )
