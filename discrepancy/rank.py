"""Rank the explanations: every mechanism alone, then, if one is needed, pairs of the leading."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .fit import Fit, baseline_situations, fit, grid_of, responses_at
from .forward import Simulator
from .mechanisms import MECHANISMS
from .mechanisms.base import Mechanism
from .outliers import outlying, without_weight
from .thresholds import gain

Array = NDArray[np.float64]
Progress = Callable[[str], None]

FULL, NEAR = 4, 12.0
"""Mechanisms that are fitted in full: at least the first few, and all within some nats of them."""
PAIRED = 4
"""Leading mechanisms whose pairs are fitted."""
_INVISIBLE = 1.0


@dataclass(frozen=True, eq=False)
class Screened:
    """First pass over one mechanism, with the baseline's own derivatives.

    Parameters
    ----------
    mechanism
        Which.
    effect
        (k, m) change of the cells over the refined grid.
    log_bayes
        ln B against the baseline.
    place
        Most probable place (axes,).
    """

    mechanism: Mechanism
    effect: Array
    log_bayes: float
    place: Array


@dataclass(frozen=True, eq=False)
class Ranking:
    """All explanations.

    Parameters
    ----------
    base
        Fit of the baseline.
    screened
        First pass, by the mechanisms' own order.
    singles, pairs
        Full fits, best first.
    excluded
        Mechanism to the reason why arithmetic rules it out.
    """

    base: Fit
    screened: tuple[Screened, ...]
    singles: tuple[Fit, ...]
    pairs: tuple[Fit, ...]
    excluded: dict[str, str]


def rank(
    simulator: Simulator,
    *,
    mechanisms: Sequence[Mechanism] = MECHANISMS,
    progress: Progress = lambda _: None,
) -> Ranking:
    """Fit the baseline and every mechanism that is not excluded, by itself.

    Parameters
    ----------
    simulator
        The problem.
    mechanisms
        What to try.
    progress
        Called with a line before each step.
    """
    progress("calibrating what is known within its uncertainty")
    base = fit(simulator, ())
    situations = baseline_situations(simulator.problem)
    excluded, screened = {}, []
    for mechanism in mechanisms:
        progress(f"screening {mechanism.name}")
        reason = mechanism.applies(situations)
        if not reason:
            found = screen(simulator, base, mechanism)
            size = visible(found, base)
            if size >= _INVISIBLE:
                screened.append(found)
                continue
            reason = f"its largest plausible effect is {size:.1g} standard errors over all cells"
        excluded[mechanism.name] = reason
    base, screened = _cleared(simulator, base, screened)
    order = sorted(screened, key=lambda s: -s.log_bayes)
    chosen = [s for i, s in enumerate(order) if i < FULL or s.log_bayes > order[0].log_bayes - NEAR]
    singles = []
    for found in chosen:
        progress(f"fitting {found.mechanism.name}")
        singles.append(fit(simulator, (found.mechanism,), start=base, place=found.place, rounds=3))
    singles.sort(key=lambda f: -f.log_evidence)
    return Ranking(base, tuple(screened), tuple(singles), (), excluded)


def _cleared(
    simulator: Simulator, base: Fit, screened: list[Screened]
) -> tuple[Fit, list[Screened]]:
    """Take the weight from outliers, and fit and screen again what that changes."""
    residual = base.residual
    lead = max(screened, key=lambda s: s.log_bayes, default=None)
    if lead is not None and lead.log_bayes > 0.0:
        misfit = np.sum(base.linear.white(residual - lead.effect) ** 2, axis=1)
        residual = residual - lead.effect[int(np.argmin(misfit))]
    outliers = outlying(base, residual)
    if not outliers.any():
        return base, screened
    simulator.problem = without_weight(simulator.problem, outliers)
    again = fit(simulator, (), start=base, rounds=2)
    white = again.linear.white(again.residual)[None, :]
    return again, [
        replace(s, log_bayes=float(gain(white, np.zeros(1), again.linear, s.effect)[0]))
        for s in screened
    ]


def with_pairs(
    simulator: Simulator,
    ranking: Ranking,
    *,
    mechanisms: Sequence[Mechanism] = MECHANISMS,
    progress: Progress = lambda _: None,
) -> Ranking:
    """Fit the pairs of the leading single mechanisms."""
    pairs = []
    for one, two in itertools.combinations(ranking.singles[:PAIRED], 2):
        both = _in_order(one, two, mechanisms)
        progress(f"fitting {both[0].name} with {both[1].name}")
        better = max((one, two), key=lambda f: f.log_evidence)
        places = {f.mechanisms[0].name: f.place for f in (one, two)}
        start = np.concatenate([places[m.name] for m in both])
        pairs.append(fit(simulator, both, start=better, rounds=1, place=start))
    pairs.sort(key=lambda f: -f.log_evidence)
    return replace(ranking, pairs=tuple(pairs))


def _in_order(one: Fit, two: Fit, mechanisms: Sequence[Mechanism]) -> tuple[Mechanism, Mechanism]:
    names = [m.name for m in mechanisms]
    first, second = sorted(
        (one.mechanisms[0], two.mechanisms[0]), key=lambda m: names.index(m.name)
    )
    return first, second


def screen(simulator: Simulator, base: Fit, mechanism: Mechanism) -> Screened:
    """Simulate a mechanism over its grid at the baseline's fit; use the baseline's derivatives."""
    grid = grid_of(simulator.problem, (mechanism,))
    responses = responses_at(simulator, (mechanism,), grid, base.z)
    here = base.responses[0] + base.linear.J @ (base.z - base.expanded)
    effect = grid.refine(responses - here)
    white = base.linear.white(base.residual)[None, :]
    log_bayes = float(gain(white, np.zeros(1), base.linear, effect)[0])
    chi2 = np.sum(base.linear.white(base.residual - effect) ** 2, axis=1)
    return Screened(mechanism, effect, log_bayes, grid.places()[int(np.argmin(chi2))])


def visible(found: Screened, base: Fit) -> float:
    """Largest effect in units of the measurements' standard errors, over all cells."""
    noise = np.sqrt(np.diag(base.linear.noise))
    return float(np.max(np.linalg.norm(found.effect / noise, axis=1)))
