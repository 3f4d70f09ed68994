"""Pairs of mechanisms: which are worth fitting, and what two do to each other."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.special import logsumexp

from ...core.arrays import Array
from ..baseline.laws import Progress
from ..comparison.forward import Simulator
from ..inference.fit import Fit, fit_anchored
from ..inference.grid import Grid
from ..inference.together import mutual
from ..rank import Ranking, Screened, sharpened_leading
from ..rules import RULES
from ..unknowns.wrong_number import is_wrong
from .odds import Priors, gains, members, tempered

# limit: places of each mechanism in the search for pairs [-]; a pair takes their square
_PLACES = 250
# limit: mechanisms that do best by themselves of which every pair is fitted [-]
_LEADING = 4


class _Candidate(NamedTuple):
    """Two by the sum of their effects: ln B over the baseline, where in priors and unknowns."""

    one: Screened
    two: Screened
    gain: float
    place: Array
    z: Array

    @property
    def names(self) -> tuple[str, str]:
        """Of both."""
        return self.one.mechanism.name, self.two.mechanism.name


def with_pairs(
    simulator: Simulator, ranking: Ranking, *, progress: Progress = lambda _: None
) -> Ranking:
    """Screen all pairs, one of them a mechanism, and fit those that lead by it.

    What leads is fitted, to the problem of the singles; the rest count by their screening. Pairs
    that decide together where bodies slide are no sum: all are fitted where one of such leads; so
    are any two of the mechanisms that do best by themselves, whose effects are no small steps.
    """
    simulator = simulator.of(ranking.problem)
    prior = Priors.of(ranking)

    def weight(names: Sequence[str], gain: float) -> float:
        return prior.log(names) + tempered(gain)

    least = max(weight(members(k), g) for k, g in gains(ranking).items()) - RULES.second
    order = sorted(_candidates(ranking), key=lambda c: -weight(c.names, c.gain))
    slides = bool(ranking.singles) and ranking.singles[0].mechanisms[0].aslant
    known = [f.log_evidence - ranking.base.log_evidence for f in ranking.singles]
    alone, best = max(known, default=0.0), -math.inf
    large = [f.name for f, gain in zip(ranking.singles, known, strict=True)
             if gain > max(RULES.clear, RULES.near_leader * alone)
             and not is_wrong(f.mechanisms[0])][:_LEADING]  # fmt: skip
    more: list[Fit] = []
    rest: list[Fit] = []
    for c in order:
        summed = weight(c.names, c.gain)
        behind = summed < least or (len(more) + len(rest) >= RULES.paired and summed < best)
        slide = slides and c.one.mechanism.aslant and c.two.mechanism.aslant
        if behind and not slide and not set(c.names) <= set(large):
            continue
        progress(f"fitting {c.names[0]} with {c.names[1]}")
        both = pair_effect(simulator, c.one, c.two)
        pair = c.one.mechanism, c.two.mechanism
        found = fit_anchored(simulator, pair, both, z=c.z, place=c.place)
        gain = found.log_evidence - ranking.base.log_evidence
        # two that gain nothing over one stay behind it, however sharp
        (more if max(gain, c.gain) > alone else rest).append(found)
        best = max(best, weight(c.names, gain))
    pairs = [*sharpened_leading(simulator, more, ranking.base, rounds=1), *rest]
    pairs.sort(key=lambda f: -f.log_evidence)
    fitted = {f.name for f in pairs}
    unfitted = {"+".join(c.names): c.gain for c in order}
    return replace(
        ranking, pairs=tuple(pairs),
        unfitted={k: gain for k, gain in unfitted.items() if k not in fitted},
    )  # fmt: skip


def _candidates(ranking: Ranking) -> Iterable[_Candidate]:
    """Every pair with one that is fitted, at the place where the sum of their effects does best."""
    found: dict[tuple[str, str], _Candidate] = {}
    for c in (c for lead in ranking.singles for c in _beside(ranking, lead)):
        if c.names not in found or found[c.names].gain < c.gain:
            found[c.names] = c
    return found.values()


def _mean(log_ratio: Array) -> float:
    """Ln of the mean of likelihood ratios."""
    return float(logsumexp(log_ratio)) - math.log(log_ratio.size)


def _beside(ranking: Ranking, lead: Fit) -> Iterable[_Candidate]:
    """A fitted explanation with each other one, by what that does beside the stated numbers."""
    own = lead.mechanisms[0]
    for s in ranking.screened:
        other = s.mechanism
        apart = other is not own and other.name not in own.holds and own.name not in other.holds
        if apart and not (is_wrong(other) and is_wrong(own)):
            yield _together(ranking, lead, s)


def _otherwise(ranking: Ranking, lead: Fit, screened: Screened) -> Array:
    """What a number of the sheet does more beside a fit than beside the stated ones, (k, m)."""
    m, known = screened.mechanism, ranking.problem.nuisances
    at = [i for i, n in enumerate(known) if is_wrong(m) and n.name == m.key]
    off = [math.log(m.parameters[0].value(x)) for i in at for x in screened.grid.places()[:, 0]]
    more = (lead.linear.J - ranking.stated.linear.J)[:, at]
    return np.outer(off, more / known[at[0]].spread) if at else np.zeros(more.shape[:1])


def _together(ranking: Ranking, lead: Fit, s: Screened) -> _Candidate:
    """A fitted explanation, its own numbers free, with another."""
    effect = s.effect + _otherwise(ranking, lead, s)
    order = [x.mechanism.name for x in ranking.screened]
    mine, its = order.index(lead.name), order.index(s.mechanism.name)
    few, some = (slice(None, None, max(len(x) // _PLACES, 1)) for x in (lead.residuals, effect))
    white, e = lead.linear.white(lead.residuals[few]), lead.linear.white(effect[some])
    alone = -0.5 * np.sum(white**2, axis=1)
    ratio = white @ e.T - 0.5 * np.sum(e**2, axis=1) + alone[:, None]
    gain = lead.log_evidence - ranking.base.log_evidence + _mean(ratio) - _mean(alone)
    p, q = np.unravel_index(int(np.argmax(ratio)), ratio.shape)
    both = [(mine, lead.grid.places()[few][p]), (its, s.grid.places()[some][q])]
    (i, first), (j, second) = both if mine < its else both[::-1]
    place = np.concatenate([first, second])
    z, _ = lead.linear.unknowns(lead.residuals[few][p] - effect[some][q])
    return _Candidate(ranking.screened[i], ranking.screened[j], gain, place, z)


def pair_effect(
    simulator: Simulator, one: Screened, two: Screened
) -> Callable[[Array, Array], Array]:
    """Return what two mechanisms do: the sum of their own effects, and what they do to each other.

    Of unknowns and a place, the change of the cells over the pair's refined grid, (k, m). The
    mutual part is simulated near the place and kept constant beyond.
    """
    n, pair = len(one.grid.axes), (one.mechanism, two.mechanism)
    grid = Grid((*one.grid.axes, *two.grid.axes))
    first = one.grid.refine(one.change, grid.fine[:n])
    second = two.grid.refine(two.change, grid.fine[n:])
    total = (first[:, None, :] + second[None, :, :]).reshape(-1, first.shape[-1])

    def effect(z: Array, place: Array) -> Array:
        count = 3 if len(place) == 2 else 2
        corners = [
            np.linspace(max(x - RULES.pair_step, 0.0), min(x + RULES.pair_step, 1.0), count)
            for x in place
        ]
        return total + mutual(simulator, pair, grid, corners, z)

    return effect
