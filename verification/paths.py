"""A plain loading path on a given discretisation, for checks that change what `fem.solve` sets."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..fem.assemble import State, advance
from ..fem.discretise import Discretisation
from ..fem.material import EXACT
from ..fem.measure import Reading, read
from ..fem.newton import Equilibrium, Solver

_SOFT_START = (1e-3, 1e-2, 1e-1, 1.0)


def press(grid: Discretisation, *, depths: tuple[float, ...]) -> list[Reading]:
    """Press through `depths` without cutting steps; the first must lie below first yield.

    Parameters
    ----------
    grid
        The discretisation, with whatever boundary conditions.
    depths
        Increasing Delta/R in steps small enough for Newton's method.

    Raises
    ------
    ArithmeticError
        A step does not converge.
    """
    solver = Solver(grid, rule=EXACT)
    state = State.virgin(len(grid.elements.conn))
    guess = np.zeros(grid.n_dofs)
    guess[1 : 2 * grid.mesh.n_sphere_points : 2] = -depths[0]
    solver.elements = replace(grid.elements, radius=np.full_like(grid.elements.radius, np.inf))
    for softness in _SOFT_START:
        solver.surfaces = replace(grid.surfaces, stiffness=grid.surfaces.stiffness * softness)
        found = _found(solver.equilibrium(guess, state=state, delta=depths[0]), depths[0])
        guess = found.u
    solver.elements, solver.surfaces = grid.elements, grid.surfaces
    readings = [read(grid, found, depths[0])]
    before, here = np.zeros(grid.n_dofs), found.u
    last, delta = 0.0, depths[0]
    for depth in depths[1:]:
        guess = here + (here - before) * (depth - delta) / (delta - last)
        found = _found(solver.equilibrium(guess, state=state, delta=depth), depth)
        state, _ = advance(grid.elements, found.u, state=state, rule=EXACT)
        readings.append(read(grid, found, depth))
        before, here, last, delta = here, found.u, delta, depth
    return readings


def _found(equilibrium: Equilibrium | None, depth: float) -> Equilibrium:
    if equilibrium is None:
        raise ArithmeticError(f"no equilibrium at Delta/R = {depth:.3g}")
    return equilibrium
