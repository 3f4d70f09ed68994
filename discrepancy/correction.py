"""When nothing known repairs the baseline: where in depth the force law would have to change.

The law's error is widened until it is free, component by component; what the data then make of it
is a correction without physics in it, with its band: the lead that a person can follow.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..impact.force import LOG_DEPTH_FIRST, LOG_DEPTH_LAST
from ..impact.strength import NODES
from .forward import Point, Simulator
from .inference.fit import Fit
from .inference.linear import Linear
from .problem import Problem

Array = NDArray[np.float64]

_SHOWN = 12


@dataclass(frozen=True, eq=False)
class Correction:
    """Factors on the force law over the depth.

    Parameters
    ----------
    phase
        `loading` or `unloading`.
    depth_over_R
        (k,) indentation over the tip's radius.
    factor, low, high
        (k,) and the 90 % band.
    """

    phase: str
    depth_over_R: Array
    factor: Array
    low: Array
    high: Array


def widened(problem: Problem, fitted: Fit) -> Linear:
    """Return the algebra of a fit with the law's error made so wide that it is free."""
    k = problem.n_nuisances
    J = fitted.linear.J.copy()
    J[:, k:] *= problem.error.freedom
    return Linear(fitted.linear.noise, J, fitted.linear.form)


def correct(simulator: Simulator, base: Fit) -> tuple[Correction, ...]:
    """Return the corrections of loading and unloading over the depths that a set reaches.

    Parameters
    ----------
    simulator
        The problem.
    base
        Fit of the baseline.
    """
    problem = simulator.problem
    k = problem.n_nuisances
    shallowest, deepest = _reached(simulator, base)
    # the expansion's offset by the law's own coefficients is part of the residual already
    mean, cov = widened(problem, base).unknowns(base.residual)
    error = problem.error
    free = error.freedom
    mean, cov = mean[k:] * free, cov[k:, k:] * np.outer(free, free)
    n, m = len(error.force), len(error.recovery)
    grid = np.linspace(LOG_DEPTH_FIRST, LOG_DEPTH_LAST, NODES)
    at = np.linspace(math.log(0.3 * shallowest), math.log(deepest), _SHOWN)
    found = []
    for phase, rows, basis in (
        ("loading", slice(0, n), error.force),
        ("unloading", slice(n, n + m), error.recovery),
    ):
        if len(basis) == 0:
            continue
        curves = np.stack([np.interp(at, grid, row) for row in basis])
        middle = mean[rows] @ curves
        spread = np.sqrt(np.einsum("ij,ik,kj->j", curves, cov[rows, rows], curves))
        found.append(
            Correction(
                phase, np.exp(at), np.exp(middle), np.exp(middle - 1.645 * spread),
                np.exp(middle + 1.645 * spread),
            )
        )  # fmt: skip
    return tuple(found)


def _reached(simulator: Simulator, base: Fit) -> tuple[float, float]:
    """Smallest and largest peak depth over radius of a set."""
    seen = simulator.observe((), [Point(base.z)])["peak_depth_m"][0]
    R = np.array([s.pair.R for s in simulator.problem.scenes(base.z)])
    return float(np.min(seen / R)), float(np.max(seen / R))
