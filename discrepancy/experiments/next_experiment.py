"""What to do next: the trial, the instrument or the observable that would bring most.

Rivals are the explanations that share the probability. A trial is simulated under each with its
posterior spread; its worth is D = (mu_i - mu_j)^T (Sigma_i + Sigma_j)^-1 (mu_i - mu_j), the
criterion of Box and Hill (Technometrics 9 (1967) 57) and of Buzzi-Ferraris and Forzatti (Chem. Eng.
Sci. 39 (1984) 81), averaged over the pairs with the product of their probabilities. Half of it is
about the nats by which the odds of two rivals would move.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ...core.observables import OBSERVABLES
from ..choice.odds import Odds
from ..comparison.cells import compared
from ..comparison.forward import Point, Simulator
from ..comparison.problem import Problem
from ..inference.fit import Fit
from ..rank import Ranking
from .feasible import Candidate, candidates_of

Array = NDArray[np.float64]

SHARE = 0.02
"""Probability from which an explanation is a rival."""
MOST = 4
"""Rivals that are told apart."""
LITTLE = 0.9
"""Width of an interval, over that of today, above which a change is not worth its while."""
_DECIDES = 1.0  # standard deviations by which rivals must differ for one trial to tell much
_SAMPLES = 12
_BUILD = 2.0  # what is to be built must bring as many times more than what is there


@dataclass(frozen=True, slots=True)
class Proposal:
    """What to do, how well it would discriminate, and what it would do to the interval.

    Parameters
    ----------
    change
        In words.
    expected_discrimination
        D averaged over the rivals; 0 where there are none.
    kind
        `trial`, `build`, `noise`, `observable` or `none`.
    interval
        Width of the leading parameter's interval over that of today; nan where not worked out.
    trial
        Striker, speed [m/s] and angle [degrees] of a trial, and mass [kg] and tip radius [m].
    """

    change: str
    expected_discrimination: float
    kind: str = "trial"
    interval: float = math.nan
    trial: Mapping[str, str | float] = field(default_factory=dict)

    @property
    def gains(self) -> tuple[str, ...]:
        """What it would tell, in words."""
        found = []
        apart = math.sqrt(max(self.expected_discrimination, 0.0))
        if apart >= _DECIDES:
            found.append(
                f"what is still confounded would lie about {apart:.1f} standard deviations apart"
            )
        elif apart > 0.0:
            found.append(
                "once will not decide: what is still confounded would lie only "
                f"{apart:.1g} standard deviations apart"
            )
        if math.isfinite(self.interval):
            found.append(f"the interval would be {self.interval:.2g} times as wide as now")
        return tuple(found)


def rivals_of(ranking: Ranking, odds: Odds) -> list[tuple[Fit, float]]:
    """Return the explanations that share the probability, most probable first, and their shares."""
    shared = [(f, odds.probability[f.name]) for f in ranking.fits]
    shared = sorted(shared, key=lambda item: -item[1])
    return [(f, p) for i, (f, p) in enumerate(shared[:MOST]) if i < 2 or p > SHARE]


def propose(
    simulator: Simulator, ranking: Ranking, odds: Odds, rng: np.random.Generator
) -> list[Proposal]:
    """Return what to do next, best first.

    Parameters
    ----------
    simulator
        The problem.
    ranking, odds
        The explanations and their probabilities.
    rng
        Draws the posterior samples.
    """
    rivals = rivals_of(ranking, odds)
    if len(rivals) < 2:
        return []
    points = [_samples(f, rng) for f, _ in rivals]
    found = [*_trials(simulator, rivals, points), *_further(simulator, rivals, points)]
    found.sort(key=lambda p: -p.expected_discrimination / (_BUILD if p.kind == "build" else 1.0))
    best = rivals[0][0]
    if best.mechanisms:
        sharper = _sharper(simulator.problem, best)
        if 1.0 - rivals[0][1] < SHARE:
            # nothing left to tell apart: what is left is to know the numbers better
            return [*sharper, *found]
        found += sharper
    return found


def _trials(
    simulator: Simulator, rivals: Sequence[tuple[Fit, float]], points: Sequence[list[Point]]
) -> list[Proposal]:
    problem = simulator.problem
    candidates = candidates_of(problem)
    built = {c.condition.striker: c.built for c in candidates if c.built}
    rig = problem.rig.model_copy(update={"strikers": {**problem.rig.strikers, **built}})
    laws = {c.condition.striker: problem.laws[c.like or c.condition.striker] for c in candidates}
    conditions = tuple(c.condition for c in candidates)
    other = replace(problem, laws=laws, conditions=conditions, rig=rig)
    trial = simulator.of(other.with_error())
    seen = [trial.observe(f.mechanisms, p) for (f, _), p in zip(rivals, points, strict=True)]
    measured = list(dict.fromkeys(problem.cells.observable))
    weight = [p for _, p in rivals]
    return [_trial(c, k, seen, measured, weight, problem) for k, c in enumerate(candidates)]


def _trial(
    c: Candidate, k: int, seen: Sequence[dict[str, Array]], measured: list[str],
    weight: Sequence[float], problem: Problem,
) -> Proposal:  # fmt: skip
    here = [{o: s[o][:, k] for o in measured} for s in seen]
    text = f"{c.change}, measuring {_words(measured)}"
    table = c.built or problem.rig.strikers[c.condition.striker]
    trial: dict[str, str | float] = {
        "striker": c.condition.striker, "speed_m_s": c.condition.speed,
        "angle_deg": math.degrees(c.condition.incidence), "mass_kg": table.mass_kg.value,
        "tip_radius_m": table.tip_radius_m.value,
    }  # fmt: skip
    kind = "build" if c.built else "trial"
    return Proposal(text, _worth(here, weight, problem), kind, trial=trial)


def _further(
    simulator: Simulator, rivals: Sequence[tuple[Fit, float]], points: Sequence[list[Point]]
) -> list[Proposal]:
    """What else could be measured, at the condition of the set where it would tell most."""
    problem = simulator.problem
    seen = [simulator.observe(f.mechanisms, p) for (f, _), p in zip(rivals, points, strict=True)]
    measured = set(problem.cells.observable)
    weight = [p for _, p in rivals]
    slides = any(c.angle < 1.5 or c.tangential or c.spin for c in problem.conditions)
    found = []
    for name, row in OBSERVABLES.items():
        if name in measured or not row.usual_noise or (row.phase == "sliding" and not slides):
            continue
        worth = [
            _worth([{name: s[name][:, k]} for s in seen], weight, problem)
            for k in range(len(problem.conditions))
        ]
        c = problem.conditions[int(np.argmax(worth))]
        text = f"measure {row.label} too, first of {c.striker} at {c.speed:.2g} m/s"
        found.append(Proposal(text, max(worth), "observable"))
    return found


def _sharper(problem: Problem, best: Fit) -> list[Proposal]:
    """What half the noise would do to the interval of the leading parameter, or that nothing will.

    By the curvature of the likelihood at the best place; the parameters are linear over it.
    """
    slopes = _slopes(best)
    total, noise = best.linear.total, best.linear.noise
    today = _width(slopes, total)
    names = list(dict.fromkeys(problem.cells.observable))
    found = []
    for name in names:
        here = np.array([o == name for o in problem.cells.observable])
        share = _width(slopes, with_half_the_noise(total, noise, here)) / today
        text = f"halve the noise of {OBSERVABLES[name].label}, or repeat it four times as often"
        found.append(Proposal(text, 0.0, "noise", share))
    found.sort(key=lambda p: p.interval)
    label = best.grid.labels[0]
    quiet = with_half_the_noise(total, noise, np.ones(len(noise), dtype=bool))
    if _width(slopes, quiet) > LITTLE * today:
        text = (
            f"nothing more to gain for {label} from better instruments or more repeats: the errors "
            "of the contact law and of the mechanism's form rule its interval"
        )
        return [Proposal(text, 0.0, "none", 1.0), *found]
    return found


def with_half_the_noise(total: Array, noise: Array, here: Array) -> Array:
    """Return the covariance `total`, (m, m), where the readings `here` have half their noise.

    Cells that share a reading stay as correlated as they were: what is taken off is no diagonal.
    """
    scale = np.where(here, 0.5, 1.0)
    return np.asarray(total - noise + noise * np.outer(scale, scale))


def _slopes(best: Fit) -> Array:
    """Derivatives of the cells by the parameters' places in their priors, (axes, m)."""
    places = best.grid.places()
    near = np.argsort(np.sum((places - best.place) ** 2, axis=1))[: 3 ** len(best.grid.axes) + 2]
    x = np.column_stack([np.ones(len(near)), places[near] - best.place])
    return np.asarray(-np.linalg.lstsq(x, best.residuals[near], rcond=None)[0][1:])


def _width(slopes: Array, total: Array) -> float:
    """Standard deviation of the first parameter's place; a flat prior has 1/sqrt(12)."""
    information = slopes @ np.linalg.solve(total, slopes.T) + 12.0 * np.eye(len(slopes))
    return math.sqrt(float(np.linalg.inv(information)[0, 0]))


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


def _worth(seen: Sequence[dict[str, Array]], weight: Sequence[float], problem: Problem) -> float:
    """D of one trial, (samples,) of each observable under each rival, averaged over the pairs."""
    names = list(seen[0])
    noise = np.array([_noise(name, seen, problem) for name in names])
    tables = [np.stack([compared(n, one[n]) for n in names]) for one in seen]
    worth, whole = 0.0, 0.0
    for (a, p), (b, q) in itertools.combinations(zip(tables, weight, strict=True), 2):
        gap = a.mean(axis=1) - b.mean(axis=1)
        cov = np.atleast_2d(np.cov(a)) + np.atleast_2d(np.cov(b)) + 2.0 * np.diag(noise**2)
        worth += p * q * float(gap @ np.linalg.solve(cov, gap))
        whole += p * q
    return worth / whole if whole > 0.0 else 0.0


def _noise(name: str, seen: Sequence[dict[str, Array]], problem: Problem) -> float:
    here = np.array([o == name for o in problem.cells.observable])
    if here.any():
        return float(np.median(problem.cells.std[here]))
    size = float(np.mean([np.mean(np.abs(s[name])) for s in seen]))
    row = OBSERVABLES[name]
    return row.usual_noise * (1.0 if row.log else max(size, 1e-12))
