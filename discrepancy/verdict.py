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
    surprises_of,
)
from .findings import Verdict
from .forward import Simulator
from .heldout import held_out
from .inference.sampling import confirm_evidence
from .locate import locate
from .next_experiment import propose, rivals_of
from .pairs import with_pairs
from .problem import problem_of
from .rank import Progress, rank
from .thresholds import null_residuals

NULLS = 500
"""Null data sets that set the thresholds of a screening."""
CONFIRMED_NULLS = 2000
"""Null data sets with `confirm`."""
PROPOSED = 5
"""Next experiments that a verdict keeps."""


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
    audit = audit_rows(recordings)
    simulator = Simulator(problem_of(recordings))

    ranking = rank(simulator, progress=progress)
    simulator = simulator.of(ranking.problem)
    progress("simulating sets in which nothing is missing")
    nulls = null_residuals(simulator, ranking.base, CONFIRMED_NULLS if confirm else NULLS, rng)
    calibration = calibrate(ranking, nulls)
    ranking = calibration.sorted(ranking)
    if needs_more(ranking, calibration, p_fit(ranking.base, nulls, ranking.problem)):
        ranking = calibration.sorted(with_pairs(simulator, ranking, progress=progress))

    progress("deciding")
    located = locate(ranking.problem, ranking.base, nulls)
    tests = FitTests.of(ranking, nulls)
    probabilities = probabilities_of(ranking, tests)
    choice = decide(ranking, nulls, calibration, tests, probabilities)
    leading = [ranking.base, *choice.members]
    sampled = confirm_evidence(simulator, leading, rng, progress) if confirm else {}

    progress("predicting conditions that were left out")
    left_out = {f.name: held_out(ranking.problem, f) for f in ranking.fits}
    progress("looking for the next experiment")
    best = choice.members[0] if choice.members else ranking.base
    proposals = propose(simulator, rivals_of(choice.members, ranking), rng)
    corrections = correct(simulator, ranking.base) if choice.verdict == OUTSIDE else ()
    return Verdict(
        name=recordings.name, seed=seed, choice=choice, audit=audit, probabilities=probabilities,
        scores=scores_of(ranking, tests.p, left_out, sampled), located=located,
        parameters=parameters_of(simulator, best), nuisance_pulls=pulls_of(ranking.problem, best),
        surprise=surprises_of(ranking.problem, best),
        excluded=ranking.excluded, limits=limits_of(ranking, calibration),
        improvement=improvement_of(left_out[ranking.base.name], left_out[best.name]),
        corrections=corrections, proposals=tuple(proposals[:PROPOSED]),
        notes=notes_of(ranking.problem, best), ranking=ranking, best=best,
        impacts=simulator.tally.impacts,
    )  # fmt: skip


__all__ = ["Verdict", "diagnose"]
