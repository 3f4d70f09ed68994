"""The whole finite-element computation of one pair: mesh, load, unload, measure.

`solve` is the main path. Lengths are in R and stresses in E' inside; results leave in SI units, so
the units of the input change nothing but the units of the output.
"""

from __future__ import annotations

import resource
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from ..core.errors import COMPLETED, Ending, Outcome
from .assemble import State, advance
from .discretise import Discretisation, discretise
from .material import EXACT
from .measure import Reading, read
from .newton import Equilibrium, Solver
from .problem import DEEPEST, Accuracy, ContactProblem, critical_depth
from .snapshot import take_profile, take_snapshot
from .solution import Counters, Curve, Profile, Snapshot, Solution, Unloading

Floats = npt.NDArray[np.float64]

_CUT = 0.4  # a failed step is tried again with this fraction of its logarithm
_REGROW = 1.5
_MOST_CUTS = 7
_STRETCH = 2.5  # largest factor by which the last increment is extrapolated
_BELOW_YIELD = 0.8  # elastic step ratio up to this fraction of the critical depth
_MOST_UNLOADING_STEPS = 60
_SOFT_START = (1e-3, 1e-2, 1e-1, 1.0)  # contact stiffness on the way to the first equilibrium


@dataclass(frozen=True)
class Record:
    """One accepted state with its energies (R = 1, E' = 1)."""

    reading: Reading
    work: float
    stored: float
    dissipated: float


@dataclass(frozen=True)
class Point:
    """Where a path stands: equilibrium, material state and energies."""

    delta: float
    equilibrium: Equilibrium
    state: State
    record: Record


@dataclass
class Tally:
    """Counts of one solve."""

    steps: int = 0
    failed: int = 0
    started: float = field(default_factory=time.process_time)
    wall: float = field(default_factory=time.perf_counter)


def solve(
    problem: ContactProblem,
    *,
    accuracy: Accuracy,
    progress: Callable[[float], None] | None = None,
    time_limit_s: float | None = None,
) -> Solution:
    """Solve the contact of a sphere and a flat through loading and unloading.

    Parameters
    ----------
    problem
        The pair and the depths.
    accuracy
        Numerical settings.
    progress
        Called with the fraction done, 0 to 1, after each step.
    time_limit_s
        Wall-clock limit; the solution then holds what was reached.

    Returns
    -------
    Solution
        Curves, unloadings and counters; `outcome` says how it ended. A solve that does not
        converge is a result too, with all that was reached.
    """
    grid = discretise(problem, accuracy)
    solver = Solver(grid, rule=EXACT)
    tally = Tally()
    loading: list[Record] = []
    unloadings: list[Unloading] = []
    snapshots: list[Snapshot] = []
    profiles: list[Profile] = []
    outcome = COMPLETED
    for item in _load(problem, accuracy, grid=grid, solver=solver, tally=tally):
        if isinstance(item, Outcome):
            outcome = item
            break
        if _among(item.delta, problem.depths) or item.delta > problem.depths[-1]:
            loading.append(item.record)
        if _among(item.delta, problem.unload_from):
            unloadings.append(_unload(item, problem=problem, grid=grid, solver=solver))
        if _among(item.delta, problem.snapshots):
            snapshots.append(
                take_snapshot(
                    grid, item.equilibrium, item.state, depth=item.delta, pair=problem.pair
                )
            )
        if _among(item.delta, problem.profiles):
            profiles.append(
                take_profile(grid, item.equilibrium, depth=item.delta, pair=problem.pair)
            )
        if progress is not None:
            progress(_fraction(item, problem))
        if time_limit_s is not None and time.perf_counter() - tally.wall > time_limit_s:
            outcome = Outcome(
                Ending.TIME_LIMIT,
                f"stopped after {time_limit_s:g} s at Delta/R = {item.delta:.4g}.",
                "Allow more time, or ask for a lower accuracy level.",
            )
            break
    return Solution(
        problem=problem,
        accuracy=accuracy,
        outcome=outcome,
        loading=_curve(loading, grid.stress_unit, problem.pair.R, energy=True),
        unloadings=tuple(unloadings),
        snapshots=tuple(snapshots),
        profiles=tuple(profiles),
        counters=_counters(solver, grid, tally),
        mesh_digest=grid.mesh.digest,
        boundary=f"top face moves by -Delta, {problem.top} radially",
    )


def _load(
    problem: ContactProblem,
    accuracy: Accuracy,
    *,
    grid: Discretisation,
    solver: Solver,
    tally: Tally,
) -> Iterator[Point | Outcome]:
    """Walk down the loading path, giving every accepted point; an `Outcome` ends it early."""
    onset = critical_depth(problem.pair)
    stops = _stops(problem, accuracy, onset)
    point = _first_contact(grid, solver, stops[0])
    if point is None:
        yield Outcome(
            Ending.NOT_CONVERGED,
            f"no equilibrium at the first depth, Delta/R = {stops[0]:.3g}.",
            "Start from a smaller first depth.",
        )
        return
    yield point
    before: Point | None = None
    ratio = accuracy.elastic_step_ratio
    target = 1
    while True:
        if target == len(stops):
            if point.record.reading.radius >= problem.radius_at_least or point.delta >= DEEPEST:
                return
            stops.append(point.delta * accuracy.step_ratio)
        goal = stops[target]
        limit = (
            accuracy.elastic_step_ratio
            if point.delta < _BELOW_YIELD * onset
            else accuracy.step_ratio
        )
        ratio = min(limit, 1.0 + (ratio - 1.0) * _REGROW)
        found, ratio = _step(
            point, before, goal=goal, ratio=ratio, solver=solver, grid=grid, tally=tally
        )
        if found is None:
            yield Outcome(
                Ending.NOT_CONVERGED,
                f"no equilibrium beyond Delta/R = {point.delta:.4g} (a/R = "
                f"{point.record.reading.radius:.3f}) after {_MOST_CUTS} cuts of the step.",
                "Try a finer or coarser accuracy level; the results up to there hold.",
            )
            return
        if np.isnan(found.record.reading.radius):
            yield Outcome(
                Ending.OUT_OF_RANGE,
                f"the contact grew out of the meshed surface at Delta/R = {found.delta:.4g}.",
                "Ask for a larger radius_at_least: it widens the mesh.",
            )
            return
        before, point = point, found
        tally.steps += 1
        if point.delta >= goal * (1.0 - 1e-12):
            target += 1
        yield point


def _stops(problem: ContactProblem, accuracy: Accuracy, onset: float) -> list[float]:
    """Depths that are hit exactly, and one well below first yield to start from."""
    depths = {*problem.depths, *problem.unload_from, *problem.snapshots, *problem.profiles}
    start = min(min(depths), 0.3 * onset)
    return sorted({start, *depths})


def _first_contact(grid: Discretisation, solver: Solver, delta: float) -> Point | None:
    """Equilibrium at the first depth, started from the rigid push of the sphere."""
    guess = np.zeros(grid.n_dofs)
    guess[1 : 2 * grid.mesh.n_sphere_points : 2] = -delta
    virgin = State.virgin(len(grid.elements.conn))
    # Well below first yield: the yield condition is left out, because Newton's way from the rigid
    # push could leave the elastic range; and the contact starts soft, because the whole push as
    # an overlap under the full stiffness would crush the innermost elements.
    solver.elements = replace(grid.elements, radius=np.full_like(grid.elements.radius, np.inf))
    found = None
    for softness in _SOFT_START:
        solver.surfaces = replace(grid.surfaces, stiffness=grid.surfaces.stiffness * softness)
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
    return Point(delta, found, state, record)


def _step(
    point: Point,
    before: Point | None,
    *,
    goal: float,
    ratio: float,
    solver: Solver,
    grid: Discretisation,
    tally: Tally,
) -> tuple[Point | None, float]:
    """Advance by at most `ratio` towards `goal`; the ratio that worked comes back."""
    for _ in range(_MOST_CUTS):
        n = max(1, int(np.ceil(np.log(goal / point.delta) / np.log(ratio) - 1e-9)))
        delta = goal if n == 1 else point.delta * (goal / point.delta) ** (1.0 / n)
        guess = _extrapolate(point, before, delta)
        found = solver.equilibrium(guess, state=point.state, delta=delta)
        if found is not None:
            return _accept(point, found, delta, solver=solver, grid=grid), ratio
        tally.failed += 1
        ratio = 1.0 + (min(ratio, delta / point.delta) - 1.0) * _CUT
    return None, ratio


def _extrapolate(point: Point, before: Point | None, delta: float) -> Floats:
    u = point.equilibrium.u
    if before is None:
        return u * (delta / point.delta)
    factor = min((delta - point.delta) / (point.delta - before.delta), _STRETCH)
    return np.asarray(u + factor * (u - before.equilibrium.u))


def _accept(
    point: Point, found: Equilibrium, delta: float, *, solver: Solver, grid: Discretisation
) -> Point:
    state, stored = advance(grid.elements, found.u, state=point.state, rule=solver.rule)
    reading = read(grid, found, delta)
    last = point.record
    # F ~ Delta^n between two points: exact for a power law, where the trapezoidal rule is not
    work = last.work + _work_between(last.reading, reading)
    stored += found.contact.energy
    return Point(delta, found, state, Record(reading, work, stored, state.dissipated))


def _work_between(a: Reading, b: Reading) -> float:
    if a.force <= 0.0 or b.force <= 0.0 or b.delta <= a.delta:
        return 0.5 * (a.force + b.force) * (b.delta - a.delta)
    n = np.log(b.force / a.force) / np.log(b.delta / a.delta)
    return float((b.force * b.delta - a.force * a.delta) / (n + 1.0))


def _unload(
    point: Point, *, problem: ContactProblem, grid: Discretisation, solver: Solver
) -> Unloading:
    """Follow the contact back to zero force, then lift the sphere off and read what is left."""
    start = point.record.reading
    pair_R = problem.pair.R
    records = [point.record]
    here = point
    behind: Point | None = None
    outcome = COMPLETED
    steps = 0
    # a flat punch of the final radius recovers F/(2 E' a): the scale of the first step
    step = 0.05 * start.force / (2.0 * max(start.radius, 1e-12))
    while here.record.reading.force > 2e-3 * start.force:
        found = None
        for _ in range(_MOST_CUTS):
            delta = here.delta - step
            guess = here.equilibrium.u if behind is None else _extrapolate(here, behind, delta)
            found = solver.equilibrium(guess, state=here.state, delta=delta)
            if found is not None:
                break
            step *= _CUT
        steps += 1
        if found is None or steps > _MOST_UNLOADING_STEPS:
            outcome = Outcome(
                Ending.NOT_CONVERGED,
                f"unloading from Delta/R = {point.delta:.4g} stopped at F/F_m = "
                f"{here.record.reading.force / start.force:.3g}.",
                "The residual depths are those of the last state.",
            )
            break
        behind, here = here, _accept(here, found, delta, solver=solver, grid=grid)
        records.append(here.record)
        slope = (behind.record.reading.force - here.record.reading.force) / (
            behind.delta - here.delta
        )
        step = min(0.6 * here.record.reading.force / slope, 2.0 * (behind.delta - here.delta))
    free = _lift(here, solver=solver, grid=grid)
    if free is None:
        free = here.equilibrium.u
        lift = here.delta
        if outcome.completed:
            outcome = Outcome(
                Ending.NOT_CONVERGED,
                f"the force-free state after Delta/R = {point.delta:.4g} was not found.",
                "The residual depths are those at F/F_m = 0.002.",
            )
    else:
        lift = -free[grid.driven[0]]
    again = None
    if problem.reload:
        back = [record.reading.delta for record in reversed(records[:-1])]
        again = _reload(here, back, grid=grid, solver=solver, pair_R=pair_R)
    slave, master = grid.surfaces.slave, grid.surfaces.master
    x = grid.mesh.points + free.reshape(-1, 2)
    return Unloading(
        depth=point.delta,
        curve=_curve(records, grid.stress_unit, pair_R, energy=False),
        residual_sphere=(lift + float(free[2 * slave[0] + 1])) * pair_R,
        residual_flat=-float(free[2 * master[0] + 1]) * pair_R,
        crater_r=x[master, 0] * pair_R,
        crater_z=x[master, 1] * pair_R,
        tip_r=x[slave, 0] * pair_R,
        tip_z=(x[slave, 1] + lift) * pair_R,
        steps=steps,
        outcome=outcome,
        reload=again,
    )


def _reload(
    here: Point, depths: list[float], *, grid: Discretisation, solver: Solver, pair_R: float
) -> Curve:
    """Load again through `depths`; the curve ends early where no equilibrium is found."""
    records = [here.record]
    behind: Point | None = None
    for delta in depths:
        guess = here.equilibrium.u if behind is None else _extrapolate(here, behind, delta)
        found = solver.equilibrium(guess, state=here.state, delta=delta)
        if found is None:
            break
        behind, here = here, _accept(here, found, delta, solver=solver, grid=grid)
        records.append(here.record)
    return _curve(records, grid.stress_unit, pair_R, energy=False)


def _lift(here: Point, *, solver: Solver, grid: Discretisation) -> Floats | None:
    """Displacements with the surfaces just apart, where the force is zero exactly."""
    step = 0.02 * here.delta
    for _ in range(3):
        delta = here.delta - step
        guess = here.equilibrium.u.copy()
        guess[1 : 2 * grid.mesh.n_sphere_points : 2] += step
        found = solver.equilibrium(guess, state=here.state, delta=delta)
        if found is not None and found.contact.force == 0.0:
            return found.u
        step *= 2.0
    return None


def _curve(records: list[Record], stress: float, R: float, *, energy: bool) -> Curve:
    def column(name: str) -> Floats:
        return np.array([getattr(r.reading, name) for r in records], dtype=float)

    force, radius = column("force") * stress * R**2, column("radius") * R
    work = np.array([r.work for r in records])
    spent = np.array([r.stored + r.dissipated for r in records])
    with np.errstate(divide="ignore", invalid="ignore"):
        hardness = np.where(radius > 0.0, force / (np.pi * radius**2), 0.0)
        defect = (work - spent) / work if energy else np.full(len(records), np.nan)
    return Curve(
        delta=column("delta") * R,
        force=force,
        radius=radius,
        radius_last_node=column("radius_last_node") * R,
        sphere=column("sphere") * R,
        flat=column("flat") * R,
        hardness=hardness,
        force_defect=column("force_defect"),
        energy_defect=defect,
        dissipated=np.array([r.dissipated for r in records]) * stress * R**3,
    )


def _counters(solver: Solver, grid: Discretisation, tally: Tally) -> Counters:
    timers = solver.timers
    return Counters(
        dofs=len(solver.free),
        steps=tally.steps,
        iterations=timers.iterations,
        factorisations=solver.system.n_factorisations,
        failed_steps=tally.failed,
        patterns=solver.system.n_patterns,
        cpu_s=time.process_time() - tally.started,
        cpu_assembly_s=timers.assembly,
        cpu_contact_s=timers.contact,
        cpu_linear_s=timers.linear,
        peak_memory_mb=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
    )


def _among(delta: float, depths: tuple[float, ...]) -> bool:
    return any(abs(delta - depth) <= 1e-12 * depth for depth in depths)


def _fraction(point: Point, problem: ContactProblem) -> float:
    first, last = problem.depths[0], problem.depths[-1]
    done = np.log(point.delta / (0.3 * first)) / np.log(last / (0.3 * first))
    return float(min(max(done, 0.0), 1.0))
