"""Thresholds from nulls, on one or two cells where each number can be worked out by hand."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.calibration import (
    Calibration,
    calibrate,
    extra_threshold,
    p_fit,
    set_width,
)
from dentscope.discrepancy.inference.linear import Linear
from dentscope.discrepancy.thresholds import gain, null_bayes_factors

# 2001 nulls whose first cell is -100 ... 100 and whose second is 0: quantiles are read off
EVEN = np.stack([np.linspace(-100.0, 100.0, 2001), np.zeros(2001)], axis=1)


def test_gain_is_the_mean_likelihood_ratio_over_the_places() -> None:
    plain = Linear(np.eye(2), np.zeros((2, 0)))
    effect = np.array([[0.0, 0.0], [2.0, 0.0]])
    # ratio 1 at no effect, exp(2 * 2 - 2^2/2) = e^2 at the other
    found = gain(np.array([[2.0, 0.0]]), np.zeros(1), plain, effect)
    assert found == pytest.approx([math.log(0.5 * (1.0 + math.e**2))], rel=1e-12)


def test_bayes_factors_are_those_of_white_residuals(toy) -> None:
    base = toy.fit_of([0.0, 0.0])
    base = replace(base, linear=Linear(4.0 * np.eye(2), np.zeros((2, 0))))
    # standard errors of 2: the draw 1 is a residual 2; the effect 2 is one standard error
    found = null_bayes_factors(toy.nulls_of([[1.0, 0.0]]), base, [np.array([[2.0, 0.0]])])
    assert found == pytest.approx(np.array([[1.0 * 1.0 - 0.5]]), rel=1e-12)


def test_offset_is_one_null_in_twenty_and_the_alarm_three_in_a_hundred(toy) -> None:
    one, two = toy.Effect("one", (1.0, 0.0)), toy.Effect("two", (0.0, 1.0))
    screened = [toy.screened_of(one, [[1.0, 0.0]]), toy.screened_of(two, [[0.0, 1.0]])]
    ranking = toy.ranking_of(None, toy.fit_of([0.0, 0.0]), screened=screened)
    found = calibrate(ranking, toy.nulls_of(EVEN))
    # ln B = x - 1/2: 95 % of x lie below 90; the second gains -1/2 from every null, so nothing
    assert found.offset == pytest.approx({"one": 89.5, "two": 0.0})
    # ln B - offset = x - 90: 97 % of x lie below 94
    assert found.single == pytest.approx(4.0)


def test_an_alarm_needs_at_least_one_nat(toy) -> None:
    one = toy.Effect("one", (1.0, 0.0))
    ranking = toy.ranking_of(
        None, toy.fit_of([0.0, 0.0]), screened=[toy.screened_of(one, [[1.0, 0.0]])]
    )
    assert calibrate(ranking, toy.nulls_of(0.01 * EVEN)).single == 1.0
    assert calibrate(toy.ranking_of(None, ranking.base), toy.nulls_of(EVEN)).single == 1.0


def test_a_gain_counts_from_the_larger_offset_of_a_pair(toy) -> None:
    one, two = toy.Effect("one", (0.0, 0.0)), toy.Effect("two", (0.0, 0.0))
    calibration = Calibration({"one": 3.0, "two": 5.0}, 2.0)
    base = toy.fit_of([0.0, 0.0])
    assert calibration.excess(toy.fit_of([0.0, 0.0], one, lift=10.0), base) == pytest.approx(7.0)
    pair = toy.fit_of([0.0, 0.0], one, two, lift=10.0)
    assert calibration.excess(pair, base) == pytest.approx(5.0)
    assert calibration.needed(pair) == pytest.approx(7.0)
    ranking = toy.ranking_of(
        None, base,
        singles=[toy.fit_of([0.0, 0.0], two, lift=11.0), toy.fit_of([0.0, 0.0], one, lift=10.0)],
    )  # fmt: skip
    assert [f.name for f in calibration.sorted(ranking).singles] == ["one", "two"]


def test_p_is_twice_the_share_of_nulls_that_fit_no_better(toy) -> None:
    given = toy.problem([0.0])
    nulls = toy.nulls_of([[float(k)] for k in range(1, 100)])
    # 91 ... 99 have a larger square than 90.5: 9 of 99, each rank counted once more
    assert p_fit(toy.fit_of([90.5]), nulls, given) == pytest.approx(2.0 * (9 + 1) / 100)
    assert p_fit(toy.fit_of([0.0]), nulls, given) == 1.0


def test_a_misfit_that_a_free_law_takes_up_is_no_noise(toy) -> None:
    """Two cells off alike, as a wrong force law makes them, and nulls off by more, but apart."""
    alike = [[0.001], [0.001]]
    error = SimpleNamespace(freedom=np.array([1e4]), count=1)
    given = toy.problem([6.0, 6.0], derivative=alike, error=error)
    apart = toy.nulls_of([[7.0, -7.0]] * 99)
    assert p_fit(toy.fit_of([6.0, 6.0], J=alike), apart, given) == pytest.approx(2.0 / 100)
    assert p_fit(toy.fit_of([6.0, -6.0], J=alike), apart, given) == 1.0


def test_an_explanation_is_fitted_to_each_of_its_own_sets(toy) -> None:
    """Nulls along its effect are taken up by it; across they stay."""
    size = toy.Effect("size", (50.0, 0.0))
    data = [25.0, 3.0]
    along = toy.nulls_of([[10.0, 0.0]] * 99)
    across = toy.nulls_of([[0.0, 10.0]] * 99)
    given = toy.problem(data)
    assert p_fit(toy.fit_of(data, size), along, given) == pytest.approx(2.0 / 100)
    assert p_fit(toy.fit_of(data, size), across, given) == 1.0


def test_a_second_mechanism_must_beat_one_of_a_hundred(toy) -> None:
    lead, other = toy.Effect("lead", (0.0, 0.0)), toy.Effect("other", (1.0, 0.0))
    screened = [toy.screened_of(lead, [[9.0, 9.0]]), toy.screened_of(other, [[1.0, 0.0]])]
    ranking = toy.ranking_of(None, toy.fit_of([0.0, 0.0]), screened=screened)
    fitted = toy.fit_of([0.0, 0.0], lead)
    # x - 1/2, and 99 % of x lie below 98; the mechanism's own screening does not count
    assert extra_threshold(fitted, ranking, toy.nulls_of(EVEN)) == pytest.approx(97.5)
    assert extra_threshold(fitted, ranking, toy.nulls_of(0.01 * EVEN)) == 2.0


@pytest.mark.parametrize(("scale", "width"), [(0.001, 2.0), (0.04, 3.1), (1.0, 5.0)])
def test_the_reported_set_is_as_wide_as_nulls_fall_behind(toy, scale, width) -> None:
    one, two = toy.Effect("one", (0.0, 0.0)), toy.Effect("two", (0.0, 0.0))
    best, rival = toy.fit_of([0.0, 0.0], one), toy.fit_of([-1.0, 0.0], two)
    pair = toy.fit_of([-2.0, 0.0], one, two)
    ranking = toy.ranking_of(None, toy.fit_of([0.0, 0.0]), singles=[best, rival], pairs=[pair])
    # the rival lies 1 away: x - 1/2, and 95 % of x lie below 90 times the scale; between 2 and 5;
    # a pair is no rival of a single
    assert set_width(best, ranking, toy.nulls_of(scale * EVEN)) == pytest.approx(width)
