"""What a laboratory could do next: what its rig and bodies allow, and what it could build."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...core.inputs.rig_numbers import solid_inertia
from ...dynamics import CREEP, Press, Scene
from ...dynamics.files.second import second_of
from ...dynamics.mechanisms.arithmetic import as_deep, deepest
from ...dynamics.strength import strength_table
from ..comparison.conditions import Condition
from ..comparison.problem import Problem
from ..rules import RULES

_NEAR = math.radians(4.0)  # of angles that are one condition


@dataclass(frozen=True, eq=False)
class Candidate:
    """One trial.

    `built`: numbers of a striker that is to be built; none for one of the set's own; `like`: the
    set's striker of whose metal it is; itself if nothing is built.
    """

    change: str
    condition: Condition
    built: Mapping[str, float] | None = None
    like: str = ""


def presses_of(problem: Problem) -> list[Candidate]:
    """Return presses with each striker, as deep as its trials went, within what a press can do."""
    found: list[Candidate] = []
    bench = problem.bench.loads_N or RULES.bench
    second = second_of(problem.rig)
    struck = "flat" if second is None else "second sphere"
    # a free sphere is not pressed
    if leaves_no_mark(problem) or (second is not None and second.free):
        return []
    for name, trials in by_striker(problem).items():
        c, scene = trials[0]
        table = strength_table(scene.law, scene.pair)
        depths = [deepest(s) for _, s in trials]
        ends = np.exp(np.interp(np.log([min(depths), max(depths)]), table.log_depth,
                                table.stated.force))  # fmt: skip
        if any(one.press is not None for one, _ in trials):
            # pressed already: what is new lies beyond
            ends = ends * np.array([1.0 / RULES.press_beyond, RULES.press_beyond])
        low, high = np.clip(ends, *bench)
        if not ends[0] < bench[1] or not ends[1] > bench[0]:
            continue
        few = RULES.press_loads if high > RULES.press_wide * low else 2
        # nobody sets a press finer than to two digits
        first = low if few > 2 else low / 2.0
        loads = [float(f"{x:.2g}") for x in np.geomspace(first, high, few)]
        found += [
            Candidate(
                f"press {name} slowly on the same {struck}, each time on a fresh place, "
                f"{RULES.press_each} times to {load:g} N", at_load(c, scene, load),
            )
            for load in loads
        ]  # fmt: skip
    return found


def leaves_no_mark(problem: Problem) -> bool:
    """Whether the bodies are taken to be elastic, so that there is nothing to scan."""
    return problem.baseline in ("elastic", "measured-restitution")


def by_striker(problem: Problem) -> dict[str, list[tuple[Condition, Scene]]]:
    """Return the conditions of each striker, by name, with their scenes as stated."""
    stated = problem.scenes(np.zeros(problem.n_z))
    own: dict[str, list[tuple[Condition, Scene]]] = {}
    for c, scene in zip(problem.conditions, stated, strict=True):
        own.setdefault(c.striker, []).append((c, scene))
    return dict(sorted(own.items()))


def at_load(c: Condition, scene: Scene, load: float) -> Condition:
    """Return a press of a condition's striker, on fresh metal."""
    speed = as_deep(scene.with_(approach=CREEP, press=Press(load)))
    upright = replace(c, angle=math.pi / 2.0, tangential=0.0, spin=0.0, after=-1)
    return replace(upright, speed=speed, press=Press(load))


def candidates_of(problem: Problem) -> list[Candidate]:
    """Return trials within the speeds, angles and bodies of a set or its rig."""
    own: dict[str, list[Condition]] = {}
    for c in problem.conditions:
        if c.press is None:
            own.setdefault(c.striker, []).append(c)
    if not own:
        return []
    speeds = problem.bench.speeds_m_s or [c.speed for tested in own.values() for c in tested]
    places = np.geomspace(min(speeds), max(speeds), RULES.speeds_tried)
    fallen = any(c.around.from_height for c in problem.conditions)
    if not (fallen or problem.bench.speeds_m_s) and all(
        max(c.speed for c in x) < (1.0 + RULES.same_speed) * min(c.speed for c in x)
        for x in own.values()
    ):
        # each striker has one speed, and no height that could be another: a spring gives it
        places = np.zeros(0)
    first = {name: tested[0] for name, tested in own.items()}
    first |= {name: replace(c, striker=name) for name, c in _idle(problem, first).items()}
    found: list[Candidate] = []
    for name, c in sorted(first.items()):
        fresh = replace(c, after=-1)
        tried = [_moved(fresh, float(v)) for v in places]
        found += [
            Candidate(f"{name} at {x.speed:.2g} m/s{at_degrees(x)}", x, like=_of_set(problem, name))
            for x in tried
            if not any(_alike(x, there) for there in own.get(name, ()))
        ]
        found += _angles(problem, fresh, float(np.median(speeds)))
    return found


def to_build(problem: Problem) -> list[Candidate]:
    """Return strikers of another size, each at the largest speed."""
    blown = [c for c in problem.conditions if c.press is None]
    fastest = max((c.speed for c in blown), default=0.0)
    struck = problem.rig.of.get("target.radius_m", math.inf)
    seat = -struck if struck < 0.0 else math.inf
    found: list[Candidate] = []
    for name, c in sorted({c.striker: c for c in reversed(blown)}.items()):
        at = _moved(replace(c, after=-1), fastest)
        found += _built(problem.rig.striker(name), name, at, widest=seat)
    return found


def again(problem: Problem) -> list[int]:
    """Return more of what was done: of each striker up to so many conditions, slow to fast."""
    found: list[int] = []
    blown = [(c.speed, k, c.striker) for k, c in enumerate(problem.conditions) if c.press is None]
    for name in sorted({striker for *_, striker in blown}):
        blows = [k for _, k, striker in sorted(blown) if striker == name]
        few = np.linspace(0, len(blows) - 1, min(len(blows), RULES.speeds_tried))
        found += [blows[int(k)] for k in few.round()]
    return found


def _of_set(problem: Problem, name: str) -> str:
    """A striker of the set's trials of whose kind a striker is: itself, if it struck."""
    used = [c.striker for c in problem.conditions]
    rod = problem.rig.striker(name)["length_m"] > 0.0
    alike = [x for x in used if (problem.rig.striker(x)["length_m"] > 0.0) == rod]
    return name if name in used else next(iter(alike), "")


def _idle(problem: Problem, first: Mapping[str, Condition]) -> dict[str, Condition]:
    """Strikers of the sheet that have not struck, each with a trial of one of its kind."""
    end = ".tip_radius_m"
    names = [k.removeprefix("strikers.").removesuffix(end) for k in problem.rig.of
             if k.startswith("strikers.") and k.endswith(end)]  # fmt: skip
    like = {name: _of_set(problem, name) for name in names if name not in first}
    return {name: first[of] for name, of in like.items() if of in first}


def _alike(one: Condition, other: Condition) -> bool:
    """Whether a trial would repeat a condition."""
    near = abs(math.log(one.speed / other.speed)) < math.log(1.0 + RULES.same_speed)
    return near and abs(one.incidence - other.incidence) < _NEAR


def _moved(c: Condition, speed: float) -> Condition:
    """Return the impact at another speed, in the same direction of approach."""
    part = speed / c.speed
    return replace(
        c, speed=speed, tangential=c.tangential * part, spin=c.spin * part, setting_spread=0.0
    )


def at_degrees(c: Condition) -> str:
    """Return the angle in words; nothing where it is upright."""
    upright = c.incidence > math.pi / 2.0 - 1e-6
    return "" if upright else f" and {math.degrees(c.incidence):.0f} degrees"


def _angles(problem: Problem, c: Condition, speed: float) -> Iterable[Candidate]:
    """Angles between those tested that are not among them."""
    near = sorted(
        {x.incidence for x in problem.conditions if x.striker == c.striker and x.press is None}
    )
    stated = problem.bench.angles_deg
    # where all were upright, nothing says to which side a blow leans, or how it rubs
    leans = bool(near and stated and near[0] < 0.5 * math.pi - _NEAR)
    if len(near) < 2 and not leans:
        return
    low, high = map(math.radians, stated) if stated else (near[0], near[-1])
    for angle in np.linspace(low, high, 2 * RULES.angles_tried + 1):
        if min(abs(angle - a) for a in near) > _NEAR:
            trial = _moved(c, speed).inclined(float(angle))
            text = f"{c.striker} at {math.degrees(angle):.0f} degrees and {speed:.2g} m/s"
            yield Candidate(text, trial)


def _built(
    striker: Mapping[str, float], name: str, c: Condition, *, widest: float
) -> Iterable[Candidate]:
    """A rod of another length, a ball or a tip of another radius, with its own mass.

    A ball has to be smaller by as much again than the seat of radius `widest` [m] that it strikes.
    """
    where = f"at {c.speed:.2g} m/s{at_degrees(c)}"

    def like(text: str, mark: str, numbers: Mapping[str, float]) -> Candidate:
        built = replace(c, striker=f"{name} {mark} {ratio:g}")
        return Candidate(f"build a {text}, {where}", built, numbers, name)

    mass, length, shank = striker["mass_kg"], striker["length_m"], striker["radius_m"]
    for ratio in (1.0 / RULES.build_ratio, RULES.build_ratio):
        radius = striker["tip_radius_m"] * ratio
        if ratio * radius > widest:
            continue
        tip = {**striker, "tip_radius_m": radius}
        if length == 0.0:
            m = mass * ratio**3
            ball = {**tip, "radius_m": radius, "mass_kg": m,
                    "inertia_kg_m2": solid_inertia(m, radius, 0.0)}  # fmt: skip
            yield like(f"ball like {name} with a radius of {1e3 * radius:.3g} mm", "x", ball)
            continue
        yield like(f"rod like {name} with a tip radius of {1e3 * radius:.3g} mm", "R x", tip)
        m, long = mass * ratio, length * ratio
        rod = {**striker, "length_m": long, "mass_kg": m,
               "inertia_kg_m2": solid_inertia(m, shank, long)}  # fmt: skip
        yield like(f"rod like {name} but {long:.3g} m long", "L x", rod)
