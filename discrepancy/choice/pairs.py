"""Pairs of mechanisms: which are worth fitting, and what two do to each other."""

from __future__ import annotations

import itertools
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
_PLACES = 48

# limit: places of one beside a fit of the other [-]; time
_BESIDE = 400


class _Candidate(NamedTuple):
    """Two by the sum of their effects: ln B over the baseline, and where in their priors."""

    one: Screened
    two: Screened
    gain: float
    place: Array

    @property
    def names(self) -> tuple[str, str]:
        """Of both."""
        return self.one.mechanism.name, self.two.mechanism.name


def with_pairs(
    simulator: Simulator, ranking: Ranking, *, progress: Progress = lambda _: None
) -> Ranking:
    """Screen all pairs, one of them a mechanism, and fit those that lead by it.

    What leads of them is fitted, to the problem that the singles were fitted to; the rest count by
    their screening.
    """
    simulator = simulator.of(ranking.problem)
    prior = Priors.of(ranking)

    def weight(names: Sequence[str], gain: float) -> float:
        return prior.log(names) + tempered(gain)

    least = max(weight(members(label), gain) for label, gain in gains(ranking).items())
    order = sorted(_candidates(ranking), key=lambda c: -weight(c.names, c.gain))
    pairs: list[Fit] = []
    best = -math.inf
    for c in order:
        worth = weight(c.names, c.gain)
        if worth < least - RULES.second or (len(pairs) >= RULES.paired and worth < best):
            break
        progress(f"fitting {c.names[0]} with {c.names[1]}")
        near = [f for f in ranking.singles if f.mechanisms[0].name in c.names]
        start = max(near, key=lambda f: f.log_evidence, default=ranking.base)
        both = pair_effect(simulator, c.one, c.two)
        pair = c.one.mechanism, c.two.mechanism
        pairs.append(fit_anchored(simulator, pair, both, start=start, place=c.place))
        own = pairs[-1].log_evidence - ranking.base.log_evidence
        best = max(best, weight(c.names, own))
    lead = max((f.log_evidence for f in ranking.singles), default=0.0)
    if max((f.log_evidence for f in pairs), default=-math.inf) > lead + RULES.second:
        pairs = sharpened_leading(simulator, pairs, ranking.base, most=1, rounds=2)
    fitted = {f.name for f in pairs}
    unfitted = {"+".join(c.names): c.gain for c in order}
    return replace(
        ranking, pairs=tuple(pairs),
        unfitted={k: gain for k, gain in unfitted.items() if k not in fitted},
    )  # fmt: skip


def _candidates(ranking: Ranking) -> Iterable[_Candidate]:
    """Every pair, at the place where the sum of its effects does best."""
    found: dict[tuple[str, str], _Candidate] = {}
    leads = [f for f in ranking.singles if not is_wrong(f.mechanisms[0])][: RULES.partners]
    leads += [f for f in ranking.singles if is_wrong(f.mechanisms[0])][:1]
    for c in (*_sums(ranking), *(c for lead in leads for c in _beside(ranking, lead))):
        if c.names not in found or found[c.names].gain < c.gain:
            found[c.names] = c
    return found.values()


def _sums(ranking: Ranking) -> Iterable[_Candidate]:
    """Two mechanisms beside the stated numbers."""
    among = [s for s in ranking.screened if not is_wrong(s.mechanism)]
    linear, w = ranking.stated.linear, ranking.stated.linear.white(ranking.stated.residual)
    thin = [np.arange(0, len(s.effect), max(len(s.effect) // _PLACES, 1)) for s in among]
    whites = [linear.white(s.effect[t]) for s, t in zip(among, thin, strict=True)]
    own = [e @ w - 0.5 * np.sum(e**2, axis=1) for e in whites]
    off = ranking.stated.log_evidence - ranking.base.log_evidence
    for i, j in itertools.combinations(range(len(whites)), 2):
        ratio = own[i][:, None] + own[j][None, :] - whites[i] @ whites[j].T
        p, q = np.unravel_index(int(np.argmax(ratio)), ratio.shape)
        one, two = among[i], among[j]
        place = np.concatenate([one.grid.places()[thin[i][p]], two.grid.places()[thin[j][q]]])
        yield _Candidate(one, two, _mean(ratio) + off, place)


def _mean(log_ratio: Array) -> float:
    """Ln of the mean of likelihood ratios."""
    return float(logsumexp(log_ratio)) - math.log(log_ratio.size)


def _beside(ranking: Ranking, lead: Fit) -> Iterable[_Candidate]:
    """A fitted explanation with each other one, of what it leaves."""
    order = [s.mechanism.name for s in ranking.screened]
    at = order.index(lead.name)
    own = ranking.screened[at]
    white = lead.linear.white(lead.residual)
    gain = lead.log_evidence - ranking.base.log_evidence
    for k, s in enumerate(ranking.screened):
        if s is own or (is_wrong(s.mechanism) and is_wrong(own.mechanism)):
            continue
        thin = np.arange(0, len(s.effect), max(len(s.effect) // _BESIDE, 1))
        e = lead.linear.white(s.effect[thin])
        ratio = white @ e.T - 0.5 * np.sum(e**2, axis=1)
        place = s.grid.places()[thin[ratio.argmax()]]
        first, second = ((own, lead.place), (s, place))
        if k < at:
            first, second = second, first
        yield _Candidate(
            first[0], second[0], gain + _mean(ratio), np.concatenate([first[1], second[1]])
        )


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
