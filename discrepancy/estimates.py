"""Numbers of a verdict: parameters, pulls, limits, scores, notes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.stats import norm

from ..core.arrays import Array
from ..recordings import RecordingSet, Severity, audit
from .choice.odds import Priors
from .comparison.forward import Simulator
from .comparison.problem import Problem
from .correction import LEVEL
from .heldout import HeldOut
from .inference.fit import Fit
from .inference.grid import interval
from .rank import Ranking
from .rules import RULES
from .unknowns.wrong_number import is_wrong

# limit: deviations of a stated number that a verdict tells [-]; one in twenty
PULLED = 2.0


def audit_rows(recordings: RecordingSet) -> tuple[dict[str, Any], ...]:
    """Contradictions and cautions, the contradictions first."""
    found = audit(recordings)
    rows = (*found.of(Severity.CONTRADICTION), *found.of(Severity.CAUTION))
    return tuple(
        {
            "check": f.check, "value": finite(float(f.value)),
            "expected": finite(float(f.expected)),
            "message": f"{f.severity.value}: {f.check}: {f.message}",
        }
        for f in rows
    )  # fmt: skip


def finite(x: float) -> float | None:
    """Return a number as JSON holds it: null where there is none."""
    return x if math.isfinite(x) else None


def scores_of(ranking: Ranking, left_out: Mapping[str, HeldOut]) -> dict[str, dict[str, float]]:
    """Return evidence over the baseline, held-out miss, p of fit and chi2 of every explanation.

    `left_out`: for each fit by name, how it predicts left-out conditions.
    """
    base = ranking.base.log_evidence
    return {
        f.name: {
            "evidence": f.log_evidence - base,
            "held_out": left_out[f.name].rms,
            "p_value": f.p_value,
            "chi2": f.chi2,
        }
        for f in ranking.fits
    }


def parameters_of(
    simulator: Simulator, fitted: Fit, level: float = LEVEL
) -> dict[str, dict[str, Any]]:
    """Return value and interval of every parameter, the nuisances included.

    A mechanism's intervals hold what the textbook's form may be off: its likelihood does.
    """
    problem, grid = simulator.problem, fitted.grid
    found: dict[str, dict[str, Any]] = {}
    for axis, (label, (_, p)) in enumerate(zip(grid.labels, grid.axes, strict=True)):
        middle, low, high = interval(*grid.marginal(fitted.weight, axis), level)
        found[label] = {
            "value": float(p.value(middle)), "low": float(p.value(low)),
            "high": float(p.value(high)), "level": level, "unit": p.unit,
        }  # fmt: skip
    spread = norm.ppf(0.5 + 0.5 * level) * np.sqrt(np.maximum(np.diag(fitted.covariance), 0.0))
    for i, n in enumerate(problem.nuisances):
        z = float(fitted.z[i])
        found[n.name] = {
            "value": n.at(z), "low": n.at(z - spread[i]), "high": n.at(z + spread[i]),
            "level": level, "unit": n.unit,
        }  # fmt: skip
    return found


def surprises_of(problem: Problem, fitted: Fit) -> dict[str, float]:
    """Shift of every stated number over what chance would give it.

    The pull over sqrt(1 - its posterior variance): unit normal when the sheet is right, however
    much of a shift other unknowns could take up.
    """
    learnt = np.sqrt(np.maximum(1.0 - np.diag(fitted.covariance), 0.01))
    return {n.name: float(fitted.z[i] / learnt[i]) for i, n in enumerate(problem.nuisances)}


def notes_of(problem: Problem, best: Fit) -> tuple[str, ...]:
    """Return what a reader must know: doubted numbers, the law's error, what was assumed."""
    notes = []
    surprises = surprises_of(problem, best)
    for i, n in enumerate(problem.nuisances):
        z, surprise = float(best.z[i]), abs(surprises[n.name])
        if surprise > PULLED:
            chance = "" if abs(z) > PULLED else f", {surprise:.1f} times what chance would move it"
            wanted = f"{n.at(z):.4g} {n.unit}".removesuffix(" -")
            notes.append(
                f"{n.name} wants to be {wanted}, {'above' if z > 0 else 'below'} the "
                f"stated {n.value:.4g}: a pull of {abs(z):.1f} stated standard deviations{chance}"
            )
    return (*notes, *problem.notes)


def misfit_of(problem: Problem, base: Fit, stated: Array) -> dict[str, float]:
    """Return the baseline's misfit before anything may move, and which part took how much of it.

    `problem`, `base`: what was compared, and the fit of the baseline; `stated`: (m,) predictions of
    the cells with every input as stated.

    With r the residual as stated, s_k what part k moves of it at the posterior mean and N the
    noise, a part took s_k^T N^-1 r / r^T N^-1 r; what no part took is `rest`. The law's error is
    shared between the finite elements and the metal by their variances.
    """
    r, J, k = problem.cells.value - stated, base.linear.J, problem.n_nuisances
    by_noise = np.linalg.solve(base.linear.noise, r)
    whole = max(float(r @ by_noise), 1e-12)
    sheet = float(J[:, :k] @ base.z[:k] @ by_noise) / whole
    found = {"law": 0.0, "metal": 0.0}
    for kind, (law, metal) in problem.error.parts.items():
        rows = problem.error.rows[kind]
        b = slice(k + rows.start, k + rows.stop)
        took = float(J[:, b] @ base.z[b] @ by_noise) / whole
        part = law**2 / max(law**2 + metal**2, 1e-30)
        found["law"] += part * took
        found["metal"] += (1.0 - part) * took
    rest = 1.0 - sheet - found["law"] - found["metal"]
    return {
        "as_stated": whole, "numbers": float(len(r)), "sheet": sheet, **found, "rest": rest,
        "error_size": float(base.linear.prior[-1]),
    }  # fmt: skip


def law_notes(problem: Problem, misfit: Mapping[str, float]) -> tuple[str, ...]:
    """Return how unsure the law is taken to be, by part, and how much of the misfit each took."""
    sizes = "; ".join(
        f"{kind} {100 * law:.2g} % from finite elements, {100 * metal:.2g} % from a metal"
        for kind, (law, metal) in problem.error.parts.items()
    )
    took = ", ".join(
        # what goes into one of them may come out of another
        f"{words} {100 * max(misfit[key], 0.0):.0f} %"
        for key, words in (
            ("sheet", "errors of the data sheet would explain"), ("metal", "a real metal"),
            ("law", "finite elements of the pair"), ("rest", "none of these"),
        )
    )  # fmt: skip
    return (
        f"how far the contact law '{problem.law_name}' may be off: {sizes}; the recordings fit "
        f"best with {misfit['error_size']:.2g} times these errors",
        f"with every input as stated the misfit is chi2 = {misfit['as_stated']:.0f} "
        f"({misfit['numbers']:.0f} numbers); of it {took}",
    )


def limits_of(ranking: Ranking) -> dict[str, float]:
    """Smallest value of each first parameter whose effect would have been named."""
    base = ranking.base
    found = {}
    priors = Priors.of(ranking)
    for s in (s for s in ranking.screened if not is_wrong(s.mechanism)):
        prior = priors.log(()) - priors.log((s.mechanism.name,))
        nats = max(prior, 0.0) / RULES.temper
        # three nats are what not knowing the parameters costs
        needed = math.sqrt(2.0 * (nats + 3.0))
        p = s.grid.axes[0].parameter
        size = np.linalg.norm(base.linear.white(s.effect), axis=1)
        n = len(s.grid.fine[0])
        # over the other parameters the typical size
        along = np.median(size.reshape(n, -1), axis=1)
        values = p.value((np.flatnonzero(along > needed) + 0.5) / n)
        if values.size:
            # nearest to doing nothing: the stiffest where that is to be rigid
            nearest = -values if math.isinf(p.neutral) else np.abs(values - p.neutral)
            found[s.mechanism.name] = float(values[np.argmin(nearest)])
    return found


def improvement_of(base: HeldOut, chosen: HeldOut) -> dict[str, float]:
    """Return how well left-out conditions are predicted by the baseline and by the best."""
    rms = {"baseline": base.rms, "extended": chosen.rms}
    return {
        # two names of one number: the second is that of before 0.4
        **{f"held_out_{k}": x for k, x in rms.items()}, **{f"raw_{k}": x for k, x in rms.items()},
        "log_density_baseline": base.log_density, "log_density_extended": chosen.log_density,
        "trials": base.trials,
    }  # fmt: skip
