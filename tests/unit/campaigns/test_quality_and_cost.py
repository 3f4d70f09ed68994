"""What is stored of a case's quality, and how well the time left is foreseen."""

from dataclasses import replace

import numpy as np
import pytest
from dentscope import fem
from dentscope.campaigns import DESIGNS, Forecast, distinct_cases, quality_of
from dentscope.campaigns.cost import pace_of_this_machine
from dentscope.campaigns.quality import steps_not_in


def curve(**changes):
    depth = np.geomspace(1e-8, 1e-4, 48)
    half = 0.5 * depth
    return {
        "delta": depth,
        "force": depth**1.2,
        "radius": depth**0.55,
        "sphere": half,
        "flat": half,
        "energy_defect": np.full(48, 1e-4),
        **changes,
    }


def test_a_smooth_curve_has_no_step():
    found = quality_of(curve(), 1e-3)
    assert found.largest_step < 1e-9
    assert found.energy_defect == pytest.approx(1e-4)
    assert found.depth_reached == pytest.approx(0.1)


@pytest.mark.parametrize("name", ["force", "radius"])
@pytest.mark.parametrize("height", [0.005, 0.03])
def test_a_step_reads_its_height_wherever_it_lies(name, height):
    smooth = curve()
    for k in range(4, 44):
        jump = np.where(np.arange(48) < k, 1.0, 1.0 + height)
        found = quality_of(curve(**{name: smooth[name] * jump}), 1e-3)
        assert getattr(found, f"{name}_step") == pytest.approx(height, rel=0.02)
        assert found.largest_step == getattr(found, f"{name}_step")


def test_a_step_that_the_finer_solve_shows_too_does_not_count():
    smooth, jump = curve(), np.where(np.arange(48) < 20, 1.0, 1.03)
    both = curve(force=smooth["force"] * jump)
    ripple = curve(force=smooth["force"] * jump, radius=smooth["radius"] * jump)
    force, radius, share = steps_not_in(ripple, both)
    assert force < 1e-9
    assert radius == pytest.approx(0.03, rel=0.02)
    assert share < 1e-9


def test_one_bad_energy_balance_is_what_counts():
    defect = np.full(48, 1e-4)
    defect[7], defect[9] = -0.02, np.nan
    assert quality_of(curve(energy_defect=defect), 1e-3).energy_defect == pytest.approx(0.02)


def survey():
    return list(distinct_cases(DESIGNS["survey"]).values())


def played(cases, costs, *, workers):
    free, ended = [0.0] * workers, []
    for case, cost in zip(cases, costs, strict=True):
        k = int(np.argmin(free))
        free[k] += cost
        ended.append((free[k], case))
    return sorted(ended, key=lambda item: item[0]), max(free)


def test_time_left_is_learned_from_the_cases_that_ended():
    # a machine three times slower, where softness costs more than foreseen, and with scatter
    cases, draw = survey(), np.random.default_rng(3)
    truth = [
        114.0 * (c.pair.E_reduced / c.pair.Sy_min / 300.0) ** 0.8 * draw.lognormal(0.0, 0.2)
        for c in cases
    ]
    # the first case of each worker compiles
    truth[:2] = [t + 600.0 for t in truth[:2]]
    ended, whole = played(cases, truth, workers=2)
    forecast, off = Forecast(cases, workers=2), []
    for at, case in ended[:-1]:
        forecast.end(case, at)
        off.append((forecast.left_s(at) - (whole - at)) / whole)
    # after a sixth of the cases it is within a fifth of the whole run, and it ends well
    assert np.abs(off[10:]).max() < 0.2
    assert np.abs(off[50:]).max() < 0.05


def test_cases_that_ended_before_tell_what_a_run_takes():
    cases = survey()
    known = [(case, 100.0) for case in cases[:32]]
    left = cases[32:]
    assert Forecast(left, workers=1, ended=known).left_s() == pytest.approx(3200.0, rel=0.1)
    assert Forecast(left, workers=4, ended=known).left_s() == pytest.approx(800.0, rel=0.1)
    assert Forecast([], workers=4).left_s() == 0.0
    # those of another resolution tell nothing
    other = [(replace(c, accuracy=fem.Accuracy.smoke()), 1.0) for c, _ in known]
    measured = Forecast(left, workers=1).left_s()
    assert Forecast(left, workers=1, ended=other).left_s() == pytest.approx(measured)


def test_a_slow_machine_is_foreseen_before_anything_ran():
    cases = survey()
    usual = Forecast(cases, workers=2).left_s()
    assert Forecast(cases, workers=2, pace=2.0).left_s() == pytest.approx(2.0 * usual)
    assert 0.1 < pace_of_this_machine() < 100.0
