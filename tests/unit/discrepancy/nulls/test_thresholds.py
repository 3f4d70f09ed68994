"""What nulls give away, on one or two cells where each number can be worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from dentscope.discrepancy.choice.calibration import (
    ONE_IN,
    Calibration,
    calibrate,
    fit_test,
    given_away,
)
from dentscope.discrepancy.choice.odds import NAMED_AT, OUTSIDE, PRIORS
from dentscope.discrepancy.inference.linear import Linear, Mixture
from scipy.integrate import quad

# 2001 nulls whose first cell is -100 ... 100 and whose second is 0: quantiles are read off
EVEN = np.stack([np.linspace(-100.0, 100.0, 2001), np.zeros(2001)], axis=1)
PLAIN = Mixture((Linear(np.eye(2), np.zeros((2, 0))),), np.zeros(1))


def test_gain_is_the_mean_likelihood_ratio_over_the_places() -> None:
    effect = np.array([[0.0, 0.0], [2.0, 0.0]])
    # ratio 1 at no effect, exp(2 * 2 - 2^2/2) = e^2 at the other
    found = PLAIN.gain(np.array([[2.0, 0.0]]), effect)
    assert found == pytest.approx([math.log(0.5 * (1.0 + math.e**2))], rel=1e-12)


def test_a_bayes_factor_of_twenty_in_one_null_of_twenty_is_nothing_given_away() -> None:
    evidence = np.linspace(0.0, 10.0, 1001)
    assert given_away(evidence) == pytest.approx(9.5 - math.log(ONE_IN))
    assert given_away(0.3 * evidence) == 0.0


def test_offset_and_common_are_read_off_the_nulls(toy) -> None:
    one, two = toy.Effect("one", (1.0, 0.0)), toy.Effect("two", (0.0, 1.0))
    screened = [toy.screened_of(one, [[1.0, 0.0]]), toy.screened_of(two, [[0.0, 1.0]])]
    ranking = toy.ranking_of(None, toy.fit_of([0.0, 0.0]), screened=screened)
    found = calibrate(ranking, toy.nulls_of(EVEN), PLAIN)
    # ln B = x - 1/2: 95 % of x lie below 90, of which ln 20 is allowed; the second gains -1/2
    offset = 89.5 - math.log(20.0)
    assert found.offset == pytest.approx({"one": offset, "two": 0.0, OUTSIDE: 0.0})
    # 97 % of x lie below 94: the odds of what is missing there, less those at which it is named
    prior = PRIORS["singles"] / 2.0 / PRIORS["baseline"]
    odds = prior * math.exp(93.5 - offset) + prior * math.exp(-0.5) + PRIORS[OUTSIDE] / 0.5
    assert found.common == pytest.approx(math.log(odds) - NAMED_AT, abs=1e-6)


def test_nulls_that_give_nothing_take_nothing_off(toy) -> None:
    one = toy.Effect("one", (1.0, 0.0))
    ranking = toy.ranking_of(
        None, toy.fit_of([0.0, 0.0]), screened=[toy.screened_of(one, [[1.0, 0.0]])]
    )
    found = calibrate(ranking, toy.nulls_of(0.01 * EVEN), PLAIN)
    assert (found.offset["one"], found.common, found.second) == (0.0, 0.0, 0.0)


def test_a_pair_counts_from_the_larger_offset_and_the_second_ones() -> None:
    given = Calibration({"one": 3.0, "two": 5.0}, 2.0, 0.5)
    assert given.off(("one",)) == 5.0
    assert given.off(("one", "two")) == 7.5
    assert given.off(()) == 0.0


def test_a_second_mechanism_counts_from_what_sets_of_the_first_give_it(toy) -> None:
    lead, other = toy.Effect("lead", (0.0, 0.0)), toy.Effect("other", (1.0, 0.0))
    screened = [toy.screened_of(lead, [[9.0, 9.0]]), toy.screened_of(other, [[1.0, 0.0]])]
    ranking = toy.ranking_of(
        None, toy.fit_of([0.0, 0.0]), singles=[toy.fit_of([0.0, 0.0], lead)], screened=screened
    )
    # x - 1/2, and 95 % of x lie below 90; the mechanism's own screening does not count
    found = calibrate(ranking, toy.nulls_of(EVEN), PLAIN)
    assert found.second == pytest.approx(89.5 - math.log(20.0))


def test_what_is_outside_counts_from_what_sets_of_the_lead_give_it(toy) -> None:
    """Something wide beside a lead whose sets leave 60 in a cell of the baseline's."""
    lead = toy.Effect("lead", (60.0, 0.0))
    wide = Mixture((Linear(np.diag([3600.0, 1.0]), np.zeros((2, 0))),), np.zeros(1))
    base, one = toy.fit_of([60.0, 0.0]), toy.fit_of([60.0, 0.0], lead)
    ranking = toy.ranking_of(
        None, base, singles=[one], screened=[toy.screened_of(lead, [[60.0, 0.0]])]
    )
    # with noise alone the lead explains its sets better than what is free
    assert calibrate(ranking, toy.nulls_of(0.01 * EVEN), wide).offset[OUTSIDE] == 0.0
    assert calibrate(ranking, toy.nulls_of(EVEN), wide).offset[OUTSIDE] > 1.0


def test_p_is_the_share_of_nulls_that_fit_no_better(toy) -> None:
    nulls = toy.nulls_of([[float(k)] for k in range(1, 100)])
    # 91 ... 99 have a larger square than 90.5: 9 of 99, each rank counted once more
    assert fit_test(toy.fit_of([90.5]), nulls).p_value == pytest.approx((9 + 1) / 100)
    assert fit_test(toy.fit_of([0.0]), nulls).p_value == 1.0


def test_an_explanation_is_fitted_to_each_of_its_own_sets(toy) -> None:
    """Nulls along its effect are taken up by it; across they stay."""
    size = toy.Effect("size", (50.0, 0.0))
    data = [25.0, 3.0]
    along = toy.nulls_of([[10.0, 0.0]] * 99)
    across = toy.nulls_of([[0.0, 10.0]] * 99)
    assert fit_test(toy.fit_of(data, size), along).p_value == pytest.approx(1.0 / 100)
    assert fit_test(toy.fit_of(data, size), across).p_value == 1.0


@pytest.mark.parametrize("chi2", [0.5, 2.0, 6.0, 20.0, 60.0])
def test_what_fits_worse_than_its_own_sets_has_something_beside_it(toy, chi2) -> None:
    """Two cells of unit noise: chi2 is exponential of mean 2, p = exp(-chi2/2)."""
    nulls = toy.nulls_of(np.random.default_rng(1).standard_normal((100_000, 2)))
    found = fit_test(toy.fit_of([math.sqrt(chi2), 0.0]), nulls).log_odds
    p = math.exp(-0.5 * chi2)
    # p values that crowd at 0, over those that are even, for every crowding alike
    asked, _ = quad(lambda xi: xi * p ** (xi - 1.0), 0.0, 1.0)
    assert found == pytest.approx(math.log(asked), abs=0.02 * (1.0 + 0.5 * chi2))


def test_a_perfect_or_a_hopeless_fit_gives_finite_odds(toy) -> None:
    nulls = toy.nulls_of(np.random.default_rng(1).standard_normal((1000, 2)))
    assert fit_test(toy.fit_of([0.0, 0.0]), nulls).log_odds == pytest.approx(-math.log(2.0))
    hopeless = fit_test(toy.fit_of([1e6, 0.0]), nulls).log_odds
    assert 600.0 < hopeless < 700.0
    # nulls without any scatter say nothing of a fit
    assert fit_test(toy.fit_of([3.0]), toy.nulls_of([[1.0]] * 9)).log_odds == 0.0
