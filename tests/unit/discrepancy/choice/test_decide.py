"""The verdict that costs least, on probabilities that are put in by hand."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.choice.decide import COSTS, cost_of_naming, decide
from dentscope.discrepancy.choice.judge import Judge
from dentscope.discrepancy.choice.odds import (
    BESIDE,
    NAMED_AT,
    OUTSIDE,
    PRIORS,
    SURE,
    Odds,
    odds_of,
)
from dentscope.discrepancy.comparison.cells import Scatter
from dentscope.discrepancy.rules import RULES
from dentscope.discrepancy.unknowns.drift import Drift

CELLS = 8
ZERO = (0.0,) * CELLS


def odds(**p: float) -> Odds:
    """Return odds of names joined by `_` for a pair; the rest is the baseline's."""
    found = {k.replace("_", "+"): x for k, x in p.items()}
    found = {OUTSIDE: found.pop("outside", 0.0), **found}
    found["baseline"] = 1.0 - math.fsum(found.values())
    names = {k: () if k in ("baseline", OUTSIDE) else tuple(k.split("+")) for k in found}
    return Odds(names, dict(sorted(found.items(), key=lambda item: -item[1])))


@pytest.fixture
def case(toy):
    """Return a function that decides by odds."""

    def decided(given: Odds, *, cells=CELLS, speeds=(), drifts=(), scatters=()):
        labels = [k for k in given.probability if given.names[k]]
        fits = [toy.fit_of(ZERO, *(toy.Effect(n, ZERO) for n in given.names[k])) for k in labels]
        known = toy.problem([0.0] * cells, speeds=speeds, scatters=scatters)
        one = [f for f in fits if len(f.mechanisms) == 1]
        two = [f for f in fits if len(f.mechanisms) == 2]
        ranking = toy.ranking_of(known, toy.fit_of(ZERO), singles=one, pairs=two)
        return decide(ranking, given, drifts=drifts)

    return decided


def named(choice):
    return [f.name for f in choice.members]


def test_too_few_numbers_or_conditions_say_nothing(case) -> None:
    found = case(odds(a=1.0), cells=5)
    assert (found.verdict, named(found)) == ("undetermined", [])
    assert "only 5 readings" in found.reasons[0]
    assert case(odds(a=1.0), cells=6).verdict == "missing-physics"


def test_few_numbers_may_say_that_something_is_missing_but_not_what(case) -> None:
    told = case(odds(a=0.9, outside=0.0995), cells=4).reasons
    assert told[1] == (
        "something is missing with a probability of more than 99.8 %; the numbers are too few to "
        "say what"
    )
    assert len(case(odds(a=0.9), cells=4).reasons) == 1


def test_no_probability_is_told_beyond_what_the_nulls_support(case) -> None:
    told = case(odds(a=0.9999999)).reasons[0]
    assert "missing with a probability of more than 99.8 %" in told
    assert "not in the library with less than 0.2 %" in told


def test_numbers_of_one_condition_say_nothing(toy) -> None:
    given = toy.problem([0.0] * CELLS)
    given.cells.condition[:] = 0
    found = decide(toy.ranking_of(given, toy.fit_of(ZERO)), odds(a=1.0))
    assert found.verdict == "undetermined"
    assert "of one condition" in found.reasons[0]


@pytest.mark.parametrize(
    ("given", "verdict", "names"),
    [
        (odds(a=0.2), "adequate", []),
        # below 0.7 `adequate` would be read as an all-clear
        (odds(a=0.29), "adequate", []),
        (odds(a=0.31), "undetermined", []),
        # a name costs ten times what silence about something missing does
        (odds(a=0.7), "undetermined", []),
        (odds(a=0.85), "undetermined", []),
        (odds(a=0.96), "missing-physics", ["a"]),
        (odds(outside=0.96), OUTSIDE, []),
        (odds(a=0.5, b=0.48), "indistinguishable", ["a", "b"]),
        (odds(a=0.95, b=0.02), "missing-physics", ["a"]),
        (odds(a=0.93, b=0.06), "indistinguishable", ["a", "b"]),
        (odds(a=0.4, b=0.3, c=0.28), "indistinguishable", ["a", "b", "c"]),
        (odds(a=0.27, b=0.27, c=0.27, d=0.1, e=0.09), "indistinguishable", ["a", "b", "c"]),
        # more than three that differ are no finding
        (odds(a=0.17, b=0.17, c=0.17, d=0.16, e=0.16, f=0.16), "undetermined", []),
        # what takes part in all that is likely, with whatever acts beside it
        (odds(a=0.4, a_b=0.3, a_c=0.28), "indistinguishable", ["a", "a+b", "a+c"]),
        (odds(a=0.75, a_b=0.1, a_c=0.1), "missing-physics", ["a"]),
        (odds(a_b=0.97), "missing-physics", ["a+b"]),
        # a pair of little probability does not stand for its members, half of each
        (odds(a=0.35, b=0.31, c=0.2, a_d=0.07, b_e=0.03, a_b=0.02), "indistinguishable",
         ["a", "b", "c"]),
        (odds(a=0.18, b=0.16, c=0.15, d=0.15, e=0.15, f=0.15, a_b=0.02, c_d=0.02, e_f=0.02),
         "undetermined", []),
        # what leads clearly is said, with its rival's probability
        (odds(a=0.58, outside=0.42), "missing-physics", ["a"]),
        (odds(a=0.43, outside=0.57), OUTSIDE, []),
        (odds(a=0.5, outside=0.5), "undetermined", []),
        # two that only together outweigh what leads
        (odds(a=0.38, b=0.23, outside=0.39), "undetermined", []),
    ],
)  # fmt: skip
def test_the_cheapest_verdict_is_given(case, given, verdict, names) -> None:
    found = case(given)
    assert found.verdict == verdict
    assert named(found) == names
    for name in names[:1]:
        if verdict == "missing-physics":
            assert all(given.inclusion[m] >= 0.5 for m in given.names[name])


def test_the_cost_of_a_name_is_the_sum_over_what_may_be_true() -> None:
    given = odds(a=0.6, b=0.1, a_b=0.1, outside=0.1)
    # b and outside are wrong, the pair is half right, the baseline is a false alarm
    cost = 0.2 * COSTS.wrong + 0.1 * COSTS.half + 0.1 * COSTS.false_alarm
    assert cost_of_naming(["a"], given) == pytest.approx(cost)
    assert cost_of_naming(["a", "b"], given) == pytest.approx(
        cost - 0.1 * COSTS.wrong + COSTS.more
    )  # fmt: skip


def test_the_odds_at_which_a_name_is_cheaper_than_silence() -> None:
    """All other numbers aside, a name costs less than `undetermined` above this probability."""
    assert COSTS.false_alarm * (1.0 - SURE) == pytest.approx(COSTS.silence)
    assert math.log(SURE / (1.0 - SURE)) == pytest.approx(NAMED_AT)


def test_scatter_beyond_the_noise_is_said_first(case) -> None:
    found = case(odds(), scatters=(Scatter("restitution", 78.0, 40),))
    assert found.reasons[0].startswith("repeats of restitution differ 78 times more than")
    assert case(odds()).reasons[0].startswith("something is missing with a probability")


def test_a_drift_is_said_beside_any_verdict(case) -> None:
    drift = Drift("peak_force_N", math.log(1.1), 5.0)
    found = case(odds(a=0.99), drifts=(drift,))
    assert found.verdict == "missing-physics"
    assert "peak_force_N: repeats of one condition change by +10.0 %" in found.reasons[-1]


def test_probabilities_are_prior_times_evidence_less_a_penalty(toy) -> None:
    base, one, two = toy.fit_of(ZERO), toy.Effect("a", ZERO), toy.Effect("b", ZERO)
    singles = [toy.fit_of(ZERO, one, lift=math.log(4.0)), toy.fit_of(ZERO, two)]
    ranking = toy.ranking_of(
        toy.problem([0.0] * CELLS), base, singles=singles,
        pairs=[toy.fit_of(ZERO, one, two, lift=math.log(2.0))],
        screened=[toy.screened_of(e, [ZERO]) for e in (one, two)],
    )  # fmt: skip
    found = odds_of(ranking, math.log(3.0))
    weight = {
        "baseline": PRIORS["baseline"], OUTSIDE: 3.0 * PRIORS[OUTSIDE],
        "a": 4.0 * PRIORS["singles"] / 2, "b": PRIORS["singles"] / 2, "a+b": 2.0 * PRIORS["pairs"],
    }  # fmt: skip
    for name in ("a", "b", "a+b"):
        weight[name] *= math.exp(-RULES.penalty)
    total = sum(weight.values())
    assert dict(found.probability) == pytest.approx({k: w / total for k, w in weight.items()})
    assert next(iter(found.probability)) == "baseline"
    assert found.inclusion["a"] == pytest.approx((weight["a"] + weight["a+b"]) / total)


def test_a_mechanism_without_a_fit_counts_by_its_screening(toy) -> None:
    base, one = toy.fit_of(ZERO), toy.Effect("a", ZERO)
    screened = SimpleNamespace(mechanism=one, log_bayes=math.log(6.0))
    ranking = toy.ranking_of(toy.problem([0.0] * CELLS), base, screened=[screened])
    found = odds_of(ranking, -math.inf)
    assert found.probability["a"] / found.baseline == pytest.approx(
        6.0 * PRIORS["singles"] / 0.5 * math.exp(-RULES.penalty)
    )


def test_what_its_own_sets_refute_gives_its_probability_to_something_outside(toy) -> None:
    base, one, two = toy.fit_of(ZERO), toy.Effect("a", ZERO), toy.Effect("b", ZERO)
    ranking = toy.ranking_of(
        toy.problem([0.0] * CELLS), base,
        singles=[toy.fit_of(ZERO, one, lift=30.0), toy.fit_of(ZERO, two)],
        screened=[toy.screened_of(e, [ZERO]) for e in (one, two)],
    )  # fmt: skip
    before = odds_of(ranking, -math.inf)
    asked = []

    def beside(fitted):
        asked.append(fitted.name)
        return math.log(3.0 / BESIDE)

    found = odds_of(ranking, -math.inf, beside=beside)
    assert asked == ["a"]  # nothing is beside what has no probability itself
    assert found.outside == pytest.approx(3.0 * found.probability["a"])
    assert found.beside == pytest.approx({"a": found.outside})
    assert found.probability["a"] == pytest.approx(before.probability["a"] / 4.0)
    assert sum(found.probability.values()) == pytest.approx(1.0)


def test_the_baseline_is_asked_as_what_is_named_is(toy) -> None:
    """A baseline that its own sets refute says that something outside acts."""
    base = toy.fit_of(ZERO)
    ranking = toy.ranking_of(toy.problem([0.0] * CELLS), base)
    found = odds_of(ranking, -math.inf, beside=lambda fitted: math.log(3.0))
    asked = 3.0 * PRIORS[OUTSIDE]
    assert found.outside == pytest.approx(asked / (asked + PRIORS["baseline"]))


def test_a_name_that_does_not_fit_is_told_beside_something_outside(toy) -> None:
    """Two cells of 30 and -30 deviations, of which the only mechanism takes up the first."""
    data = (30.0, -30.0, *ZERO[2:])
    effect = toy.Effect("a", (30.0, *ZERO[1:]))
    ranking = toy.ranking_of(
        toy.problem(data), toy.fit_of(data), singles=[toy.fit_of(data, effect)],
        screened=[toy.screened_of(effect, [ZERO])],
    )  # fmt: skip
    nulls = toy.nulls_of(np.random.default_rng(2).standard_normal((500, CELLS)))
    found = Judge(-math.inf, {}, nulls).decided(ranking, {})
    assert found.verdict == OUTSIDE
    assert found.reasons[-1] == (
        "a comes nearest of what has a name, but fits worse than 99.8 % of the sets that it makes "
        "itself"
    )
    fits = toy.ranking_of(
        ranking.problem, toy.fit_of((30.0, *ZERO[1:])),
        singles=[toy.fit_of((30.0, *ZERO[1:]), effect)], screened=ranking.screened,
    )  # fmt: skip
    named = Judge(-math.inf, {}, nulls).decided(fits, {})
    assert (named.verdict, [f.name for f in named.members]) == ("missing-physics", ["a"])
