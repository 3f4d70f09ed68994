"""Pairs of mechanisms: which are worth fitting, and what two do to each other."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import logsumexp

from ...core.arrays import Array
from ...impact.mechanisms.base import Mechanism
from ..comparison.forward import Simulator
from ..inference.fit import fit_anchored
from ..inference.grid import Grid
from ..inference.together import mutual
from ..rank import Progress, Ranking, Screened, sharpened_leading
from ..rules import RULES


def with_pairs(
    simulator: Simulator, ranking: Ranking, *, progress: Progress = lambda _: None
) -> Ranking:
    """Fit the leading pairs, to the problem that the singles were fitted to."""
    simulator = simulator.of(ranking.problem)
    pairs = []
    found = {
        (one.mechanism.name, two.mechanism.name): (one, two, place)
        for one, two, place in (*_leading_pairs(ranking), *_partners(ranking))
    }
    for one, two, place in found.values():
        progress(f"fitting {one.mechanism.name} with {two.mechanism.name}")
        near = [f for f in ranking.singles if f.mechanisms[0] in (one.mechanism, two.mechanism)]
        start = max(near, key=lambda f: f.log_evidence, default=ranking.base)
        both = PairEffect(simulator, one, two)
        pairs.append(fit_anchored(simulator, both.mechanisms, both, start=start, place=place))
    pairs = sharpened_leading(simulator, pairs, ranking.base, most=2, rounds=5)
    return replace(ranking, pairs=tuple(pairs))


def _leading_pairs(ranking: Ranking) -> list[tuple[Screened, Screened, Array]]:
    """Return the best pairs by the sum of their effects, and where in their priors they fit."""
    base = ranking.base
    w = base.linear.white(base.residual)
    thin = [
        np.arange(0, len(s.effect), max(len(s.effect) // RULES.pair_places, 1))
        for s in ranking.screened
    ]
    whites = [base.linear.white(s.effect[t]) for s, t in zip(ranking.screened, thin, strict=True)]
    scored = []
    for i, j in itertools.combinations(range(len(whites)), 2):
        a, b = whites[i], whites[j]
        ratio = (a @ w - 0.5 * np.sum(a**2, axis=1))[:, None] - a @ b.T
        ratio = ratio + (b @ w - 0.5 * np.sum(b**2, axis=1))[None, :]
        evidence = float(logsumexp(ratio)) - math.log(ratio.size)
        scored.append((evidence, i, j, np.unravel_index(int(np.argmax(ratio)), ratio.shape)))
    scored.sort(key=lambda x: -x[0])
    found = []
    for _, i, j, (p, q) in scored[: RULES.paired]:
        one, two = ranking.screened[i], ranking.screened[j]
        place = np.concatenate([one.grid.places()[thin[i][p]], two.grid.places()[thin[j][q]]])
        found.append((one, two, place))
    return found


def _partners(ranking: Ranking) -> list[tuple[Screened, Screened, Array]]:
    """Return the leading mechanism with those that explain most of what it leaves."""
    if not ranking.singles:
        return []
    lead = ranking.singles[0]
    white = lead.linear.white(lead.residual)
    scored: list[tuple[float, int, Array]] = []
    for i, s in enumerate(ranking.screened):
        if s.mechanism in lead.mechanisms:
            first = i
            continue
        e = lead.linear.white(s.effect)
        ratio = white @ e.T - 0.5 * np.sum(e**2, axis=1)
        scored.append(
            (float(logsumexp(ratio)) - math.log(len(e)), i, s.grid.places()[ratio.argmax()])
        )
    found = []
    for _, i, place in sorted(scored, key=lambda x: -x[0])[: RULES.partners]:
        (j, one), (k, two) = sorted([(i, place), (first, lead.place)], key=lambda x: x[0])
        found.append((ranking.screened[j], ranking.screened[k], np.concatenate([one, two])))
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
