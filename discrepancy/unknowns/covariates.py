"""What varies over the conditions of a set, and how alike its cells are for it."""

from __future__ import annotations

import numpy as np

from ...core.arrays import Array
from ..comparison.problem import Problem

PRESSED = "press instead of impact"
"""Of sets with both: what no mechanism that needs motion does in a press."""


def covariates(problem: Problem) -> dict[str, Array]:
    """Return what varies over the conditions, standardised, each of shape (conditions,).

    A press lies at the speed at which its striker's impact goes as deep.
    """
    c, of = problem.conditions, problem.rig.of
    pressed = np.array([x.press is not None for x in c], dtype=float)
    raw = {
        "load" if pressed.all() else "impact speed": np.log([x.speed for x in c]),
        PRESSED: pressed,
        "rod length": np.array([of[f"strikers.{x.striker}.length_m"] for x in c]),
        "tip radius": np.log([of[f"strikers.{x.striker}.tip_radius_m"] for x in c]),
        "striker mass": np.log([of[f"strikers.{x.striker}.mass_kg"] for x in c]),
        "angle": np.array([x.incidence for x in c]),
        "tangential speed": np.array([x.tangential for x in c]),
        "temperature": np.array([x.around.temperature for x in c]),
    }
    found = {}
    for name, value in raw.items():
        spread = float(np.std(value))
        if spread > 1e-6 * max(1.0, float(np.max(np.abs(value)))):
            found[name] = (value - value.mean()) / spread
    return found


def nearness(problem: Problem, length: float) -> Array:
    """Squared-exponential covariance of the cells by their conditions alone, (m, m).

    `length`: correlation length, in standard deviations of each covariate.
    """
    # a form that is off is so in presses as well
    varied = [x for name, x in covariates(problem).items() if name != PRESSED]
    m = len(problem.cells)
    if not varied:
        return np.ones((m, m))
    place = np.stack(varied, axis=1)[problem.cells.condition] / length
    away = np.sum((place[:, None, :] - place[None, :, :]) ** 2, axis=2)
    return np.asarray(np.exp(-0.5 * away))


def same_observable(problem: Problem) -> Array:
    """1 where two cells are of one observable, else 0, (m, m)."""
    names = np.array(problem.cells.observable)
    return np.asarray((names[:, None] == names[None, :]).astype(float))
