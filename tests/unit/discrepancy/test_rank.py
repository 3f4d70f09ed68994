"""Ranking, where the baseline misses, and the smallest effect that would show, on linear cells."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.choice.odds import PRIORS
from dentscope.discrepancy.choice.pairs import _candidates, pair_effect, with_pairs
from dentscope.discrepancy.comparison.forward import Point
from dentscope.discrepancy.estimates import limits_of
from dentscope.discrepancy.inference.grid import Axis, Grid
from dentscope.discrepancy.inference.linear import Linear
from dentscope.discrepancy.inference.together import refined
from dentscope.discrepancy.locate import ORDER, locate
from dentscope.discrepancy.rank import rank
from dentscope.discrepancy.report.sentences import limit_rows
from dentscope.discrepancy.rules import RULES
from dentscope.discrepancy.unknowns.covariates import covariates
from dentscope.discrepancy.unknowns.repeats import Drift
from dentscope.dynamics.mechanisms.base import Parameter

RISING = tuple(8.0 * (k - 3.5) for k in range(8))
ALIKE = (20.0,) * 8
LESS = tuple(4.0 * (k - 3.5) for k in range(8))
BENT = tuple(4.0 * (k - 3.5) ** 2 for k in range(8))


@pytest.fixture
def library(toy):
    return (
        toy.Effect("alike", ALIKE),
        toy.Effect("rising", RISING),
        toy.Effect("bent", BENT),
        toy.Effect("faint", (0.01,) * 8),
        toy.Effect("ruled-out", ALIKE, reason="the bodies are of the wrong kind"),
    )


def ranked(toy, library, data, derivative=None):
    simulator = toy.Simulator(toy.problem(data, derivative=derivative))
    return simulator, rank(simulator, mechanisms=library)


def test_the_shape_that_made_the_data_comes_first_with_occams_evidence(toy, library) -> None:
    _, found = ranked(toy, library, 0.5 * np.array(RISING))
    lead, size = found.singles[0], np.linalg.norm(RISING)
    assert lead.name == "rising"
    # known to 1/|shape| = 1/52 of its range: sharpened beyond the five nodes and 241 places
    assert lead.place[0] == pytest.approx(0.5, abs=2e-3)
    assert lead.chi2 < 0.1
    evidences = [f.log_evidence for f in found.singles]
    assert evidences == sorted(evidences, reverse=True)
    # a Gaussian likelihood of width s inside a flat prior: sqrt(2 pi) s times its height
    gain = 0.5 * (0.5 * size) ** 2 + np.log(np.sqrt(2.0 * np.pi) / size)
    assert lead.log_evidence - found.base.log_evidence == pytest.approx(gain, abs=0.02)
    # what cannot act or be seen is excluded with its reason
    assert found.excluded["ruled-out"] == "the bodies are of the wrong kind"
    assert found.excluded["faint"].startswith(
        "its largest plausible effect is 0.03 standard errors"
    )
    assert {s.mechanism.name for s in found.screened} == {"alike", "rising", "bent"}


def test_what_has_no_name_is_kept_apart_with_its_evidence(toy, library) -> None:
    nameless = toy.Effect("nameless", RISING, named=False)
    _, found = ranked(toy, (*library[:1], *library[2:], nameless), 0.5 * np.array(RISING))
    _, named = ranked(toy, library, 0.5 * np.array(RISING))
    (kept,) = found.nameless.values()
    assert kept == pytest.approx(named.singles[0].log_evidence - named.base.log_evidence, abs=1e-9)
    assert "nameless" not in {*found.excluded, *(f.name for f in found.fits)}
    assert [s.mechanism.name for s in found.screened] == ["alike", "bent"]
    _, gone = ranked(toy, (*library, replace(nameless, reason="it cannot act here")), RISING)
    assert gone.nameless == {}
    assert "nameless" not in gone.excluded


def test_what_a_size_multiplies_may_be_off(toy) -> None:
    """A size that multiplies a radius known to 10 % or so is known no better than that."""
    data = 0.5 * np.array(RISING)
    spreads = []
    for error in (0.0, 0.1):
        effect = toy.Effect("rising", RISING, scale_error=error)
        _, found = ranked(toy, (effect,), data)
        lead = found.singles[0]
        places = lead.grid.places()[:, 0]
        mean = lead.weight @ places
        spreads.append(np.sqrt(lead.weight @ (places - mean) ** 2))
    known = 1.0 / np.linalg.norm(RISING)
    assert spreads[0] == pytest.approx(known, rel=0.1)
    off = 0.5 * np.expm1(0.1)
    assert spreads[1] == pytest.approx(np.hypot(known, off), rel=0.05)


def test_what_would_rest_on_an_assumed_modulus_is_excluded(toy, library) -> None:
    waves = toy.Effect("waves", RISING, rests_on=("target",))
    unstated = {"target": ("target",), "striker": ()}
    given = toy.problem(0.5 * np.array(RISING), without_modulus=unstated)
    found = rank(toy.Simulator(given), mechanisms=(*library, waves))
    assert found.excluded["waves"] == (
        "its numbers would rest on the modulus of target, which is not stated"
    )
    assert found.singles[0].name == "rising"


def test_what_a_stated_number_can_follow_is_not_physics(toy, library) -> None:
    """The same data, where an unknown of the sheet has the same shape."""
    _, found = ranked(toy, library, 0.5 * np.array(RISING), np.array(RISING)[:, None])
    assert found.base.chi2 < 0.5
    assert found.base.z[0] == pytest.approx(0.5, abs=0.01)
    assert found.singles[0].log_evidence - found.base.log_evidence < 1.0


def test_an_outlier_loses_its_weight_in_the_problem_that_is_returned(toy, library) -> None:
    data = np.zeros(8)
    data[5] = 40.0
    simulator, found = ranked(toy, library, data)
    assert found.problem.cells.std.tolist() == [1, 1, 1, 1, 1, RULES.outlier_wider, 1, 1]
    assert "given no weight" in found.problem.notes[-1]
    assert "6 m/s" in found.problem.notes[-1]
    # nothing was written into what was given
    assert simulator.problem.cells.std.tolist() == [1.0] * 8
    assert simulator.problem.notes == ()


def test_what_lost_its_weight_no_longer_speaks_for_a_mechanism(toy, library) -> None:
    """A value of 40 along a shape: its evidence is gone with its weight."""
    data = np.zeros(8)
    data[5] = 40.0
    spike = toy.Effect("spike", (0.0, 0.0, 0.0, 0.0, 0.0, 40.0, 2.0, 0.0))
    _, found = ranked(toy, (*library, spike), data)
    for s in found.screened:
        expected = found.base.mixture.gain(found.base.residual[None, :], s.effect)[0]
        assert s.log_bayes == pytest.approx(expected)


def together(toy, data, mutual):
    """A bench that adds to the sum of two effects the product of their sizes times a shape."""

    class Together(toy.Simulator):
        def predict(self, mechanisms, points):
            found = super().predict(mechanisms, points)
            for row, point in zip(found, points, strict=True):
                both = [point.values[m.name]["size"] for m in mechanisms]
                row += math.prod(both) * np.array(mutual) if len(both) == 2 else 0.0
            return found

    return Together(toy.problem(data))


def test_what_two_mechanisms_do_to_each_other_is_part_of_a_pair(toy, library) -> None:
    mutual = np.array([5.0, -5.0] * 4)
    bench = together(toy, 0.2 * np.array(RISING), mutual)
    found = rank(bench, mechanisms=library)
    one, two = (
        next(s for s in found.screened if s.mechanism.name == n) for n in ("rising", "bent")
    )
    both = pair_effect(bench, one, two)
    place = np.array([0.5, 0.4])
    grid = Grid((*one.grid.axes, *two.grid.axes))
    at = grid.index(place)
    x, y = grid.places()[at]
    effect = both(np.zeros(0), place)[at]
    assert effect == pytest.approx(
        x * np.array(RISING) + y * np.array(BENT) + x * y * mutual, abs=1e-6
    )


def test_a_pair_is_found_whose_members_both_act(toy, library) -> None:
    data = 0.5 * np.array(RISING) + 0.4 * np.array(BENT)
    simulator, found = ranked(toy, library, data)
    pair = with_pairs(simulator, found).pairs[0]
    assert pair.name == "rising+bent"
    assert pair.place == pytest.approx([0.5, 0.4], abs=0.02)
    assert pair.log_evidence > found.singles[0].log_evidence + 10.0


def test_a_pair_is_fitted_from_the_unknowns_that_both_leave(toy, library) -> None:
    """One effect alone takes part of the other by an unknown; beside both that stands still."""
    data = 0.5 * np.array(RISING) + 0.4 * np.array(BENT)
    _, found = ranked(toy, library, data, 0.2 * np.array(BENT)[:, None])
    alone = next(f for f in found.singles if f.name == "rising")
    both = max(_candidates(found), key=lambda c: c.gain)
    assert (both.names, abs(both.z[0]) < 0.1 * abs(alone.z[0])) == (("rising", "bent"), True)


@pytest.mark.parametrize(
    ("shape", "aslant", "fitted"),
    [((-3.0,) * 8, True, True), ((-3.0,) * 8, False, False), (LESS, False, True)],
)
def test_two_that_decide_together_or_lead_are_fitted_whatever_their_sum(
    toy, shape, aslant, fitted
) -> None:
    """Beside what rises the other bends what it alone would only move or tilt."""
    effects = (
        toy.Effect("rising", RISING, aslant=aslant), toy.Effect("low", shape, aslant=aslant)
    )  # fmt: skip
    data = 0.5 * np.array(RISING) + 0.8 * np.array(shape) + 0.4 * np.array(BENT)
    simulator = together(toy, data, BENT)
    pairs = with_pairs(simulator, rank(simulator, mechanisms=effects)).pairs
    assert [pair.name for pair in pairs] == ["rising+low"] * fitted


def test_what_a_mechanism_is_made_of_has_no_effect_beside_it(toy) -> None:
    effects = (toy.Effect("rising", RISING, holds=("bent",)), toy.Effect("bent", BENT))
    simulator = together(toy, 0.5 * np.array(RISING) + 0.4 * np.array(BENT), BENT)
    found = with_pairs(simulator, rank(simulator, mechanisms=effects))
    assert (found.pairs, found.unfitted) == ((), {})


def test_a_pair_of_many_parameters_costs_the_sum_of_its_nodes_not_their_product() -> None:
    """Two effects that bend, of three parameters each, and a product of both between them."""
    numbers = tuple(Parameter(k, "-", 0.0, 1.0, "linear", 0.0, "", nodes=9) for k in "abc")
    one, two = SimpleNamespace(name="one"), SimpleNamespace(name="two")
    asked = []

    def predict(mechanisms, points):
        asked.append(len(points))
        rows = []
        for p in points:
            own = [sum(math.exp(0.3 * x) for x in p.values[m.name].values()) for m in mechanisms]
            both = math.prod(own) if len(own) == 2 else 0.0
            rows.append([sum(own), 0.1 * both])
        return np.array(rows)

    grid = Grid(
        tuple(Axis(m.name, p) for m in (one, two) for p in numbers),
        tuple((0.4, 0.6) for _ in range(6)),
    )
    place = np.full(6, 0.5)
    here = predict((one, two), [Point(np.zeros(0), grid.values(place))])[0]
    found = refined(SimpleNamespace(predict=predict), (one, two), grid, np.zeros(0), place, here)
    exact = predict((one, two), [Point(np.zeros(0), grid.values(p)) for p in grid.places()])
    assert found == pytest.approx(exact, rel=1e-3)
    assert sum(asked[1:-1]) < 3**6
    assert np.ptp(exact[:, 1]) > 0.05


def test_no_pairs_where_nothing_that_has_a_name_was_fitted(toy) -> None:
    given = toy.problem([0.0] * 8)
    bare = toy.ranking_of(given, toy.fit_of([0.0] * 8))
    assert with_pairs(toy.Simulator(given), bare).pairs == ()


SPEEDS = [1.0, np.e, np.e**2, np.e**3]


@pytest.fixture
def located(toy):
    def found(residual, level=0.95):
        given = toy.problem(residual, speeds=SPEEDS)
        return locate(given, toy.fit_of(residual), np.random.default_rng(1), level=level)

    return found


def test_only_what_varies_is_a_covariate(toy) -> None:
    found = covariates(toy.problem([0.0] * 4, speeds=SPEEDS))
    # ln v = 0 ... 3: mean 3/2, standard deviation sqrt(5)/2
    assert list(found) == ["impact speed"]
    assert found["impact speed"] == pytest.approx(np.array([-3.0, -1.0, 1.0, 3.0]) / np.sqrt(5.0))


@pytest.mark.parametrize(
    ("residual", "covariate", "trend", "z"),
    [   # the sum over the square root of their number
        ([3.0] * 4, "overall", "recordings lie above the simulation", 6.0),
        ([-3.0] * 4, "overall", "recordings lie below it", -6.0),
        ([-3.0, -1.0, 1.0, 3.0], "impact speed",
         "recording over simulation rises with impact speed", math.sqrt(20.0)),
    ],
)  # fmt: skip
def test_a_miss_is_along_the_condition_that_it_follows(located, residual, covariate, trend, z):
    (miss,) = located(residual).misses
    assert (miss.covariate, miss.trend) == (covariate, trend)
    assert miss.z == pytest.approx(z, rel=0.05)
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
    given = toy.problem([0.0] * 2, speeds=[1.0, 1.0])
    paths = [replace(c, tangential=t) for c, t in zip(given.conditions, (-1.0, 0.0), strict=True)]
    found = covariates(replace(given, conditions=tuple(paths)))
    assert found["angle"] == pytest.approx([-1.0, 1.0])


def test_a_drift_is_a_miss_along_the_order_of_testing(toy) -> None:
    given = toy.problem([0.0] * 4, speeds=SPEEDS, drifts=(Drift("restitution", 0.1, 7.0, -26.0),))
    (miss,) = locate(given, toy.fit_of([0.0] * 4), np.random.default_rng(1)).misses
    assert (miss.observable, miss.covariate) == ("restitution", ORDER)
    assert miss.trend == "recordings rise with the order of testing"


# Standard errors that one alternative has to win to be named, and three nats for its parameter.
PRIOR = math.log(PRIORS["baseline"] / PRIORS["mechanisms"])
NEEDED = math.sqrt(2.0 * (PRIOR / RULES.temper + 3.0))


@pytest.mark.parametrize(
    ("low", "high", "scale", "neutral", "effect", "value"),
    [
        (-8.0, 8.0, "linear", 0.0, lambda x: x, NEEDED),
        (1e-3, 1e1, "log", 0.0, lambda x: 10.0 * x, NEEDED / 10.0),
        (1e5, 1e9, "log", math.inf, lambda x: 1e8 / x, 1e8 / NEEDED),
    ],
)
def test_limit_is_the_value_nearest_to_doing_nothing(low, high, scale, neutral, effect, value):
    own = Parameter("p", "-", low, high, scale, neutral, "", nodes=5)
    grid = Grid((Axis("m", own),))
    found = limits_of(
        SimpleNamespace(
            base=SimpleNamespace(linear=Linear(np.eye(1), np.zeros((1, 0)))),
            problem=SimpleNamespace(n_nuisances=0, conditions=(), by_density={}),
            screened=[
                SimpleNamespace(
                    mechanism=SimpleNamespace(name="m", parameters=(None,)), grid=grid,
                    effect=effect(own.value(grid.places()[:, 0]))[:, None],
                )
            ],
        ),
    )  # fmt: skip
    n = len(grid.fine[0])
    step = (high / low) ** (1.0 / n) - 1.0 if scale == "log" else (high - low) / n / value
    assert abs(found["m"]) == pytest.approx(value, rel=step)
    assert np.abs(effect(found["m"])) > NEEDED


def test_a_limit_is_told_with_its_unit():
    mechanism = SimpleNamespace(name="m", parameters=(Parameter("p_m", "m", 0, 1, "log", 0, ""),))
    ranking = SimpleNamespace(screened=[SimpleNamespace(mechanism=mechanism)])
    told = SimpleNamespace(limits={"m": 1.5e-7}, titles={"m": "it yields"}, ranking=ranking)
    assert limit_rows(told) == (("it yields", "p", "150 nm"),)
