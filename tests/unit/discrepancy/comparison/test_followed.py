"""Repeats that follow a column which no simulation knows."""

import math

import numpy as np
import pytest
from dentscope.discrepancy.rules import RULES
from dentscope.discrepancy.unknowns.repeats import Entries, followed_of
from scipy.stats import f_oneway


def sheets(rng, effect, *, noise=0.02, stated=0.02):
    """Three conditions, three entries of four repeats each."""
    names = ("one", "two", "three")
    return [
        Entries(
            tuple(n for n in names for _ in range(4)),
            level + np.repeat([0.0, effect, 2.0 * effect], 4) + rng.normal(0.0, noise, 12),
            np.full(12, stated),
        )
        for level in (0.5, 0.6, 0.7)
    ]  # fmt: skip


def test_the_chance_is_that_of_an_analysis_of_variance():
    """One condition whose scatter exceeds its stated noise: scipy's one-way F test."""
    (one, *_) = sheets(np.random.default_rng(1), 0.2, noise=0.03, stated=1e-3)
    found = followed_of("x_sheets", "restitution", [one], tested=1)
    groups = np.split(one.value, 3)
    assert found.log_p == pytest.approx(math.log(f_oneway(*groups).pvalue), rel=1e-9)
    assert found.span == pytest.approx(groups[2].mean() - groups[0].mean())


def test_a_column_that_matters_is_seen_and_one_that_does_not_is_not():
    rng = np.random.default_rng(2)
    assert followed_of("x_sheets", "restitution", sheets(rng, 0.1), tested=2) is not None
    seen = [followed_of("x_day", "restitution", sheets(rng, 0.0), tested=1) for _ in range(400)]
    # two in four hundred would come up once in sixteen such tests
    assert sum(s is not None for s in seen) <= 2
    assert RULES.false_alarms * 400 < 1.0


def test_entries_without_repeats_are_held_against_the_stated_noise():
    alone = Entries(("a", "b"), np.array([0.5, 0.6]), np.full(2, 0.01))
    assert followed_of("x_oil", "restitution", [alone], tested=1).span == pytest.approx(0.1)
    same = Entries(("a", "a"), np.array([0.5, 0.6]), np.full(2, 0.01))
    assert followed_of("x_oil", "restitution", [same], tested=1) is None
