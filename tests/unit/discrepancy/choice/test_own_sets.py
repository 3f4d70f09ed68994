"""How an explanation fits beside its own sets, on one or two cells worked out by hand."""

import math

import numpy as np
import pytest
from dentscope.discrepancy.choice.thresholds import fit_test
from dentscope.discrepancy.inference.linear import Linear, Mixture
from scipy.integrate import quad

PLAIN = Mixture((Linear(np.eye(2), np.zeros((2, 0))),), np.zeros(1))


def test_gain_is_the_mean_likelihood_ratio_over_the_places() -> None:
    effect = np.array([[0.0, 0.0], [2.0, 0.0]])
    # ratio 1 at no effect, exp(2 * 2 - 2^2/2) = e^2 at the other
    found = PLAIN.gain(np.array([[2.0, 0.0]]), effect)
    assert found == pytest.approx([math.log(0.5 * (1.0 + math.e**2))], rel=1e-12)


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
