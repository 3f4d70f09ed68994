"""What the cells do about one point: their derivatives, their noise, the error of a form."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ...core.arrays import Array
from ...dynamics.mechanisms.base import Constants, Mechanism
from ..comparison.forward import Point, Simulator
from ..comparison.problem import Problem
from ..rules import RULES
from ..unknowns.covariates import nearness, same_observable
from .linear import Linear, Sizes

FORMS = Sizes.normal(RULES.form_spread)
"""Of the error of a form."""


def measured_covariance(problem: Problem, by_speed: Array, by_angle: Array) -> Array:
    """Noise of the cells, with what errors of speed, angle and setting add, shape (m, m).

    `by_speed`, `by_angle`: (m,) derivative of each cell by its condition's relative speed and
    angle.
    """
    k = problem.cells.condition
    same = k[:, None] == k[None, :]
    speed = np.array([c.speed_spread for c in problem.conditions])[k]
    angle = np.array([c.angle_spread for c in problem.conditions])[k]
    total = np.diag(problem.cells.std**2)
    setting = np.array([c.setting for c in problem.conditions])[k]
    set_once = np.array([c.setting_spread for c in problem.conditions])[k]
    for derivative, spread, alike in (
        (by_speed, speed, same), (by_angle, angle, same),
        (by_speed, set_once, setting[:, None] == setting[None, :]),
    ):  # fmt: skip
        column = derivative * spread
        total = total + np.where(alike, column[:, None] * column[None, :], 0.0)
    return np.asarray(total)


def form_error(problem: Problem, effect: Array, share: float) -> Array:
    """Return what the textbook form of a mechanism may be off, as components (m, m).

    The same physics has several published forms, which differ by some share of their effect even
    when they are fitted to each other: half of the variance alike in all observables, half in each
    by itself, smooth over what varies but for a tenth.

    `effect`: (m,) change of the cells by the mechanism; `share`: standard deviation, as a share of
    the effect.
    """
    smooth = (1.0 - RULES.form_rough) * nearness(problem, RULES.form_length)
    alike = smooth * (0.5 + 0.5 * same_observable(problem)) + RULES.form_rough * np.eye(len(effect))
    lower = np.linalg.cholesky(alike + 1e-9 * np.eye(len(effect)))
    return np.asarray(share * effect[:, None] * lower)


def derivatives(
    simulator: Simulator, mechanisms: Sequence[Mechanism], values: Constants, z: Array
) -> tuple[Array, Linear]:
    """Return prediction (m,) at z, and the algebra there."""
    problem = simulator.problem
    leaning = any(c.angle_spread > 0.0 for c in problem.conditions)
    points = [Point(z, values), Point(z, values, faster=RULES.setting_step)]
    if leaning:
        points.append(Point(z, values, steeper=-RULES.setting_step))
    first = len(points)
    # away from the bounds of the priors the sign of the step does not matter
    sign = np.where(z > 0.0, -1.0, 1.0)
    for i in range(len(z)):
        moved = z.copy()
        moved[i] += RULES.step * sign[i]
        points.append(Point(moved, values))
    beside = len(points)
    points += [Point(z, v) for v in _beside(mechanisms, values)]
    found = simulator.predict(mechanisms, points)
    found, around = found[:beside], found[beside:]
    here = found[0]
    by_speed = (found[1] - here) / RULES.setting_step
    by_angle = (found[2] - here) / -RULES.setting_step if leaning else np.zeros_like(here)
    J = ((found[first:] - here) / (RULES.step * sign[:, None])).T
    noise = measured_covariance(problem, by_speed, by_angle)
    if not mechanisms:
        return here, Linear(noise, J)
    without = [[o for o in mechanisms if o is not m] for m in mechanisms]
    effects = [here - simulator.predict(rest, [Point(z, values)])[0] for rest in without]
    form = np.hstack([
        form_error(problem, effect, m.form) for m, effect in zip(mechanisms, effects, strict=True)
    ])  # fmt: skip
    # of known size, other than what the forms may be off
    noise = noise + sum(x @ x.T for x in _scaled(simulator, mechanisms, values, z, here))
    wider = max(m.law_error for m in mechanisms)
    if wider > 1.0:
        form = np.hstack([form, math.sqrt(wider**2 - 1.0) * J[:, problem.n_nuisances :]])
    if len(around):
        # by how much a cell departs from a smooth change nearby: half a jump, if there is one
        below, above = around[0::2], around[1::2]
        jump = 0.5 * np.max(np.abs(below + above - 2.0 * here), axis=0)
        form = np.hstack([form, np.diag(jump)])
    return here, Linear(noise, J, _condensed(form))


def _scaled(
    simulator: Simulator, mechanisms: Sequence[Mechanism], values: Constants, z: Array, here: Array
) -> list[Array]:
    """Change of the cells (m, 1) where what a first parameter multiplies is off, of each."""
    found = []
    for m in mechanisms:
        if m.scale_error:
            size = m.parameters[0].name
            more = values[m.name][size] * math.exp(m.scale_error)
            moved = {**values, m.name: {**values[m.name], size: more}}
            found.append((simulator.predict(mechanisms, [Point(z, moved)])[0] - here)[:, None])
    return found


def _condensed(form: Array) -> Array:
    """Components (m, c) with the same covariance, no more of them than cells."""
    if form.shape[1] <= form.shape[0]:
        return form
    size, shape = np.linalg.eigh(form @ form.T)
    return np.asarray(shape * np.sqrt(np.maximum(size, 0.0)))


def _beside(mechanisms: Sequence[Mechanism], values: Constants) -> list[Constants]:
    """Values a little below and above those of mechanisms whose outcome may jump."""
    jumping = [(m.name, m.parameters[0].name) for m in mechanisms if m.jumps]
    if not jumping:
        return []
    found: list[Constants] = []
    for side in (sign * jump for jump in RULES.jumps for sign in (-1.0, 1.0)):
        moved = {m: {**values[m], p: values[m][p] * (1.0 + side)} for m, p in jumping}
        found.append({**values, **moved})
    return found
