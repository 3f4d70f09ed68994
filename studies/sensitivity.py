"""What verdicts turn on: priors, costs and errors halved and doubled; stages taken away.

`python -m dentscope.studies.sensitivity challenge/open data/proof/altered.jsonl`

What a prior, a cost or a stage of the judgement makes of a set follows from the same fits, exactly;
other errors of the law or of forms are fitted anew. The sets are the open ones of the challenge and
the shipped recordings, whose truth nobody knows. Half as wide, a prior lies about the best place;
twice as wide, nothing new explains the data: the most and the least that a width can do.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType, ModuleType
from typing import Any, NamedTuple

import numpy as np
from scipy.special import logsumexp

from ..core.arrays import Array
from ..core.processes.threads import in_one_thread
from ..discrepancy.choice import odds
from ..discrepancy.choice.decide import decide
from ..discrepancy.choice.odds import OUTSIDE, PRIORS, gains, odds_of
from ..discrepancy.choice.own_sets import fit_test
from ..discrepancy.choice.pairs import with_pairs
from ..discrepancy.choice.thresholds import Nulls, null_residuals
from ..discrepancy.comparison.forward import Simulator
from ..discrepancy.comparison.problem import Problem, problem_of
from ..discrepancy.inference import derivatives
from ..discrepancy.inference.grid import Grid
from ..discrepancy.rank import Ranking, Screened, rank
from ..discrepancy.rules import RULES
from ..discrepancy.unknowns.lawerror import LawError
from ..recordings import read
from ..recordings.shipped import FOLDER, shipped_sets
from .challenge.archive import sets_of, truths_of
from .proof.altered import AS_IT_IS, LAW_ERROR, NO_FORM, NO_LAW, WIDTHS, WITHOUT, label
from .proof.ranks import read_ranks
from .proof.rivals import LEAST

_HARDLY = 0.01
"""Times the law's error where it is taken away: what is left is less than any noise."""

_NOTHING = 1e-12
"""Prior probability of what is taken away."""


@contextmanager
def standing(module: ModuleType, **values: Any) -> Iterator[None]:
    """Let names of a module stand for other values for a while."""
    before = {name: getattr(module, name) for name in values}
    try:
        for name, value in values.items():
            setattr(module, name, value)
        yield
    finally:
        for name, value in before.items():
            setattr(module, name, value)


class Explained(NamedTuple):
    """All explanations of a set, fitted, and sets with nothing missing."""

    ranking: Ranking
    nulls: Nulls


def explained(problem: Problem) -> Explained:
    """Fit every explanation as a diagnosis does, with the draws of its seed 0."""
    simulator = Simulator(problem)
    ranking = rank(simulator)
    simulator = simulator.of(ranking.problem)
    ranking = with_pairs(simulator, ranking)
    nulls = null_residuals(simulator, ranking.base, RULES.nulls, np.random.default_rng(0))
    return Explained(ranking, nulls)


def said(found: Explained, more: Mapping[str, float] = MappingProxyType({})) -> dict[str, Any]:
    """Return the verdict, the names in it and all probabilities that count.

    `more` is added to the ln evidence of explanations.
    """
    ranking = found.ranking
    each = odds_of(
        ranking, sampled={k: x + more.get(k, 0.0) for k, x in gains(ranking).items()},
        beside={f.name: fit_test(f, found.nulls).log_odds for f in ranking.fits},
    )  # fmt: skip
    choice = decide(ranking, each)
    return {
        "verdict": choice.verdict, "names": [list(f.names) for f in choice.members],
        "odds": {k: round(p, 4) for k, p in each.probability.items() if p >= 0.5 * LEAST},
    }  # fmt: skip


def priors(**times: float) -> ExitStack:
    """Let prior odds be other multiples: of `mechanisms`, `inputs`, `second` and `OUTSIDE`."""
    second = min(PRIORS["second"] * times.pop("second", 1.0), 0.9)
    raw = {k: p * times.get(k, 1.0) for k, p in PRIORS.items() if k != "second"}
    whole = sum(raw.values()) / sum(p for k, p in PRIORS.items() if k != "second")
    stack = ExitStack()
    p = {k: x / whole for k, x in raw.items()} | {"second": second}
    stack.enter_context(standing(odds, PRIORS=p))
    return stack


def ruled(name: str, times: float) -> ExitStack:
    """Let a number of the judgement be a multiple of itself."""
    rules = replace(RULES, **{name: times * getattr(RULES, name)})
    stack = ExitStack()
    stack.enter_context(standing(odds, RULES=rules))
    return stack


def narrowed(log_likelihood: Array, grid: Grid) -> float:
    """Ln of what the evidence gains where every prior is half as wide, about the best place.

    Parameters
    ----------
    log_likelihood
        (k,) over the refined grid.
    grid
        Of all parameters; what is outside its window has no likelihood.
    """
    best = grid.places()[int(np.argmax(log_likelihood))]
    inside = np.ones(1)
    for axis, at in enumerate(best):
        low, high = grid.window[axis] if grid.window else (0.0, 1.0)
        edges = np.linspace(low, high, len(grid.fine[axis]) + 1)
        first = min(max(at - 0.25, 0.0), 0.5)
        part = np.clip(edges, first, first + 0.5)
        inside = np.multiply.outer(inside, np.diff(part) / np.diff(edges))
    kept = logsumexp(log_likelihood, b=inside.ravel()) - logsumexp(log_likelihood)
    return float(kept) + len(grid.axes) * math.log(2.0)


def widths(found: Explained, times: float) -> tuple[Explained, dict[str, float]]:
    """Let all priors of parameters be half or twice as wide.

    Returns
    -------
    tuple
        All with what has no name so, and ln of what the evidence of each other gains.
    """
    ranking = found.ranking
    base = ranking.base

    def gain(log_likelihood: Array, grid: Grid) -> float:
        wide = -len(grid.axes) * math.log(2.0)
        return narrowed(log_likelihood, grid) if times < 1.0 else wide

    def screened(s: Screened) -> float:
        return gain(base.mixture.log_likelihood(base.residual - s.effect), s.grid)

    wider = {s.mechanism.name: screened(s) for s in ranking.screened}
    wider |= {f.name: gain(f.log_likelihood, f.grid) for f in (*ranking.singles, *ranking.pairs)}
    nameless = tuple(
        replace(n, log_bayes=n.log_bayes + (
            gain(n.fit.log_likelihood, n.fit.grid) if n.fit else screened(n.screened)
        ))
        for n in ranking.nameless
    )  # fmt: skip
    return found._replace(ranking=replace(ranking, nameless=nameless)), wider


_ROWS: Mapping[str, Callable[[float], ExitStack]] = {
    "prior odds of a mechanism": lambda t: priors(mechanisms=t),
    "prior odds of a wrong number": lambda t: priors(inputs=t),
    "prior odds of a second one": lambda t: priors(second=t),
    "prior odds of something outside": lambda t: priors(**{OUTSIDE: t}),
    "gain that counts by its share": lambda t: ruled("by_ratio", t),
    "odds beside what leads": lambda t: ruled("beside", t),
    "temper of the evidence": lambda t: ruled("temper", t),
}


def altered(found: Explained) -> dict[str, dict[str, Any]]:
    """Return what is said as it is, and with each prior and weight halved and doubled."""
    told = {AS_IT_IS: said(found)}
    for times in (0.5, 2.0):
        for row, standing_in in _ROWS.items():
            with standing_in(times):
                told[label(row, times)] = said(found)
        told[label(WIDTHS, times)] = said(*widths(found, times))
    return told


def taken_away(found: Explained) -> dict[str, dict[str, Any]]:
    """Return what is said without each stage of the judgement."""
    ranking = found.ranking
    told = {
        "nameless effects": said(found._replace(ranking=replace(ranking, nameless=()))),
        "second explanations": said(found._replace(ranking=replace(ranking, pairs=()))),
    }
    away: dict[str, Callable[[], ExitStack]] = {
        "wrong numbers": lambda: priors(inputs=_NOTHING),
        "temper": lambda: ruled("temper", 1.0 / RULES.temper),
        "gains by their share": lambda: ruled("by_ratio", 1e9),
        "fit beside its own sets": lambda: ruled("beside", _NOTHING),
        "all outside the library": lambda: priors(**{OUTSIDE: _NOTHING}),
    }
    for stage, standing_in in away.items():
        with standing_in():
            told[stage] = said(found)
    return told


def with_error(problem: Problem, times: float) -> Problem:
    """Return a problem whose law, and whose metal, may be off by a multiple of what they may."""
    error: LawError = problem.error
    spreads = {
        striker: replace(
            s, law={k: times * x for k, x in s.law.items()},
            metal={k: times * x for k, x in s.metal.items()},
        )
        for striker, s in error.spreads.items()
    }  # fmt: skip
    return replace(problem, error=replace(error, spreads=spreads))


def _as_it_is(problem: Problem) -> dict[str, Any]:
    found = explained(problem)
    return brief(altered(found) | {WITHOUT + k: v for k, v in taken_away(found).items()})


def brief(told: dict[str, dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """Leave out probabilities that are those as it is."""
    same = told[AS_IT_IS]["odds"]
    return {
        k: {n: v for n, v in one.items() if k == AS_IT_IS or n != "odds" or v != same}
        for k, one in told.items()
    }


def _without_form(problem: Problem) -> dict[str, Any]:
    error = derivatives.form_error
    with standing(derivatives, form_error=lambda p, effect, share: error(p, effect, 0.0)):
        return {NO_FORM: said(explained(problem))}


def _law_error(name: str, times: float) -> Callable[[Problem], dict[str, Any]]:
    return lambda problem: {name: said(explained(with_error(problem, times)))}


FITS: Mapping[str, Callable[[Problem], dict[str, Any]]] = {
    AS_IT_IS: _as_it_is,
    label(LAW_ERROR, 0.5): _law_error(label(LAW_ERROR, 0.5), 0.5),
    label(LAW_ERROR, 2.0): _law_error(label(LAW_ERROR, 2.0), 2.0),
    NO_LAW: _law_error(NO_LAW, _HARDLY),
    NO_FORM: _without_form,
}
"""What is fitted, and what it is asked."""

_FEWER = 3
"""Of the open sets every so-manyth is fitted anew."""


def asked(open_sets: Sequence[str]) -> list[tuple[str, str]]:
    """Return what is asked, a set and a fit each, in order; of the shipped no stage is taken away.

    What is told again from the same fits comes first.
    """
    found = [(name, AS_IT_IS) for name in (*shipped_sets(), *open_sets)]
    fewer = open_sets[::_FEWER]
    for fit in FITS:
        if fit != AS_IT_IS:
            some = fewer if fit in (NO_LAW, NO_FORM) else (*shipped_sets(), *fewer)
            found += [(name, fit) for name in some]
    return found


def lines(folder: Path, out: Path) -> Iterator[dict[str, Any]]:
    """Go on where a file of lines stopped; yield each line.

    Parameters
    ----------
    folder
        Part `open` of the challenge.
    out
        A line of JSON for each set and fit: `set`, `truth` (none of a shipped recording), `fit`,
        and what is `said`, as in `proof.rivals`; without `odds` where they are those as it is.
    """
    known = {(x["set"], x["fit"]) for x in read_ranks(out)}
    open_sets = sets_of(folder)
    truths = truths_of(folder, open_sets)
    for name, fit in asked(open_sets):
        if (name, fit) not in known:
            place = folder / "sets" / name if name in open_sets else FOLDER / name
            said_of_it = _asked(place, FITS[fit])
            yield {"set": name, "truth": truths.get(name), "fit": fit, "said": said_of_it}


@in_one_thread
def _asked(place: Path, ask: Callable[[Problem], dict[str, Any]]) -> dict[str, Any]:
    return ask(problem_of(read(place)))


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("out", type=Path)
    given = parser.parse_args()
    with given.out.open("a", encoding="utf-8") as stream:
        for line in lines(given.folder, given.out):
            stream.write(json.dumps(line) + "\n")
            stream.flush()


if __name__ == "__main__":
    main()
