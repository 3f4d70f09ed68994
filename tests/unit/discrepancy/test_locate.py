"""Where the baseline misses, on four cells whose contrasts can be added up by hand."""

from dataclasses import replace

import numpy as np
import pytest
from dentscope.discrepancy.locate import ORDER, locate
from dentscope.discrepancy.unknowns.covariates import covariates
from dentscope.discrepancy.unknowns.repeats import Drift

SPEEDS = [1.0, np.e, np.e**2, np.e**3]
BALL = {"length_m": 0.0, "tip_radius_m": 0.01, "mass_kg": 0.1}


@pytest.fixture
def located(toy):
    rig = toy.rig_of(ball=BALL)

    def found(residual, level=0.95):
        given = toy.problem(residual, speeds=SPEEDS, rig=rig)
        return locate(given, toy.fit_of(residual), np.random.default_rng(1), level=level)

    return found


def test_only_what_varies_is_a_covariate(toy, located) -> None:
    rig = toy.rig_of(ball=BALL)
    found = covariates(toy.problem([0.0] * 4, speeds=SPEEDS, rig=rig))
    # ln v = 0 ... 3: mean 3/2, standard deviation sqrt(5)/2
    assert list(found) == ["impact speed"]
    assert found["impact speed"] == pytest.approx(np.array([-3.0, -1.0, 1.0, 3.0]) / np.sqrt(5.0))


def test_a_miss_everywhere_is_a_miss_overall(located) -> None:
    (miss,) = located([3.0, 3.0, 3.0, 3.0]).misses
    # the sum over the square root of their number
    assert (miss.covariate, miss.trend) == ("overall", "recordings lie above the simulation")
    assert miss.z == pytest.approx(6.0, rel=0.05)
    (below,) = located([-3.0, -3.0, -3.0, -3.0]).misses
    assert below.trend == "recordings lie below it"


def test_a_slope_is_a_miss_along_its_condition(located) -> None:
    (miss,) = located([-3.0, -1.0, 1.0, 3.0]).misses
    assert miss.covariate == "impact speed"
    assert miss.trend == "recording over simulation rises with impact speed"
    assert miss.z == pytest.approx(np.sqrt(20.0), rel=0.05)
    assert miss.phase == "free-flight"


def test_misses_come_worst_first(located) -> None:
    found = located([0.0, 4.0, 8.0, 12.0]).misses
    assert [m.covariate for m in found] == ["overall", "impact speed"]


def test_an_observable_that_agrees_has_no_miss_though_a_nuisance_moves_it(toy) -> None:
    """Raising both by one number repairs the first and spoils the second: the first missed."""
    both = toy.problem([3.0, 0.0], speeds=[1.0, 1.0], derivative=np.ones((2, 1)))
    both = replace(both, cells=replace(both.cells, observable=("restitution", "contact_time_s")))
    fitted = toy.fit_of([3.0, 0.0], J=np.ones((2, 1)))
    one, two = locate(both, fitted, np.random.default_rng(1), least=2).misses
    # noise of 1 and a nuisance of 1
    assert (one.observable, one.z) == ("restitution", pytest.approx(3.0 / np.sqrt(2.0), rel=0.05))
    assert (two.observable, two.z) == ("contact_time_s", 0.0)


def test_chance_gives_one_set_in_twenty_a_miss(located) -> None:
    """Over all observables and conditions together, whatever the number of contrasts."""
    draws = np.random.default_rng(2).standard_normal((1000, 4))
    seen = sum(bool(located(r).misses) for r in draws)
    assert 30 <= seen <= 75


def test_an_oblique_ball_has_an_angle_though_it_leans_nowhere(toy) -> None:
    given = toy.problem([0.0] * 2, speeds=[1.0, 1.0], rig=toy.rig_of(ball=BALL))
    paths = [replace(c, tangential=t) for c, t in zip(given.conditions, (-1.0, 0.0), strict=True)]
    found = covariates(replace(given, conditions=tuple(paths)))
    assert found["angle"] == pytest.approx([-1.0, 1.0])


def test_a_drift_is_a_miss_along_the_order_of_testing(toy, located) -> None:
    given = toy.problem([0.0] * 4, speeds=SPEEDS, drifts=(Drift("restitution", 0.1, 7.0, -26.0),),
                        rig=toy.problem([0.0] * 4).rig)  # fmt: skip
    (miss,) = locate(given, toy.fit_of([0.0] * 4), np.random.default_rng(1)).misses
    assert (miss.observable, miss.covariate) == ("restitution", ORDER)
    assert miss.trend == "recordings rise with the order of testing"
