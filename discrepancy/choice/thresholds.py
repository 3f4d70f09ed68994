"""What the comparison answers when nothing is missing: thresholds for one rig, by simulation.

The null generators give, for this rig's own conditions, noise and nuisances, discrepancies of laws
that the baseline does not know. Each is put through the same algebra as the data, with the stored
derivatives and responses of the data's own fits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import Array
from ...dynamics import Scene
from ...dynamics.mechanisms.arithmetic import deepest
from ...dynamics.strength import strength_table
from ..comparison.cells import compared
from ..comparison.forward import Point, Simulator
from ..comparison.problem import Problem
from ..inference.fit import Fit
from ..nulls import NullRig, discrepancies, scatter
from ..nulls.laws import NullReference
from ..nulls.motion import NullBodies
from ..rules import RULES
from ..unknowns.lawerror import SIZE_SPREAD, not_given_back


@dataclass(frozen=True, eq=False)
class Nulls:
    """Null residuals of one rig.

    Parameters
    ----------
    law
        (n, m) discrepancy of null laws from the baseline, without noise.
    scatter, unknown
        (n, m) and (n, nuisances) unit draws of noise and nuisances.
    form
        (n, m) unit normal draws of the error of a mechanism's form.
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
        form = linear.form
        return found + self.form[:, : form.shape[1]] @ form.T if form.size else found


def null_residuals(simulator: Simulator, base: Fit, count: int, rng: np.random.Generator) -> Nulls:
    """Draw residuals that a complete baseline would leave in this rig.

    Parameters
    ----------
    simulator
        The problem.
    base
        Fit of the baseline: where the null laws are levelled.
    count
        Number of null laws.
    rng
        Source of the draws.
    """
    problem = simulator.problem
    z = base.z.copy()
    z[problem.n_nuisances :] = 0.0
    # null laws strike fresh metal; what they differ by there stands for later blows as well
    here = Simulator(replace(problem.fresh, assumed=())).predict((), [Point(z)])[0]
    sizes = problem.error.sizes
    spread: dict[str, float] = {}
    for kind in ("force", "recovery", "crater", "radius"):
        known = sizes.get(kind, 0.0)
        spread |= {
            kind: RULES.null_level * known,
            f"{kind} slope": RULES.null_slope * known,
            f"{kind} shape": known,
        }
    spread["size"] = SIZE_SPREAD
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
    known: dict[tuple[float, ...], NullReference] = {}
    plain = [_reference(scene, known) for scene in scenes]
    depth = [deepest(s) for s in scenes]
    ranged = {}
    for one in known.values():
        own = [d for r, d in zip(plain, depth, strict=True) if r is one]
        ranged[id(one)] = replace(one, low=0.5 * min(own), high=1.5 * max(own))
    references = [ranged[id(r)] for r in plain]
    arms = [s.striker.arm(s.approach.angle) for s in scenes]
    upright = [abs(s.approach.angle - math.pi / 2.0) < 1e-9 for s in scenes]
    bodies = NullBodies(
        np.array([s.striker.mass for s in scenes]),
        np.array([s.striker.inertia for s in scenes]),
        np.array([0.0 if up else a[0] for a, up in zip(arms, upright, strict=True)]),
        np.array([a[1] for a in arms]),
        np.array([s.striker.tip_radius for s in scenes]),
        np.array([s.approach.speed for s in scenes]),
        np.array([s.approach.tangential for s in scenes]),
        np.array([s.approach.spin for s in scenes]),
        np.array([s.friction.mu for s in scenes]),
        np.array([r.given_back for r in references]),
        np.array([s.instrument.scan_height for s in scenes]),
    )
    loads = np.array([s.press.load if s.press else math.nan for s in scenes])
    return NullRig(bodies, references, loads)


def _reference(scene: Scene, known: dict[tuple[float, ...], NullReference]) -> NullReference:
    pair, law = scene.pair, scene.law
    key: tuple[float, ...] = (
        pair.R,
        pair.E_reduced,
        pair.Sy_min,
        pair.Sy_ratio,
        pair.elastic_share,
    )
    # a pair without yield has no ratio of strengths
    key = tuple(-1.0 if math.isnan(x) else x for x in key)
    if key not in known:
        table = strength_table(law, pair)
        depth = table.depth
        _, flat = law.residual(pair, depth)
        # a baseline that does not yield is compared with laws that do not yield
        strength = math.inf if law.name == "hertz" else pair.Sy_min
        known[key] = NullReference(
            pair.R, pair.E_reduced, strength, depth, np.exp(table.stated.force),
            np.exp(table.stated.recovery), flat, table.radius, scene.force.given_back,
            not_given_back(scene),
        )  # fmt: skip
    return known[key]
