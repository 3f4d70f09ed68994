"""Decide: which explanations stand, by thresholds from nulls, tests of fit, and odds."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import logsumexp

from ..core.observables import OBSERVABLES
from .calibration import Calibration, extra_threshold, p_fit, set_width
from .cells import Scatter
from .correction import widened
from .drift import Drift
from .inference.fit import Fit
from .rank import Ranking
from .thresholds import Nulls

P_FIT = 0.01
"""An explanation that fits worse than this share of its own data sets is rejected."""
MOST = 3
"""Explanations that are reported as indistinguishable; with more the verdict is undetermined."""
_FEWEST = 6
OUTSIDE = "outside-library"
_RATHER_OUTSIDE = 0.5
"""Probability of something outside the library above which no explanation is named."""
INEXACT = 0.15
"""Part of the baseline's misfit, as an amplitude, that an explanation may leave: by so much of its
effect does the textbook form of a mechanism differ from other published forms."""


@dataclass(frozen=True, eq=False)
class Choice:
    """A verdict, the explanations that it holds (best first), and why."""

    verdict: str
    members: tuple[Fit, ...]
    reasons: tuple[str, ...]


def needs_more(ranking: Ranking, calibration: Calibration, p_base: float) -> bool:
    """Whether the baseline is in doubt, so that pairs are worth fitting."""
    base = ranking.base
    if not ranking.singles:
        return False
    gain = calibration.excess(ranking.singles[0], base)
    return gain > calibration.single or p_base < P_FIT


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
    def of(cls, ranking: Ranking, nulls: Nulls) -> FitTests:
        """Judge all fits of a ranking."""
        p = {f.name: p_fit(f, nulls, ranking.problem) for f in ranking.fits}
        passed = frozenset(
            f.name
            for f in ranking.fits
            if p[f.name] >= P_FIT or (f.mechanisms and left_over(f, ranking.base) <= INEXACT)
        )
        return cls(p, passed)


def probabilities_of(ranking: Ranking, tests: FitTests) -> dict[str, float]:
    """Posterior probabilities; half the prior on the baseline, a twentieth outside the library.

    An explanation that its fit test rejects is not one: its share goes to outside the library.
    """
    base = ranking.base
    outside = float(widened(ranking.problem, base).log_likelihood(base.residual))
    names = ["baseline", OUTSIDE]
    logs = [base.log_evidence + math.log(0.5), outside + math.log(0.05)]
    rejected = {f.name for f in ranking.fits} - tests.passed
    for share, fits in ((0.3, ranking.singles), (0.15, ranking.pairs)):
        for f in fits:
            names.append(f.name)
            logs.append(f.log_evidence + math.log(share / len(fits)))
    total = logsumexp(logs)
    found = {n: float(np.exp(x - total)) for n, x in zip(names, logs, strict=True)}
    found[OUTSIDE] = math.fsum([found[OUTSIDE], *(found[n] for n in rejected)])
    found |= dict.fromkeys(rejected, 0.0)
    return dict(sorted(found.items(), key=lambda item: -item[1]))


def decide(
    ranking: Ranking, nulls: Nulls, calibration: Calibration, tests: FitTests,
    probabilities: Mapping[str, float],
) -> Choice:  # fmt: skip
    """Decide by thresholds from nulls of the same set, by the odds of something outside, by drifts.

    Parameters
    ----------
    ranking, nulls, calibration
        All fits, and what nulls of the same set give.
    tests
        How they fit.
    probabilities
        For each fit by name, and for `OUTSIDE`.
    """
    choice = _by_thresholds(ranking, nulls, calibration, tests)
    choice = replace(choice, reasons=(*map(_scattered, ranking.problem.scatters), *choice.reasons))
    if choice.members and probabilities[OUTSIDE] > _RATHER_OUTSIDE:
        choice = Choice(OUTSIDE, (), (*choice.reasons, _rather_outside(choice, probabilities)))
    drifts = ranking.problem.drifts
    if not drifts:
        return choice
    seen = (
        f"{d.observable}: repeats of one condition change by {_change(d)} from the first trial to "
        f"the last ({abs(d.z):.1f} standard errors), whatever the simulation"
        for d in drifts
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


def _scattered(s: Scatter) -> str:
    return (
        f"repeats of {OBSERVABLES[s.observable].label} differ {s.ratio:.2g} times more than their "
        "stated noise: it is too small, or something was varied and not recorded; their own "
        "scatter is used"
    )


def _change(drift: Drift) -> str:
    if OBSERVABLES[drift.observable].log:
        return f"{100.0 * math.expm1(drift.change):+.1f} %"
    return f"{drift.change:+.3g}"


def _by_thresholds(
    ranking: Ranking, nulls: Nulls, calibration: Calibration, tests: FitTests
) -> Choice:
    base = ranking.base
    cells = len(ranking.problem.cells)
    if cells < _FEWEST:
        reason = f"too few: only {cells} numbers to compare, {_FEWEST} are needed"
        return Choice("undetermined", (), (reason,))
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
