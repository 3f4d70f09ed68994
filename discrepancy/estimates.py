"""Numbers of a verdict: parameters, pulls, limits, scores, notes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..recordings import RecordingSet, Severity, audit
from .calibration import Calibration
from .forward import Point, Simulator
from .heldout import HeldOut
from .inference.fit import Fit
from .inference.grid import interval
from .problem import Problem
from .rank import Ranking

Array = NDArray[np.float64]

_PULLED = 2.0


def audit_rows(recordings: RecordingSet) -> tuple[dict[str, Any], ...]:
    """Contradictions and cautions, the contradictions first."""
    found = audit(recordings)
    rows = (*found.of(Severity.CONTRADICTION), *found.of(Severity.CAUTION))
    return tuple(
        {
            "check": f.check, "value": _finite(f.value), "expected": _finite(f.expected),
            "message": f"{f.severity.value}: {f.check}: {f.message}",
        }
        for f in rows
    )  # fmt: skip


def _finite(x: float) -> float | None:
    return float(x) if math.isfinite(x) else None


def scores_of(
    ranking: Ranking,
    p: Mapping[str, float],
    left_out: Mapping[str, HeldOut],
    sampled: Mapping[str, float],
) -> dict[str, dict[str, float]]:
    """Return evidence over the baseline, held-out miss and p of fit of every explanation.

    Parameters
    ----------
    ranking
        All fits.
    p, left_out
        For each fit by name, how it passes the test of fit and predicts left-out conditions.
    sampled
        Sampled ln evidence over the baseline, of those that were sampled.
    """
    base = ranking.base.log_evidence
    return {
        f.name: {
            "evidence": sampled.get(f.name, f.log_evidence - base),
            "held_out": left_out[f.name].score,
            "p_value": p[f.name],
        }
        for f in ranking.fits
    }


def parameters_of(
    simulator: Simulator, fitted: Fit, level: float = 0.90
) -> dict[str, dict[str, Any]]:
    """Return value and interval of every parameter, the nuisances included.

    A mechanism's intervals hold what the textbook's form may be off in the size of its effect: the
    likelihood leaves that to the parameters.
    """
    problem = simulator.problem
    found: dict[str, dict[str, Any]] = {}
    if fitted.mechanisms:
        places = fitted.grid.places()
        off = 1.645 * _moved_by_form(simulator, fitted)
        for axis, (label, (_, p)) in enumerate(
            zip(fitted.grid.labels, fitted.grid.axes, strict=True)
        ):
            middle, low, high = interval(places[:, axis], fitted.weight, level)
            low = max(middle - math.hypot(middle - low, off[axis]), 0.0)
            high = min(middle + math.hypot(high - middle, off[axis]), 1.0)
            found[label] = {
                "value": float(p.value(middle)), "low": float(p.value(low)),
                "high": float(p.value(high)), "level": level, "unit": p.unit,
            }  # fmt: skip
    spread = 1.645 * np.sqrt(np.maximum(np.diag(fitted.covariance), 0.0))
    for i, n in enumerate(problem.nuisances):
        z = float(fitted.z[i])
        found[n.name] = {
            "value": n.at(z), "low": n.at(z - spread[i]), "high": n.at(z + spread[i]),
            "level": level, "unit": n.unit,
        }  # fmt: skip
    return found


def _moved_by_form(simulator: Simulator, fitted: Fit) -> Array:
    """By how much of their ranges the parameters would move, (axes,), if the form's size is off.

    To first order the posterior mean follows a change d of the data by its covariance with
    d^T Sigma^-1 times the prediction; d is the form's share of the effect.
    """
    without = simulator.predict((), [Point(fitted.z)])[0]
    share = max(m.form for m in fitted.mechanisms)
    change = fitted.linear.white(share * (fitted.prediction - without))
    along = -fitted.linear.white(fitted.residuals) @ change
    places = fitted.grid.places()
    away = places - fitted.weight @ places
    return np.abs((fitted.weight * (along - fitted.weight @ along)) @ away)


def pulls_of(problem: Problem, fitted: Fit) -> dict[str, float]:
    """Shift of every stated number in its own stated standard deviations."""
    return {n.name: float(fitted.z[i]) for i, n in enumerate(problem.nuisances)}


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
        if surprise > _PULLED:
            chance = "" if abs(z) > _PULLED else f", {surprise:.1f} times what chance would move it"
            notes.append(
                f"{n.name} wants to be {n.at(z):.4g} {n.unit}, {'above' if z > 0 else 'below'} the "
                f"stated {n.value:.4g}: a pull of {abs(z):.1f} stated standard deviations{chance}"
            )
    sizes = ", ".join(f"{k} {100 * v:.2g} %" for k, v in problem.error.sizes.items())
    notes.append(f"the contact law '{problem.law.name}' is taken to be uncertain by: {sizes}")
    return (*notes, *problem.notes)


def limits_of(ranking: Ranking, calibration: Calibration) -> dict[str, float]:
    """Smallest value of each first parameter whose effect would have been seen."""
    base = ranking.base
    found = {}
    for s in ranking.screened:
        seen_at = calibration.single + calibration.offset.get(s.mechanism.name, 0.0)
        needed = math.sqrt(2.0 * (max(seen_at, 1.0) + 3.0))
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


def improvement_of(base: HeldOut, best: HeldOut) -> dict[str, float]:
    """Return how well left-out conditions are predicted, before and after."""
    return {
        "held_out_baseline": base.score, "held_out_extended": best.score,
        "raw_baseline": base.raw, "raw_extended": best.raw, "trials": base.trials,
    }  # fmt: skip
