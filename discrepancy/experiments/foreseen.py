"""What cells that were not measured would show under an explanation, given all that was.

The same algebra as the fit's, over the measured cells and the new ones together: what the law, the
nuisances and a mechanism's form may be off is shared by both, so that what the set already says
narrows it. Of the mechanism's parameters samples of the posterior are simulated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.linalg import block_diag, cho_factor, cho_solve
from scipy.special import logsumexp
from scipy.stats.qmc import MultivariateNormalQMC

from ...core.arrays import Array, Indices
from ..comparison.forward import Point, Simulator
from ..comparison.problem import Problem
from ..inference.derivatives import FORMS, derivatives
from ..inference.fit import Fit
from ..inference.linear import Linear, Mixture
from ..rules import RULES
from ..unknowns.lawerror import SIZES
from ..unknowns.wrong_number import wrong_factors

# limit: draws of each rival's parameters [-]; time
_DRAWS = 12

# limit: dimensions in which noise is drawn together [-]
_DRAWN_TOGETHER = 32


class Settled(NamedTuple):
    """A number of the sheet that is measured again: its key, and the relative error of that."""

    key: str
    std: float


@dataclass(frozen=True, eq=False)
class Foreseen:
    """What new cells would show: mean (n,) and covariance (n, n), their noise in it."""

    mean: Array
    covariance: Array

    def of(self, cells: Indices) -> Foreseen:
        """Return the same of some of the cells."""
        return Foreseen(self.mean[cells], self.covariance[np.ix_(cells, cells)])


def foreseen(
    simulator: Simulator, wider: Problem, fitted: Fit, rng: np.random.Generator,
    settled: Sequence[Settled] = (),
) -> Foreseen:  # fmt: skip
    """Return what the further cells of a wider problem would show under an explanation.

    - `simulator`: the problem that was fitted, of m cells.
    - `wider`: the same with n more cells after its own, whose values are not looked at.
    - `rng`: draws samples of the mechanisms' parameters.
    - `settled`: numbers of the sheet that are measured again: ln of each, over what is stated,
      stands behind the cells.
    """
    whole, known = simulator.of(wider), len(simulator.problem.cells)
    z, values = fitted.z, fitted.grid.values(fitted.place)
    here, linear = derivatives(whole, fitted.mechanisms, values, z)
    linear = _with_numbers(linear, wider, settled)
    measured = simulator.problem.cells.value + linear.J[:known] @ z
    parts = Mixture.of(linear, wider.n_nuisances, SIZES, FORMS)
    residual = measured - here[:known]
    said = [
        w + _first(p, known).log_likelihood(residual)
        for w, p in zip(parts.log_weight, parts.parts, strict=True)
    ]
    likeliest = parts.parts[int(np.argmax(said))]
    total = likeliest.total
    gain = cho_solve(cho_factor(total[:known, :known], lower=True), total[:known, known:]).T
    samples = _samples(fitted, rng)
    off = [wrong_factors(fitted.mechanisms, p.values) for p in samples]
    numbers = np.array([[np.log(f.get(s.key, 1.0)) for s in settled] for f in off])
    numbers = numbers.reshape(len(samples), len(settled)) + linear.J[len(here) :] @ z
    seen = np.hstack([whole.predict(fitted.mechanisms, samples), numbers])
    means = seen[:, known:] - linear.J[known:] @ z + (measured - seen[:, :known]) @ gain.T
    covariance = total[known:, known:] - gain @ total[:known, known:]
    if len(means) > 1:
        covariance = covariance + np.atleast_2d(np.cov(means.T))
    return Foreseen(means.mean(axis=0), np.asarray(0.5 * (covariance + covariance.T)))


def _with_numbers(linear: Linear, problem: Problem, settled: Sequence[Settled]) -> Linear:
    """The algebra with a further row for each number of the sheet."""
    place = {n.name: i for i, n in enumerate(problem.nuisances) if n.log}
    J = np.zeros((len(settled), linear.J.shape[1]))
    for row, one in zip(J, settled, strict=True):
        if one.key in place:
            row[place[one.key]] = problem.nuisances[place[one.key]].spread
    noise = block_diag(linear.noise, np.diag([s.std**2 for s in settled]))
    form = np.pad(linear.form, ((0, len(settled)), (0, 0)))
    return replace(linear, noise=noise, J=np.vstack([linear.J, J]), form=form)


def _first(linear: Linear, known: int) -> Linear:
    """The algebra of the first cells."""
    noise, J, form = linear.noise[:known, :known], linear.J[:known], linear.form[:known]
    return replace(linear, noise=noise, J=J, form=form)


def _samples(fitted: Fit, rng: np.random.Generator) -> list[Point]:
    """Samples of the mechanisms' parameters, at the fitted unknowns."""
    if not fitted.mechanisms:
        return [Point(fitted.z)]
    places = fitted.grid.places()
    chosen = rng.choice(len(places), size=_DRAWS, p=fitted.weight)
    return [Point(fitted.z, fitted.grid.values(places[i])) for i in chosen]


def discrimination(seen: Sequence[Foreseen], weight: Sequence[float]) -> float:
    """Return D of some cells, averaged over pairs of rivals by the product of their probabilities.

    D = (mu_i - mu_j)^T (Sigma_i + Sigma_j)^-1 (mu_i - mu_j).
    """
    worth, whole = 0.0, 0.0
    for i, (a, p) in enumerate(zip(seen, weight, strict=True)):
        for b, q in zip(seen[i + 1 :], weight[i + 1 :], strict=True):
            gap = a.mean - b.mean
            worth += p * q * float(gap @ np.linalg.solve(a.covariance + b.covariance, gap))
            whole += p * q
    return worth / whole if whole > 0.0 else 0.0


def information(seen: Sequence[Foreseen], weight: Sequence[float]) -> float:
    """Return by how much some cells would lower the entropy of which rival is true, in nats.

    The expected Kullback-Leibler distance of the probabilities after from those before (D. V.
    Lindley, Ann. Math. Stat. 27 (1956) 986), over draws from each rival.
    """
    possible = np.array(weight) > 0.0
    if np.sum(possible) < 2:
        # one has it all, or something outside: nothing is left to tell apart
        return 0.0
    seen = [s for s, one in zip(seen, possible, strict=True) if one]
    p = np.array(weight)[possible] / np.sum(weight)
    lower = [np.asarray(np.linalg.cholesky(s.covariance)) for s in seen]
    # the same draws for every candidate: what differs between two of them is no chance
    draws = _spread_out(len(seen[0].mean))
    worth = 0.0
    for share, one, root in zip(p, seen, lower, strict=True):
        y = one.mean + draws @ root.T
        told = np.stack([_log_density(y, s, low) for s, low in zip(seen, lower, strict=True)])
        own = _log_density(y, one, root)
        worth += share * float(np.mean(own - logsumexp(np.log(p)[:, None] + told, axis=0)))
    return max(worth, 0.0)


@cache
def _spread_out(n: int) -> Array:
    """Standard normal draws (draws, n) without clumps, the same for the first n of more."""
    if n % _DRAWN_TOGETHER:
        return _spread_out(n - n % _DRAWN_TOGETHER + _DRAWN_TOGETHER)[:, :n]
    drawn = MultivariateNormalQMC(np.zeros(n), rng=np.random.default_rng(0))
    return np.asarray(drawn.random(RULES.noise_draws))


def _log_density(y: Array, seen: Foreseen, lower: Array) -> Array:
    """Ln of the density of draws (k, n), but for a constant."""
    white = np.linalg.solve(lower, (y - seen.mean).T)
    return np.asarray(-0.5 * np.sum(white**2, axis=0) - np.sum(np.log(np.diag(lower))))
