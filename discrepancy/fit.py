"""Fit one explanation: a tuple of mechanisms, none for the baseline.

Gauss-Newton in the nuisances and the law's error, a simulated grid in the mechanisms' parameters;
the derivatives are taken with a step of 0.3 prior standard deviations, on which the slight
roughness of an event-driven simulation does not matter.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .evidence import Grid, Linear, posterior
from .forward import Point, Simulator
from .mechanisms.base import Mechanism, Situation
from .problem import Problem

Array = NDArray[np.float64]

STEP = 0.3
_SPEED_STEP, _ANGLE_STEP = 0.01, 0.01
_JUMPS = (0.02, 0.05, 0.1)  # of the parameter: how near a jump makes a cell unsure
_ROUNDS, _SETTLED = 4, 0.15
_FARTHEST = 2.0  # of the unknowns within one round
# places of the refined grid in a standard deviation that need no window; its half width, in those
_RESOLVED, _WINDOW = 2.0, 4.0
_NODE = 0.25  # of a prior's range: nodes farther apart stand for a response that is nearly straight


@dataclass(frozen=True, eq=False)
class Fit:
    """A fitted explanation.

    Parameters
    ----------
    mechanisms
        Its mechanisms; empty for the baseline.
    grid, weight
        Refined grid of their parameters and posterior weights (k,).
    place
        Most probable place (axes,).
    values
        Parameters there.
    z, covariance
        Posterior mean (n_z,) and covariance of the unknowns there.
    prediction
        (m,) cells at `place` and `z`.
    log_evidence
        ln of the mean likelihood over the priors.
    chi2
        r^T Sigma^-1 r at `place`.
    linear
        Algebra at the expansion point.
    residual
        (m,) data minus prediction at the prior mean, with the mechanism at `place`.
    here
        (m,) prediction at the expansion point.
    log_likelihood
        (k,) over the refined grid.
    residuals
        (k, m) as `residual`, over the refined grid.
    expanded
        (n_z,) unknowns at the expansion point.
    """

    mechanisms: tuple[Mechanism, ...]
    grid: Grid
    weight: Array
    place: Array
    values: dict[str, float]
    z: Array
    covariance: Array
    prediction: Array
    log_evidence: float
    chi2: float
    linear: Linear
    residual: Array
    here: Array
    log_likelihood: Array
    residuals: Array
    expanded: Array

    @property
    def name(self) -> str:
        """Names of the mechanisms joined by "+"."""
        return label(self.mechanisms)


def label(mechanisms: Sequence[Mechanism]) -> str:
    """Return an explanation's name."""
    return "+".join(m.name for m in mechanisms) or "baseline"


def measured_covariance(problem: Problem, by_speed: Array, by_angle: Array) -> Array:
    """Noise of the cells, with what the scatter of speed and angle adds, shape (m, m).

    Parameters
    ----------
    problem
        Cells and conditions.
    by_speed, by_angle
        (m,) derivative of each cell by its condition's relative speed and angle.
    """
    k = problem.cells.condition
    same = k[:, None] == k[None, :]
    speed = np.array([c.speed_spread for c in problem.conditions])[k]
    angle = np.array([c.angle_spread for c in problem.conditions])[k]
    total = np.diag(problem.cells.std**2)
    for derivative, spread in ((by_speed, speed), (by_angle, angle)):
        column = derivative * spread
        total = total + np.where(same, column[:, None] * column[None, :], 0.0)
    return np.asarray(total)


def form_error(problem: Problem, effect: Array, share: float) -> Array:
    """Return what the textbook form of a mechanism may be off, as components (m, c).

    The same physics has several published forms, which differ by some share of their effect even
    when they are fitted to each other. Components: shares of the observables against each other,
    and slope and curvature over the speed. The common size of the effect is left to the
    mechanism's parameters.

    Parameters
    ----------
    problem
        Cells and conditions.
    effect
        (m,) change of the cells by the mechanism.
    share
        Standard deviation of each component, as a share of the effect.
    """
    cells = problem.cells
    names = list(dict.fromkeys(cells.observable))
    here = np.array([[o == n for n in names] for o in cells.observable], dtype=float)
    speed = np.log([c.speed for c in problem.conditions])[cells.condition]
    columns = [here[:, k] - here[:, k + 1 :].mean(axis=1) * (k + 1 < len(names))
               for k in range(len(names) - 1)]  # fmt: skip
    if np.ptp(speed) > 0.0:
        x = (speed - speed.mean()) / np.std(speed)
        columns += [x, (x * x - 1.0) / math.sqrt(2.0)]
    if not columns:
        return np.zeros((len(effect), 0))
    return np.asarray(share * effect[:, None] * np.stack(columns, axis=1))


def derivatives(
    simulator: Simulator, mechanisms: Sequence[Mechanism], values: dict[str, float], z: Array
) -> tuple[Array, Linear]:
    """Return prediction (m,) at z, and the algebra there."""
    problem = simulator.problem
    leaning = any(c.angle_spread > 0.0 for c in problem.conditions)
    points = [Point(z, values), Point(z, values, faster=_SPEED_STEP)]
    if leaning:
        points.append(Point(z, values, steeper=-_ANGLE_STEP))
    first = len(points)
    # away from the bounds of the priors the sign of the step does not matter
    sign = np.where(z > 0.0, -1.0, 1.0)
    for i in range(len(z)):
        moved = z.copy()
        moved[i] += STEP * sign[i]
        points.append(Point(moved, values))
    beside = len(points)
    points += [Point(z, v) for v in _beside(mechanisms, values)]
    found = simulator.predict(mechanisms, points)
    found, around = found[:beside], found[beside:]
    here = found[0]
    by_speed = (found[1] - here) / _SPEED_STEP
    by_angle = (found[2] - here) / -_ANGLE_STEP if leaning else np.zeros_like(here)
    J = ((found[first:] - here) / (STEP * sign[:, None])).T
    noise = measured_covariance(problem, by_speed, by_angle)
    if not mechanisms:
        return here, Linear(noise, J)
    effect = here - simulator.predict((), [Point(z)])[0]
    form = form_error(problem, effect, max(m.form for m in mechanisms))
    wider = max(m.law_error for m in mechanisms)
    if wider > 1.0:
        form = np.hstack([form, math.sqrt(wider**2 - 1.0) * J[:, problem.n_nuisances :]])
    if len(around):
        # by how much a cell departs from a smooth change nearby: half a jump, if there is one
        below, above = around[0::2], around[1::2]
        jump = 0.5 * np.max(np.abs(below + above - 2.0 * here), axis=0)
        form = np.hstack([form, np.diag(jump)])
    return here, Linear(noise, J, form)


def _beside(mechanisms: Sequence[Mechanism], values: dict[str, float]) -> list[dict[str, float]]:
    """Values a little below and above those of mechanisms whose outcome may jump."""
    names = [m.parameters[0].name for m in mechanisms if m.jumps]
    if not names:
        return []
    sides = [side for jump in _JUMPS for side in (-jump, jump)]
    return [values | {n: values[n] * (1.0 + side) for n in names} for side in sides]


def fit(
    simulator: Simulator,
    mechanisms: tuple[Mechanism, ...],
    *,
    start: Fit | None = None,
    place: Array | None = None,
    rounds: int = _ROUNDS,
    effect: Array | None = None,
) -> Fit:
    """Fit an explanation.

    Parameters
    ----------
    simulator
        The problem.
    mechanisms
        The explanation.
    start
        A fit whose unknowns to start from.
    place
        Where in the mechanisms' priors to start; a place of the refined grid.
    rounds
        Largest number of Gauss-Newton rounds.
    effect
        (k, m) change of the cells over the refined grid, if known from a first pass: used, and
        brought to the simulation at the expansion point, until the last round.
    """
    problem = simulator.problem
    grid = grid_of(problem, mechanisms)
    z = np.zeros(problem.n_z) if start is None else start.z.copy()
    if place is None:
        place = np.full(len(grid.parameters), 0.5)
    last = max(rounds, 1) - 1
    settled = False
    for k in range(last + 1):
        exact = effect is None or settled or k == last
        found = _expand(simulator, mechanisms, grid, z, place, None if exact else effect)
        moved = found.z - z
        shift = np.max(np.abs(moved), initial=0.0)
        turned = np.max(np.abs(found.place - place), initial=0.0)
        z = z + moved * min(1.0, _FARTHEST / shift) if shift > 0.0 else z
        place = found.place
        settled = bool(shift < _SETTLED and turned < 0.08)
        if settled and exact:
            break
    return replace(found, z=z, values=grid.values(place))


def fit_anchored(
    simulator: Simulator,
    mechanisms: tuple[Mechanism, ...],
    effect: Callable[[Array, Array], Array],
    *,
    start: Fit,
    place: Array,
    rounds: int = 2,
) -> Fit:
    """Fit an explanation of several mechanisms whose effects are known one by one.

    Parameters
    ----------
    simulator
        The problem.
    mechanisms
        The explanation.
    effect
        From unknowns (n_z,) and a place of the refined grid to the change of the cells over the
        refined grid, (k, m).
    start, place, rounds
        As for `fit`.
    """
    grid = grid_of(simulator.problem, mechanisms)
    z, place = start.z.copy(), grid.places()[grid.index(place)]
    for _ in range(rounds):
        found = _expand(simulator, mechanisms, grid, z, place, effect(z, place))
        moved = found.z - z
        shift = np.max(np.abs(moved), initial=0.0)
        turned = np.max(np.abs(found.place - place), initial=0.0)
        z = z + moved * min(1.0, _FARTHEST / shift) if shift > 0.0 else z
        place = found.place
        if shift < _SETTLED and turned < 0.08:
            break
    return replace(found, z=z, values=grid.values(place))


def sharpened(simulator: Simulator, fitted: Fit, *, rounds: int = 8) -> Fit:
    """Fit again on a grid about the most probable place, if the data know it better than a grid.

    A grid over the whole prior has few nodes; where the data pin a parameter down to a part of
    their distance, neither the simulation between them nor the interval can be trusted. The window
    follows the most probable place, and shrinks to a few standard deviations about it.

    Parameters
    ----------
    simulator
        The problem.
    fitted
        A fit with mechanisms.
    rounds
        Largest number of windows, at least 1.
    """
    grid, z, place = fitted.grid, fitted.z, fitted.place
    spread = _spread(fitted)
    share = np.array([1.0 / len(f) for f in grid.fine])
    node = np.array([min(1.0 / (len(c) - 1), _NODE) for c in grid.coarse])
    jumps = any(m.jumps for m in fitted.mechanisms)
    if np.all(spread > np.maximum(_RESOLVED * share, node)) and not jumps:
        return fitted
    half = np.maximum(_WINDOW * spread, 2.5 * share)
    best = None
    for _ in range(rounds):
        low, high = np.maximum(place - half, 0.0), np.minimum(place + half, 1.0)
        window = tuple(zip(low.tolist(), high.tolist(), strict=True))
        local = Grid(grid.parameters, window)
        found = _expand(simulator, fitted.mechanisms, local, z, place, None)
        # where outcomes jump, a step may fall off the branch that the data are on
        if best is None or found.log_evidence > best.log_evidence:
            best = found
        moved = found.z - z
        shift = np.max(np.abs(moved), initial=0.0)
        z = z + moved * min(1.0, _FARTHEST / shift) if shift > 0.0 else z
        wide = high - low
        outward = (
            ((found.place < low + 0.1 * wide) & (low > 0.0))
            | ((found.place > high - 0.1 * wide) & (high < 1.0))
        )  # fmt: skip
        place = found.place
        narrow = _WINDOW * _spread(found)
        if not outward.any() and np.all(narrow > 0.3 * half) and shift < _SETTLED:
            break
        half = np.where(outward, 1.6 * half, np.clip(narrow, 0.1 * half, half))
    assert best is not None
    return best


def _spread(fitted: Fit) -> Array:
    """Posterior standard deviation of each parameter, as a share of its prior's range."""
    places, weight = fitted.grid.places(), fitted.weight
    away = places - weight @ places
    return np.asarray(np.sqrt(weight @ away**2))


def grid_of(problem: Problem, mechanisms: Sequence[Mechanism]) -> Grid:
    """Return the grid of an explanation's parameters, with this rig's ranges."""
    situations = baseline_situations(problem)
    return Grid(tuple(p for m in mechanisms for p in m.ranges(situations)))


def baseline_situations(problem: Problem) -> list[Situation]:
    """Return every condition's stated scene and surroundings."""
    scenes = problem.scenes(np.zeros(problem.n_z))
    return [(s, c.around) for s, c in zip(scenes, problem.conditions, strict=True)]


def responses_at(
    simulator: Simulator, mechanisms: Sequence[Mechanism], grid: Grid, z: Array
) -> Array:
    """Return predictions at every node of the grid, shape (nodes, m)."""
    return simulator.predict(mechanisms, [Point(z, values) for values in grid.nodes()])


def _expand(
    simulator: Simulator, mechanisms: tuple[Mechanism, ...], grid: Grid, z: Array, place: Array,
    effect: Array | None,
) -> Fit:  # fmt: skip
    cells = simulator.problem.cells
    here, linear = derivatives(simulator, mechanisms, grid.values(place), z)
    if not mechanisms:
        fine = here[None]
    elif effect is None:
        fine = grid.refine(responses_at(simulator, mechanisms, grid, z))
    else:
        fine = effect + (here - effect[grid.index(place)])
    r = cells.value - fine + linear.J @ z
    log_likelihood = linear.log_likelihood(r)
    log_evidence, weight = posterior(log_likelihood)
    log_evidence += grid.log_volume
    best = int(np.argmax(log_likelihood))
    at = grid.places()[best] if mechanisms else place
    mean, cov = linear.unknowns(r[best])
    prediction = fine[best] + linear.J @ (mean - z)
    return Fit(
        mechanisms, grid, weight, at, grid.values(at), mean, cov, prediction, log_evidence,
        float(np.sum(linear.white(r[best]) ** 2)), linear, r[best], here, log_likelihood, r, z,
    )  # fmt: skip
