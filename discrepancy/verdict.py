"""The main path: a recording set in, a verdict out.

audit -> calibrate the nuisances -> rank the explanations -> decide -> locate the mismatch ->
held-out conditions -> next experiment. `Verdict.to_dict` gives verdict.json, version 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple, get_args

import numpy as np

from ..core.arrays import one_number
from ..core.errors import InputError
from ..core.processes.threads import in_one_thread
from ..dynamics.mechanisms import MECHANISMS, NAMELESS, Mechanism
from ..dynamics.mechanisms.own import own_mechanisms, uncovered
from ..recordings import RecordingSet
from . import estimates
from .baseline.laws import LawChoice, Progress
from .choice.decide import Choice, decide
from .choice.odds import OUTSIDE, Odds, odds_of
from .choice.pairs import with_pairs
from .comparison.forward import Point, Simulator
from .comparison.problem import problem_of
from .comparison.units import with_units
from .correction import correct
from .experiments.next_experiment import propose
from .findings import After, Verdict
from .heldout import held_out
from .locate import locate
from .rank import Ranking, rank

# limit: next experiments that a verdict keeps [-]: a screen
_PROPOSED = 5
_SEED = "a whole number from 0 on"


class _Asked(NamedTuple):
    """What a verdict is asked of, and how."""

    recordings: RecordingSet
    audit: tuple[dict[str, Any], ...]
    own: tuple[Mechanism, ...]
    seed: int
    rng: np.random.Generator
    progress: Progress


@in_one_thread
def diagnose(
    recordings: RecordingSet,
    *,
    seed: int = 0,
    law: LawChoice | None = None,
    cautious: bool = False,
    assume: Sequence[str] = (),
    mechanisms: Sequence[Mechanism] = (),
    history: bool = True,
    progress: Progress = lambda _: None,
) -> Verdict:
    """Say what physics is missing in the simulation of a recording set.

    - `recordings`: from `recordings.read`.
    - `seed`, `law`, `cautious`, `assume`, `mechanisms`: as `dentscope.diagnose` takes
      and explains them.
    - `history`: whether what was known before each later session of the set is worked out too.

    Raises `InputError`: the set holds nothing that can be compared, or a mechanism bears a name of
    the library.
    """
    if law not in (None, *get_args(LawChoice)):
        known = " or ".join(get_args(LawChoice))
        why = "how far off another is, is not known and would pass for physics"
        raise InputError(repr(law), key="law", allowed=f"{known}; {why}")
    if not (one_number(seed, key="seed", allowed=_SEED) >= 0 and seed == int(seed)):
        raise InputError(repr(seed), key="seed", allowed=_SEED)
    rng = np.random.default_rng(int(seed))
    own = own_mechanisms(mechanisms)
    progress("auditing the inputs")
    asked = _Asked(recordings, estimates.audit_rows(recordings), own, seed, rng, progress)
    simulator = Simulator(problem_of(recordings, law=law, assume=assume, progress=progress))
    simulator, ranking = _explained(asked, simulator)
    progress("deciding")
    odds = odds_of(ranking)
    verdict = _told(asked, simulator, decide(ranking, odds, cautious=cautious), ranking, odds)
    if not history or not np.ptp(recordings.trials.sessions):
        return verdict
    return replace(verdict, history=_history(asked, verdict, law, assume))


def _history(
    asked: _Asked, verdict: Verdict, law: LawChoice | None, assume: Sequence[str]
) -> tuple[After, ...]:
    """Return what was known after each session, as if it had been the last."""
    sessions = asked.recordings.trials.sessions
    found = []
    for session in np.unique(sessions).tolist()[:-1]:
        asked.progress(f"what was known after session {session:g}")
        part = asked.recordings.take(sessions <= session)
        simulator = Simulator(problem_of(part, law=law, assume=assume))
        _, ranking = _explained(asked, simulator)
        found.append(After(session, len(part.trials), dict(odds_of(ranking).probability)))
    return (*found, After(float(sessions.max()), len(sessions), verdict.probabilities))


def _explained(asked: _Asked, simulator: Simulator) -> tuple[Simulator, Ranking]:
    """Fit the baseline, every wrong number and mechanism, and the pairs that gain by it."""
    simulator = simulator.of(with_units(simulator))
    library = (*MECHANISMS, *NAMELESS, *asked.own, *simulator.problem.wrong_numbers)
    ranking = rank(simulator, library, progress=asked.progress)
    simulator = simulator.of(ranking.problem)
    return simulator, with_pairs(simulator, ranking, progress=asked.progress)


def _told(
    asked: _Asked, simulator: Simulator, choice: Choice, ranking: Ranking, odds: Odds
) -> Verdict:
    """Locate the mismatch, predict what was left out, propose, and say it all."""
    problem, base = ranking.problem, ranking.base
    asked.progress("predicting conditions that were left out")
    left_out = {f.name: held_out(problem, f) for f in ranking.fits}
    asked.progress("looking for the next experiment")
    proposals, session = propose(simulator, ranking, odds, asked.rng)
    best = choice.members[0] if choice.members else base
    stated = simulator.predict((), [Point(np.zeros(problem.n_z))])[0]
    misfit = estimates.misfit_of(problem, base, stated)
    misses = int(choice.verdict not in ("adequate", "undetermined"))
    told = (*estimates.notes_of(problem, best), *estimates.law_notes(problem, misfit))
    return Verdict(
        name=asked.recordings.name, seed=asked.seed, choice=choice, audit=asked.audit,
        probabilities=dict(odds.probability), inclusion=odds.inclusion,
        scores=estimates.scores_of(ranking, left_out),
        located=locate(problem, base, asked.rng, least=misses),
        parameters=estimates.parameters_of(simulator, best),
        nuisance_pulls={n.name: float(best.z[i]) for i, n in enumerate(problem.nuisances)},
        surprise=estimates.surprises_of(problem, best), excluded=ranking.excluded,
        limits=estimates.limits_of(ranking),
        improvement=estimates.improvement_of(left_out[base.name], left_out[best.name]),
        misfit=misfit, stated=stated,
        corrections=correct(simulator, base) if choice.verdict == OUTSIDE else (),
        proposals=tuple(proposals[: _PROPOSED]), session=session, history=(),
        notes=(*told, *uncovered(asked.own)), ranking=ranking, best=best,
        impacts=simulator.tally["impacts"],
        titles={m.name: m.title for m in (*MECHANISMS, *asked.own, *problem.wrong_numbers)},
    )  # fmt: skip
