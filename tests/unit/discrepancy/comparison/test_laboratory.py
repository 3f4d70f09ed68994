"""What a laboratory does to its numbers: one reading twice, settings that are off, many repeats."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from dentscope.discrepancy.choice.decide import decide
from dentscope.discrepancy.choice.odds import OUTSIDE, Odds
from dentscope.discrepancy.comparison.forward import Point, Simulator
from dentscope.discrepancy.comparison.problem import Problem, problem_of
from dentscope.discrepancy.inference.derivatives import measured_covariance
from dentscope.discrepancy.unknowns.nuisances import Nuisance
from dentscope.recordings import read

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
