"""One fit of every explanation of a set, for all rules: no error of law or form, a flat floor."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_triangular
from scipy.special import logsumexp

from ...core.arrays import Array, Indices
from ...core.processes.threads import in_one_thread
from ...discrepancy.comparison.forward import Simulator
from ...discrepancy.comparison.problem import Problem, problem_of
from ...discrepancy.inference.fit import Fit, baseline_situations, fit
from ...discrepancy.inference.linear import Linear
from ...discrepancy.rank import Screened, screen
from ...discrepancy.unknowns.lawerror import NO_ERROR
from ...dynamics.mechanisms import MECHANISMS, Mechanism
from ...recordings import RecordingSet

FLOOR = 0.03
"""Share of every number that a simple rule takes the model to be off by, independently."""

_LEADING = 2
"""So many of the first pass are fitted in full, by each of the criteria that order it."""

_PLACES = 150
"""Places of a grid that a pair's mean likelihood is taken over, about."""

_NO_CELLS = np.zeros(0)


class Tried(NamedTuple):
    """One explanation, and the least chi2 over its grid with ln det of the covariance.

    By the noise alone, and with the floor. With the floor also ln of the mean likelihood over the
    grid, and ln of what each condition's cells had, predicted from all others.
    """

    name: str
    parameters: int
    noise: tuple[float, float]
    floor: tuple[float, float]
    evidence: float = 0.0
    left_out: Array = _NO_CELLS


@dataclass(frozen=True, eq=False)
class Fitted:
    """All explanations of one set.

    - `cells`: their number, m.
    - `tried`: the baseline, then every mechanism that arithmetic does not rule out.
    - `pairs`: the best single with each other mechanism.
    - `white`: (m,) whitened residual of the baseline, with the floor.
    - `columns`: mechanism to its whitened effect (m,) where it fits best.
    """

    cells: int
    tried: tuple[Tried, ...]
    pairs: tuple[Tried, ...] = ()
    white: Array = field(default_factory=lambda: _NO_CELLS)
    columns: Mapping[str, Array] = field(default_factory=dict)

    @property
    def acting(self) -> int:
        """Number of mechanisms that were tried."""
        return len(self.tried) - 1


@dataclass(frozen=True, eq=False)
class _Floored:
    """What explains a set with a floor under its noise: (m,) floor, (m,) condition of each cell."""

    floor: Array
    condition: Indices

    def tried(self, name: str, parameters: int, residuals: Array, linear: Linear) -> Tried:
        """Weigh one explanation by its residuals (k, m) over the grid."""
        bare = linear.noise - np.diag(self.floor**2)
        noise, log_det_bare = _white(residuals, bare + linear.J @ linear.J.T)
        floored, log_det = _white(residuals, linear.noise + linear.J @ linear.J.T)
        squares = np.sum(floored**2, axis=1)
        log_likelihood = -0.5 * (squares + log_det + len(self.floor) * math.log(2.0 * math.pi))
        return Tried(
            name, parameters,
            (float(np.min(np.sum(noise**2, axis=1))), log_det_bare),
            (float(np.min(squares)), log_det),
            float(logsumexp(log_likelihood)) - math.log(len(residuals)),
            self._left_out(residuals, linear, log_likelihood),
        )  # fmt: skip

    def _left_out(self, residuals: Array, linear: Linear, log_likelihood: Array) -> Array:
        """Return ln p of each condition's cells given all others, over the grid, (conditions,).

        Exact: the cells are jointly normal at every node, whose weight is its likelihood without
        the condition.
        """
        precision = np.linalg.inv(linear.noise + linear.J @ linear.J.T)
        weighted = residuals @ precision
        found = []
        for number in np.unique(self.condition):
            here = self.condition == number
            own = precision[np.ix_(here, here)]
            miss = np.sum(weighted[:, here] * np.linalg.solve(own, weighted[:, here].T).T, axis=1)
            log_det = float(np.linalg.slogdet(own)[1]) - np.sum(here) * math.log(2.0 * math.pi)
            given = 0.5 * (log_det - miss)
            found.append(logsumexp(log_likelihood) - logsumexp(log_likelihood - given))
        return np.array(found)


def _white(residuals: Array, covariance: Array) -> tuple[Array, float]:
    """Return whitened residuals (k, m), and ln det of the covariance."""
    lower = np.linalg.cholesky(covariance)
    log_det = 2.0 * float(np.sum(np.log(np.diag(lower))))
    return solve_triangular(lower, residuals.T, lower=True).T, log_det


@in_one_thread
def fitted_of(recordings: RecordingSet) -> Fitted:
    """Fit a set's baseline and every mechanism that acts in it.

    Every mechanism's grid is simulated once, at the baseline's fit; what leads by any criterion is
    fitted in full.
    """
    problem = problem_of(recordings)
    cells = problem.cells
    floor = FLOOR * np.where(cells.is_log, 1.0, np.abs(cells.value))
    simulator = Simulator(replace(
        problem, error=replace(NO_ERROR, spreads=problem.error.spreads),
        cells=replace(cells, std=np.hypot(cells.std, floor)),
    ))  # fmt: skip
    weigh = _Floored(floor, cells.condition)
    base = fit(simulator, ())
    nothing = weigh.tried(base.name, 0, base.residuals, base.linear)
    seen = {m.name: screen(simulator, base, m) for m in _acting(simulator.problem)}
    tried = {
        name: weigh.tried(name, len(s.grid.axes), base.residual - s.effect, base.linear)
        for name, s in seen.items()
    }
    fits = {
        name: fit(
            simulator, (seen[name].mechanism,), start=base, place=seen[name].place, rounds=2,
            effect=seen[name].effect,
        )
        for name in _leading(tried, len(cells))
    }  # fmt: skip
    for name, f in fits.items():
        tried[name] = weigh.tried(name, len(f.grid.axes), f.residuals, f.linear)
    white, _ = _white(base.residual[None], base.linear.total)
    effects = {name: _white(s.effect, base.linear.total)[0] for name, s in seen.items()}
    nearest = {k: e[np.argmin(np.sum((white - e) ** 2, axis=1))] for k, e in effects.items()}
    return Fitted(
        len(cells), (nothing, *tried.values()), tuple(_pairs(fits, tried, seen, len(cells))),
        white[0], nearest,
    )  # fmt: skip


def _acting(problem: Problem) -> Iterator[Mechanism]:
    """The mechanisms that arithmetic leaves, without errors of their forms."""
    situations = baseline_situations(problem)
    exact = {"form": 0.0, "scale_error": 0.0, "jumps": False, "law_error": 1.0}
    for m in MECHANISMS:
        rests = any(problem.without_modulus[body] for body in m.rests_on)
        if not rests and not m.ruled_out(situations):
            yield type(type(m).__name__, (type(m),), exact)()


def _bic(t: Tried, cells: int) -> float:
    return sum(t.floor) + t.parameters * math.log(cells)


def _leading(tried: Mapping[str, Tried], cells: int) -> set[str]:
    """Names of what leads the first pass: by BIC, BIC and AIC on noise, mean likelihood."""
    orders: list[Callable[[str], float]] = [
        lambda k: _bic(tried[k], cells),
        lambda k: sum(tried[k].noise) + tried[k].parameters * math.log(cells),
        lambda k: sum(tried[k].noise) + 2.0 * tried[k].parameters,
        lambda k: -tried[k].evidence,
    ]
    return {name for order in orders for name in sorted(tried, key=order)[:_LEADING]}


def _pairs(
    fits: Mapping[str, Fit], tried: Mapping[str, Tried], seen: Mapping[str, Screened], cells: int
) -> Iterator[Tried]:
    """A second forward step: each other mechanism's effect added to the best single's fit."""
    if not fits:
        return
    first = min(fits, key=lambda k: _bic(tried[k], cells))
    linear = fits[first].linear
    left, log_det = _white(fits[first].residuals, linear.total)
    thin = left[_thinned(len(left))]
    for name, s in seen.items():
        if name == first:
            continue
        more, _ = _white(s.effect, linear.total)
        some = more[_thinned(len(more))]
        chi2 = _squares(thin, some)
        # the least of the whole grids, along each from the least of the thin ones
        i, j = np.unravel_index(int(np.argmin(chi2)), chi2.shape)
        beside = more[int(np.argmin(_squares(thin[[i]], more)))]
        least = float(np.min(_squares(left, beside[None])))
        mean = math.log(float(np.mean(np.exp(-0.5 * (chi2 - chi2[i, j]))))) - 0.5 * chi2[i, j]
        yield Tried(
            f"{first}+{name}", tried[first].parameters + tried[name].parameters,
            (math.nan, math.nan), (least, log_det),
            mean - 0.5 * (log_det + cells * math.log(2.0 * math.pi)),
        )  # fmt: skip


def _thinned(n: int) -> slice:
    return slice(None, None, max(n // _PLACES, 1))


def _squares(left: Array, more: Array) -> Array:
    """Chi2 (k, j) of whitened residuals (k, m) less whitened effects (j, m)."""
    own = np.sum(left**2, axis=1)[:, None] + np.sum(more**2, axis=1)
    return np.asarray(own - 2.0 * left @ more.T)
