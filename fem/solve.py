"""The whole finite-element computation of one pair: mesh, load, unload, measure.

`solve` is the main path. Lengths are in R and stresses in E' inside; results leave in SI units, so
the units of the input change nothing but the units of the output.
"""

from __future__ import annotations

import hashlib
import resource
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from ..core.errors import COMPLETED, Ending, Outcome
from .loading import Loading, Tally
from .path import PathPoint, Record
from .problem import Accuracy, ContactProblem
from .results.ripple import RippleTrack
from .results.snapshot import take_profile, take_snapshot
from .solution import Counters, Curve, Profile, Snapshot, Solution, Unloading
from .unloading import curve_of, level, unload


def solve(
    problem: ContactProblem,
    *,
    accuracy: Accuracy,
    progress: Callable[[float], None] | None = None,
    time_limit_s: float | None = None,
) -> Solution:
    """Solve the contact of a sphere and a flat through loading and unloading.

    - `problem`: the pair and the depths.
    - `accuracy`: numerical settings.
    - `progress`: called with the fraction done, 0 to 1, after each step.
    - `time_limit_s`: wall-clock limit; the solution then holds what was reached.

    Returned: curves, unloadings and counters; `outcome` says how it ended. A solve that does not
    converge is a result too, with all that was reached.
    """
    tally = Tally()
    found = _Found(problem)
    outcome = COMPLETED
    last: PathPoint | None = None
    path = Loading(problem, accuracy, tally)
    for item in path.points():
        if isinstance(item, Outcome):
            outcome = item
            break
        last = item
        found.track.readings.append(item.record.reading)
        if path.past_end:
            continue
        found.take(item)
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
        loading=found.curve(),
        unloadings=found.levelled(),
        snapshots=tuple(found.snapshots),
        profiles=tuple(found.profiles),
        counters=_counters(tally),
        mesh_digest=hashlib.sha256("".join(tally.digests).encode()).hexdigest(),
        boundary=f"top face moves by -Delta, {problem.top} radially",
    )


@dataclass
class _Found:
    """What is kept of the points of the path, as the problem asks."""

    problem: ContactProblem
    track: RippleTrack = field(default_factory=RippleTrack)
    loading: list[Record] = field(default_factory=list)
    unloadings: list[Unloading] = field(default_factory=list)
    snapshots: list[Snapshot] = field(default_factory=list)
    profiles: list[Profile] = field(default_factory=list)

    def take(self, point: PathPoint) -> None:
        """Record, unload from and picture a point where its depth asks for it."""
        wanted, delta = self.problem, point.delta
        if _among(delta, wanted.depths) or delta > wanted.depths[-1]:
            self.loading.append(point.record)
        if _among(delta, wanted.unload_from):
            self.unloadings.append(unload(point, wanted))
        here = (point.grid, point.equilibrium)
        if _among(delta, wanted.snapshots):
            self.snapshots.append(take_snapshot(*here, point.state, depth=delta, pair=wanted.pair))
        if _among(delta, wanted.profiles):
            self.profiles.append(take_profile(*here, depth=delta, pair=wanted.pair))

    def curve(self) -> Curve:
        """The loading curve without its ripple."""
        pair = self.problem.pair
        smooth = self.track.smooth([record.reading for record in self.loading])
        records = [
            replace(record, reading=reading)
            for record, reading in zip(self.loading, smooth, strict=True)
        ]
        return curve_of(records, pair.E_reduced, pair.R, energy=True)

    def levelled(self) -> tuple[Unloading, ...]:
        """The unloadings, scaled so that each begins at the smooth curve's force and radius."""
        raw = [r for r in self.track.readings if _among(r.delta, self.problem.unload_from)]
        smooth = self.track.smooth(raw)
        return tuple(
            level(unloading, force=to.force / was.force, radius=to.radius / was.radius)
            for unloading, was, to in zip(self.unloadings, raw, smooth, strict=True)
        )


def _counters(tally: Tally) -> Counters:
    return Counters(
        **vars(tally.timers),
        dofs=tally.dofs,
        steps=tally.steps,
        factorisations=tally.factorisations,
        failed_steps=tally.failed,
        patterns=tally.patterns,
        meshes=tally.meshes,
        transfer_jump=tally.jump,
        cpu_s=time.process_time() - tally.started,
        peak_memory_mb=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
    )


def _among(delta: float, depths: tuple[float, ...]) -> bool:
    return any(abs(delta - depth) <= 1e-12 * depth for depth in depths)


def _fraction(point: PathPoint, problem: ContactProblem) -> float:
    first, last = problem.depths[0], problem.depths[-1]
    done = np.log(point.delta / (0.3 * first)) / np.log(last / (0.3 * first))
    return float(min(max(done, 0.0), 1.0))
