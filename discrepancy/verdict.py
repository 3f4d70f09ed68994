"""The main path: a recording set in, a verdict out.

audit -> calibrate the nuisances -> locate the mismatch -> rank the explanations -> decide ->
held-out conditions -> next experiment. `Verdict.to_dict` gives verdict.json, version 1.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from .. import __version__
from ..recordings import RecordingSet, Severity, audit
from .calibration import Calibration, calibrate, extra_threshold, p_fit, set_width
from .correction import Correction, correct, widened
from .drift import Drift
from .evidence import interval
from .fit import Fit
from .forward import Point, Simulator
from .heldout import HeldOut, held_out
from .locate import Located, locate
from .next_experiment import Proposal, propose
from .problem import LOGARITHMIC, Problem, problem_of
from .rank import Progress, Ranking, rank, with_pairs
from .thresholds import Nulls, null_residuals

Array = NDArray[np.float64]

NULLS = 500
"""Null data sets that set the thresholds of a screening."""
CONFIRMED_NULLS = 2000
"""Null data sets with `confirm`."""
P_FIT = 0.01
"""An explanation that fits worse than this share of its own data sets is rejected."""
MOST = 3
"""Explanations that are reported as indistinguishable; with more the verdict is undetermined."""
_FEWEST = 6
_PULLED = 2.0
OUTSIDE = "outside-library"
_RATHER_OUTSIDE = 0.5
"""Probability of something outside the library above which no explanation is named."""
INEXACT = 0.15
"""Part of the baseline's misfit, as an amplitude, that an explanation may leave: by so much of its
effect does the textbook form of a mechanism differ from other published forms."""


@dataclass(frozen=True, eq=False)
class Verdict:
    """What a diagnosis says; the fields are those of verdict.json, and what the report draws.

    Parameters
    ----------
    verdict
        `adequate`, `missing-physics`, `indistinguishable`, `outside-library`, `undetermined`.
    mechanisms
        Names of the best explanation's mechanisms.
    alternatives
        Other explanations that the data cannot tell from the best.
    best
        Its fit; the baseline's when none is named.
    """

    name: str
    seed: int
    verdict: str
    mechanisms: tuple[str, ...]
    alternatives: tuple[tuple[str, ...], ...]
    audit: tuple[dict[str, Any], ...]
    probabilities: dict[str, float]
    scores: dict[str, dict[str, float]]
    located: Located
    parameters: dict[str, dict[str, Any]]
    nuisance_pulls: dict[str, float]
    excluded: dict[str, str]
    limits: dict[str, float]
    improvement: dict[str, float]
    corrections: tuple[Correction, ...]
    proposals: tuple[Proposal, ...]
    notes: tuple[str, ...]
    problem: Problem
    ranking: Ranking
    best: Fit
    calibration: Calibration
    reasons: tuple[str, ...] = ()
    impacts: int = 0
    confirmed: dict[str, float] = field(default_factory=dict)

    def to_dict(self) -> dict[str, Any]:
        """Return the content of verdict.json."""
        return {
            "format": "verdict/1",
            "set": self.name,
            "seed": self.seed,
            "version": __version__,
            "audit": list(self.audit),
            "verdict": self.verdict,
            "mechanisms": list(self.mechanisms),
            "alternatives": [list(names) for names in self.alternatives],
            "probabilities": self.probabilities,
            "scores": self.scores,
            "located": [
                {
                    "observable": m.observable, "phase": m.phase, "covariate": m.covariate,
                    "trend": m.trend, "z": round(m.z, 3),
                }
                for m in self.located.misses
            ],
            "parameters": self.parameters,
            "nuisance_pulls": self.nuisance_pulls,
            "excluded": [{"mechanism": k, "reason": v} for k, v in self.excluded.items()],
            "limits": self.limits,
            "improvement": self.improvement,
            "correction": [
                {
                    "phase": c.phase, "indentation_over_R": c.depth_over_R.tolist(),
                    "factor": c.factor.tolist(), "low": c.low.tolist(), "high": c.high.tolist(),
                }
                for c in self.corrections
            ],
            "next_experiment": {
                "change": self.proposals[0].change if self.proposals else "",
                "expected_discrimination": (
                    self.proposals[0].expected_discrimination if self.proposals else 0.0
                ),
            },
            "notes": [*self.reasons, *self.notes],
        }  # fmt: skip


def diagnose(
    recordings: RecordingSet,
    *,
    seed: int = 0,
    confirm: bool = False,
    progress: Progress = lambda _: None,
) -> Verdict:
    """Say what physics is missing in the simulation of a recording set.

    Parameters
    ----------
    recordings
        From `recordings.read`.
    seed
        Of every draw; the same seed gives the same verdict.
    confirm
        Also sample the leading explanations' evidence and use the full null ensemble.
    progress
        Called with a line before each step.

    Raises
    ------
    InputError
        The set holds nothing that can be compared.
    """
    rng = np.random.default_rng(seed)
    progress("auditing the inputs")
    findings = _audit(recordings)
    problem = problem_of(recordings)
    simulator = Simulator(problem)
    ranking = rank(simulator, progress=progress)
    problem = simulator.problem
    progress("simulating sets in which nothing is missing")
    nulls = null_residuals(simulator, ranking.base, CONFIRMED_NULLS if confirm else NULLS, rng)
    calibration = calibrate(ranking, nulls)
    ranking = calibration.sorted(ranking)
    p_fits = {ranking.base.name: p_fit(ranking.base, nulls, problem)}
    if needs_more(ranking, calibration, p_fits):
        ranking = calibration.sorted(with_pairs(simulator, ranking, progress=progress))
    located = locate(problem, ranking.base, nulls)
    progress("deciding")
    p_fits |= {f.name: p_fit(f, nulls, problem) for f in (*ranking.singles, *ranking.pairs)}
    tests = FitTests.of(ranking, p_fits)
    probabilities = _probabilities(problem, ranking, tests)
    choice = decide(problem, ranking, nulls, calibration, tests, probabilities)
    confirmed: dict[str, float] = {}
    if confirm:
        from .confirm import confirm_evidence

        leading = [ranking.base, *choice.members[:4]]
        confirmed = confirm_evidence(simulator, leading, rng, progress)
    progress("predicting conditions that were left out")
    best = choice.members[0] if choice.members else ranking.base
    scored = {f.name: f for f in (ranking.base, *ranking.singles, *ranking.pairs)}
    scores = {name: held_out(problem, f) for name, f in scored.items()}
    progress("looking for the next experiment")
    rivals = list(choice.members[:4])
    if len(rivals) < 2:
        others = [f for f in (*ranking.singles, ranking.base) if f.name != best.name]
        rivals = [best, *others[:1]]
    proposals = propose(simulator, rivals, rng)
    corrections = (
        tuple(correct(problem, ranking.base, _reached(simulator, ranking.base)))
        if choice.verdict == OUTSIDE
        else ()
    )
    return Verdict(
        name=recordings.name, seed=seed, verdict=choice.verdict,
        mechanisms=tuple(m.name for m in best.mechanisms),
        alternatives=tuple(
            tuple(m.name for m in f.mechanisms) for f in choice.members[1:]
        ),
        audit=findings, probabilities=probabilities,
        scores=_scores(ranking, p_fits, scores, confirmed), located=located,
        parameters=parameters_of(simulator, best), nuisance_pulls=_pulls(problem, best),
        excluded=ranking.excluded, limits=_limits(ranking, calibration),
        improvement=_improvement(scores[ranking.base.name], scores[best.name]),
        corrections=corrections, proposals=tuple(proposals[:5]), notes=_notes(problem, best),
        problem=problem, ranking=ranking, best=best, calibration=calibration,
        reasons=choice.reasons, impacts=simulator.impacts, confirmed=confirmed,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Choice:
    """A verdict, the explanations that it holds (best first), and why."""

    verdict: str
    members: tuple[Fit, ...]
    reasons: tuple[str, ...]


def needs_more(ranking: Ranking, calibration: Calibration, p_fits: Mapping[str, float]) -> bool:
    """Whether the baseline is in doubt, so that pairs are worth fitting."""
    base = ranking.base
    if not ranking.singles:
        return False
    gain = calibration.excess(ranking.singles[0], base)
    return gain > calibration.single or p_fits[base.name] < P_FIT


def left_over(fitted: Fit, base: Fit) -> float:
    """Part of the baseline's misfit that an explanation leaves, as an amplitude."""
    cells = len(fitted.residual)
    return math.sqrt(max(fitted.chi2 - cells, 0.0) / max(base.chi2 - cells, 1.0))


@dataclass(frozen=True)
class FitTests:
    """How the explanations fit.

    Parameters
    ----------
    p
        For each fit by name, the share of its own data sets that fit it no better.
    passed
        Names of those that are not rejected: they fit, or leave no more than an inexact form may.
    """

    p: Mapping[str, float]
    passed: frozenset[str]

    @classmethod
    def of(cls, ranking: Ranking, p_fits: Mapping[str, float]) -> FitTests:
        """Judge all fits of a ranking."""
        base = ranking.base
        passed = frozenset(
            f.name
            for f in (base, *ranking.singles, *ranking.pairs)
            if p_fits[f.name] >= P_FIT or (f.mechanisms and left_over(f, base) <= INEXACT)
        )
        return cls(p_fits, passed)


def decide(
    problem: Problem, ranking: Ranking, nulls: Nulls, calibration: Calibration,
    tests: FitTests, probabilities: Mapping[str, float],
) -> Choice:  # fmt: skip
    """Decide by thresholds from nulls of the same set, by the odds of something outside, by drifts.

    Parameters
    ----------
    problem, ranking, nulls, calibration
        What was compared, all fits, and what nulls of the same set give.
    tests
        How they fit.
    probabilities
        For each fit by name, and for `OUTSIDE`.
    """
    choice = _by_thresholds(problem, ranking, nulls, calibration, tests)
    if choice.members and probabilities[OUTSIDE] > _RATHER_OUTSIDE:
        choice = Choice(OUTSIDE, (), (*choice.reasons, _rather_outside(choice, probabilities)))
    if not problem.drifts:
        return choice
    seen = (
        f"{d.observable}: repeats of one condition change by {_change(d)} from the first trial to "
        f"the last ({abs(d.z):.1f} standard errors), whatever the simulation"
        for d in problem.drifts
    )
    outside = choice.verdict in ("adequate", "undetermined")
    return replace(
        choice, verdict=OUTSIDE if outside else choice.verdict, reasons=(*choice.reasons, *seen)
    )


def _rather_outside(choice: Choice, probabilities: Mapping[str, float]) -> str:
    return (
        f"{choice.members[0].name} passes the tests, but a contact law that is free explains the "
        f"set so much better that something outside the library has "
        f"{_percent(probabilities[OUTSIDE])} of the probability"
    )


def _change(drift: Drift) -> str:
    if drift.observable in LOGARITHMIC:
        return f"{100.0 * math.expm1(drift.change):+.1f} %"
    return f"{drift.change:+.3g}"


def _by_thresholds(
    problem: Problem, ranking: Ranking, nulls: Nulls, calibration: Calibration, tests: FitTests
) -> Choice:
    base = ranking.base
    cells = len(problem.cells)
    if cells < _FEWEST:
        return Choice("undetermined", (), (f"only {cells} numbers to compare",))
    p_base = tests.p[base.name]
    reasons = [
        f"the baseline's misfit is {base.chi2:.0f} over {cells} cells; "
        f"{_percent(p_base)} of sets with nothing missing fit no better"
    ]
    if not ranking.singles:
        verdict = "adequate" if p_base >= P_FIT else OUTSIDE
        return Choice(verdict, (), tuple(reasons))
    lead = ranking.singles[0]
    gain = calibration.excess(lead, base)
    reasons.append(
        f"the best single mechanism, {lead.name}, gains {lead.log_evidence - base.log_evidence:.1f}"
        " nats; with nothing missing three sets in a hundred would give it, or an equally rare "
        f"gain to another, {calibration.needed(lead):.1f}"
    )
    if gain <= calibration.single and p_base >= P_FIT:
        return Choice("adequate", (), tuple(reasons))
    # something is missing: from here on the evidence alone says what
    pairs = _by_evidence(f for f in ranking.pairs if f.name in tests.passed)
    singles = _by_evidence(f for f in ranking.singles if f.name in tests.passed)
    lead = _by_evidence(ranking.singles)[0]
    needed = extra_threshold(lead, ranking, nulls)
    if lead.name in tests.passed:
        # a second mechanism must explain more than the first one's form may be off by
        needed = max(needed, 0.5 * INEXACT**2 * (base.chi2 - cells))
    more = pairs[0].log_evidence - lead.log_evidence if pairs else -math.inf
    if pairs and (more > needed or not singles):
        reasons.append(
            f"{pairs[0].name} gains {more:.1f} nats more; one mechanism too many would gain "
            f"{needed:.1f} in one of a hundred"
        )
        return _set_of(pairs, pairs[0], ranking, nulls, reasons)
    if any(calibration.excess(f, base) > calibration.single for f in singles):
        if tests.p[singles[0].name] < P_FIT:
            left = _percent(left_over(singles[0], base))
            reasons.append(
                f"{singles[0].name} does not fit to the last: {left} of the mismatch stays, as "
                "where its form is not quite the textbook's"
            )
        return _set_of(singles, singles[0], ranking, nulls, reasons)
    reasons.append(
        f"no mechanism or pair fits: of the sets that {lead.name} would make, "
        f"{_percent(tests.p[lead.name])} fit it no better"
    )
    return Choice(OUTSIDE, (), tuple(reasons))


def _by_evidence(fits: Iterable[Fit]) -> list[Fit]:
    return sorted(fits, key=lambda f: -f.log_evidence)


def _percent(p: float) -> str:
    return f"{100.0 * p:.1f} %" if p < 0.1 else f"{100.0 * p:.0f} %"


def _set_of(
    fits: list[Fit], best: Fit, ranking: Ranking, nulls: Nulls, reasons: list[str]
) -> Choice:
    width = set_width(best, ranking, nulls)
    members = [f for f in fits if f.log_evidence > best.log_evidence - width]
    if len(members) > MOST:
        names = ", ".join(f.name for f in members)
        reasons.append(
            f"something is missing, but {len(members)} explanations lie within {width:.1f} nats of "
            f"each other: {names}; the set says too little to choose"
        )
        return Choice("undetermined", (), tuple(reasons))
    if len(members) > 1:
        reasons.append(f"{len(members)} explanations lie within {width:.1f} nats of each other")
        return Choice("indistinguishable", tuple(members), tuple(reasons))
    return Choice("missing-physics", (best,), tuple(reasons))


def _audit(recordings: RecordingSet) -> tuple[dict[str, Any], ...]:
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


def _probabilities(problem: Problem, ranking: Ranking, tests: FitTests) -> dict[str, float]:
    """Posterior probabilities; half the prior on the baseline, a twentieth outside the library.

    An explanation that its fit test rejects is not one: its share goes to outside the library.
    """
    base = ranking.base
    outside = float(widened(problem, base).log_likelihood(base.residual))
    names = ["baseline", OUTSIDE]
    logs = [base.log_evidence + math.log(0.5), outside + math.log(0.05)]
    rejected = {f.name for f in (base, *ranking.singles, *ranking.pairs)} - tests.passed
    for share, fits in ((0.3, ranking.singles), (0.15, ranking.pairs)):
        for f in fits:
            names.append(f.name)
            logs.append(f.log_evidence + math.log(share / len(fits)))
    total = logsumexp(logs)
    found = {n: float(np.exp(x - total)) for n, x in zip(names, logs, strict=True)}
    found[OUTSIDE] += sum(found[n] for n in rejected)
    found |= dict.fromkeys(rejected, 0.0)
    return dict(sorted(found.items(), key=lambda item: -item[1]))


def _scores(
    ranking: Ranking,
    p_fits: Mapping[str, float],
    scores: dict[str, HeldOut],
    confirmed: dict[str, float],
) -> dict[str, dict[str, float]]:
    found = {}
    for f in (ranking.base, *ranking.singles, *ranking.pairs):
        if f.name in scores:
            found[f.name] = {
                "evidence": confirmed.get(f.name, f.log_evidence - ranking.base.log_evidence),
                "held_out": scores[f.name].score,
                "p_value": p_fits[f.name],
            }
    return found


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
        for axis, p in enumerate(fitted.grid.parameters):
            middle, low, high = interval(places[:, axis], fitted.weight, level)
            low = max(middle - math.hypot(middle - low, off[axis]), 0.0)
            high = min(middle + math.hypot(high - middle, off[axis]), 1.0)
            found[p.name] = {
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


def _pulls(problem: Problem, fitted: Fit) -> dict[str, float]:
    """Shift of every stated number over what chance would give it.

    The posterior mean in prior standard deviations, over sqrt(1 - its posterior variance): unit
    normal when the sheet is right, however much of a shift other unknowns could take up.
    """
    learnt = np.sqrt(np.maximum(1.0 - np.diag(fitted.covariance), 0.01))
    return {n.name: float(fitted.z[i] / learnt[i]) for i, n in enumerate(problem.nuisances)}


def _notes(problem: Problem, best: Fit) -> tuple[str, ...]:
    notes = []
    pulls = _pulls(problem, best)
    for i, n in enumerate(problem.nuisances):
        z, pull = float(best.z[i]), pulls[n.name]
        if abs(pull) > _PULLED:
            notes.append(
                f"{n.name} wants to be {n.at(z):.4g} {n.unit}, {'above' if z > 0 else 'below'} the "
                f"stated {n.value:.4g}: a pull of {abs(pull):.1f} standard deviations"
            )
    sizes = ", ".join(f"{k} {100 * v:.2g} %" for k, v in problem.error.sizes.items())
    notes.append(f"the contact law '{problem.law.name}' is taken to be uncertain by: {sizes}")
    return (*notes, *problem.notes)


def _limits(ranking: Ranking, calibration: Calibration) -> dict[str, float]:
    """Smallest value of each first parameter whose effect would have been seen."""
    base = ranking.base
    found = {}
    for s in ranking.screened:
        seen_at = calibration.single + calibration.offset.get(s.mechanism.name, 0.0)
        needed = math.sqrt(2.0 * (max(seen_at, 1.0) + 3.0))
        p = s.grid.parameters[0]
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


def _improvement(base: HeldOut, best: HeldOut) -> dict[str, float]:
    return {
        "held_out_baseline": base.score, "held_out_extended": best.score,
        "raw_baseline": base.raw, "raw_extended": best.raw, "trials": base.trials,
    }  # fmt: skip


def _reached(simulator: Simulator, base: Fit) -> tuple[float, float]:
    seen = simulator.observe((), [Point(base.z)])["peak_depth_m"][0]
    R = np.array([s.pair.R for s in simulator.problem.scenes(base.z)])
    return float(np.min(seen / R)), float(np.max(seen / R))


__all__ = ["Choice", "Verdict", "decide", "diagnose", "parameters_of"]
