"""A drift over the order of testing is seen in repeats alone, and seldom where there is none."""

import numpy as np
import pytest
from dentscope.discrepancy.unknowns.repeats import drift_of


def repeats(rng, slope, *, conditions=12, each=3, std=0.01, scatter=1.0):
    order = rng.permutation(conditions * each).reshape(conditions, each) / (conditions * each)
    level = rng.normal(0.0, 1.0, conditions)
    return [
        (
            x,
            y + slope * x + scatter * std * rng.standard_t(5, each) * np.sqrt(0.6),
            np.full(each, std),
        )
        for x, y in zip(order, level, strict=True)
    ]


def test_a_drift_is_measured():
    rng = np.random.default_rng(1)
    found = [drift_of("restitution", repeats(rng, 0.1), observables=2) for _ in range(50)]
    assert all(f is not None for f in found)
    changes = np.array([f.change for f in found])
    assert changes.mean() == pytest.approx(0.1, abs=0.003)
    # the z of each says how far off it is
    errors = np.array([(f.change - 0.1) * f.z / f.change for f in found])
    assert 0.7 < errors.std() < 1.4


@pytest.mark.parametrize("scatter", [1.0, 4.0])
def test_no_drift_is_seen_where_there_is_none(scatter):
    rng = np.random.default_rng(2)
    seen = [drift_of("x", repeats(rng, 0.0, scatter=scatter), observables=1) for _ in range(3000)]
    assert sum(s is not None for s in seen) <= 12


def test_without_order_or_repeats_nothing_is_said():
    one = [(np.array([0.1]), np.array([1.0]), np.array([0.01]))] * 20
    assert drift_of("x", one, observables=1) is None
    unknown = [(np.full(3, np.nan), np.arange(3.0), np.full(3, 0.01))] * 20
    assert drift_of("x", unknown, observables=1) is None
