"""What a laboratory does to its numbers: readings, settings, repeats, what drifts or follows."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from dentscope.discrepancy.choice.decide import decide
from dentscope.discrepancy.choice.odds import OUTSIDE, Odds
from dentscope.discrepancy.comparison.cells import cells_of
from dentscope.discrepancy.comparison.conditions import conditions_of
from dentscope.discrepancy.comparison.derived import derived_columns
from dentscope.discrepancy.comparison.forward import Point, Simulator
from dentscope.discrepancy.comparison.problem import Problem, problem_of
from dentscope.discrepancy.curves.readings import Readings, reduced
from dentscope.discrepancy.inference.derivatives import measured_covariance
from dentscope.discrepancy.rules import RULES
from dentscope.discrepancy.unknowns.nuisances import Nuisance, nuisances_of
from dentscope.discrepancy.unknowns.repeats import Entries, drift_of, followed_of
from dentscope.recordings import read
from scipy.stats import f_oneway

NOISE = {
    "restitution": 0.01, "rebound_speed_m_s": 0.01, "permanent_depth_m_relative": 0.03,
    "dent_diameter_m_relative": 0.015, "friction_impulse_ratio": 0.01,
    "tangential_rebound_m_s": 0.01,
}  # fmt: skip
BALLS = {"small": (5e-3, 4.1e-3), "large": (1e-2, 3.3e-2)}
FOUR = (("a", 0.5, 0.612), ("b", 1.0, 0.538), ("c", 1.5, 0.497), ("d", 2.0, 0.471))


@pytest.fixture
def problem(tmp_path: Path, set_of_balls: Callable[..., Path]) -> Callable[[str], Problem]:
    return lambda table: problem_of(read(set_of_balls(tmp_path, table, noise=NOISE, balls=BALLS)))


def bounces(rebound: list[float]) -> str:
    head = "trial,striker,angle_deg,impact_speed_m_s,restitution,rebound_speed_m_s\n"
    rows = zip(FOUR, rebound, strict=True)
    return head + "".join(f"{t},small,90,{v},{e},{back:.4f}\n" for (t, v, e), back in rows)


def test_four_bounces_in_two_columns_are_four_numbers(problem) -> None:
    given = problem(bounces([v * e for _, v, e in FOUR]))
    assert given.cells.observable == ("restitution",) * 4
    assert any("rebound_speed_m_s is restitution times" in note for note in given.notes)


def test_a_number_of_one_ball_leaves_the_impacts_of_the_other(problem) -> None:
    """Five impacts, and again the three of the ball whose number moves; nothing else changes."""
    rows = [*FOUR[:3], ("e", 1.0, 0.538), ("f", 2.0, 0.47)]
    balls = ["small"] * 3 + ["large"] * 2
    text = "trial,striker,angle_deg,impact_speed_m_s,restitution\n"
    text += "".join(f"{t},{b},90,{v},{e}\n" for b, (t, v, e) in zip(balls, rows, strict=True))
    given = problem(text)
    one = Nuisance("strikers.small.mass_kg", "kg", 4.1e-3, 0.1, True)
    given = replace(given, nuisances=(one, *given.nuisances))
    z = np.zeros((2, given.n_z))
    z[1, 0] = 1.0
    simulator = Simulator(given)
    counted = []
    for at in (z[0], z[1], z[0]):
        found = simulator.predict((), [Point(at)])
        assert np.array_equal(found, Simulator(given).predict((), [Point(at)]))
        counted.append(simulator.tally["impacts"])
    assert counted == [5, 8, 8]


def test_a_second_instrument_counts(problem) -> None:
    """A hundredth of a metre a second apart, as its noise says: eight numbers."""
    off = (0.01, -0.012, 0.008, -0.01)
    given = problem(bounces([v * e + x for (_, v, e), x in zip(FOUR, off, strict=True)]))
    assert len(given.cells) == 8
    assert not any("counted once" in note for note in given.notes)


def test_a_depth_of_zero_has_no_part_in_what_is_derived(problem) -> None:
    head = "trial,striker,angle_deg,impact_speed_m_s,permanent_depth_m,dent_diameter_m\n"
    rows = [f"{k},small,90,{1 + k},{d},{6e-4 + 2e-4 * k}\n" for k, d in enumerate((0, 1e-5, 4e-5))]
    with np.errstate(all="raise"):
        given = problem(head + "".join(rows))
    assert given.cells.observable.count("permanent_depth_m") == 2


def test_a_depth_that_is_the_cap_of_its_diameter_is_no_depth(problem) -> None:
    head = "trial,striker,angle_deg,impact_speed_m_s,permanent_depth_m,dent_diameter_m\n"
    widths = (6e-4, 8e-4, 1e-3)
    rows = [f"{k},small,90,{1 + k},{d * d / 0.04:.4g},{d}\n" for k, d in enumerate(widths)]
    assert problem(head + "".join(rows)).cells.observable == ("dent_diameter_m",) * 3


def test_an_impulse_ratio_from_the_speeds_is_those_speeds(problem) -> None:
    head = "trial,striker,angle_deg,impact_speed_m_s,restitution,tangential_rebound_m_s,"
    head += "friction_impulse_ratio\n"
    # a sphere at 45 degrees comes with -v along the flat
    rows = [f"{t},small,45,{v},{e},{-0.8 * v},{0.2 * v / ((1 + e) * v):.4f}\n" for t, v, e in FOUR]
    seen = set(problem(head + "".join(rows)).cells.observable)
    assert seen == {"restitution", "tangential_rebound_m_s"}


def test_an_error_of_a_height_is_one_for_all_that_fell_from_it(problem) -> None:
    """Two balls from 0.2 and 0.5 m, each height known to 10 mm: no repeats average that."""
    head = "trial,striker,angle_deg,drop_height_m,drop_height_m_std,restitution\n"
    rows = [
        f"{name}{h}{k},{name},90,{h},0.01,0.5\n"
        for name in ("small", "large") for h in (0.2, 0.5) for k in range(4)
    ]  # fmt: skip
    given = problem(head + "".join(rows))
    heights = [c.setting for c in given.conditions]
    assert heights == ["0.2 m", "0.5 m", "0.2 m", "0.5 m"]
    # v goes with the root of the height: 2.5 and 1 %
    off = np.array([0.025, 0.01, 0.025, 0.01])
    assert [c.setting_spread for c in given.conditions] == pytest.approx(off)
    slope = np.array([-1.0, -2.0, 3.0, -4.0])
    found = measured_covariance(given, slope, np.zeros(4))
    own = np.array([c.speed_spread for c in given.conditions])
    alone = np.diag(given.cells.std**2 + (slope * own) ** 2)
    shared = np.outer(slope * off, slope * off) * np.equal.outer(heights, heights)
    np.testing.assert_allclose(found, alone + shared)
    # what is not stated is as before: apart in every condition
    unknown = tuple(replace(c, setting_spread=0.0) for c in given.conditions)
    np.testing.assert_allclose(
        measured_covariance(replace(given, conditions=unknown), slope, np.zeros(4)), alone
    )


def test_sixty_readings_at_six_heights_are_not_too_few(toy) -> None:
    """Heights within 5 % in speed share a simulation; what they say is not less for it."""
    given = toy.problem([0.0] * 4)
    given.cells.count[:] = 15
    effect = toy.Effect("a", (0.0,) * 4)
    ranking = toy.ranking_of(
        given, toy.fit_of((0.0,) * 4), singles=[toy.fit_of((0.0,) * 4, effect)]
    )
    names = {"a": ("a",), "baseline": (), OUTSIDE: ()}
    odds = Odds(names, {"a": 0.97, "baseline": 0.02, OUTSIDE: 0.01})
    assert decide(ranking, odds).verdict == "missing-physics"


def repeats(rng, slope, *, conditions=12, each=3, std=0.01, scatter=1.0):
    order = rng.permutation(conditions * each).reshape(conditions, each) / (conditions * each)
    level = rng.normal(0.0, 1.0, conditions)
    wide = scatter * std * np.sqrt(0.6)
    return [
        (x, y + slope * x + wide * rng.standard_t(5, each), np.full(each, std))
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


def cells_of_repeats(toy, value):
    n = len(value)
    c = replace(toy.condition(1.0), trials=tuple(range(n)))
    readings = {"restitution": Readings(value, np.full(n, 0.01))}
    return cells_of(readings, np.ones(n), np.full(n, math.nan), [c], {})


def test_one_repeat_in_ten_may_be_a_slip(toy) -> None:
    """Twenty repeats with two or three far off; three are their noise."""

    def dropped(far):
        value = np.full(20, 1.0) + 1e-3 * np.resize([1.0, -1.0], 20)
        value[:far] = 2.0
        return len(cells_of_repeats(toy, value).notes)

    assert [dropped(2), dropped(3)] == [1, 0]


def test_repeats_tell_their_own_scatter_from_nine_on(toy) -> None:
    """Three deviations to and fro: nine times the variance, eight degrees of freedom."""

    def wider(n):
        return bool(cells_of_repeats(toy, 1.0 + 0.03 * np.resize([1.0, -1.0], n)).scatters)

    assert [wider(8), wider(9)] == [False, True]


@pytest.mark.parametrize("known", [True, False])
def test_repeats_differ_by_the_error_of_their_speeds_too(toy, known) -> None:
    """Speeds read to 1 %, a spin to 0.01 %: what moves it to the mean speed scatters by 1 %."""
    n = 12
    speed = 2.0 * (1.0 + 0.01 * np.resize([1.0, -1.0], n))
    spread = 0.01 / math.sqrt(n) if known else 0.0
    c = replace(toy.condition(2.0), trials=tuple(range(n)), speed_spread=spread)
    read_ = {"rebound_spin_rad_s": Readings(np.full(n, 100.0), np.full(n, 0.01))}
    found = cells_of(read_, speed, np.arange(n) + 0.0, [c], {})
    assert bool(found.scatters) is not known
    # the error of the mean speed is an unknown of its own: that of the readings is left
    assert bool(found.cells.std[0] < 0.01) is known


def test_the_noise_of_a_curve_is_that_of_forty_copies() -> None:
    calls = []

    def peak(curve):
        calls.append(curve["force_N"])
        return {"peak_force_N": float(curve["force_N"].max())}

    curve = {"time_s": np.arange(3.0), "force_N": np.array([0.0, 1.0, 0.0])}
    value, std = reduced(curve, {"force_N": 0.01}, peak, seed=0)["peak_force_N"]
    assert value == 1.0
    assert len(calls) == 41
    # a deviation of forty draws is known to a ninth
    assert std == pytest.approx(0.01, rel=0.35)


@pytest.fixture
def balls(set_of_balls, tmp_path):
    return lambda rows, **more: read(set_of_balls(tmp_path, rows, **more))


HEAD = "trial,striker,angle_deg,impact_speed_m_s,restitution,rebound_speed_m_s\n"


def test_a_column_is_derived_that_is_another_to_a_fifth_of_its_noise_in_three_trials(balls) -> None:
    def derived(n, off):
        rows = HEAD + "".join(
            f"t{k},ball,90,2,0.5,{1.0 + off * 0.01 * (-1) ** k}\n" for k in range(n)
        )
        found = balls(rows, noise={"restitution": 0.005, "rebound_speed_m_s": 0.01})
        given = {n: Readings(found.values(n), found.std(n)) for n in found.observed}
        return bool(derived_columns(found, given))

    assert [derived(3, 0.19), derived(3, 0.21), derived(2, 0.0)] == [True, False, False]


def test_speeds_are_known_to_three_thousandths_and_those_of_a_fall_to_five(toy, balls) -> None:
    rows = HEAD + "t0,ball,90,2,0.5,\n"
    found = balls(rows, noise={"restitution": 0.005})

    def spread(height):
        around = replace(toy.condition().around, from_height=height)
        given = [replace(toy.condition(), around=around)]
        return next(n.spread for n in nuisances_of(found, given) if n.name == "speed.scale")

    assert (spread(False), spread(True)) == (0.003, 0.005)


def test_impacts_within_a_twentieth_of_a_speed_are_one_condition(balls) -> None:
    def count(times):
        rows = HEAD + f"t0,ball,90,1,0.5,\nt1,ball,90,{times},0.5,\n"
        return len(conditions_of(balls(rows, noise={"restitution": 0.005})))

    assert [count(math.exp(0.049)), count(math.exp(0.051))] == [1, 2]


def test_a_load_repeats_to_three_thousandths_where_nothing_is_said(balls) -> None:
    head = "trial,striker,load_N,permanent_depth_m\n"
    rows = head + "".join(f"t{k},ball,400,2e-5\n" for k in range(4))
    [c] = conditions_of(balls(rows, noise={"permanent_depth_m_relative": 0.02}))
    assert c.speed_spread == pytest.approx(0.003 / 2.0)


def test_a_rim_is_a_twentieth_wider_within_three_per_cent(balls, toy) -> None:
    head = "trial,striker,angle_deg,impact_speed_m_s,dent_diameter_m\n"
    found = balls(
        head + "t0,ball,90,1,1e-3\n", noise={"dent_diameter_m": 1e-5, "dent_edge": '"rim"'}
    )
    [scale] = [n for n in nuisances_of(found, [toy.condition()]) if "rim" in n.note]
    assert (scale.value, scale.spread) == (1.05, 0.03)


def test_a_body_of_which_nothing_is_said_is_of_steel(balls, toy) -> None:
    head = "trial,striker,angle_deg,impact_speed_m_s,restitution\n"
    found = balls(head + "t0,ball,90,1,0.5\n", noise={"restitution": 0.005})
    bare = found.setup.target.model_copy(update={"E_Pa": None, "nu": None})
    found = replace(found, setup=found.setup.model_copy(update={"target": bare}))
    modulus = next(n for n in nuisances_of(found, [toy.condition()]) if n.name == "target.E_Pa")
    assert modulus.value == 200e9
