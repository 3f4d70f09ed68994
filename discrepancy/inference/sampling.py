"""Evidence by sampling: what `--confirm` adds to the screening's algebra.

The screening's posterior q(z, u) (a grid in the mechanism's parameters u, Gaussian in the unknowns
z) is annealed into the exact one with the full simulation at every point, by sequential Monte Carlo
through q^(1-b) p^b. Both moves leave q unchanged, so a step is accepted by the change of p/q alone:
a Crank-Nicolson step of z about its mean at u, and a fresh u that takes z along.

References
----------
P. Del Moral, A. Doucet, A. Jasra, J. R. Stat. Soc. B 68 (2006) 411.
S. L. Cotter et al., Statist. Sci. 28 (2013) 424 (Crank-Nicolson proposals).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy.special import logsumexp

from ...core.arrays import Array, Indices
from ..baseline.laws import Progress
from ..comparison.forward import Point, Simulator
from ..rules import RULES
from .fit import Fit

# limit: particles of a sampled evidence, and moves of each at each temperature [-]; time
_PARTICLES, _MOVES = 160, 3


def confirm_evidence(
    simulator: Simulator, fits: Sequence[Fit], rng: np.random.Generator, progress: Progress
) -> dict[str, float]:
    """Return the sampled ln evidence of each explanation, less that of the first.

    `fits`: explanations, the baseline first.
    """
    found = {}
    for fitted in fits:
        progress(f"sampling {fitted.name}")
        found[fitted.name] = sampled_evidence(simulator, fitted, rng)
    first = next(iter(found.values()))
    return {name: value - first for name, value in found.items()}


def sampled_evidence(simulator: Simulator, fitted: Fit, rng: np.random.Generator) -> float:
    """Return ln evidence of one explanation by annealing from its screened posterior."""
    linear, cells = fitted.linear, simulator.problem.cells
    prior = linear.prior
    solved = linear.solve(fitted.residuals.T)
    means = (linear.J.T @ solved).T * prior**2
    _, cov = linear.unknowns(fitted.residual)
    lower = np.linalg.cholesky(cov + 1e-10 * np.eye(len(cov)))
    noise = np.linalg.cholesky(linear.measured)
    places = fitted.grid.places() if fitted.mechanisms else np.zeros((1, 0))
    constant = float(np.sum(np.log(np.diag(lower))) - np.sum(np.log(np.diag(noise))))
    constant -= float(np.sum(np.log(prior)))
    constant -= 0.5 * len(cells) * math.log(2.0 * math.pi)

    def log_ratio(index: Indices, offset: Array) -> Array:
        z = means[index] + offset @ lower.T
        points = [Point(z[i], fitted.grid.values(places[k])) for i, k in enumerate(index)]
        miss = cells.value - simulator.predict(fitted.mechanisms, points)
        white = np.linalg.solve(noise, miss.T).T
        log_p = -0.5 * np.sum(white**2, axis=1) - 0.5 * np.sum((z / prior) ** 2, axis=1)
        log_q = np.log(fitted.weight[index] * len(places)) - 0.5 * np.sum(offset**2, axis=1)
        return np.asarray(np.nan_to_num(log_p - log_q + constant, nan=-1e9))

    # of every particle: index into the grid, offset of z from its mean there, and ln p/q
    n = len(lower)
    index = rng.choice(len(places), size=_PARTICLES, p=fitted.weight)
    offset = rng.standard_normal((_PARTICLES, n))
    ratio = log_ratio(index, offset)
    done, total = 0.0, 0.0
    while done < 1.0:
        step = _next_step(ratio, 1.0 - done)
        weight = step * ratio
        total += float(logsumexp(weight)) - math.log(_PARTICLES)
        done += step
        chosen = _resample(weight, rng)
        index, offset, ratio = index[chosen], offset[chosen], ratio[chosen]
        if done >= 1.0:
            break
        for move in range(_MOVES):
            there, aside = index, offset
            if move == 0 and len(places) > 1:
                there = rng.choice(len(places), size=_PARTICLES, p=fitted.weight)
            else:
                kick = rng.standard_normal((_PARTICLES, n))
                aside = math.sqrt(1.0 - RULES.sample_step**2) * offset + RULES.sample_step * kick
            other = log_ratio(there, aside)
            take = np.log(rng.random(_PARTICLES)) < done * (other - ratio)
            index, ratio = np.where(take, there, index), np.where(take, other, ratio)
            offset = np.where(take[:, None], aside, offset)
    # sampled with the likeliest size of the law's error: the others as the algebra has them
    one_size = float(logsumexp(linear.log_likelihood(fitted.residuals)))
    return total + float(logsumexp(fitted.log_likelihood)) - one_size + fitted.grid.log_volume


def _next_step(log_ratio: Array, most: float) -> float:
    """Largest step whose weights keep half of the particles effective."""

    def effective(step: float) -> float:
        w = step * log_ratio
        return math.exp(2.0 * float(logsumexp(w)) - float(logsumexp(2.0 * w))) / len(w)

    if effective(most) >= RULES.sample_left:
        return most
    low, high = 0.0, most
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if effective(middle) >= RULES.sample_left else (low, middle)
    return max(low, 1e-4)


def _resample(weight: Array, rng: np.random.Generator) -> Indices:
    share = np.exp(weight - logsumexp(weight))
    ticks = (rng.random() + np.arange(len(share))) / len(share)
    return np.minimum(np.searchsorted(np.cumsum(share), ticks), len(share) - 1).astype(np.intp)
