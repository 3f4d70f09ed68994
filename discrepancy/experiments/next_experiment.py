"""What to do next: the trial, the instrument or the observable that would bring most.

Rivals are the explanations that share the probability. What a trial would show is foreseen under
each, given all that was measured; first comes what would lower the entropy of which rival is true
by most. Told with it is D = (mu_i - mu_j)^T (Sigma_i + Sigma_j)^-1 (mu_i - mu_j), the criterion of
Box and Hill (Technometrics 9 (1967) 57) and of Buzzi-Ferraris and Forzatti (Chem. Eng. Sci. 39
(1984) 81), averaged over the pairs with the product of their probabilities.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from ...core.arrays import Array
from ...core.observables import OBSERVABLES
from ...dynamics.files.second import second_of
from ...recordings.checks.press import LOAD_CLASS
from ..choice.odds import Odds
from ..comparison.conditions import Condition
from ..comparison.forward import Point, Simulator
from ..comparison.problem import Problem
from ..inference.fit import Fit
from ..rank import Ranking
from ..rules import RULES
from ..unknowns.wrong_number import is_wrong
from . import feasible
from .foreseen import Settled, discrimination, foreseen, information
from .session import Option, Proposal, Session, session_of, takes

_ELSEWHERE = ("build", "observable")  # what the rig has not had
_BY = {
    "Sy_Pa": "hardness", "mass_kg": "weigh", "tip_radius_m": "calliper", "radius_m": "calliper",
    "thickness_m": "calliper",
}  # fmt: skip
_SETTLE = {
    "hardness": "test the hardness of {}: hardness_Pa in place of Sy_Pa",
    "weigh": "weigh {}", "calliper": "measure the {what} of {} with a calliper or in a picture",
}  # fmt: skip
_ERRORS = dict(RULES.settled)
_PRESSED = dict(RULES.press_reading)


def rivals_of(ranking: Ranking, odds: Odds) -> list[tuple[Fit, float]]:
    """Return the explanations that share the probability, most probable first, and their shares."""
    shared = [(f, odds.probability[f.name]) for f in ranking.fits]
    return sorted(shared, key=lambda item: -item[1])[: RULES.rivals]


def propose(
    simulator: Simulator, ranking: Ranking, odds: Odds, rng: np.random.Generator
) -> tuple[list[Proposal], Session]:
    """Return every thing to do next by itself, best first, and a session's worth together.

    `ranking`, `odds`: the explanations and their probabilities.
    """
    rivals = rivals_of(ranking, odds)
    if len(rivals) < 2:
        return [], Session()
    found, session = _worth_of_each(_options(simulator), rivals, rng)
    if not session.goes_on:
        found += _worth_of_each(_bodies(simulator), rivals, rng)[0]
        worth = sorted((p for p in found if p.kind in _ELSEWHERE), key=lambda p: -p.information)
        elsewhere = tuple(p for p in worth[:1] if p.information >= RULES.worth)
        session = replace(session, elsewhere=elsewhere)
    found.sort(key=lambda p: -p.per_hour)
    best = rivals[0][0]
    if best.mechanisms and not all(map(is_wrong, best.mechanisms)):
        sharper = _sharper(simulator.problem, best)
        if 1.0 - rivals[0][1] < RULES.rival:
            # nothing left to tell apart: what is left is to know the numbers better
            return [*sharper, *found], session
        found += sharper
    return found, session


def _worth_of_each(
    plan: _Plan, rivals: Sequence[tuple[Fit, float]], rng: np.random.Generator
) -> tuple[list[Proposal], Session]:
    """What each thing of a plan would tell, and the best of them together."""
    if not plan.options:
        return [], Session()
    wider = plan.wider
    seen = [foreseen(plan.simulator, wider, f, rng, plan.settled) for f, _ in rivals]
    weight = [p for _, p in rivals]
    found, within = [], []
    for cells, proposal in plan.options:
        here = [s.of(cells) for s in seen]
        worth = replace(
            proposal, expected_discrimination=discrimination(here, weight),
            information=information(here, weight),
        )  # fmt: skip
        found.append(worth)
        if proposal.kind not in _ELSEWHERE:
            within.append(Option(cells, worth))
    read = wider.cells.observable[len(plan.problem.cells) :]
    reads = [*read, *(one.key for one in plan.settled)]
    session = session_of(wider.bench, within, seen, {f.name: p for f, p in rivals}, reads)
    # of what else could be measured, the condition of the set where it would tell most
    best: dict[str, Proposal] = {}
    for p in found:
        name = p.observable or p.change
        if name not in best or p.information > best[name].information:
            best[name] = p
    return list(best.values()), session


class _Plan:
    """What could be done, its cells behind those of a problem, and the numbers behind them."""

    def __init__(self, simulator: Simulator) -> None:
        self.simulator, self.problem = simulator, simulator.problem
        bench = self.problem.bench
        self.options: list[Option] = []
        self.settled: list[Settled] = []
        self.conditions = list(self.problem.conditions)
        self.cells: list[tuple[int, str, float]] = []
        self.rig, self.laws = self.problem.rig, dict(self.problem.laws)
        seen = dict.fromkeys((*self.problem.cells.observable, *bench.reads))
        self.measured = [n for n in seen if "impact" in OBSERVABLES[n].of]
        # of a press what is read already, where that is known; a depth's scan has the diameter too
        read = [n for n in _PRESSED if n in seen]
        every = "permanent_depth_m" in read or not (read or bench.reads)
        self.pressed = list(_PRESSED) if every else read
        self.noise = {name: _noise(simulator, name) for name in self.measured}
        self.repeats = bench.repeats or max(int(np.median(self.problem.cells.count)), 1)
        self.strike = self.repeats * takes(bench, "strike")

    def add(self, condition: int, noise: Mapping[str, float], told: Proposal) -> None:
        """Add a reading of each observable, with its standard error."""
        first = len(self.cells)
        self.cells += [(condition, name, std) for name, std in noise.items()]
        self.options.append(Option(np.arange(first, len(self.cells)), told))

    def blow(self, c: feasible.Candidate, minutes: float) -> None:
        """Add a trial that was not made yet."""
        name = c.condition.striker
        if c.built:
            self.rig = self.rig.with_striker(name, c.like, c.built)
        self.laws[name] = self.problem.laws[c.like or name]
        self.conditions.append(c.condition)
        self.add(len(self.conditions) - 1, self.noise, self.told(c, minutes))

    def told(self, c: feasible.Candidate, minutes: float) -> Proposal:
        """Return a trial that reads what the set has read."""
        striker = self.rig.striker(c.condition.striker)
        trial: dict[str, str | float] = {
            "striker": c.condition.striker, "speed_m_s": c.condition.speed,
            "angle_deg": math.degrees(c.condition.incidence), "mass_kg": striker["mass_kg"],
            "tip_radius_m": striker["tip_radius_m"], "repeats": float(self.repeats),
        }  # fmt: skip
        reads = ", ".join(OBSERVABLES[n].label for n in self.measured)
        text = f"{c.change}{_fall(c.condition, self.rig.of)}, measuring {reads}"
        kind = "build" if c.built else "trial"
        return Proposal(text, 0.0, kind, trial=trial, minutes=minutes)

    @property
    def wider(self) -> Problem:
        """The problem with all cells."""
        wide = replace(
            self.problem, conditions=tuple(self.conditions), rig=self.rig, laws=self.laws,
            cells=self.problem.cells.and_new(self.cells),
        )  # fmt: skip
        return wide.with_error(self.problem.error)


def _fall(one: Condition, stated: Mapping[str, float]) -> str:
    """The height of an upright blow, for who sets heights."""
    if not one.around.from_height or one.incidence < 0.5 * math.pi - 1e-6:
        return ""
    fall = 1e3 * one.speed**2 / (2.0 * stated["gravity_m_s2"])
    return f" (a fall of {float(f'{fall:.3g}'):g} mm)"  # 1000, no 1e+03


def _options(simulator: Simulator) -> _Plan:
    """Return what the rig can do, and what it could read with another instrument."""
    problem, new = simulator.problem, _Plan(simulator)
    for c in feasible.candidates_of(problem):
        new.blow(c, new.strike)
    # what repeats share does not average away: half of one reading's noise
    worse = math.sqrt(1.0 + 0.5 * new.repeats)
    for k in feasible.again(problem):
        one = problem.conditions[k]
        c = feasible.Candidate(f"{one.striker} {one.told}{feasible.at_degrees(one)} once more", one)
        new.add(k, {n: worse * x for n, x in new.noise.items()}, new.told(c, new.strike))
    _add_instruments(new)
    if not math.isnan(each := takes(problem.bench, "press")):
        for c in feasible.presses_of(problem) if new.pressed else ():
            new.conditions.append(c.condition)
            read = {name: _press_noise(problem, name) for name in new.pressed}
            new.add(len(new.conditions) - 1, read, _pressing(c, each * RULES.press_each, read))
    _settling(new)
    return new


def _bodies(simulator: Simulator) -> _Plan:
    """Return what could be built."""
    new = _Plan(simulator)
    minutes = new.strike + takes(new.problem.bench, "build")
    for c in () if math.isnan(minutes) else feasible.to_build(new.problem):
        new.blow(c, minutes)
    return new


def _add_instruments(new: _Plan) -> None:
    """What else could be read, where it can be had, of each condition that is struck again."""
    minutes = new.strike + takes(new.problem.bench, "instrument")
    for name in () if math.isnan(minutes) else _not_measured(new.problem):
        noise = _noise(new.simulator, name)
        for k, one in enumerate(new.problem.conditions):
            if ("impact" if one.press is None else "press") not in OBSERVABLES[name].of:
                continue
            text = f"measure {OBSERVABLES[name].label} too, first of {one.striker} {one.told}"
            told = Proposal(text, 0.0, "observable", observable=name, minutes=minutes)
            new.add(k, {name: noise}, told)


def _settling(new: _Plan) -> None:
    """Numbers of the sheet that can be measured again, behind all cells."""
    problem = new.problem
    keys = [n.name for n in problem.nuisances]
    keys += [one.key for one in problem.wrong_numbers if one.of_rig]
    for key in dict.fromkeys(keys):
        body, _, word = key.rpartition(".")
        kind = _BY.get(word, "")
        if not kind or math.isnan(minutes := takes(problem.bench, kind)):
            continue
        if kind == "hardness" and f"{body}.hardness_Pa" in problem.rig.of:
            continue  # it was tested
        of = "the flat" if body == "target" else body.removeprefix("strikers.")
        if second_of(problem.rig) is not None and body == "target":
            of = "the second sphere"
        text = _SETTLE[kind].format(of, what=word.removesuffix("_m").removeprefix("tip_"))
        told = Proposal(text, 0.0, kind, trial={"key": key}, minutes=minutes)
        new.options.append(Option(np.array([len(new.cells) + len(new.settled)]), told))
        new.settled.append(Settled(key, _ERRORS[kind]))


def _pressing(c: feasible.Candidate, minutes: float, read: Iterable[str]) -> Proposal:
    assert c.condition.press is not None
    trial: dict[str, str | float] = {
        "striker": c.condition.striker, "load_N": c.condition.press.load,
        "repeats": float(RULES.press_each),
    }  # fmt: skip
    words = " and ".join(OBSERVABLES[n].label for n in read)
    return Proposal(f"{c.change}, measuring {words}", 0.0, "press", trial=trial, minutes=minutes)


def _press_noise(problem: Problem, name: str) -> float:
    """Standard error of what repeated presses read at one load, the load's own in it."""
    law = RULES.dent_law_error if name == "dent_diameter_m" and not problem.sees_dents else 0.0
    load = LOAD_CLASS * OBSERVABLES[name].power
    return math.sqrt(_PRESSED[name] ** 2 / RULES.press_each + law**2 + load**2)


def _not_measured(problem: Problem) -> list[str]:
    """Observables that a set does not have and that its trials would show."""
    slides = any(c.angle < 1.5 or c.tangential or c.spin for c in problem.conditions)
    return [
        name
        for name, row in OBSERVABLES.items()
        if name not in problem.cells.observable
        and row.usual_noise
        and (row.phase != "sliding" or slides)
        and not (row.instrument == "surface" and feasible.leaves_no_mark(problem))
    ]


def _sharper(problem: Problem, best: Fit) -> list[Proposal]:
    """What half the noise would do to the interval of the leading parameter, or that nothing will.

    By the curvature of the likelihood at the best place; the parameters are linear over it.
    """
    slopes = _slopes(best)
    total, noise = best.linear.total, best.linear.noise
    today = _width(slopes, total)
    found = []
    for name in dict.fromkeys(problem.cells.observable):
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
