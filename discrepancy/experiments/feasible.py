"""What a laboratory could do next: what its rig and bodies allow, and what it could build."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ...core.rig import Quantity, StrikerTable
from ..comparison.conditions import Condition
from ..comparison.problem import Problem

_SPEEDS, _ANGLES = 5, 4
"""Places over the tested range of speeds and of angles."""
_RATIO = 2.0
"""Size of a body to be built over that of the one there is, and one over it."""
_NEAR = math.radians(4.0)


@dataclass(frozen=True, eq=False)
class Candidate:
    """One trial.

    Parameters
    ----------
    change
        In words.
    condition
        The impact.
    built
        Table of a striker that is to be built; none for one of the set's own.
    like
        The set's striker of whose metal it is; itself if nothing is built.
    """

    change: str
    condition: Condition
    built: StrikerTable | None = None
    like: str = ""


def candidates_of(problem: Problem) -> list[Candidate]:
    """Return trials within the speeds, angles and bodies of a set, then those to be built."""
    speeds = [c.speed for c in problem.conditions]
    places = np.geomspace(min(speeds), max(speeds), _SPEEDS)
    if max(speeds) < 1.05 * min(speeds):
        places = np.array([float(np.median(speeds))])
    first = {c.striker: c for c in reversed(problem.conditions)}
    found: list[Candidate] = []
    for name, c in sorted(first.items()):
        fresh = replace(c, after=-1)
        tried = [_moved(fresh, float(v)) for v in places]
        found += [Candidate(f"{name} at {x.speed:.2g} m/s{_at(x)}", x) for x in tried]
        found += _angles(problem, fresh, float(np.median(speeds)))
    for name, c in sorted(first.items()):
        at = _moved(replace(c, after=-1), float(max(speeds)))
        found += _built(problem.rig.strikers[name], name, at)
    return found


def _moved(c: Condition, speed: float) -> Condition:
    """Return the impact at another speed, in the same direction of approach."""
    part = speed / c.speed
    return replace(c, speed=speed, tangential=c.tangential * part, spin=c.spin * part)


def _at(c: Condition) -> str:
    upright = c.incidence > math.pi / 2.0 - 1e-6
    return "" if upright else f" and {math.degrees(c.incidence):.0f} degrees"


def _angles(problem: Problem, c: Condition, speed: float) -> Iterable[Candidate]:
    """Angles between those tested that are not among them."""
    near = sorted({x.incidence for x in problem.conditions if x.striker == c.striker})
    if len(near) < 2:
        return
    for angle in np.linspace(near[0], near[-1], 2 * _ANGLES + 1):
        if min(abs(angle - a) for a in near) > _NEAR:
            trial = _moved(c, speed).inclined(float(angle))
            text = f"{c.striker} at {math.degrees(angle):.0f} degrees and {speed:.2g} m/s"
            yield Candidate(text, trial)


def _built(table: StrikerTable, name: str, c: Condition) -> Iterable[Candidate]:
    """A rod of another length, a ball or a tip of another radius, with its own mass."""
    where = f"at {c.speed:.2g} m/s{_at(c)}"
    for ratio in (1.0 / _RATIO, _RATIO):
        radius, mass = table.tip_radius_m.value * ratio, table.mass_kg.value
        if table.length == 0.0:
            changed = _changed(
                table,
                tip_radius_m=Quantity(value=radius),
                inertia_kg_m2=None,
                mass_kg=Quantity(value=mass * ratio**3),
            )
            text = f"build a ball like {name} with a radius of {1e3 * radius:.3g} mm"
            yield Candidate(
                f"{text}, {where}", replace(c, striker=f"{name} x {ratio:g}"), changed, name
            )
            continue
        changed = _changed(table, tip_radius_m=Quantity(value=radius))
        text = f"build a rod like {name} with a tip radius of {1e3 * radius:.3g} mm"
        yield Candidate(
            f"{text}, {where}", replace(c, striker=f"{name} R x {ratio:g}"), changed, name
        )
        if table.length_m is None:
            continue
        length = table.length * ratio
        changed = _changed(
            table,
            length_m=Quantity(value=length),
            mass_kg=Quantity(value=mass * ratio),
            inertia_kg_m2=None,
        )
        text = f"build a rod like {name} but {length:.3g} m long"
        yield Candidate(
            f"{text}, {where}", replace(c, striker=f"{name} L x {ratio:g}"), changed, name
        )


def _changed(table: StrikerTable, **values: Quantity | None) -> StrikerTable:
    return table.model_copy(update=values)
