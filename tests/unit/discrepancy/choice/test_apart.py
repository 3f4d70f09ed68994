"""The law's error apart in every number, and the mean of both its forms, worked out by hand."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.choice.apart import apart, weighed
from dentscope.discrepancy.choice.odds import OUTSIDE, PRIORS, Odds, odds_apart, pooled
from scipy.stats import chi2, multivariate_normal

SHARED = [[2.0], [2.0]]  # an error of the law that both numbers share
LAW = SimpleNamespace(freedom=np.ones(1), count=1, parts={}, rows={})


def ranking(toy, data, shape):
    """Two numbers of unit noise, and one mechanism over its grid."""
    effect = toy.Effect("a", shape)
    problem = toy.problem(data, derivative=SHARED, error=LAW)
    fits = [toy.fit_of(data, *who, J=SHARED) for who in ((), (effect,))]
    grid = fits[1].grid.places() * np.array(shape)
    return toy.ranking_of(
        problem, fits[0], singles=fits[1:], screened=[toy.screened_of(effect, grid)]
    )


def test_the_law_error_is_as_large_and_shared_by_nothing(toy) -> None:
    found = ranking(toy, [3.0, 3.0], (3.0, 3.0))
    base = found.base
    assert base.linear.total == pytest.approx(np.array([[5.0, 4.0], [4.0, 5.0]]))
    assert apart(base.linear, base, found.problem).total == pytest.approx(5.0 * np.eye(2))


def test_evidence_and_fit_are_those_of_the_normal_distribution(toy) -> None:
    data = np.array([3.0, 3.0])
    found = ranking(toy, data, (3.0, 3.0))
    normal = multivariate_normal(np.zeros(2), 5.0 * np.eye(2))
    each = weighed(found)
    assert each["baseline"].log_evidence == pytest.approx(float(normal.logpdf(data)))
    assert math.exp(each["baseline"].log_p) == pytest.approx(chi2.sf(18.0 / 5.0, 1.0 * 2))
    effects = found.singles[0].grid.places() * np.array([3.0, 3.0])
    asked = np.log(np.mean(normal.pdf(data - effects)))
    assert each["a"].log_evidence == pytest.approx(float(asked))


def test_what_the_law_can_follow_stands_out_where_it_cannot(toy) -> None:
    """Both numbers off alike: the shared error takes it up, the one apart does not."""
    found = ranking(toy, [9.0, 9.0], (9.0, 9.0))
    inside = found.singles[0].log_evidence - found.base.log_evidence
    each = weighed(found)
    assert each["a"].log_evidence - each["baseline"].log_evidence > 1.5 * inside > 0.0


@pytest.mark.parametrize(("left", "inside"), [(0.0, 0.9), (5.6, 0.9), (5.9, 0.18), (30.0, 0.18)])
def test_outside_has_its_prior_and_most_where_the_leader_does_not_fit(toy, left, inside) -> None:
    """A variance of 5: beyond 5.76 lies one in a hundred; a fifth of it stays."""
    found = odds_apart(ranking(toy, [20.0, left], (20.0, 0.0)))
    assert found.outside == pytest.approx(1.0 - inside)
    assert found.probability["a"] == pytest.approx(inside, abs=1e-3)
    assert PRIORS[OUTSIDE] == pytest.approx(0.1)


def test_both_forms_are_as_likely(toy) -> None:
    names = {"baseline": (), OUTSIDE: (), "a": ("a",)}
    one = Odds(names, {"baseline": 0.7, "a": 0.2, OUTSIDE: 0.1}, {"a": 0.08})
    other = Odds(names, {"a": 0.9, OUTSIDE: 0.1, "baseline": 0.0})
    found = pooled(one, other)
    assert list(found.probability) == ["a", "baseline", OUTSIDE]
    assert list(found.probability.values()) == pytest.approx([0.55, 0.35, 0.1])
    assert found.beside == pytest.approx({"a": 0.04})
