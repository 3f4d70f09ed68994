"""Points of a loading path: a converged state with what was measured there, and how one follows.

Everything is in units of R and E'.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.arrays import Array
from .assemble import advance
from .discretise import Discretisation
from .elements import State
from .newton import Equilibrium, Solver
from .remesh import moved_outwards
from .results.measure import Reading, read
from .rules import RULES

# limit: cuts after which the path ends [-]
MOST_CUTS = 7


@dataclass(frozen=True)
class Record:
    """One accepted state with its energies (R = 1, E' = 1); `dissipated` holds `rubbed` too."""

    reading: Reading
    work: float
    stored: float
    dissipated: float
    rubbed: float = 0.0


@dataclass(frozen=True)
class PathPoint:
    """Where a path stands: equilibrium, material state and energies, on the mesh of `solver`."""

    delta: float
    equilibrium: Equilibrium
    state: State
    record: Record
    solver: Solver

    @property
    def grid(self) -> Discretisation:
        """The discretisation that the point stands on."""
        return self.solver.grid

    def balanced(self, guess: Array, delta: float) -> Equilibrium | None:
        """Equilibrium at `delta`, one step from here; none: not found."""
        seconds = self.grid.clock.seconds(self.delta, delta)
        now = self.equilibrium
        grip = self.solver.grip(now.u, now.contact.traction)
        closed = now.contact.pressure > 0.0 if delta > self.delta else None
        return self.solver.equilibrium(
            guess, state=self.state, delta=delta, seconds=seconds, grip=grip, closed=closed
        )


def extrapolate(
    point: PathPoint, before: Array | None, reach: float, outwards: float = 1.0
) -> Array:
    """First guess of the displacements after a step from `point`.

    - `before`: displacements at the point before, on the same mesh; none: in proportion to the
      approach.
    - `reach`: the step over the last one; without a last one, the approach over that of `point`.
    - `outwards`: factor by which the last increment is taken away from the pole, as the edge of the
      contact has moved.
    """
    u = point.equilibrium.u
    if before is None:
        return u * reach
    last = u - before
    if outwards != 1.0:
        last = moved_outwards(point.grid, last, outwards)
    return np.asarray(u + min(reach, RULES.stretch) * last)


def accept(point: PathPoint, found: Equilibrium, delta: float) -> PathPoint:
    """Return the point after `point`, with the equilibrium `found` at `delta`."""
    solver, grid = point.solver, point.grid
    seconds = grid.clock.seconds(point.delta, delta)
    state, stored = advance(
        grid.elements, found.u, state=point.state, rule=solver.rule, seconds=seconds
    )
    reading = read(grid, found, delta)
    last = point.record
    # F ~ Delta^n between two points: exact for a power law, where the trapezoidal rule is not
    work = last.work + _work_between(last.reading, reading)
    stored += found.contact.energy
    rubbed = last.rubbed + found.contact.rubbed
    record = Record(reading, work, stored, state.dissipated + rubbed, rubbed)
    return PathPoint(delta, found, state, record, solver)


def _work_between(a: Reading, b: Reading) -> float:
    if a.force <= 0.0 or b.force <= 0.0 or b.delta <= a.delta:
        return 0.5 * (a.force + b.force) * (b.delta - a.delta)
    n = np.log(b.force / a.force) / np.log(b.delta / a.delta)
    return float((b.force * b.delta - a.force * a.delta) / (n + 1.0))
