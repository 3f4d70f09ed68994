"""The whole finite-element computation of one pair: mesh, load, unload, measure.

`solve` is the main path. Lengths are in R and stresses in E' inside; results leave in SI units, so
the units of the input change nothing but the units of the output.
"""

from __future__ import annotations

import hashlib
import resource
import time
from collections.abc import Callable

import numpy as np

from ..core.errors import COMPLETED, Ending, Outcome
from .loading import Loading, Tally
from .path import Point, Record
from .problem import Accuracy, ContactProblem
from .snapshot import take_profile, take_snapshot
from .solution import Counters, Profile, Snapshot, Solution, Unloading
from .unloading import curve_of, unload


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
    tally = Tally()
    loading: list[Record] = []
    unloadings: list[Unloading] = []
    snapshots: list[Snapshot] = []
    profiles: list[Profile] = []
    outcome = COMPLETED
    last: Point | None = None
    for item in Loading(problem, accuracy, tally).points():
        if isinstance(item, Outcome):
            outcome = item
            break
        last = item
        if _among(item.delta, problem.depths) or item.delta > problem.depths[-1]:
            loading.append(item.record)
        if _among(item.delta, problem.unload_from):
            unloadings.append(unload(item, problem))
        if _among(item.delta, problem.snapshots):
            snapshots.append(
                take_snapshot(
                    item.grid, item.equilibrium, item.state, depth=item.delta, pair=problem.pair
                )
            )
        if _among(item.delta, problem.profiles):
            profiles.append(
                take_profile(item.grid, item.equilibrium, depth=item.delta, pair=problem.pair)
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
    if last is not None:
        tally.leave(last.solver)
    return Solution(
        problem=problem,
        accuracy=accuracy,
        outcome=outcome,
        loading=curve_of(loading, problem.pair.E_reduced, problem.pair.R, energy=True),
        unloadings=tuple(unloadings),
        snapshots=tuple(snapshots),
        profiles=tuple(profiles),
        counters=_counters(tally),
        mesh_digest=hashlib.sha256("".join(tally.digests).encode()).hexdigest(),
        boundary=f"top face moves by -Delta, {problem.top} radially",
    )


def _counters(tally: Tally) -> Counters:
    timers = tally.timers
    return Counters(
        dofs=tally.dofs,
        steps=tally.steps,
        iterations=timers.iterations,
        factorisations=tally.factorisations,
        failed_steps=tally.failed,
        patterns=tally.patterns,
        meshes=tally.meshes,
        transfer_jump=tally.jump,
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
