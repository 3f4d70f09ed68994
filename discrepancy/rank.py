"""Rank the explanations by themselves: the baseline, and every mechanism alone."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..core.arrays import Array
from ..dynamics.mechanisms.base import Mechanism
from .baseline.laws import Progress
from .comparison.forward import Simulator
from .comparison.problem import Problem
from .inference.fit import Fit, baseline_situations, expand, fit, grid_of, sharpened
from .inference.grid import Grid
from .inference.outliers import outlying, without_weight
from .inference.together import responses_at
from .rules import RULES
from .unknowns.wrong_number import is_wrong

# limit: fits that are sharpened [-]: of 105 sets of two makes the mean ln p is that with three
_SHARPENED = 2


@dataclass(frozen=True, eq=False)
class Screened:
    """First pass over one mechanism, with the baseline's own derivatives.

    - `grid`, `change`: grid of its parameters, and the simulated change of the cells at its nodes
      (nodes, m).
    - `effect`: (k, m) the same over the refined grid.
    - `log_bayes`: ln B against the baseline.
    - `place`: most probable place (axes,).
    """

    mechanism: Mechanism
    grid: Grid
    change: Array
    effect: Array
    log_bayes: float
    place: Array


@dataclass(frozen=True, eq=False)
class Ranking:
    """All explanations.

    - `problem`: what they were fitted to: outliers have no weight in it.
    - `base`, `stated`: fit of the baseline, and its algebra at the stated numbers, where the first
      pass is.
    - `screened`: first pass, by the mechanisms' own order.
    - `singles`, `pairs`: full fits, best first.
    - `excluded`: mechanism to the reason why arithmetic rules it out.
    - `nameless`: title of what a verdict has no name for to its ln B against the baseline.
    - `unfitted`: pairs without a full fit: ln B against the baseline by the sum of their effects.
    """

    problem: Problem
    base: Fit
    stated: Fit
    screened: tuple[Screened, ...]
    singles: tuple[Fit, ...]
    pairs: tuple[Fit, ...]
    excluded: dict[str, str]
    nameless: Mapping[str, float] = field(default_factory=dict)
    unfitted: Mapping[str, float] = field(default_factory=dict)

    @property
    def fits(self) -> tuple[Fit, ...]:
        """The baseline, the singles and the pairs."""
        return (self.base, *self.singles, *self.pairs)


def rank(
    simulator: Simulator, mechanisms: Sequence[Mechanism], *, progress: Progress = lambda _: None
) -> Ranking:
    """Fit the baseline and every mechanism that is not excluded, by itself."""
    progress("calibrating what is known within its uncertainty")
    base, stated = fit(simulator, ()), as_stated(simulator)
    situations = baseline_situations(simulator.problem)
    excluded, screened = {}, []
    for mechanism in mechanisms:
        progress(f"screening {mechanism.name}")
        reason = _idle(mechanism, simulator.problem) or mechanism.ruled_out(situations)
        if not reason:
            found = screen(simulator, stated, mechanism)
            size = float(sizes(found, base).max())
            if size >= RULES.invisible:
                screened.append(replace(found, log_bayes=_gain(stated, base, found.effect)))
                continue
            reason = f"its largest plausible effect is {size:.1g} standard errors in all"
        if mechanism.named and not is_wrong(mechanism):
            excluded[mechanism.name] = reason
    lead = max(screened, key=lambda s: s.log_bayes, default=None)
    known, judge = {}, base
    if lead is not None and lead.log_bayes > RULES.leads:
        # a large effect moves the derivatives: judge single values by its own fit
        judge = known[lead.mechanism.name] = _in_full(simulator, stated, lead)
    problem, outliers = simulator.problem, outlying(simulator.problem, judge)
    if outliers.any():
        problem = without_weight(problem, outliers)
        known, simulator = {}, simulator.of(problem)
        base, stated = fit(simulator, (), start=base, rounds=2), as_stated(simulator)
        screened = [replace(s, log_bayes=_gain(stated, base, s.effect)) for s in screened]
    fits = _leading_fits(simulator, base, stated, screened, known, progress)
    progress("sharpening the leading fits")
    fits = sharpened_leading(simulator, fits, base)
    fitted = {f.name: f.log_evidence - base.log_evidence for f in fits}
    nameless = {
        s.mechanism.title: fitted.get(s.mechanism.name, s.log_bayes)
        for s in screened
        if not s.mechanism.named
    }
    return Ranking(
        problem, base, stated, tuple(s for s in screened if s.mechanism.named),
        tuple(f for f in fits if f.mechanisms[0].named), (), excluded, nameless,
    )  # fmt: skip


def _in_full(simulator: Simulator, stated: Fit, found: Screened) -> Fit:
    """Fit a screened mechanism from the stated numbers: beside the true effect they are near."""
    return fit(
        simulator, (found.mechanism,), start=stated, place=found.place, rounds=2,
        effect=found.effect,
    )  # fmt: skip


def _leading_fits(
    simulator: Simulator, base: Fit, stated: Fit, screened: Sequence[Screened],
    known: Mapping[str, Fit], progress: Progress,
) -> list[Fit]:  # fmt: skip
    """Fit in full what leads by its screening, until no screening comes near the best fit.

    A large effect is no small step from the stated numbers: its screening shows but a part of what
    it explains. `known`: fits that there are already.
    """
    order = sorted(screened, key=lambda s: -s.log_bayes)
    fits: list[Fit] = []
    best = -math.inf
    for found in order:
        least = max(RULES.hidden * min(order[0].log_bayes, best), 0.0)
        if len(fits) >= RULES.full and found.log_bayes <= least:
            break
        progress(f"fitting {found.mechanism.name}")
        one = known.get(found.mechanism.name) or _in_full(simulator, stated, found)
        fits.append(one)
        best = max(best, one.log_evidence - base.log_evidence)
    return fits


def _idle(mechanism: Mechanism, problem: Problem) -> str:
    """Return why a mechanism is assumed already, or would rest on an assumption, or ""."""
    if mechanism in problem.assumed:
        return "it is assumed: it acts whatever is found, as published"
    unknown = problem.without_modulus
    tables = [table for body in mechanism.rests_on for table in unknown[body]]
    if not tables:
        return ""
    return f"its numbers would rest on the modulus of {', '.join(tables)}, which is not stated"


def as_stated(simulator: Simulator) -> Fit:
    """Return the baseline with every number as stated.

    Where much is missing, the baseline's own fit pulls the stated numbers to where no effect is
    what it is beside the true ones.
    """
    problem = simulator.problem
    z = np.zeros(problem.n_z)
    found = expand(simulator, (), grid_of(problem, ()), z, np.zeros(0), None)
    return replace(found, z=z)


def screen(simulator: Simulator, base: Fit, mechanism: Mechanism) -> Screened:
    """Simulate a mechanism over its grid at a baseline's unknowns, with the derivatives there."""
    grid = grid_of(simulator.problem, (mechanism,))
    responses = responses_at(simulator, (mechanism,), grid, base.z)
    change = responses - (base.here + base.linear.J @ (base.z - base.expanded))
    effect = grid.refine(change)
    log_bayes = _gain(base, base, effect)
    chi2 = np.sum(base.linear.white(base.residual - effect) ** 2, axis=1)
    place = grid.places()[int(np.argmin(chi2))]
    return Screened(mechanism, grid, change, effect, log_bayes, place)


def _gain(stated: Fit, base: Fit, effect: Array) -> float:
    """Ln B of an effect (k, m) beside the stated numbers, against the baseline's own fit."""
    gain = float(stated.mixture.gain(stated.residual[None, :], effect)[0])
    return gain + stated.log_evidence - base.log_evidence


def sizes(found: Screened, base: Fit) -> Array:
    """Return effects over all cells in the measurements' standard errors, (k,) over the grid."""
    noise = np.sqrt(np.diag(base.linear.noise))
    return np.asarray(np.linalg.norm(found.effect / noise, axis=1))


def sharpened_leading(
    simulator: Simulator, fits: list[Fit], base: Fit, *, rounds: int = 8
) -> list[Fit]:
    """Sharpen fits that gain much, the leading one and its rival; best first."""
    fits = sorted(fits, key=lambda f: -f.log_evidence)
    best = fits[0].log_evidence - base.log_evidence if fits else 0.0
    enough = max(RULES.clear, RULES.near_leader * best)
    found = [
        sharpened(simulator, f, rounds=rounds)
        if i < _SHARPENED and f.log_evidence - base.log_evidence > enough
        else f
        for i, f in enumerate(fits)
    ]
    return sorted(found, key=lambda f: -f.log_evidence)
