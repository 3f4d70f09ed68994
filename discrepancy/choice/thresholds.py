"""What the comparison answers when nothing is missing: thresholds for one rig, by simulation.

The null generators give, for this rig's own conditions, noise and nuisances, discrepancies of laws
that the baseline does not know. Each is put through the same algebra as the data, with the stored
derivatives and responses of the data's own fits. With them an explanation makes data sets of its
own, beside which its fit to the data is judged.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import gamma

from ...core.arrays import Array
from ...core.material import Pair
from ...dynamics import Scene
from ...dynamics.mechanisms.arithmetic import deepest
from ...dynamics.strength import strength_table
from ..comparison.cells import compared
from ..comparison.forward import Point, Simulator
from ..comparison.problem import Problem
from ..inference.fit import Fit
from ..nulls.ensemble import NullRig, discrepancies, scatter
from ..nulls.laws import NullReference
from ..nulls.motion import NullBodies
from ..rules import RULES
from ..unknowns.lawerror import not_given_back

# limit: places of a grid that stand for all [-]; memory
_THINNED = 400

_LEAST_LOG_P = -700.0  # what a float holds


@dataclass(frozen=True, eq=False)
class Nulls:
    """Null residuals of one rig.

    - `law`: (n, m) discrepancy of null laws from the baseline, without noise.
    - `scatter`, `unknown`: (n, m) and (n, nuisances) unit draws of noise and nuisances.
    - `form`: (n, m) unit normal draws of the error of a mechanism's form.
    """

    law: Array
    scatter: Array
    unknown: Array
    form: Array

    def made_by(self, fitted: Fit) -> Array:
        """Residuals at the prior mean of sets that an explanation makes, (n, m).

        What noise of the approach and nuisances do follows the explanation's own derivatives.
        """
        linear = fitted.linear
        noise = self.scatter @ np.linalg.cholesky(linear.noise).T
        found = self.law + noise + self.unknown @ linear.J[:, : self.unknown.shape[1]].T
        return found + self.form[:, : linear.form.shape[1]] @ linear.form.T


def null_residuals(simulator: Simulator, base: Fit, count: int, rng: np.random.Generator) -> Nulls:
    """Draw residuals that a complete baseline would leave in this rig.

    `base`: fit of the baseline: where the null laws are levelled; `count`: of null laws.
    """
    problem = simulator.problem
    z = base.z.copy()
    z[problem.n_nuisances :] = 0.0
    # null laws strike fresh metal; what they differ by there stands for later blows as well
    fresh = tuple(replace(c, after=-1) for c in problem.conditions)
    plain = Simulator(replace(problem, conditions=fresh, assumed=()))
    here = plain.predict((), [Point(z)])[0]
    sizes = problem.error.sizes
    spread: dict[str, float] = {}
    for kind in ("force", "recovery", "crater", "radius"):
        known = sizes.get(kind, 0.0)
        spread |= {
            kind: RULES.null_level * known,
            f"{kind} slope": RULES.null_slope * known,
            f"{kind} shape": known,
        }
    spread["size"] = RULES.size_spread
    seen = discrepancies(rig_of(problem, z), count, rng, spread)
    seen |= problem.own_motion(seen, z, problem.scenes(z))
    cells = problem.cells
    law = np.empty((count, len(cells)))
    for j, name in enumerate(cells.observable):
        read = problem.scale(name, z) * seen[name][:, cells.condition[j]]
        law[:, j] = compared(name, read)
    law -= here
    # what a condition's scatter of speed and angle does is shared by its observables
    unit = scatter(rng, law.shape)
    unknown = rng.standard_normal((count, problem.n_nuisances))
    form = rng.standard_normal((count, len(cells)))
    return Nulls(law, unit, unknown, form)


def rig_of(problem: Problem, z: Array) -> NullRig:
    """Return the rig at the unknowns z, as plain numbers for the null generators."""
    scenes = problem.scenes(z)
    keys, depth = [_contact(s.pair) for s in scenes], [deepest(s) for s in scenes]
    known: dict[tuple[float, ...], NullReference] = {}
    for key, scene in zip(keys, scenes, strict=True):
        if key not in known:
            own = [d for k, d in zip(keys, depth, strict=True) if k == key]
            known[key] = _reference(scene, 0.5 * min(own), 1.5 * max(own))
    rows = []
    for s, key in zip(scenes, keys, strict=True):
        a, body = s.approach, s.striker
        beside, above = body.arm(a.angle)
        rows.append((
            body.mass, body.inertia, 0.0 if abs(a.angle - math.pi / 2.0) < 1e-9 else beside, above,
            body.tip_radius, a.speed, a.tangential, a.spin, s.friction.mu, known[key].given_back,
            s.instrument.scan_height,
        ))  # fmt: skip
    loads = np.array([s.press.load if s.press else math.nan for s in scenes])
    bodies = NullBodies(*np.array(rows).T.copy())
    return NullRig(bodies, [known[k] for k in keys], loads)


def _contact(pair: Pair) -> tuple[float, ...]:
    """What scenes of one contact have in common."""
    numbers = (pair.R, pair.E_reduced, pair.Sy_min, pair.Sy_ratio, pair.elastic_share)
    # a pair without yield has no ratio of strengths
    return tuple(-1.0 if math.isnan(x) else x for x in numbers)


def _reference(scene: Scene, low: float, high: float) -> NullReference:
    pair, law = scene.pair, scene.law
    table = strength_table(law, pair)
    _, flat = law.residual(pair, table.depth)
    # a baseline that does not yield is compared with laws that do not yield
    strength = math.inf if law.name == "hertz" else pair.Sy_min
    return NullReference(
        pair.R, pair.E_reduced, strength, table.depth, np.exp(table.stated.force),
        np.exp(table.stated.recovery), flat, table.radius, not_given_back(scene),
        scene.force.given_back, low, high,
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class FitTest:
    """How an explanation's own sets fit it, beside the data.

    `p_value`: share of them that fit no better than the data do; `log_odds`: ln Bayes factor of
    something that acts beside it, whatever that is.
    """

    p_value: float
    log_odds: float


def fit_test(fitted: Fit, nulls: Nulls) -> FitTest:
    """Compare the fit of an explanation with its fits to data sets that it makes itself.

    A set is the explanation's prediction with the null residuals; the mechanism's parameters are
    fitted to each. Beyond the last of the sets their chi2, a sum of squares, is taken for a gamma
    variable of the same mean and variance (F. Satterthwaite, Biometrics Bull. 2 (1946) 110).
    """
    residual = nulls.made_by(fitted)
    if fitted.mechanisms:
        effects = fitted.residual - fitted.residuals
        effects = effects[:: max(len(effects) // _THINNED, 1)]
        e = fitted.linear.white(effects)
        ratio = 2.0 * fitted.linear.white(residual) @ e.T - np.sum(e**2, axis=1)
        best = np.argmax(ratio, axis=1)
        moved = ratio[np.arange(len(best)), best] > 0.0
        residual = np.where(moved[:, None], residual - effects[best], residual)
    chi2 = np.sum(fitted.linear.white(residual) ** 2, axis=1)
    p = (int(np.sum(chi2 >= fitted.chi2)) + 1) / (len(chi2) + 1)
    mean, variance = float(np.mean(chi2)), float(np.var(chi2))
    if not variance > 0.0:
        return FitTest(p, 0.0)
    log_p = float(gamma.logsf(fitted.chi2, mean**2 / variance, scale=variance / mean))
    return FitTest(p, _something_else(max(log_p, _LEAST_LOG_P)))


def _something_else(log_p: float) -> float:
    """Ln Bayes factor of p values that crowd at 0 as xi p^(xi - 1), xi even in (0, 1).

    T. Sellke, M. J. Bayarri, J. O. Berger, Am. Stat. 55 (2001) 62, for the family.
    """
    if log_p > -1e-3:
        return -math.log(2.0)
    return math.log(math.exp(log_p) * (log_p - 1.0) + 1.0) - log_p - 2.0 * math.log(-log_p)
