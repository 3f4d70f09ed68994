"""What is named when: each rule of a verdict, on explanations whose evidence is put in by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from dentscope.discrepancy.calibration import Calibration
from dentscope.discrepancy.cells import Scatter
from dentscope.discrepancy.decide import (
    OUTSIDE,
    FitTests,
    decide,
    left_over,
    needs_more,
    probabilities_of,
)
from dentscope.discrepancy.drift import Drift

CELLS = 8
ZERO = (0.0,) * CELLS
# thresholds at their least: 2 nats for a second mechanism, 2 nats for the width of the set
STILL = np.zeros((50, CELLS))


@pytest.fixture
def case(toy):
    """Return a function that decides among explanations given as name: nats over the baseline."""

    def decided(
        singles, pairs=(), *, p_base=0.5, rejected=(), chi2=CELLS, cells=CELLS, outside=0.0,
        drifts=(), scatters=(),
    ):  # fmt: skip
        given = toy.problem([0.0] * cells, drifts=drifts, scatters=scatters)
        base = replace(toy.fit_of([0.0] * CELLS), chi2=float(chi2))
        effects = {n: toy.Effect(n, ZERO) for n in singles}
        one = [toy.fit_of(ZERO, effects[n], lift=x) for n, x in singles.items()]
        two = [
            toy.fit_of(ZERO, *(effects[n] for n in names.split("+")), lift=x)
            for names, x in dict(pairs).items()
        ]
        other = toy.screened_of(toy.Effect("other", ZERO), [ZERO])
        ranking = toy.ranking_of(given, base, singles=one, pairs=two, screened=[other])
        p = {f.name: 0.5 for f in ranking.fits} | {base.name: p_base}
        p |= dict.fromkeys(rejected, 0.001)
        tests = FitTests(p, frozenset(p) - set(rejected))
        calibration = Calibration({}, 3.0)
        return decide(ranking, toy.nulls_of(STILL), calibration, tests, {OUTSIDE: outside})

    return decided


def named(choice):
    return [f.name for f in choice.members]


def test_too_few_numbers_say_nothing(case) -> None:
    found = case({"a": 50.0}, cells=5)
    assert (found.verdict, named(found)) == ("undetermined", [])
    assert "only 5 numbers" in found.reasons[0]
    assert case({"a": 50.0}, cells=6).verdict == "missing-physics"


def test_below_the_alarm_nothing_is_missing_while_the_baseline_fits(case) -> None:
    assert case({"a": 2.9}).verdict == "adequate"
    assert case({"a": 3.1}).verdict == "missing-physics"
    assert case({}).verdict == "adequate"


def test_a_baseline_that_does_not_fit_and_nothing_that_passes_is_outside(case) -> None:
    assert case({"a": 2.9}, p_base=0.009).verdict == OUTSIDE
    assert case({"a": 2.9}, p_base=0.011).verdict == "adequate"
    assert case({}, p_base=0.009).verdict == OUTSIDE
    assert case({"a": 9.0}, rejected=["a"]).verdict == OUTSIDE


def test_what_is_rejected_is_not_named_though_it_leads(case) -> None:
    assert named(case({"a": 20.0, "b": 10.0}, rejected=["a"])) == ["b"]


def test_explanations_within_the_width_are_reported_together_up_to_three(case) -> None:
    close = case({"a": 10.0, "b": 8.1, "c": 7.9})
    assert (close.verdict, named(close)) == ("indistinguishable", ["a", "b"])
    many = case({"a": 10.0, "b": 9.5, "c": 9.0, "d": 8.5})
    assert (many.verdict, named(many)) == ("undetermined", [])
    assert "4 explanations lie within 2.0 nats" in many.reasons[-1]


def test_a_pair_must_gain_more_than_one_mechanism_too_many_would(case) -> None:
    assert named(case({"a": 10.0, "b": 5.0}, {"a+b": 11.9})) == ["a"]
    assert named(case({"a": 10.0, "b": 5.0}, {"a+b": 12.1})) == ["a+b"]


def test_a_pair_must_also_gain_what_the_first_ones_form_may_be_off(case) -> None:
    # 0.15^2/2 of the misfit over the cells: 9 nats of 800
    singles, much = {"a": 10.0, "b": 5.0}, CELLS + 800
    assert named(case(singles, {"a+b": 18.9}, chi2=much)) == ["a"]
    assert named(case(singles, {"a+b": 19.1}, chi2=much)) == ["a+b"]
    # a leading form that is rejected has no such claim
    assert named(case(singles, {"a+b": 12.1}, chi2=much, rejected=["a"])) == ["a+b"]


def test_rather_something_outside_than_a_name(case) -> None:
    assert case({"a": 10.0}, outside=0.49).verdict == "missing-physics"
    found = case({"a": 10.0}, outside=0.51)
    assert (found.verdict, named(found)) == (OUTSIDE, [])


def test_scatter_beyond_the_noise_is_said_first(case) -> None:
    found = case({"a": 1.0}, scatters=(Scatter("restitution", 78.0, 40),))
    assert found.reasons[0].startswith("repeats of restitution differ 78 times more than")
    assert case({"a": 1.0}).reasons[0].startswith("the baseline's misfit")


def test_a_drift_is_something_outside_unless_something_is_named(case) -> None:
    drift = Drift("peak_force_N", math.log(1.1), 5.0)
    assert case({"a": 1.0}, drifts=(drift,)).verdict == OUTSIDE
    found = case({"a": 10.0}, drifts=(drift,))
    assert found.verdict == "missing-physics"
    assert "peak_force_N: repeats of one condition change by +10.0 %" in found.reasons[-1]


def test_pairs_are_worth_fitting_where_the_baseline_is_in_doubt(toy) -> None:
    base, one = toy.fit_of(ZERO), toy.Effect("a", ZERO)
    calibration = Calibration({"a": 1.0}, 3.0)

    def more(gain: float, p_base: float) -> bool:
        ranking = toy.ranking_of(None, base, singles=[toy.fit_of(ZERO, one, lift=gain)])
        return needs_more(ranking, calibration, p_base)

    assert not more(3.9, 0.5)
    assert more(4.1, 0.5)
    assert more(3.9, 0.009)
    assert not needs_more(toy.ranking_of(None, base), calibration, 0.001)


def test_what_an_explanation_leaves_is_an_amplitude(toy) -> None:
    base = replace(toy.fit_of(ZERO), chi2=CELLS + 400.0)
    assert left_over(replace(base, chi2=CELLS + 9.0), base) == pytest.approx(0.15)
    assert left_over(replace(base, chi2=CELLS - 3.0), base) == 0.0


@pytest.mark.parametrize(("leaves", "stands"), [(9.0, True), (11.0, False)])
def test_a_form_that_is_not_quite_the_textbooks_stands(toy, leaves, stands) -> None:
    """3 of 20 standard deviations (15 %) may stay where no null is so far off; 3.3 may not."""
    base = replace(toy.fit_of(ZERO), chi2=CELLS + 400.0)
    one = replace(toy.fit_of(ZERO, toy.Effect("a", ZERO)), chi2=CELLS + leaves)
    ranking = toy.ranking_of(toy.problem([0.0] * CELLS), base, singles=[one])
    tests = FitTests.of(ranking, toy.nulls_of(np.zeros((499, CELLS))))
    assert tests.p["a"] == pytest.approx(2.0 / 500)
    assert ("a" in tests.passed) is stands
    assert "baseline" not in tests.passed


def test_probabilities_are_prior_times_evidence(toy) -> None:
    base, one, two = toy.fit_of(ZERO), toy.Effect("a", ZERO), toy.Effect("b", ZERO)
    singles = [toy.fit_of(ZERO, one, lift=math.log(4.0)), toy.fit_of(ZERO, two)]
    ranking = toy.ranking_of(
        toy.problem([0.0] * CELLS), base, singles=singles,
        pairs=[toy.fit_of(ZERO, one, two, lift=math.log(2.0))],
    )  # fmt: skip
    every = frozenset(f.name for f in ranking.fits)
    found = probabilities_of(ranking, FitTests({}, every))
    # priors 1/2, 1/20 outside, 3/10 over two singles, 3/20 on one pair; evidence 1, 1, 4 and 1, 2
    weight = {"baseline": 0.5, OUTSIDE: 0.05, "a": 0.6, "b": 0.15, "a+b": 0.3}
    assert found == pytest.approx({k: w / sum(weight.values()) for k, w in weight.items()})
    assert list(found) == ["a", "baseline", "a+b", "b", OUTSIDE]
    # what is rejected is no explanation: its share is something outside
    without = probabilities_of(ranking, FitTests({}, every - {"a"}))
    assert without["a"] == 0.0
    assert without[OUTSIDE] == pytest.approx(found["a"] + found[OUTSIDE])
