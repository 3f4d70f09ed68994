"""Pairs of mechanisms: which are worth fitting, and what two do to each other."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import logsumexp

from ...core.arrays import Array
from ...dynamics.mechanisms.base import Mechanism
from ..comparison.forward import Simulator
from ..inference.fit import Fit, fit_anchored
from ..inference.grid import Grid
from ..inference.together import mutual
from ..rank import Progress, Ranking, Screened, sharpened_leading
from ..rules import RULES
from ..unknowns.wrong_number import is_wrong

# limit: places of each mechanism in the search for pairs [-]; a pair takes their square
_PLACES = 48


def with_pairs(
    simulator: Simulator, ranking: Ranking, *, progress: Progress = lambda _: None
) -> Ranking:
    """Fit the leading pairs, to the problem that the singles were fitted to."""
    simulator = simulator.of(ranking.problem)
    pairs = []
    physics = [s for s in ranking.screened if not is_wrong(s.mechanism)]
    numbers = [s for s in ranking.screened if is_wrong(s.mechanism)]
    single = next((f for f in ranking.singles if not is_wrong(f.mechanisms[0])), None)
    number = next((f for f in ranking.singles if is_wrong(f.mechanisms[0])), None)
    found = {
        (one.mechanism.name, two.mechanism.name): (one, two, place)
        for one, two, place in (
            *_leading_pairs(ranking, physics),
            *_partners(ranking, single, physics, RULES.partners),
            # a number beside the leading mechanism, and mechanisms beside the leading number
            *_partners(ranking, single, numbers, RULES.mixed),
            *_partners(ranking, number, physics, RULES.mixed),
        )
    }  # fmt: skip
    for one, two, place in found.values():
        progress(f"fitting {one.mechanism.name} with {two.mechanism.name}")
        near = [f for f in ranking.singles if f.mechanisms[0] in (one.mechanism, two.mechanism)]
        start = max(near, key=lambda f: f.log_evidence, default=ranking.base)
        both = PairEffect(simulator, one, two)
        pairs.append(fit_anchored(simulator, both.mechanisms, both, start=start, place=place))
    least = max((f.log_evidence for f in ranking.singles), default=0.0)
    if max((f.log_evidence for f in pairs), default=-math.inf) > least + RULES.second:
        pairs = sharpened_leading(simulator, pairs, ranking.base, most=1, rounds=2)
    return replace(ranking, pairs=tuple(pairs))


def _leading_pairs(
    ranking: Ranking, among: Sequence[Screened]
) -> list[tuple[Screened, Screened, Array]]:
    """Return the best pairs by the sum of their effects, and where in their priors they fit."""
    linear, w = ranking.stated.linear, ranking.stated.linear.white(ranking.stated.residual)
    thin = [np.arange(0, len(s.effect), max(len(s.effect) // _PLACES, 1)) for s in among]
    whites = [linear.white(s.effect[t]) for s, t in zip(among, thin, strict=True)]
    scored = []
    own = [e @ w - 0.5 * np.sum(e**2, axis=1) for e in whites]
    alone = max((_mean(x) for x in own), default=0.0)
    for i, j in itertools.combinations(range(len(whites)), 2):
        ratio = own[i][:, None] + own[j][None, :] - whites[i] @ whites[j].T
        evidence = _mean(ratio)
        if evidence > alone + RULES.second:
            scored.append((evidence, i, j, np.unravel_index(int(np.argmax(ratio)), ratio.shape)))
    scored.sort(key=lambda x: -x[0])
    found = []
    for _, i, j, (p, q) in scored[: RULES.paired]:
        one, two = among[i], among[j]
        place = np.concatenate([one.grid.places()[thin[i][p]], two.grid.places()[thin[j][q]]])
        found.append((one, two, place))
    return found


def _mean(log_ratio: Array) -> float:
    """Ln of the mean of likelihood ratios."""
    return float(logsumexp(log_ratio)) - math.log(log_ratio.size)


def _partners(
    ranking: Ranking, lead: Fit | None, among: Sequence[Screened], most: int
) -> list[tuple[Screened, Screened, Array]]:
    """Return a leading explanation with those that explain most of what it leaves."""
    if lead is None:
        return []
    order = [s.mechanism.name for s in ranking.screened]
    own = ranking.screened[order.index(lead.name)]
    white = lead.linear.white(lead.residual)
    scored: list[tuple[float, Screened, Array]] = []
    for s in (s for s in among if s is not own):
        e = lead.linear.white(s.effect)
        ratio = white @ e.T - 0.5 * np.sum(e**2, axis=1)
        if _mean(ratio) > RULES.second:
            scored.append((_mean(ratio), s, s.grid.places()[ratio.argmax()]))
    found = []
    for _, s, place in sorted(scored, key=lambda x: -x[0])[:most]:
        both = sorted(
            [(s, place), (own, lead.place)], key=lambda x: order.index(x[0].mechanism.name)
        )
        (one, first), (two, second) = both
        found.append((one, two, np.concatenate([first, second])))
    return found


@dataclass(frozen=True, eq=False)
class PairEffect:
    """Effect of two mechanisms: the sum of their own, and what they do to each other.

    The mutual part is simulated near the place that is asked for and kept constant beyond.
    """

    simulator: Simulator
    one: Screened
    two: Screened

    @property
    def mechanisms(self) -> tuple[Mechanism, Mechanism]:
        """Both."""
        return self.one.mechanism, self.two.mechanism

    def __call__(self, z: Array, place: Array) -> Array:
        """Return the change of the cells over the pair's refined grid, (k, m)."""
        n = len(self.one.grid.axes)
        grid = Grid((*self.one.grid.axes, *self.two.grid.axes))
        first = self.one.grid.onto(self.one.change, grid.fine[:n])
        second = self.two.grid.onto(self.two.change, grid.fine[n:])
        total = (first[:, None, :] + second[None, :, :]).reshape(-1, first.shape[-1])
        count = 3 if len(place) == 2 else 2
        corners = [
            np.linspace(max(x - RULES.pair_step, 0.0), min(x + RULES.pair_step, 1.0), count)
            for x in place
        ]
        return total + mutual(self.simulator, self.mechanisms, grid, corners, z)
