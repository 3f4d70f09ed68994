"""The main path: a recording set in, a verdict out.

audit -> calibrate the nuisances -> rank the explanations -> decide -> locate the mismatch ->
held-out conditions -> next experiment. `Verdict.to_dict` gives verdict.json, version 1.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..core.processes.threads import in_one_thread
from ..impact.mechanisms import MECHANISMS, NAMELESS, Mechanism
from ..impact.mechanisms.own import own_mechanisms, uncovered
from ..recordings import RecordingSet
from .baseline.laws import LawChoice
from .choice.judge import Judge
from .choice.odds import OUTSIDE
from .choice.pairs import with_pairs
from .choice.thresholds import null_residuals
from .comparison.forward import Point, Simulator
from .comparison.problem import problem_of
from .correction import correct
from .estimates import (
    audit_rows,
    improvement_of,
    law_notes,
    limits_of,
    misfit_of,
    notes_of,
    parameters_of,
    pulls_of,
    scores_of,
    surprises_of,
)
from .experiments.next_experiment import propose
from .findings import Verdict
from .heldout import held_out
from .inference.sampling import confirm_evidence
from .locate import locate
from .rank import Progress, rank
from .rules import RULES


@in_one_thread
def diagnose(
    recordings: RecordingSet,
    *,
    seed: int = 0,
    confirm: bool = False,
    law: LawChoice | None = None,
    mechanisms: Sequence[Mechanism] = (),
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
        Also sample the leading explanations' evidence, use the full null ensemble, and solve the
        set's own pair by finite elements, unless `law` says otherwise.
    law
        Contact law of the baseline: `fitted`, or `table` for finite elements of the set's own pair.
        None: `table` with `confirm`, where a body has a flow curve or the target asks for it.
    mechanisms
        One's own, tried beside those of the library and those that other packages add.
    progress
        Called with a line before each step.

    Raises
    ------
    InputError
        The set holds nothing that can be compared, or a mechanism bears a name of the library.
    """
    own = own_mechanisms(mechanisms)
    rng = np.random.default_rng(seed)
    progress("auditing the inputs")
    audit = audit_rows(recordings)
    chosen = law or ("table" if confirm else None)
    simulator = Simulator(problem_of(recordings, law=chosen, progress=progress))

    ranking = rank(simulator, mechanisms=(*MECHANISMS, *NAMELESS, *own), progress=progress)
    simulator = simulator.of(ranking.problem)
    progress("simulating sets in which nothing is missing")
    nulls = null_residuals(
        simulator, ranking.base, RULES.confirmed_nulls if confirm else RULES.nulls, rng
    )
    judge = Judge.of(ranking, nulls)
    if judge.wants_second(ranking):
        ranking = with_pairs(simulator, ranking, progress=progress)

    progress("deciding")
    choice = judge.decided(ranking, {})
    sampled: dict[str, float] = {}
    if confirm:
        leading = [ranking.base, *choice.members]
        sampled = confirm_evidence(simulator, leading, rng, progress)
        choice = judge.decided(ranking, sampled)
    odds = judge.odds(ranking, sampled)
    progress("predicting conditions that were left out")
    left_out = {f.name: held_out(ranking.problem, f) for f in ranking.fits}
    progress("looking for the next experiment")
    best = choice.members[0] if choice.members else ranking.base
    proposals = propose(simulator, ranking, odds, rng)
    corrections = correct(simulator, ranking.base) if choice.verdict == OUTSIDE else ()
    misses = int(choice.verdict not in ("adequate", "undetermined"))
    stated = simulator.predict((), [Point(np.zeros(ranking.problem.n_z))])[0]
    misfit = misfit_of(ranking.problem, ranking.base, stated)
    notes = (*notes_of(ranking.problem, best), *law_notes(ranking.problem, misfit),
             *uncovered(own))  # fmt: skip
    return Verdict(
        name=recordings.name, seed=seed, choice=choice, audit=audit,
        probabilities=dict(odds.probability), inclusion=odds.inclusion,
        scores=scores_of(ranking, {f.name: judge.test(f).p_value for f in ranking.fits}, left_out,
                         sampled),
        located=locate(ranking.problem, ranking.base, nulls, least=misses),
        parameters=parameters_of(simulator, best), nuisance_pulls=pulls_of(ranking.problem, best),
        surprise=surprises_of(ranking.problem, best), excluded=ranking.excluded,
        limits=limits_of(ranking),
        improvement=improvement_of(left_out[ranking.base.name], left_out[best.name]),
        misfit=misfit,
        stated=stated, corrections=corrections, proposals=tuple(proposals[: RULES.proposed]),
        notes=notes, ranking=ranking, best=best, impacts=simulator.tally.impacts,
    )  # fmt: skip


__all__ = ["Verdict", "diagnose"]
