"""Tuned numbers of readings and conditions where they act, worked out by hand."""

import math
from dataclasses import replace

import numpy as np
import pytest
from dentscope.discrepancy.comparison.cells import cells_of
from dentscope.discrepancy.comparison.derived import derived_columns
from dentscope.discrepancy.curves.readings import Readings, reduced
from dentscope.discrepancy.unknowns.nuisances import nuisances_of
from dentscope.recordings import read


def test_one_repeat_in_ten_may_be_a_slip(toy) -> None:
    """Twenty repeats with two or three far off; three are their noise."""

    def dropped(far):
        c = replace(toy.condition(1.0), trials=tuple(range(20)))
        value = np.full(20, 1.0) + 1e-3 * np.resize([1.0, -1.0], 20)
        value[:far] = 2.0
        read_ = {"restitution": Readings(value, np.full(20, 1e-2))}
        return len(cells_of(read_, np.ones(20), np.full(20, math.nan), [c], {}).notes)

    assert [dropped(2), dropped(3)] == [1, 0]


def test_repeats_tell_their_own_scatter_from_nine_on(toy) -> None:
    """Three deviations to and fro: nine times the variance, eight degrees of freedom."""

    def wider(n):
        c = replace(toy.condition(1.0), trials=tuple(range(n)))
        value = 1.0 + 0.03 * np.resize([1.0, -1.0], n)
        found = cells_of(
            {"restitution": Readings(value, np.full(n, 0.01))}, np.ones(n), np.full(n, math.nan),
            [c], {},
        )  # fmt: skip
        return bool(found.scatters)

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
    from dentscope.discrepancy.comparison.conditions import conditions_of

    def count(times):
        rows = HEAD + f"t0,ball,90,1,0.5,\nt1,ball,90,{times},0.5,\n"
        return len(conditions_of(balls(rows, noise={"restitution": 0.005})))

    assert [count(math.exp(0.049)), count(math.exp(0.051))] == [1, 2]


def test_a_load_repeats_to_three_thousandths_where_nothing_is_said(balls) -> None:
    from dentscope.discrepancy.comparison.conditions import conditions_of

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
