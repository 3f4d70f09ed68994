"""When nothing known repairs the baseline: where in depth the force law would have to change.

The law's error is widened until it is free, component by component; what the data then make of it
is a correction without physics in it, with its band: the lead that a person can follow.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import norm

from ..core.arrays import Array
from ..dynamics.force import LOG_DEPTH_FIRST, LOG_DEPTH_LAST
from ..dynamics.strength import NODES
from .comparison.forward import Point, Simulator
from .comparison.problem import Problem
from .inference.fit import Fit
from .inference.linear import Linear

# limit: probability of bands and intervals [-]; usual
LEVEL = 0.90

# limit: rows of a correction that are shown [-]: half a screen
_CORRECTIONS_SHOWN = 12


@dataclass(frozen=True, eq=False)
class Correction:
    """Factors on the force law over the depth.

    `phase`: `loading` or `unloading`; `depth_over_R`: (k,) indentation over the tip's radius;
    `factor`, `low`, `high`: (k,) and the 90 % band.
    """

    phase: str
    depth_over_R: Array
    factor: Array
    low: Array
    high: Array


def widened(problem: Problem, fitted: Fit) -> Linear:
    """Return the algebra of a fit with the law's error made so wide that it is free."""
    prior = np.concatenate([np.ones(problem.n_nuisances), problem.error.freedom])
    return replace(fitted.linear, prior=prior)


def correct(simulator: Simulator, base: Fit) -> tuple[Correction, ...]:
    """Return the corrections of loading and unloading over the depths that a set reaches."""
    problem = simulator.problem
    k = problem.n_nuisances
    R = np.array([s.pair.R for s in problem.scenes(base.z)])
    reached = simulator.observe((), [Point(base.z)])["peak_depth_m"][0] / R
    # the expansion's offset by the law's own coefficients is part of the residual already
    mean, cov = widened(problem, base).unknowns(base.residual)
    mean, cov = mean[k:], cov[k:, k:]
    error = problem.error
    beyond = norm.ppf(0.5 + 0.5 * LEVEL)
    grid = np.linspace(LOG_DEPTH_FIRST, LOG_DEPTH_LAST, NODES)
    ends = math.log(0.3 * float(np.min(reached))), math.log(float(np.max(reached)))
    at = np.linspace(*ends, _CORRECTIONS_SHOWN)
    found = []
    for phase, kind in (("loading", "force"), ("unloading", "recovery")):
        rows = error.rows[kind]
        if rows.start == rows.stop:
            continue
        curves = np.stack([np.interp(at, grid, row) for row in error.curves(kind)])
        middle = mean[rows] @ curves
        spread = np.sqrt(np.einsum("ij,ik,kj->j", curves, cov[rows, rows], curves))
        found.append(
            Correction(
                phase, np.exp(at), np.exp(middle), np.exp(middle - beyond * spread),
                np.exp(middle + beyond * spread),
            )
        )  # fmt: skip
    return tuple(found)
