"""From a recording set to the flow curve of the body that its marks are in.

Gauss-Newton in the curve, the rate law, the nuisances and the law's error, all with normal priors;
the three sizes of the law's error are weighed by their evidence. Only marks take part: what a
rebound loses elsewhere says nothing of the metal.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.special import logsumexp
from scipy.stats import norm

from ...core.arrays import Array, Mask
from ...core.errors import InputError
from ...core.inputs.flow_curve import SPECIMENS, Rise
from ...core.processes.threads import in_one_thread
from ...core.rig import TABOR_STRAIN
from ...dynamics import dent_radius
from ...dynamics.mechanisms.base import Constants, Mechanism, attached
from ...dynamics.mechanisms.strength.strain_rate_hardening import (
    StrainRateHardening,
    rises_misfit,
)
from ...models.hardening import REPRESENTATIVE
from ...models.uncertainty import METAL
from ...recordings import RecordingSet
from ..comparison.forward import Point, Simulator
from ..comparison.problem import Problem, problem_of
from ..correction import LEVEL
from ..inference.derivatives import form_error, measured_covariance
from ..rules import RULES
from ..unknowns.lawerror import SIZES
from .flow import STRAINS, FlowCurveOfMarks, curve_values, weights
from .next_mark import TOLD, NextMark, next_mark, with_marks

# limit: rounds of linearising at most [-]
_METAL_ROUNDS = 10

MARKS = ("permanent_depth_m", "dent_diameter_m", "press_depth_m", "recovered_depth_m")
"""What a blow or a press leaves to be measured."""
RATE = dict(RULES.rate_priors)

_KIND = {"dent_diameter_m": "radius"}  # of the law's errors, where it is not the crater's
_FROZEN = 1e-9  # prior deviation of what the curve itself stands for


@dataclass(frozen=True, eq=False)
class Metal:
    """The flow curve of a body from its marks.

    - `name`, `body`: of the set; key of the body's table.
    - `strength`: as stated [Pa]: the curve's unit.
    - `mean`, `covariance`: (n,) and (n, n) posterior of what the fit moves: logarithm of stress
      over `strength` at 0.2 % (of a hardness: 8 %), exponents at the nodes, the rate law where
      impacts left marks (of the rise ln(1 + rise)), then the nuisances.
    - `map`: (nodes, n) from these to the logarithms at the nodes.
    - `rated`: whether impacts left marks.
    - `pressed`, `struck`: how many numbers came from presses and from impacts.
    - `strain`, `stress`, `error`, `press`: (m,) of every mark: representative strain, the stress
      [Pa] at which it lies on the law, its relative error by the reading alone, and whether it is a
      press's.
    - `next`: the press that would narrow the stresses most; none where nothing would.
    - `notes`: what a reader must know.
    """

    name: str
    body: str
    strength: float
    mean: Array
    covariance: Array
    map: Array
    rated: bool
    pressed: int
    struck: int
    strain: Array
    stress: Array
    error: Array
    press: Mask
    next: NextMark | None
    notes: tuple[str, ...]

    def log_stress(self, strains: Sequence[float] | Array) -> tuple[Array, Array]:
        """Return ln stress [ln Pa], (k,), and its covariance (k, k) at plastic strains."""
        rows = weights(strains) @ self.map
        return math.log(self.strength) + rows @ self.mean, rows @ self.covariance @ rows.T

    def stress_at(self, strain: float) -> tuple[float, float, float]:
        """Return the stress at a plastic strain and its 90 % interval [Pa]."""
        mean, cov = self.log_stress([strain])
        reach = norm.ppf(0.5 + 0.5 * LEVEL) * math.sqrt(cov[0, 0])
        middle, low, high = (float(np.exp(mean[0] + k * reach)) for k in (0.0, -1.0, 1.0))
        return middle, low, high

    def spread_at(self, strain: float) -> float:
        """Standard deviation of ln stress at a plastic strain."""
        return math.sqrt(self.log_stress([strain])[1][0, 0])

    @cached_property
    def rise(self) -> tuple[float, float, float]:
        """Rise of the strength at 1000 1/s over the static one and its interval; nan unrated."""
        if not self.rated:
            return math.nan, math.nan, math.nan
        k = 1 + len(STRAINS)
        reach = norm.ppf(0.5 + 0.5 * LEVEL) * math.sqrt(self.covariance[k, k])
        middle = float(self.mean[k])
        return math.expm1(middle), math.expm1(middle - reach), math.expm1(middle + reach)

    @property
    def covered(self) -> tuple[float, float]:
        """Smallest and largest strain of a mark."""
        return float(self.strain.min()), float(self.strain.max())


@in_one_thread
def metal_of(recordings: RecordingSet) -> Metal:
    """Return the flow curve that a set's marks speak for.

    `recordings`: the set; a flow curve that it states is not used.

    Raises `InputError`: no marks, a metal that does not yield, or marks that say nothing of the
    body that does.
    """
    if not recordings.setup.target.yields:
        raise InputError("a baseline that does not yield", source=recordings.name,
                         key="target.law", allowed="elastic-plastic")  # fmt: skip
    problem = _of_marks(problem_of(replace(recordings, flows={})))
    known = len(problem.cells)
    wider = with_marks(problem, RULES.bench)
    body, stated = _dented(problem)
    table = recordings.setup.bodies[body]
    tested = table.Sy_Pa is None and table.hardness_Pa is not None
    fit = _Fit.of(wider, known, at=TABOR_STRAIN if tested else STRAINS[0])
    mean, covariance, J = fit.posterior()
    strain, back = _marks(wider, fit, mean, J)
    pressed = np.array([problem.conditions[k].press is not None for k in problem.cells.condition])
    best = next_mark(wider, known, weights(TOLD) @ fit.map, covariance, J)
    source = "assumed" if table.strength is None else "of the hardness" if tested else "stated"
    return Metal(
        recordings.name, body, stated, mean, covariance, fit.map, fit.rated, int(pressed.sum()),
        int((~pressed).sum()), strain, stated * np.exp(back[0]), back[1], pressed, best,
        (f"{body}.Sy_Pa, {source}, counts as the stress at "
         f"{100.0 * fit.at:g} % within {100.0 * fit.first:.0f} %",),
    )  # fmt: skip


def _of_marks(problem: Problem) -> Problem:
    kept = np.array([name in MARKS for name in problem.cells.observable])
    if not kept.any():
        raise InputError("no marks", source=problem.name, key="trials.csv",
                         allowed=f"one or more of {', '.join(MARKS)}")  # fmt: skip
    # a press that is proposed leaves a diameter, whatever was read before
    return replace(problem, cells=problem.cells.take(kept), sees_dents=True).with_error()


def _dented(problem: Problem) -> tuple[str, float]:
    """Key of the body that yields first, and its strength as stated [Pa]."""
    pair = problem.scenes(np.zeros(problem.n_z))[0].pair
    if pair.weaker is pair.flat:
        return "target", pair.flat.Sy
    return f"strikers.{problem.conditions[0].striker}", pair.sphere.Sy


def rate_prior(rises: Sequence[Rise]) -> Array:
    """Mean and standard deviation of the rate law's numbers, (2, 2), after curves at several rates.

    The prior of those numbers without such curves is `RATE`.
    """
    prior = np.array(list(RATE.values()))
    if not rises:
        return prior
    of = {p.name: p for p in StrainRateHardening.parameters}
    rise, exponent = (of[name] for name in RATE)
    axes = (
        np.linspace(math.log1p(rise.low), math.log1p(rise.high), 200),
        np.linspace(exponent.low, exponent.high, 200),
    )
    at = np.array(np.meshgrid(*axes, indexing="ij"))
    away = (at - prior[:, 0, None, None]) / prior[:, 1, None, None]
    weight = np.exp(-0.5 * (rises_misfit(rises, np.expm1(at[0]), at[1]) + (away**2).sum(axis=0)))
    mean = (weight * at).sum(axis=(1, 2)) / weight.sum()
    apart = at - mean[:, None, None]
    return np.stack([mean, np.sqrt((weight * apart**2).sum(axis=(1, 2)) / weight.sum())], axis=1)


@dataclass(frozen=True, eq=False)
class _Fit:
    """What is fitted: a problem, of whose cells the first count, and the priors."""

    problem: Problem
    known: int
    prior: Array
    spread: Array
    """(n, n) covariance of the priors."""
    map: Array
    rated: bool
    first: float
    at: float
    """Strain at which the stress is the strength, within `first`."""

    @classmethod
    def of(cls, problem: Problem, known: int, *, at: float = STRAINS[0]) -> _Fit:
        nodes = np.log(STRAINS)
        n = len(nodes)
        body = f"{_dented(problem)[0]}.Sy_Pa"
        own = [m.spread for m in problem.nuisances if m.name == body]
        first = own[0] if own else SPECIMENS
        seen = {problem.cells.condition[i] for i in range(known)}
        rated = any(problem.conditions[k].press is None for k in seen)
        rate = rate_prior(problem.conditions[0].around.rises) if rated else np.zeros((0, 2))
        prior = np.concatenate(
            [[0.0], np.full(n, RULES.exponent), rate[:, 0], np.zeros(problem.n_z)]
        )
        alike = np.exp(-0.5 * ((nodes[:, None] - nodes[None, :]) / RULES.exponent_length) ** 2)
        sheet = [_FROZEN if m.name == body else 1.0 for m in problem.nuisances]
        spread = np.diag(np.concatenate([
            [first**2], np.zeros(n), rate[:, 1] ** 2, np.square(sheet),
            np.ones(problem.error.count),
        ]))  # fmt: skip
        spread[1 : n + 1, 1 : n + 1] = RULES.exponent_spread**2 * alike
        # the logarithm of stress is the integral of its exponent
        step = 0.5 * np.diff(nodes)
        integral = np.zeros((n, n))
        for k in range(1, n):
            integral[k] = integral[k - 1]
            integral[k, k - 1] += step[k - 1]
            integral[k, k] += step[k - 1]
        integral -= weights([at]) @ integral
        mapped = np.hstack([np.ones((n, 1)), integral, np.zeros((n, len(prior) - 1 - n))])
        return cls(problem, known, prior, spread, mapped, rated, first, at)

    @property
    def mechanisms(self) -> tuple[Mechanism, ...]:
        """The curve, and the rate where impacts left marks."""
        curve = FlowCurveOfMarks()
        return (curve, StrainRateHardening()) if self.rated else (curve,)

    def constants(self, u: Array) -> Constants:
        """Return the numbers of the mechanisms at the unknowns (n,)."""
        found = {FlowCurveOfMarks.name: curve_values(self.map @ u)}
        if self.rated:
            at = 1 + len(STRAINS)
            log_rise, *others = u[at : at + len(RATE)].tolist()
            found[StrainRateHardening.name] = dict(
                zip(RATE, (math.expm1(log_rise), *others), strict=True)
            )
        return found

    def point(self, u: Array, *, faster: float = 0.0) -> Point:
        """Return where to predict."""
        return Point(u[len(u) - self.problem.n_z :], self.constants(u), faster=faster)

    def linear(self, u: Array) -> tuple[Array, Array, Array]:
        """Return predictions (m,), derivatives (m, n) and noise (m, m) at the unknowns."""
        size = RULES.metal_step * np.sqrt(np.diag(self.spread))
        moved = u + np.diag(size)
        points = [self.point(u), self.point(u, faster=RULES.setting_step), *map(self.point, moved)]
        found = Simulator(self.problem).predict(self.mechanisms, points)
        J = ((found[2:] - found[0]) / size[:, None]).T
        by_drive = (found[1] - found[0]) / RULES.setting_step
        noise = measured_covariance(self.problem, by_drive, np.zeros_like(by_drive))
        if self.rated:
            static = Simulator(self.problem).predict(self.mechanisms[:1], points[:1])[0]
            noise = noise + self._of_impacts(found[0] - static)
        return found[0], J, noise

    def _of_impacts(self, effect: Array) -> Array:
        """Errors of impacts alone, (m, m): of the rate's form, and of a dent beside a press's.

        By how much a rate moves a mark, laws of a rate do not agree. And what a press carries at a
        depth says what an impact spends up to it only as well as the law's crater is known.
        """
        cells, conditions = self.problem.cells, self.problem.conditions
        struck = np.array([conditions[k].press is None for k in cells.condition])
        form = form_error(self.problem, effect, RULES.rate_form)
        if struck[: self.known].all():
            return form @ form.T
        size = [METAL[_KIND.get(name, "crater")] for name in cells.observable]
        beside = form_error(self.problem, np.where(struck, size, 0.0), 1.0)
        return np.asarray(form @ form.T + beside @ beside.T)

    def posterior(self) -> tuple[Array, Array, Array]:
        """Return mean (n,), covariance (n, n) and derivatives (m, n) of all cells."""
        u, k = self.prior.copy(), self.known
        sd = np.sqrt(np.diag(self.spread))
        far = math.inf
        for _ in range(_METAL_ROUNDS):
            if far > RULES.metal_near:
                here, J, noise = self.linear(u)
                self._check_moved(J[:k])
            else:
                here = Simulator(self.problem).predict(self.mechanisms, [self.point(u)])[0]
            r = self.problem.cells.value[:k] - here[:k] + J[:k] @ (u - self.prior)
            found = [_update(self.sized(s), J[:k], noise[:k, :k], r) for s in SIZES.factors]
            said = np.array([f[2] for f in found]) + np.log(SIZES.weights)
            share = np.exp(said - logsumexp(said))
            step = sum(w * f[0] for w, f in zip(share, found, strict=True)) + self.prior - u
            far = float(np.max(np.abs(step) / sd))
            u = u + step * min(1.0, RULES.metal_farthest / far)
            if far < RULES.metal_settled:
                break
        middle = u - self.prior
        cov = sum(
            w * (f[1] + np.outer(f[0] - middle, f[0] - middle))
            for w, f in zip(share, found, strict=True)
        )
        return u, np.asarray(cov), J

    def _check_moved(self, J: Array) -> None:
        if not J[:, : 1 + len(STRAINS)].any():
            body, _ = _dented(self.problem)
            raise InputError(
                f"by the stated strengths {body} yields first, and no mark depends on its strength",
                source=self.problem.name, key=f"{body}.Sy_Pa",
                allowed="strengths by which the body with the marks yields",
            )  # fmt: skip

    def sized(self, factor: float) -> Array:
        """Return the priors' covariance with the law's error of another size."""
        scale = np.ones(len(self.prior))
        scale[len(scale) - self.problem.error.count :] = factor
        return self.spread * np.outer(scale, scale)


def _update(spread: Array, J: Array, noise: Array, r: Array) -> tuple[Array, Array, float]:
    """Posterior mean less the prior's, its covariance, and ln evidence."""
    total = J @ spread @ J.T + noise
    gain = np.linalg.solve(total, J @ spread).T
    log_det = float(np.linalg.slogdet(total)[1])
    evidence = -0.5 * (float(r @ np.linalg.solve(total, r)) + log_det)
    return gain @ r, spread - gain @ J @ spread, evidence


def _marks(problem: Problem, fit: _Fit, u: Array, J: Array) -> tuple[Array, tuple[Array, Array]]:
    """Strain of every mark, and ln stress (over the stated) where it lies, with its own error."""
    point = fit.point(u)
    scenes = [
        attached(fit.mechanisms[:1], scene, point.values, c.around)
        for scene, c in zip(problem.scenes(point.z), problem.conditions, strict=True)
    ]
    simulator = Simulator(problem)
    peak = simulator.observe(fit.mechanisms, [point])["peak_depth_m"][0]
    R = np.array([s.pair.R for s in scenes])
    strain = REPRESENTATIVE * np.minimum(dent_radius(scenes, peak) / R, 1.0)
    cells, k = problem.cells, fit.known
    here = strain[cells.condition[:k]]
    at = weights(here) @ fit.map @ u
    # by a change of the whole curve: the first unknown moves all of it
    slope = J[:k, 0]
    residual = cells.value[:k] - simulator.predict(fit.mechanisms, [point])[0][:k]
    return here, (at + residual / slope, cells.std[:k] / np.abs(slope))
