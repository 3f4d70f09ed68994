"""The main path: a recording set in, a verdict out.

audit -> calibrate the nuisances -> locate the mismatch -> rank the explanations -> decide ->
held-out conditions -> next experiment. `Verdict.to_dict` gives verdict.json, version 1.
"""

from __future__ import annotations

import numpy as np

from ..recordings import RecordingSet
from .calibration import calibrate, p_fit
from .correction import correct
from .decide import OUTSIDE, FitTests, decide, needs_more, probabilities_of
from .estimates import (
    audit_rows,
    improvement_of,
    limits_of,
    notes_of,
    parameters_of,
    pulls_of,
    scores_of,
)
from .findings import Verdict
from .forward import Point, Simulator
from .heldout import held_out
from .inference.fit import Fit
from .locate import locate
from .next_experiment import propose
from .pairs import with_pairs
from .problem import problem_of
from .rank import Progress, rank
from .thresholds import null_residuals

NULLS = 500
"""Null data sets that set the thresholds of a screening."""
CONFIRMED_NULLS = 2000
"""Null data sets with `confirm`."""


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
    findings = audit_rows(recordings)
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
    probabilities = probabilities_of(problem, ranking, tests)
    choice = decide(problem, ranking, nulls, calibration, tests, probabilities)
    confirmed: dict[str, float] = {}
    if confirm:
        from .inference.sampling import confirm_evidence

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
        scores=scores_of(ranking, p_fits, scores, confirmed), located=located,
        parameters=parameters_of(simulator, best), nuisance_pulls=pulls_of(problem, best),
        excluded=ranking.excluded, limits=limits_of(ranking, calibration),
        improvement=improvement_of(scores[ranking.base.name], scores[best.name]),
        corrections=corrections, proposals=tuple(proposals[:5]), notes=notes_of(problem, best),
        problem=problem, ranking=ranking, best=best, calibration=calibration,
        reasons=choice.reasons, impacts=simulator.impacts, confirmed=confirmed,
    )  # fmt: skip


def _reached(simulator: Simulator, base: Fit) -> tuple[float, float]:
    seen = simulator.observe((), [Point(base.z)])["peak_depth_m"][0]
    R = np.array([s.pair.R for s in simulator.problem.scenes(base.z)])
    return float(np.min(seen / R)), float(np.max(seen / R))


__all__ = ["Verdict", "diagnose"]
