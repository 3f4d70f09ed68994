"""Unloading to zero force, the force-free state and the way back to the load."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..core.arrays import Array
from ..core.errors import COMPLETED, Ending, Outcome
from .path import MOST_CUTS, PathPoint, Record, accept, extrapolate
from .problem import ContactProblem
from .rules import RULES
from .solution import Curve, Unloading

# limit: most steps of an unloading [-]
_UNLOADING_STEPS = 60


def unload(point: PathPoint, problem: ContactProblem) -> Unloading:
    """Follow the contact back to zero force, then lift the sphere off and read what is left."""
    grid, pair_R = point.grid, problem.pair.R
    records = [point.record]
    here, outcome, steps = _back(point, records)
    free = _lift(here)
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
        again = _reload(here, back, pair_R)
    sphere, flat = grid.surfaces.sphere, grid.surfaces.flat
    x = grid.mesh.points + free.reshape(-1, 2)
    return Unloading(
        depth=point.delta,
        curve=curve_of(records, grid.stress_unit, pair_R, energy=False),
        residual_sphere=(lift + float(free[2 * sphere[0] + 1])) * pair_R,
        residual_flat=-float(free[2 * flat[0] + 1]) * pair_R,
        crater_r=x[flat, 0] * pair_R,
        crater_z=x[flat, 1] * pair_R,
        tip_r=x[sphere, 0] * pair_R,
        tip_z=(x[sphere, 1] + lift) * pair_R,
        steps=steps,
        outcome=outcome,
        reload=again,
    )


def _back(point: PathPoint, records: list[Record]) -> tuple[PathPoint, Outcome, int]:
    """Walk back until next to no force is left: last state, how it ended, steps; fill `records`."""
    start = point.record.reading
    here = point
    behind: PathPoint | None = None
    steps = 0
    # a flat punch of the final radius recovers F/(2 E' a): the scale of the first step
    step = 0.05 * start.force / (2.0 * max(start.radius, 1e-12))
    while here.record.reading.force > 2e-3 * start.force:
        found = None
        for _ in range(MOST_CUTS):
            delta = here.delta - step
            guess = _guess(here, behind, delta)
            found = here.balanced(guess, delta)
            if found is not None:
                break
            step *= RULES.step_cut
        steps += 1
        if found is None or steps > _UNLOADING_STEPS:
            stopped = Outcome(
                Ending.NOT_CONVERGED,
                f"unloading from Delta/R = {point.delta:.4g} stopped at F/F_m = "
                f"{here.record.reading.force / start.force:.3g}.",
                "The residual depths are those of the last state.",
            )
            return here, stopped, steps
        behind, here = here, accept(here, found, delta)
        records.append(here.record)
        slope = (behind.record.reading.force - here.record.reading.force) / (
            behind.delta - here.delta
        )
        step = min(0.6 * here.record.reading.force / slope, 2.0 * (behind.delta - here.delta))
    return here, COMPLETED, steps


def _reload(here: PathPoint, depths: list[float], pair_R: float) -> Curve:
    """Load again through `depths`; the curve ends early where no equilibrium is found."""
    records = [here.record]
    behind: PathPoint | None = None
    for delta in depths:
        guess = _guess(here, behind, delta)
        found = here.balanced(guess, delta)
        if found is None:
            break
        behind, here = here, accept(here, found, delta)
        records.append(here.record)
    return curve_of(records, here.grid.stress_unit, pair_R, energy=False)


def _guess(here: PathPoint, behind: PathPoint | None, delta: float) -> Array:
    if behind is None:
        return here.equilibrium.u
    reach = (delta - here.delta) / (here.delta - behind.delta)
    return extrapolate(here, behind.equilibrium.u, reach)


def _lift(here: PathPoint) -> Array | None:
    """Displacements with the surfaces just apart, where the force is zero exactly."""
    grid, now = here.grid, here.record.reading
    # Hertz's way back from this force is 3/4 F/(E' a): it is long where little has yielded
    step = max(0.02 * here.delta, now.force / max(now.radius, 1e-12))
    for _ in range(3):
        delta = here.delta - step
        guess = here.equilibrium.u.copy()
        guess[1 : 2 * grid.mesh.n_sphere_points : 2] += step
        found = here.balanced(guess, delta)
        if found is not None and found.contact.force == 0.0:
            return found.u
        step *= 2.0
    return None


def level(unloading: Unloading, *, force: float, radius: float) -> Unloading:
    """Scale forces and contact radii of an unloading, and of its reload, by two factors."""

    def scaled(curve: Curve) -> Curve:
        return replace(
            curve,
            force=force * curve.force,
            radius=radius * curve.radius,
            hardness=force / radius**2 * curve.hardness,
        )

    again = unloading.reload
    return replace(
        unloading, curve=scaled(unloading.curve), reload=None if again is None else scaled(again)
    )


def curve_of(records: list[Record], stress: float, R: float, *, energy: bool) -> Curve:
    """Columns of a list of records, in SI units; `stress` is E' [Pa], `energy` its balance too."""

    def column(name: str) -> Array:
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
