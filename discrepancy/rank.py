"""Rank the explanations: every mechanism alone, then, if one is needed, pairs of the leading."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from .evidence import Grid, along_all
from .fit import (
    Fit,
    baseline_situations,
    fit,
    fit_anchored,
    grid_of,
    responses_at,
    sharpened,
)
from .forward import Point, Simulator
from .mechanisms import MECHANISMS
from .mechanisms.base import Mechanism
from .outliers import outlying, without_weight
from .thresholds import gain

Array = NDArray[np.float64]
Progress = Callable[[str], None]

FULL, NEAR = 4, 12.0
"""Mechanisms that are fitted in full: at least the first few, and all within some nats of them."""
PAIRED, PARTNERS = 4, 3
"""Pairs that are fitted: the leading by the sum of their effects, and of the leading mechanism with
those that explain most of what it leaves."""
_INVISIBLE = 1.0
_CLEAR, _RIVAL = 10.0, 0.6  # nats, and part of the leading gain, from which a fit is sharpened
_LEADS = 3.0  # nats from which outliers are judged under the leading mechanism
_FEW = 48  # places of each mechanism that stand for all in the search for pairs
_NEAR = 0.12  # of the prior's width: where the mutual effect of two mechanisms is simulated


@dataclass(frozen=True, eq=False)
class Screened:
    """First pass over one mechanism, with the baseline's own derivatives.

    Parameters
    ----------
    mechanism
        Which.
    grid, change
        Grid of its parameters, and the simulated change of the cells at its nodes (nodes, m).
    effect
        (k, m) the same over the refined grid.
    log_bayes
        ln B against the baseline.
    place
        Most probable place (axes,).
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
        singles.append(
            fit(
                simulator, (found.mechanism,), start=base, place=found.place, rounds=3,
                effect=found.effect,
            )
        )  # fmt: skip
    progress("sharpening the leading fits")
    singles = _sharpened(simulator, singles, base)
    return Ranking(base, tuple(screened), tuple(singles), (), excluded)


def _sharpened(
    simulator: Simulator, fits: list[Fit], base: Fit, *, most: int = FULL, rounds: int = 8
) -> list[Fit]:
    """Sharpen fits that gain much, the leading and its rivals; best first."""
    fits = sorted(fits, key=lambda f: -f.log_evidence)
    best = fits[0].log_evidence - base.log_evidence if fits else 0.0
    enough = max(_CLEAR, _RIVAL * best)
    found = [
        sharpened(simulator, f, rounds=rounds)
        if i < most and f.log_evidence - base.log_evidence > enough
        else f
        for i, f in enumerate(fits)
    ]
    return sorted(found, key=lambda f: -f.log_evidence)


def _cleared(
    simulator: Simulator, base: Fit, screened: list[Screened]
) -> tuple[Fit, list[Screened]]:
    """Take the weight from outliers, and fit and screen again what that changes."""
    judge = base
    lead = max(screened, key=lambda s: s.log_bayes, default=None)
    if lead is not None and lead.log_bayes > _LEADS:
        # a large effect moves the derivatives: judge single values by its own fit
        judge = fit(
            simulator, (lead.mechanism,), start=base, place=lead.place, rounds=2, effect=lead.effect
        )
    outliers = outlying(simulator.problem, judge)
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
    simulator: Simulator, ranking: Ranking, *, progress: Progress = lambda _: None
) -> Ranking:
    """Fit the leading pairs."""
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
    pairs = _sharpened(simulator, pairs, ranking.base, most=2, rounds=5)
    return replace(ranking, pairs=tuple(pairs))


def _leading_pairs(ranking: Ranking) -> list[tuple[Screened, Screened, Array]]:
    """Return the best pairs by the sum of their effects, and where in their priors they fit."""
    base = ranking.base
    w = base.linear.white(base.residual)
    thin = [np.arange(0, len(s.effect), max(len(s.effect) // _FEW, 1)) for s in ranking.screened]
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
    for _, i, j, (p, q) in scored[:PAIRED]:
        one, two = ranking.screened[i], ranking.screened[j]
        place = np.concatenate([one.grid.places()[thin[i][p]], two.grid.places()[thin[j][q]]])
        found.append((one, two, place))
    return found


def _partners(ranking: Ranking) -> list[tuple[Screened, Screened, Array]]:
    """Return the leading mechanism with those that explain most of what it leaves."""
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
    for _, i, place in sorted(scored, key=lambda x: -x[0])[:PARTNERS]:
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
        n = len(self.one.grid.parameters)
        own, other = self.one.grid.parameters, self.two.grid.parameters
        grid = Grid((*own, *other))
        first = self.one.grid.onto(self.one.change, grid.fine[:n])
        second = self.two.grid.onto(self.two.change, grid.fine[n:])
        total = (first[:, None, :] + second[None, :, :]).reshape(-1, first.shape[-1])
        return np.asarray(total + self._mutual(grid, n, z, place))

    def _mutual(self, grid: Grid, n: int, z: Array, place: Array) -> Array:
        count = 3 if len(place) == 2 else 2
        axes = [np.linspace(max(x - _NEAR, 0.0), min(x + _NEAR, 1.0), count) for x in place]
        both, plain = self._at(self.mechanisms, grid, axes, z), self._plain(z)
        alone = self._at(self.mechanisms[:1], self.one.grid, axes[:n], z)
        rest = self._at(self.mechanisms[1:], self.two.grid, axes[n:], z)
        m = both.shape[-1]
        table = both.reshape(len(alone), len(rest), m) - alone[:, None] - rest[None, :] + plain
        table = table.reshape(*[count] * len(place), m)
        inside = [np.clip(f, a[0], a[-1]) for f, a in zip(grid.fine, axes, strict=True)]
        return np.asarray(along_all(axes, inside, table).reshape(-1, m))

    def _plain(self, z: Array) -> Array:
        return np.asarray(self.simulator.predict((), [Point(z)])[0])

    def _at(
        self, mechanisms: Sequence[Mechanism], grid: Grid, axes: list[Array], z: Array
    ) -> Array:
        places = itertools.product(*axes)
        return self.simulator.predict(mechanisms, [Point(z, grid.values(p)) for p in places])


def screen(simulator: Simulator, base: Fit, mechanism: Mechanism) -> Screened:
    """Simulate a mechanism over its grid at the baseline's fit; use the baseline's derivatives."""
    grid = grid_of(simulator.problem, (mechanism,))
    responses = responses_at(simulator, (mechanism,), grid, base.z)
    change = responses - (base.here + base.linear.J @ (base.z - base.expanded))
    effect = grid.refine(change)
    white = base.linear.white(base.residual)[None, :]
    log_bayes = float(gain(white, np.zeros(1), base.linear, effect)[0])
    chi2 = np.sum(base.linear.white(base.residual - effect) ** 2, axis=1)
    place = grid.places()[int(np.argmin(chi2))]
    return Screened(mechanism, grid, change, effect, log_bayes, place)


def visible(found: Screened, base: Fit) -> float:
    """Largest effect in units of the measurements' standard errors, over all cells."""
    noise = np.sqrt(np.diag(base.linear.noise))
    return float(np.max(np.linalg.norm(found.effect / noise, axis=1)))
