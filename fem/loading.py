"""The loading path: from first contact down to the last depth, on meshes that follow the contact.

The mesh is fine only about the edge of the contact. When the edge nears the end of the fine zone, a
mesh made for the present radius takes over at the same approach (`remesh`).
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ..core.arrays import Array
from ..core.errors import Ending, Outcome
from ..core.rules import RULES as CORE
from .assemble import advance
from .discretise import discretise
from .elements import State
from .material import EXACT
from .mesh import Zone
from .newton import Solver, Timers
from .path import MOST_CUTS, PathPoint, Record, accept, extrapolate
from .problem import Accuracy, ContactProblem
from .remesh import Transfer
from .results.measure import read
from .rules import RULES

# limit: ratio of depths below which the path stands still, whatever converges [-]: a million
# steps would follow
_LEAST_STEP_RATIO = 1.0 + 1e-6


@dataclass
class Tally:
    """Counts of one solve."""

    steps: int = 0
    failed: int = 0
    meshes: int = 1
    jump: float = 0.0
    factorisations: int = 0
    patterns: int = 0
    dofs: int = 0
    timers: Timers = field(default_factory=Timers)
    started: float = field(default_factory=time.process_time)
    wall: float = field(default_factory=time.perf_counter)
    digests: list[str] = field(default_factory=list)

    def leave(self, solver: Solver) -> None:
        """Add up the counts of a mesh that is done with."""
        self.factorisations += solver.system.n_factorisations
        self.patterns += solver.system.n_patterns
        self.dofs = max(self.dofs, len(solver.free))
        self.digests.append(solver.grid.mesh.digest)


class Loading:
    """Walks down the loading path of a problem; the counts go to `tally`."""

    def __init__(self, problem: ContactProblem, accuracy: Accuracy, tally: Tally) -> None:
        self.problem, self.accuracy, self.tally = problem, accuracy, tally
        self._onset = problem.pair.first_yield
        self._stops = _stops(problem, self._onset)
        self._radius = np.sqrt(self._stops[0])  # of the contact that the mesh is made for
        self._beyond = 0  # steps past the end

    def points(self) -> Iterator[PathPoint | Outcome]:
        """Give every accepted point; an `Outcome` ends the path early.

        A few points follow past the end, for the smooth curve at the last depth (`past_end`).
        """
        point = self._first_contact()
        if point is None:
            yield Outcome(
                Ending.NOT_CONVERGED,
                f"no equilibrium at the first depth, Delta/R = {self._stops[0]:.3g}.",
                "Start from a smaller first depth.",
            )
            return
        before: Array | None = None
        last_step = point.delta
        ratio = self.accuracy.elastic_step_ratio
        target = 1
        while True:
            yield point
            point, before = self._follow(point, before)
            if target == len(self._stops):
                if self._deep_enough(point):
                    self._beyond += 1
                    if self._beyond > RULES.steps_beyond:
                        return
                self._stops.append(point.delta * self.accuracy.step_ratio)
            goal = self._stops[target]
            ratio = min(self._limit(point), 1.0 + (ratio - 1.0) * _growth(point))
            found, ratio = self._step(point, before, last_step, goal=goal, ratio=ratio)
            if self._beyond and (found is None or np.isnan(found.record.reading.radius)):
                return
            if found is None:
                yield self._stuck(point)
                return
            if np.isnan(found.record.reading.radius):
                yield Outcome(
                    Ending.OUT_OF_RANGE,
                    f"the contact grew out of the meshed surface at Delta/R = {found.delta:.4g}.",
                    "Go less deep: the part of the surface that can touch ends there.",
                )
                return
            before, last_step = point.equilibrium.u, found.delta - point.delta
            point = found
            self.tally.steps += 1
            if point.delta >= goal * (1.0 - 1e-12):
                target += 1

    @property
    def past_end(self) -> bool:
        """Whether the last point lies past the end."""
        return self._beyond > 0

    def _deep_enough(self, point: PathPoint) -> bool:
        radius = point.record.reading.radius
        return radius >= self.problem.radius_at_least or point.delta >= CORE.deepest

    def _limit(self, point: PathPoint) -> float:
        elastic = point.delta < RULES.elastic_until * self._onset
        return self.accuracy.elastic_step_ratio if elastic else self.accuracy.step_ratio

    def _stuck(self, point: PathPoint) -> Outcome:
        return Outcome(
            Ending.NOT_CONVERGED,
            f"no equilibrium beyond Delta/R = {point.delta:.4g} (a/R = "
            f"{point.record.reading.radius:.3f}), however short the step.",
            "Go less deep (docs/case.md: how deep this goes), or try another accuracy level; the "
            "results up to there hold.",
        )

    def _solver(self) -> Solver:
        last = RULES.zone_serves * self._radius > RULES.last_mesh
        zone = Zone(
            RULES.zone_behind * self._radius, 1.0 if last else RULES.zone_ahead * self._radius
        )
        grid = discretise(self.problem, self.accuracy, zone)
        return Solver(grid, rule=EXACT, timers=self.tally.timers)

    def _first_contact(self) -> PathPoint | None:
        """Equilibrium at the first depth, started from the rigid push of the sphere."""
        delta = self._stops[0]
        solver = self._solver()
        grid = solver.grid
        guess = np.zeros(grid.n_dofs)
        guess[1 : 2 * grid.mesh.n_sphere_points : 2] = -delta
        virgin = State.virgin(len(grid.elements.conn))
        # Well below first yield: the yield condition is left out, because Newton's way from the
        # rigid push could leave the elastic range; and the contact starts soft, because the whole
        # push as an overlap under the full stiffness would crush the innermost elements.
        solver.elements = grid.elements.elastic
        found = None
        for softness in RULES.soft_start:
            solver.surfaces = grid.surfaces._replace(stiffness=grid.surfaces.stiffness * softness)
            found = solver.equilibrium(guess, state=virgin, delta=delta)
            if found is None:
                break
            guess = found.u
        solver.elements, solver.surfaces = grid.elements, grid.surfaces
        if found is None:
            return None
        state, stored = advance(grid.elements, found.u, state=virgin, rule=solver.rule)
        reading = read(grid, found, delta)
        # below first yield F ~ Delta^(3/2), so the work so far is 2/5 F Delta
        stored += found.contact.energy
        record = Record(reading, 0.4 * reading.force * delta, stored, state.dissipated)
        return PathPoint(delta, found, state, record, solver)

    def _step(
        self, point: PathPoint, before: Array | None, last_step: float, *, goal: float, ratio: float
    ) -> tuple[PathPoint | None, float]:
        """Advance by at most `ratio` towards `goal`; the ratio that worked comes back."""
        for _ in range(MOST_CUTS):
            if ratio < _LEAST_STEP_RATIO:
                break
            n = max(1, int(np.ceil(np.log(goal / point.delta) / np.log(ratio) - 1e-9)))
            delta = goal if n == 1 else point.delta * (goal / point.delta) ** (1.0 / n)
            reach = delta / point.delta if before is None else (delta - point.delta) / last_step
            growth = (point.delta + delta) / (2.0 * point.delta - last_step)
            guess = extrapolate(point, before, reach, growth**RULES.outwards)
            found = point.balanced(guess, delta)
            if found is not None:
                return accept(point, found, delta), ratio
            self.tally.failed += 1
            ratio = 1.0 + (min(ratio, delta / point.delta) - 1.0) * RULES.step_cut
        return None, ratio

    def _follow(self, point: PathPoint, before: Array | None) -> tuple[PathPoint, Array | None]:
        """The same point on a mesh made for its contact radius, where the old one is outgrown."""
        radius = point.record.reading.radius
        if (
            radius < RULES.zone_serves * self._radius
            or RULES.zone_serves * self._radius > RULES.last_mesh
        ):
            return point, before
        was, self._radius = self._radius, radius
        solver = self._solver()
        transfer = Transfer(point.grid, solver.grid)
        guess = transfer.displacements(point.equilibrium.u)
        state = transfer.state(point.state, guess)
        # no time passes: what feels the rate can't flow
        solver.elements = solver.grid.elements.unhurried
        held = np.interp(
            solver.grid.slave_radius, point.grid.slave_radius, point.equilibrium.contact.traction
        )
        found = solver.equilibrium(
            guess, state=state, delta=point.delta, grip=solver.grip(guess, held)
        )
        if found is None:
            self._radius = was  # it is tried again after the next step
            return point, before
        self.tally.leave(point.solver)
        self.tally.meshes += 1
        state, stored = advance(solver.elements, found.u, state=state, rule=solver.rule)
        solver.elements = solver.grid.elements
        reading = read(solver.grid, found, point.delta)
        old = point.record
        jump = abs(reading.force / old.reading.force - 1.0)
        self.tally.jump = max(self.tally.jump, jump)
        rubbed = old.rubbed + found.contact.rubbed
        record = Record(
            reading, old.work, stored + found.contact.energy, state.dissipated + rubbed, rubbed
        )
        moved = PathPoint(point.delta, found, state, record, solver)
        return moved, None if before is None else transfer.displacements(before)


def _growth(point: PathPoint) -> float:
    return next(
        (factor for most, factor in RULES.regrowth if point.equilibrium.iterations <= most), 1.0
    )


def _stops(problem: ContactProblem, onset: float) -> list[float]:
    """Depths that are hit exactly, and one well below first yield to start from."""
    depths = {*problem.depths, *problem.unload_from, *problem.snapshots, *problem.profiles}
    start = RULES.lead_in * min(min(depths), 0.3 * onset)
    return sorted({start, *depths})
