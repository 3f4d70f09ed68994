"""What to do next: the trial, the instrument or the observable that would bring most.

Rivals are the explanations that share the probability. What a trial would show is foreseen under
each, given all that was measured; first comes what would lower the entropy of which rival is true
by most. Told with it is D = (mu_i - mu_j)^T (Sigma_i + Sigma_j)^-1 (mu_i - mu_j), the criterion of
Box and Hill (Technometrics 9 (1967) 57) and of Buzzi-Ferraris and Forzatti (Chem. Eng. Sci. 39
(1984) 81), averaged over the pairs with the product of their probabilities.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...core.arrays import Array, Indices
from ...core.inputs.rig_numbers import RigNumbers
from ...core.observables import OBSERVABLES
from ...core.unstated import unstated_equal
from ..choice.odds import Odds
from ..comparison.conditions import LOAD_CLASS
from ..comparison.forward import Point, Simulator
from ..comparison.problem import Problem
from ..inference.fit import Fit
from ..rank import Ranking
from ..rules import RULES
from .feasible import Candidate, PressSeries, candidates_of, leaves_no_mark, press_series
from .foreseen import discrimination, foreseen, information

_LARGE = ("build", "press")  # another body, or a dozen of presses, beside one more trial
_PRESSED = dict(RULES.press_reading)
"""What is read of a proposed press, with the relative error of one reading: a stylus or a
microscope, and a microscope with a scale."""


@unstated_equal
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
        `trial`, `press`, `build`, `noise`, `observable` or `none`.
    information
        Nats by which the entropy of which rival is true is expected to fall.
    interval
        Width of the leading parameter's interval over that of today; nan where not worked out.
    trial
        Striker, speed [m/s] and angle [degrees] of a trial, and mass [kg] and tip radius [m]; of
        presses the striker, the smallest and the largest load [N], and how many.
    observable
        What to measure as well, of a proposal of that kind.
    """

    change: str
    expected_discrimination: float
    kind: str = "trial"
    interval: float = math.nan
    trial: Mapping[str, str | float] = field(default_factory=dict)
    information: float = 0.0
    observable: str = ""

    @property
    def gains(self) -> tuple[str, ...]:
        """What it would tell, in words."""
        found = []
        apart = math.sqrt(max(self.expected_discrimination, 0.0))
        differ = f"the explanations would then differ by {apart:.2g} standard deviations"
        if apart > 0.0:
            found.append(differ if apart >= RULES.decides else f"once will not decide: {differ}")
        if math.isfinite(self.interval):
            found.append(f"the interval would be {self.interval:.2g} times as wide as now")
        return tuple(found)


def rivals_of(ranking: Ranking, odds: Odds) -> list[tuple[Fit, float]]:
    """Return the explanations that share the probability, most probable first, and their shares."""
    shared = [(f, odds.probability[f.name]) for f in ranking.fits]
    shared = sorted(shared, key=lambda item: -item[1])
    return [(f, p) for i, (f, p) in enumerate(shared[: RULES.rivals]) if i < 2 or p > RULES.rival]


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
        Draws the posterior's samples.
    """
    rivals = rivals_of(ranking, odds)
    if len(rivals) < 2:
        return []
    found = _worth_of_each(simulator, rivals, rng)
    found.sort(key=lambda p: -p.information / (RULES.build_worth if p.kind in _LARGE else 1.0))
    best = rivals[0][0]
    if best.mechanisms:
        sharper = _sharper(simulator.problem, best)
        if 1.0 - rivals[0][1] < RULES.rival:
            # nothing left to tell apart: what is left is to know the numbers better
            return [*sharper, *found]
        found += sharper
    return found


def _worth_of_each(
    simulator: Simulator, rivals: Sequence[tuple[Fit, float]], rng: np.random.Generator
) -> list[Proposal]:
    """Trials and further observables, with what each would tell."""
    options, wider = _options(simulator)
    seen = [foreseen(simulator, wider, f, rng) for f, _ in rivals]
    weight = [p for _, p in rivals]
    found = []
    for cells, proposal in options:
        here = [s.of(cells) for s in seen]
        found.append(
            replace(
                proposal, expected_discrimination=discrimination(here, weight),
                information=information(here, weight),
            )
        )  # fmt: skip
    # of what else could be measured, the condition of the set where it would tell most
    best: dict[str, Proposal] = {}
    for p in found:
        name = p.observable or p.change
        if name not in best or p.information > best[name].information:
            best[name] = p
    return list(best.values())


def _options(simulator: Simulator) -> tuple[list[tuple[Indices, Proposal]], Problem]:
    """What could be measured, each with its places among the new cells, and the wider problem."""
    problem = simulator.problem
    candidates = candidates_of(problem)
    rig = problem.rig
    for c in candidates:
        if c.built:
            rig = rig.with_striker(c.condition.striker, c.like, c.built)
    laws = {c.condition.striker: problem.laws[c.like or c.condition.striker] for c in candidates}
    conditions = (*problem.conditions, *(c.condition for c in candidates))
    seen = list(dict.fromkeys(problem.cells.observable))
    measured = [name for name in seen if "impact" in OBSERVABLES[name].of]
    noise = {name: _noise(simulator, name) for name in measured}
    first = len(problem.conditions)
    options: list[tuple[Indices, Proposal]] = []
    new: list[tuple[int, str]] = []
    for k, c in enumerate(candidates):
        at = np.arange(len(new), len(new) + len(measured))
        options.append((at, _proposal(c, measured, rig)))
        new += [(first + k, name) for name in measured]
    for name in _not_measured(problem):
        noise[name] = _noise(simulator, name)
        for k, one in enumerate(problem.conditions):
            if ("impact" if one.press is None else "press") not in OBSERVABLES[name].of:
                continue
            label = OBSERVABLES[name].label
            text = f"measure {label} too, first of {one.striker} {one.told}"
            told = Proposal(text, 0.0, "observable", observable=name)
            options.append((np.array([len(new)]), told))
            new.append((k, name))
    std = [noise[name] for _, name in new]
    for series in press_series(problem):
        first = len(conditions)
        conditions = (*conditions, *series.conditions)
        read = [(first + k, name) for k in range(len(series.conditions)) for name in _PRESSED]
        options.append((np.arange(len(new), len(new) + len(read)), _pressing(series)))
        new += read
        std += [_press_noise(problem, name, series.each) for _, name in read]
    cells = problem.cells
    more = replace(
        cells, condition=np.append(cells.condition, [k for k, _ in new]).astype(np.intp),
        observable=(*cells.observable, *(name for _, name in new)),
        value=np.append(cells.value, np.zeros(len(new))),
        std=np.append(cells.std, std),
        count=np.append(cells.count, np.ones(len(new))).astype(np.intp),
    )  # fmt: skip
    wider = replace(
        problem, conditions=conditions, cells=more, rig=rig, laws={**problem.laws, **laws}
    )
    return options, wider.with_error(problem.error)


def _proposal(c: Candidate, measured: list[str], rig: RigNumbers) -> Proposal:
    striker = rig.striker(c.condition.striker)
    trial: dict[str, str | float] = {
        "striker": c.condition.striker, "speed_m_s": c.condition.speed,
        "angle_deg": math.degrees(c.condition.incidence), "mass_kg": striker["mass_kg"],
        "tip_radius_m": striker["tip_radius_m"],
    }  # fmt: skip
    words = ", ".join(OBSERVABLES[n].label for n in measured)
    return Proposal(
        f"{c.change}, measuring {words}", 0.0, "build" if c.built else "trial", trial=trial
    )


def _pressing(series: PressSeries) -> Proposal:
    loads = [c.press.load for c in series.conditions if c.press is not None]
    trial: dict[str, str | float] = {
        "striker": series.conditions[0].striker, "least_load_N": min(loads),
        "load_N": max(loads), "presses": float(series.each * len(loads)),
    }  # fmt: skip
    words = " and ".join(OBSERVABLES[n].label for n in _PRESSED)
    return Proposal(f"{series.change}, measuring {words}", 0.0, "press", trial=trial)


def _press_noise(problem: Problem, name: str, each: int) -> float:
    """Standard error of what a series reads at one load, the load's own in it."""
    law = RULES.dent_law_error if name == "dent_diameter_m" and not problem.sees_dents else 0.0
    load = LOAD_CLASS * OBSERVABLES[name].power
    return math.sqrt(_PRESSED[name] ** 2 / each + law**2 + load**2)


def _not_measured(problem: Problem) -> list[str]:
    """Observables that a set does not have and that its trials would show."""
    slides = any(c.angle < 1.5 or c.tangential or c.spin for c in problem.conditions)
    return [
        name
        for name, row in OBSERVABLES.items()
        if name not in problem.cells.observable
        and row.usual_noise
        and (row.phase != "sliding" or slides)
        and not (row.instrument == "surface" and leaves_no_mark(problem))
    ]


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
    if _width(slopes, quiet) > RULES.worth_less * today:
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


def _noise(simulator: Simulator, name: str) -> float:
    """Standard error of a cell: the set's usual one, or what is usual for the observable."""
    problem = simulator.problem
    here = np.array([o == name for o in problem.cells.observable])
    if here.any():
        return float(np.median(problem.cells.std[here]))
    row = OBSERVABLES[name]
    if name == "dent_diameter_m":
        return math.hypot(row.usual_noise, RULES.dent_law_error)
    if row.log:
        return row.usual_noise
    seen = simulator.observe((), [Point(np.zeros(problem.n_z))])[name]
    return row.usual_noise * max(float(np.mean(np.abs(seen))), 1e-12)
