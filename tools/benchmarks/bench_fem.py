"""Cost of the solver's parts as ratios within one run, on the production mesh.

python tools/benchmarks/bench_fem.py
"""

from __future__ import annotations

import time
import timeit
from collections.abc import Callable

import numpy as np
import skfem
from dentscope import fem
from dentscope.core import Material, Pair
from dentscope.fem.assemble import bulk_forces
from dentscope.fem.contact import contact_forces
from dentscope.fem.discretise import discretise
from dentscope.fem.elements import State
from dentscope.fem.linear import superlu
from dentscope.fem.material import EXACT
from dentscope.fem.newton import Solver
from skfem.models.elasticity import lame_parameters, linear_elasticity

STEEL = Material(E=200e9, nu=0.3, Sy=503e6)


def seconds(work: Callable[[], object], repeats: int = 5) -> float:
    """Median processor seconds of a call, after one that is not counted."""
    spent = timeit.repeat(work, timer=time.process_time, number=1, repeat=1 + repeats)
    return float(np.median(spent[1:]))


def main() -> None:
    pair = Pair(STEEL, STEEL, 1e-3)
    problem = fem.ContactProblem(pair, (0.3 * pair.first_yield, 0.1))
    grid = discretise(problem, fem.Accuracy.production())
    solver = Solver(grid, rule=EXACT)
    state = State.virgin(len(grid.elements.conn))
    u = np.zeros(grid.n_dofs)
    u[1 : 2 * grid.mesh.n_sphere_points : 2] = -1e-7
    force, tangent = np.zeros(grid.n_dofs), np.empty((len(grid.elements.conn), 8, 8))

    loop = seconds(
        lambda: bulk_forces(grid.elements, u, state=state, rule=EXACT, force=force, tangent=tangent)
    )
    x = grid.mesh.points + u.reshape(-1, 2)
    contact = seconds(lambda: contact_forces(grid.surfaces, x, force=force))
    now = solver._evaluate(u, state)
    assert now is not None
    solver._direction(now)
    matrix, rhs = solver.system._matrix, np.ones(solver.system.n)
    factors, fronts = superlu(matrix), solver.system._fronts
    mesh = skfem.MeshQuad(grid.mesh.points.T.copy(), grid.mesh.quads.T.copy())
    basis = skfem.CellBasis(mesh, skfem.ElementVector(skfem.ElementQuad1()), intorder=2)
    form = linear_elasticity(*lame_parameters(1.0, 0.3))
    plain = seconds(lambda: form.assemble(basis), repeats=3)

    print(f"{grid.n_dofs} degrees of freedom, {len(grid.elements.conn)} elements")
    print(f"element loop                              {1e3 * loop:8.2f} ms")
    for name, value in (
        ("contact without tangent", contact),
        ("SuperLU factorisation", seconds(lambda: superlu(matrix))),
        ("SuperLU solve", seconds(lambda: factors(rhs))),
        ("multifrontal factorisation", seconds(lambda: fronts.factorise(matrix.data))),
        ("GMRES with these factors", seconds(lambda: solver.system._iterate(rhs))),
        ("scikit-fem's plane linear elasticity form", plain),
    ):
        print(f"{name:42}{1e3 * value:8.2f} ms, {value / loop:6.2f} of the element loop")


if __name__ == "__main__":
    main()
