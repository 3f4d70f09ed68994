"""Which feasible trial would best separate what is still confounded.

Each candidate is simulated under the rival explanations with their posterior spread; its worth is
D = (mu_i - mu_j)^T (Sigma_i + Sigma_j)^-1 (mu_i - mu_j), the criterion of Buzzi-Ferraris and
Forzatti (Chem. Eng. Sci. 39 (1984) 81), averaged over the pairs.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..core.observables import OBSERVABLES
from ..core.rig import Quantity, StrikerTable
from .cells import compared
from .conditions import Condition
from .forward import Point, Simulator
from .inference.fit import Fit
from .problem import Problem
from .rank import Ranking

Array = NDArray[np.float64]
_Candidate = tuple[str, Condition, StrikerTable | None]

_SAMPLES = 6


@dataclass(frozen=True, slots=True)
class Proposal:
    """A trial to make, and how well it would discriminate."""

    change: str
    expected_discrimination: float


def rivals_of(members: Sequence[Fit], ranking: Ranking) -> list[Fit]:
    """Return the explanations that a next experiment should tell apart.

    Those that the verdict holds; where it holds one or none, it or the baseline, and the best other
    single mechanism or the baseline.
    """
    if len(members) > 1:
        return list(members)
    best = members[0] if members else ranking.base
    others = [f for f in (*ranking.singles, ranking.base) if f.name != best.name]
    return [best, *others[:1]]


def propose(
    simulator: Simulator, rivals: Sequence[Fit], rng: np.random.Generator
) -> list[Proposal]:
    """Return candidate trials, best first.

    Parameters
    ----------
    simulator
        The problem.
    rivals
        At least two explanations.
    rng
        Draws the posterior samples.
    """
    problem = simulator.problem
    candidates = _candidates(problem)
    if len(rivals) < 2 or not candidates:
        return []
    strikers = {**problem.rig.strikers, **{c.striker: s for _, c, s in candidates if s}}
    trial = simulator.of(
        replace(
            problem, conditions=tuple(c for _, c, _ in candidates),
            rig=problem.rig.model_copy(update={"strikers": strikers}),
        )
    )  # fmt: skip
    seen = [trial.observe(f.mechanisms, _samples(f, rng)) for f in rivals]
    measured = list(dict.fromkeys(problem.cells.observable))
    found = []
    for k, (change, _, _) in enumerate(candidates):
        same = _worth([{o: s[o][:, k] for o in measured} for s in seen], problem)
        found.append(Proposal(f"{change}, measuring {_words(measured)}", same))
        for extra, row in OBSERVABLES.items():
            idle = row.phase == "sliding" and candidates[k][1].angle > 1.5
            if extra in measured or idle or not row.usual_noise:
                continue
            more = _worth([{o: s[o][:, k] for o in [*measured, extra]} for s in seen], problem)
            if more > 1.5 * same:
                found.append(Proposal(f"{change}, measuring {_words([*measured, extra])}", more))
    found.sort(key=lambda p: -p.expected_discrimination)
    return found


def _words(names: Sequence[str]) -> str:
    return ", ".join(OBSERVABLES[n].label for n in names)


def _samples(fitted: Fit, rng: np.random.Generator) -> list[Point]:
    lower = np.linalg.cholesky(fitted.covariance + 1e-9 * np.eye(len(fitted.z)))
    places = fitted.grid.places() if fitted.mechanisms else np.zeros((1, 0))
    chosen = rng.choice(len(places), size=_SAMPLES, p=fitted.weight)
    return [
        Point(fitted.z + lower @ rng.standard_normal(len(fitted.z)), fitted.grid.values(places[i]))
        for i in chosen
    ]


def _worth(seen: Sequence[dict[str, Array]], problem: Problem) -> float:
    names = list(seen[0])
    noise = np.array([_noise(name, seen, problem) for name in names])
    tables = []
    for one in seen:
        tables.append(np.stack([compared(n, one[n]) for n in names]))
    worth = []
    for a, b in itertools.combinations(tables, 2):
        gap = a.mean(axis=1) - b.mean(axis=1)
        cov = np.atleast_2d(np.cov(a)) + np.atleast_2d(np.cov(b)) + 2.0 * np.diag(noise**2)
        worth.append(float(gap @ np.linalg.solve(cov, gap)))
    return float(np.mean(worth))


def _noise(name: str, seen: Sequence[dict[str, Array]], problem: Problem) -> float:
    here = np.array([o == name for o in problem.cells.observable])
    if here.any():
        return float(np.median(problem.cells.std[here]))
    size = float(np.mean([np.mean(np.abs(s[name])) for s in seen]))
    row = OBSERVABLES[name]
    return row.usual_noise * (1.0 if row.log else max(size, 1e-12))


def _candidates(problem: Problem) -> list[_Candidate]:
    """Conditions near those of the set: other speeds, lengths, radii and angles."""
    found: list[_Candidate] = []
    heard = set()
    for c in problem.conditions:
        if c.striker in heard:
            continue
        heard.add(c.striker)
        speeds = [x.speed for x in problem.conditions if x.striker == c.striker]
        for v in (0.4 * min(speeds), 2.0 * max(speeds), 4.0 * max(speeds)):
            found.append((f"{c.striker} at {v:.2g} m/s", replace(c, speed=v), None))
        table = problem.rig.strikers[c.striker]
        v = float(np.median(speeds))
        if table.length > 0.0 and table.length_m is not None:
            for ratio in (0.4, 2.5):
                changed = table.model_copy(
                    update={
                        "length_m": Quantity(value=table.length * ratio),
                        "mass_kg": Quantity(value=table.mass_kg.value * ratio),
                        "inertia_kg_m2": None,
                    }
                )
                name = f"{c.striker} x {ratio:g}"
                text = (
                    f"a rod like {c.striker} but {table.length * ratio:.3g} m long at {v:.2g} m/s"
                )
                found.append((text, replace(c, striker=name, speed=v), changed))
            for angle in (30.0, 60.0, 90.0):
                near = [x.angle for x in problem.conditions if x.striker == c.striker]
                radians = math.radians(angle)
                if min(abs(radians - a) for a in near) > math.radians(8.0):
                    text = f"{c.striker} at {angle:.0f} degrees and {v:.2g} m/s"
                    found.append((text, replace(c, angle=radians, speed=v), None))
        for ratio in (0.4, 2.5):
            radius = table.tip_radius_m.value * ratio
            changed = table.model_copy(update={"tip_radius_m": Quantity(value=radius)})
            name = f"{c.striker} R x {ratio:g}"
            text = f"{c.striker} with a tip radius of {1e3 * radius:.3g} mm at {v:.2g} m/s"
            found.append((text, replace(c, striker=name, speed=v), changed))
    return found
