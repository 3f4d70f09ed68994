"""Fit one explanation: a tuple of mechanisms, none for the baseline.

Gauss-Newton in the nuisances and the law's error, a simulated grid in the mechanisms' parameters;
the derivatives are taken with a step of 0.3 prior standard deviations, on which the slight
roughness of an event-driven simulation does not matter. What the data know better than the grid is
fitted again on a grid about its most probable place.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import chdtrc

from ...core.arrays import Array
from ...dynamics.mechanisms.base import Mechanism, Situation
from ..comparison.forward import Point, Simulator
from ..comparison.problem import Problem
from ..rules import RULES
from ..unknowns.lawerror import SIZES
from .derivatives import FORMS, derivatives
from .grid import Axis, Grid, posterior
from .linear import Linear, Mixture
from .together import refined

# limit: windows in a row that do no better, after which a fit is sharp [-]; time
_IN_VAIN = 2


@dataclass(frozen=True, eq=False)
class Fit:
    """A fitted explanation.

    - `mechanisms`: its mechanisms; empty for the baseline.
    - `grid`, `weight`: refined grid of their parameters and posterior weights (k,).
    - `place`: most probable place (axes,).
    - `z`, `covariance`: posterior mean (n_z,) and covariance of the unknowns there.
    - `prediction`: (m,) cells at `place` and `z`.
    - `log_evidence`: ln of the mean likelihood over the priors.
    - `chi2`: r^T Sigma^-1 r at `place`.
    - `residual`: (m,) data minus prediction at the prior mean, with the mechanism at `place`.
    - `here`: (m,) prediction at the expansion point.
    - `log_likelihood`: (k,) over the refined grid.
    - `residuals`: (k, m) as `residual`, over the refined grid.
    - `expanded`: (n_z,) unknowns at the expansion point.
    - `mixture`, `linear`: algebra at the expansion point with the model's error of every size,
      and that of the likeliest.
    """

    mechanisms: tuple[Mechanism, ...]
    grid: Grid
    weight: Array
    place: Array
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
    mixture: Mixture

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the mechanisms."""
        return tuple(m.name for m in self.mechanisms)

    @property
    def form(self) -> Array:
        """Posterior mean of each component of the mechanisms' form, (c,)."""
        return np.asarray(self.linear.form.T @ self.linear.solve(self.residual))

    @property
    def p_value(self) -> float:
        """Probability that an explanation which is the truth fits no better than this one does."""
        return float(chdtrc(max(len(self.residual) - len(self.place), 1), self.chi2))

    @property
    def name(self) -> str:
        """Names of the mechanisms joined by "+"."""
        return label(self.mechanisms)


def label(mechanisms: Sequence[Mechanism]) -> str:
    """Return an explanation's name."""
    return "+".join(m.name for m in mechanisms) or "baseline"


def fit(
    simulator: Simulator,
    mechanisms: tuple[Mechanism, ...],
    *,
    start: Fit | None = None,
    place: Array | None = None,
    rounds: int = RULES.fit_rounds,
    effect: Array | None = None,
) -> Fit:
    """Fit an explanation.

    - `start`: a fit whose unknowns to start from.
    - `place`: where in the mechanisms' priors to start; a place of the refined grid.
    - `rounds`: largest number of Gauss-Newton rounds.
    - `effect`: (k, m) change of the cells over the refined grid, if known from a first pass: used,
      and brought to the simulation at the expansion point, until the last round.
    """
    problem = simulator.problem
    grid = grid_of(problem, mechanisms)
    z = np.zeros(problem.n_z) if start is None else start.z.copy()
    if place is None:
        place = np.full(len(grid.axes), 0.5)
    last = max(rounds, 1) - 1
    settled = False
    for k in range(last + 1):
        exact = effect is None or settled or k == last
        found = expand(simulator, mechanisms, grid, z, place, None if exact else effect)
        z, settled = moved_towards(found, z, place)
        place = found.place
        if settled and exact:
            break
    return replace(found, z=z)


def fit_anchored(
    simulator: Simulator,
    mechanisms: tuple[Mechanism, ...],
    effect: Callable[[Array, Array], Array],
    *,
    z: Array,
    place: Array,
) -> Fit:
    """Fit an explanation of several mechanisms whose effects are known one by one, as `fit` does.

    `effect` gives the change of the cells over the refined grid, (k, m), from unknowns (n_z,) and a
    place of that grid; `z` and `place` are where to start. Of two rounds the better one counts.
    """
    grid = grid_of(simulator.problem, mechanisms)
    place = grid.places()[grid.index(place)]
    rounds = []
    for _ in range(2):
        found = expand(simulator, mechanisms, grid, z, place, effect(z, place))
        z, settled = moved_towards(found, z, place)
        place = found.place
        rounds.append(replace(found, z=z))
        if settled:
            break
    return max(rounds, key=lambda one: one.log_evidence)


def moved_towards(found: Fit, z: Array, place: Array) -> tuple[Array, bool]:
    """Return the unknowns of the next round, from z towards a fit, and whether they have settled.

    No unknown moves by more than two prior standard deviations at once; the place in the
    mechanisms' priors must have settled as well.
    """
    moved = found.z - z
    shift = float(np.max(np.abs(moved), initial=0.0))
    turned = float(np.max(np.abs(found.place - place), initial=0.0))
    after = z + moved * min(1.0, RULES.fit_farthest / shift) if shift > 0.0 else z
    return after, shift < RULES.fit_settled and turned < RULES.fit_turned


def tried_steps(
    simulator: Simulator, found: Fit, z: Array, place: Array
) -> tuple[Array, Array, bool]:
    """Return unknowns and place as `moved_towards` a fit, by the part of a step that fits best.

    Far from the stated values responses bend, and whole steps may swing to and fro between two
    places that both fit worse than what lies between them: the part of the step is gone that the
    simulation itself likes best, and none where it likes none.

    `found`: the fit expanded at z and place; `z`, `place`: (n_z,) unknowns and (axes,) place of
    this round.
    """
    whole, settled = moved_towards(found, z, place)
    if settled:
        return whole, found.place, True
    tried = [(z, place), *((z + t * (whole - z), found.place) for t in RULES.fit_parts)]
    points = [Point(z, found.grid.values(place)) for z, place in tried]
    r = simulator.problem.cells.value - simulator.predict(found.mechanisms, points)
    away = np.array([np.sum((z / found.linear.prior) ** 2) for z, _ in tried])
    badness = np.sum(r * np.linalg.solve(found.linear.measured, r.T).T, axis=1) + away
    best = int(np.argmin(badness))
    return *tried[best], bool(badness[0] - badness[best] < RULES.fit_little)


def grid_of(problem: Problem, mechanisms: Sequence[Mechanism]) -> Grid:
    """Return the grid of an explanation's parameters, with this rig's ranges."""
    situations = baseline_situations(problem)
    return Grid(tuple(Axis(m.name, p) for m in mechanisms for p in m.ranges(situations)))


def baseline_situations(problem: Problem) -> list[Situation]:
    """Return every condition's stated scene and surroundings."""
    scenes = problem.scenes(np.zeros(problem.n_z))
    return [(s, c.around) for s, c in zip(scenes, problem.conditions, strict=True)]


def expand(
    simulator: Simulator, mechanisms: tuple[Mechanism, ...], grid: Grid, z: Array, place: Array,
    effect: Array | None,
) -> Fit:  # fmt: skip
    """Fit once, with the derivatives at the unknowns z and the place given.

    `effect` is the change of the cells over the refined grid where it is known; else the grid's
    nodes are simulated.
    """
    problem = simulator.problem
    here, linear = derivatives(simulator, mechanisms, grid.values(place), z)
    if not mechanisms:
        fine = here[None]
    elif effect is None:
        fine = refined(simulator, mechanisms, grid, z, place, here)
    else:
        fine = effect + (here - effect[grid.index(place)])
    r = problem.cells.value - fine + linear.J @ z
    mixture = Mixture.of(linear, problem.n_nuisances, SIZES, FORMS)
    log_likelihood = mixture.log_likelihood(r)
    log_evidence, weight = posterior(log_likelihood)
    log_evidence += grid.log_volume
    best = int(np.argmax(log_likelihood))
    at = grid.places()[best] if mechanisms else place
    mean, cov = mixture.unknowns(r[best])
    linear = mixture.likeliest(r[best])
    prediction = fine[best] + linear.J @ (mean - z)
    return Fit(
        mechanisms, grid, weight, at, mean, cov, prediction, log_evidence,
        float(np.sum(linear.white(r[best]) ** 2)), linear, r[best], here, log_likelihood, r, z,
        mixture,
    )  # fmt: skip


def sharpened(simulator: Simulator, fitted: Fit, *, rounds: int = 8) -> Fit:
    """Fit again on a grid about the most probable place, if the data know it better than a grid.

    A grid over the whole prior has few nodes; where the data pin a parameter down to a part of
    their distance, neither the simulation between them nor the interval can be trusted. The window
    follows the most probable place, and shrinks to a few standard deviations about it.

    It ends where two in a row do no better: places that both fit worse than the best take turns.

    `fitted`: a fit with mechanisms; `rounds`: largest number of windows, at least 1.
    """
    grid, z, place = fitted.grid, fitted.z, fitted.place
    spread = _spread(fitted)
    share = np.array([1.0 / len(f) for f in grid.fine])
    node = np.array([min(1.0 / (len(c) - 1), RULES.node_apart) for c in grid.coarse])
    jumps = any(m.jumps for m in fitted.mechanisms)
    if np.all(spread > np.maximum(RULES.resolved * share, node)) and not jumps:
        return fitted
    half = np.maximum(RULES.window * spread, 2.5 * share)
    best, in_vain = None, 0
    for _ in range(max(rounds, 1)):
        low, high = np.maximum(place - half, 0.0), np.minimum(place + half, 1.0)
        window = tuple(zip(low.tolist(), high.tolist(), strict=True))
        local = Grid(grid.axes, window)
        found = expand(simulator, fitted.mechanisms, local, z, place, None)
        # where outcomes bend or jump, a step may fall off the branch that the data are on
        if best is None or found.log_evidence > best.log_evidence:
            best, in_vain = found, 0
        else:
            in_vain += 1
        if in_vain == _IN_VAIN:
            break
        wide = high - low
        outward = (
            ((found.place < low + 0.1 * wide) & (low > 0.0))
            | ((found.place > high - 0.1 * wide) & (high < 1.0))
        )  # fmt: skip
        z, place, settled = tried_steps(simulator, found, z, place)
        narrow = RULES.window * _spread(found)
        if not outward.any() and np.all(narrow > 0.3 * half) and settled:
            break
        half = np.where(outward, 1.6 * half, np.clip(narrow, 0.1 * half, half))
    assert best is not None
    return best


def _spread(fitted: Fit) -> Array:
    """Posterior standard deviation of each parameter, as a share of its prior's range."""
    places, weight = fitted.grid.places(), fitted.weight
    away = places - weight @ places
    # no window leaves one of two out
    return np.where(fitted.grid.either, np.inf, np.sqrt(weight @ away**2))
