"""Tuned numbers of the audit where they act, in balances that are worked out by hand."""

import math
from contextlib import nullcontext
from functools import partial

import numpy as np
import pytest
from dentscope.core import InputError
from dentscope.core.rig import StrikerTable
from dentscope.recordings import audit
from dentscope.recordings.checks import motion, press
from dentscope.recordings.checks.contact import _budget, _supply, check_energy, check_force
from dentscope.recordings.checks.findings import Severity
from dentscope.recordings.checks.momentum import MomentumTrials, momentum_misfit
from dentscope.recordings.checks.trial_view import TrialReading
from dentscope.recordings.noise import noise_of
from made_sets import BALL, STEEL, made_set

ROD = f'shape = "rod"\ntip_radius_m = 5e-3\nradius_m = 5e-3\nlength_m = 0.3\nmass_kg = 0.2\n{STEEL}'


@pytest.fixture
def set_of(tmp_path):
    return partial(made_set, tmp_path)


def of_check(findings, name):
    [found] = [f for f in findings if name in f.check]
    return found


@pytest.mark.parametrize(("std", "said"), [(0.024, "CONTRADICTION"), (0.026, "CONSISTENT")])
def test_a_dent_takes_055_of_its_work_at_the_least_and_four_deviations_contradict(std, said):
    """0.55 of 2 J are 0.1 J more than was brought."""
    found = _supply("a", TrialReading(2.0, 0.0), TrialReading(1.0, std))
    assert found.severity is Severity[said]
    assert found.significance == pytest.approx(0.1 / std)


@pytest.mark.parametrize(("lost", "said"), [(2.9, "CAUTION"), (2.7, "CONSISTENT")])
def test_a_dent_explains_half_of_what_was_lost(lost, said) -> None:
    """1.1 of its work of 1 J at the most; half of what was lost is known to 0.15 J."""
    found = _budget("a", TrialReading(1.0, 0.0), TrialReading(lost, 0.3))
    assert found.severity is Severity[said]
    assert found.significance == pytest.approx((0.5 * lost - 1.1) / 0.15)


def test_a_force_that_a_rod_cannot_bear_is_judged_by_a_bound_known_to_a_twentieth(set_of):
    """Yields at 1e8 * pi * 25e-6 N; half as much again is 0.5 of it, in 0.05."""
    bound = 1e8 * math.pi * 25e-6
    found = set_of(
        ROD + "Sy_Pa = 1e8\n", angle_deg=[90], impact_speed_m_s=[10], peak_force_N=[1.5 * bound],
        noise="peak_force_N_relative = 1e-6\n",
    )  # fmt: skip
    assert of_check(check_force(found), "yield").significance == pytest.approx(10.0, rel=1e-3)


def test_a_strength_without_an_error_is_known_to_a_seventh(set_of):
    """A dent of 1 mm: the load's error is 0.5 %, the area's twice 0.1 %, the strength's 15 %."""
    load = 0.1 * 2.84 * 3.5e8 * math.pi * 0.25e-6
    found = set_of(load_N=[load], dent_diameter_m=[1e-3], noise="dent_diameter_m = 1e-6\n")
    # a tenth of the mean pressure where 0.35 are the least
    expected = 0.25 / (0.1 * math.hypot(0.005, 0.002, 0.15))
    seen = of_check(press.check_press_load(found), "load")
    assert seen.significance == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    ("target", "pressure", "said"),
    [
        ("hardness_Pa = { value = 1e9, std = 1e6 }\n", 1.31e9, "CONTRADICTION"),
        ("hardness_Pa = { value = 1e9, std = 1e6 }\n", 1.29e9, "CONSISTENT"),
        ("hardness_Pa = { value = 1e9, std = 1e6 }\n", 0.34e9, "CONTRADICTION"),
        ("hardness_Pa = { value = 1e9, std = 1e6 }\n", 0.36e9, "CONSISTENT"),
        # a strength says nothing of how the metal hardens: four times as much
        ("Sy_Pa = { value = 3.5e8, std = 3.5e5 }\n", 4.1 * 1.3 * 2.84 * 3.5e8, "CONTRADICTION"),
        ("Sy_Pa = { value = 3.5e8, std = 3.5e5 }\n", 3.9 * 1.3 * 2.84 * 3.5e8, "CONSISTENT"),
    ],
)
def test_a_mean_pressure_lies_between_a_third_of_a_hardness_and_a_third_above_it(
    set_of, target, pressure, said
):
    found = set_of(
        target=target, load_N=[pressure * math.pi * 0.25e-6], dent_diameter_m=[1e-3],
        noise="dent_diameter_m = 1e-9\nload_N_relative = 1e-4\n",
    )  # fmt: skip
    assert of_check(press.check_press_load(found), "load").severity is Severity[said]


@pytest.mark.parametrize(
    ("share", "said"),
    [(0.38, "CONTRADICTION"), (0.42, "CONSISTENT"), (1.0, "CONSISTENT"), (1.06, "CONTRADICTION")],
)
def test_what_springs_back_is_half_to_six_sevenths_of_f_over_e_a(set_of, share, said):
    """F/(E' a) is known to 5 %: a quarter of the scale off 0.5 or 0.85 is four of its errors."""
    modulus = 2e11 / 0.91 / 2.0
    scale = 500.0 / (modulus * 0.5e-3)
    back = {0.38: 0.5 - 0.21, 0.42: 0.5 - 0.19, 1.0: 0.85 + 0.19, 1.06: 0.85 + 0.21}[share]
    found = set_of(
        load_N=[500],
        dent_diameter_m=[1e-3],
        recovered_depth_m=[back * scale],
        noise="dent_diameter_m = 1e-9\nrecovered_depth_m = 1e-12\nload_N_relative = 1e-4\n",
    )
    assert of_check(press.check_press_recovery(found), "recovery").severity is Severity[said]


def test_a_contact_is_0975_of_its_circle_of_the_depth_where_no_diameter_was_read(set_of):
    """Between 0.7, sunk in, and 1.25, piled up; half the span is two of its errors."""
    deepest = 5e-5
    a = math.sqrt(2.0 * 5e-3 * deepest - deepest**2)
    back = 0.675 * 500.0 / (2e11 / 0.91 / 2.0 * 0.975 * a)
    found = set_of(
        load_N=[500],
        press_depth_m=[deepest],
        recovered_depth_m=[2.0 * back],
        noise="press_depth_m = 1e-9\nrecovered_depth_m = 1e-12\nload_N_relative = 1e-4\n",
    )
    seen = of_check(press.check_press_recovery(found), "recovery")
    assert seen.expected == pytest.approx(back, rel=1e-9)
    error = back / 0.675 * math.hypot(0.25 * 0.55 / 0.975, 0.05)
    assert seen.significance == pytest.approx((2.0 - 0.85 / 0.675) * back / error, rel=1e-4)


PRESSED = {"load_N": [500], "permanent_depth_m": [4e-5], "recovered_depth_m": [1e-5]}
DEPTHS = "permanent_depth_m = 1e-6\nrecovered_depth_m = 1e-6\npress_depth_m = 1e-6\n"
GAUGE = "[gauge]\npermanent_depth_m = 0.04\npress_depth_m = 0.04\n"


@pytest.mark.parametrize(
    ("deepest", "scales", "z"),
    [*((5e-5 + z * math.sqrt(3.0) * 1e-6, "", z) for z in (3.9, 4.1)),
     (6e-5, "", 10.0 / math.sqrt(3.0)), (6e-5, GAUGE, 10.0 / math.sqrt(3.0 + 1.6**2 + 2.4**2))],
)  # fmt: skip
def test_four_standard_deviations_are_a_mistake_and_the_error_of_a_scale_counts(
    set_of, deepest, scales, z
):
    """What stays and springs back, 50 um, are the depth under load; readings are off by 1 um.

    A scale may be off by 4 %.
    """
    ball = BALL + "Sy_Pa = 2e9\n"
    found = set_of(ball, **PRESSED, press_depth_m=[deepest], noise=DEPTHS + scales)
    seen = of_check(press.check_press_depths(found), "depths")
    assert seen.severity is Severity["CONTRADICTION" if z > 4.0 else "CONSISTENT"]
    assert seen.significance == pytest.approx(z, rel=1e-9)


def test_a_load_without_an_error_is_known_to_half_a_per_cent(set_of):
    found = set_of(
        target="hardness_Pa = { value = 1e9, std = 1e3 }\n",
        load_N=[2e9 * math.pi * 0.25e-6], dent_diameter_m=[1e-3], noise="dent_diameter_m = 1e-9\n",
    )  # fmt: skip
    # twice the hardness where 1.3 of it are the most
    seen = of_check(press.check_press_load(found), "load")
    assert seen.significance == pytest.approx(0.7 / (2.0 * 0.005), rel=1e-4)


def _pulse(set_of, ratio):
    found = set_of(
        angle_deg=[90], impact_speed_m_s=[1], impact_speed_m_s_std=[1e-6], restitution=[1e-9],
        peak_force_N=[4e-3 / ratio / 1e-4], contact_time_s=[1e-4],
        noise="restitution = 1e-6\npeak_force_N_relative = 1e-5\ncontact_time_s = 1e-12\n",
    )  # fmt: skip
    return of_check(motion.check_impulse(found), "impulse")


def test_an_impulse_is_a_quarter_to_all_of_peak_force_times_duration(set_of):
    assert _pulse(set_of, 0.24).severity is Severity.CAUTION
    assert _pulse(set_of, 0.26).severity is Severity.CONSISTENT
    # exact numbers are rounded ones, to 0.3 %: four of these are 1.2 %
    assert _pulse(set_of, 1.01).severity is Severity.CONSISTENT
    assert _pulse(set_of, 1.015).severity is Severity.CONTRADICTION
    assert _pulse(set_of, 1.01).significance == pytest.approx(0.01 / 1.01 / 0.003, rel=1e-4)


@pytest.mark.parametrize(
    ("strength", "said"), [(174, "CAUTION"), (250, "CONSISTENT"), (300, "CONSISTENT")]
)
def test_a_hardness_that_is_not_of_the_strength_is_told(set_of, strength, said):
    """840 MPa are of 300 MPa (2.8); of 174, ln(4.83/2.8) is 4.7 of hypot(3, 5.2, 10) per cent."""
    Sy, hard = f"{{ value = {strength}e6, std = 9e6 }}", "{ value = 840e6, std = 25.2e6 }"
    found = set_of(target=f"Sy_Pa = {Sy}\nhardness_Pa = {hard}\n",
                   angle_deg=[90], impact_speed_m_s=[1])  # fmt: skip
    told = of_check(audit(found).findings, "hardness")
    assert told.severity.name == said
    off = math.log(840 / strength / 2.8) / math.hypot(0.03, 9 / strength, 0.1)
    assert told.significance == pytest.approx(off, abs=1e-9)


DENSE = "density_kg_m3 = 7800\n"
SOLID = 7800.0 * 4.0 / 3.0 * math.pi * 125e-9


def off_by(z):
    """A ball whose stated mass is off by z of its errors, 1 % each."""
    mass = SOLID * (1.0 + z * 0.01)
    return BALL.replace("4e-3", f"{{ value = {mass}, std = {0.01 * mass} }}") + DENSE


@pytest.mark.parametrize(("z", "said"), [(2.25, "CONSISTENT"), (2.45, "CONTRADICTION")])
def test_masses_share_a_fiftieth_of_false_alarms_and_one_alone_has_it_all(set_of, z, said):
    """Two-sided beyond 2.33 is 0.02."""
    found = set_of(off_by(z), angle_deg=[90], impact_speed_m_s=[1])
    assert motion.check_mass(found)[0].severity.name == said


def test_of_several_masses_single_ones_have_a_quarter_of_the_false_alarms(set_of):
    """Two balls, 0.02/4 shared by both: two-sided 0.0025 lies beyond 3.02; together 0.015."""

    def said(first, second):
        other = f"[strikers.other]\n{off_by(second)}"
        found = set_of(off_by(first), more=other, angle_deg=[90], impact_speed_m_s=[1])
        return [f.severity.name for f in motion.check_mass(found)]

    assert said(2.95, -2.95)[:2] == ["CONSISTENT", "CONSISTENT"]
    assert said(3.1, -3.1)[:2] == ["CONTRADICTION", "CONTRADICTION"]
    # both alike: chi squared of 2 z^2 has 0.015 beyond 5.92
    assert said(1.69, 1.69)[2] == "CONSISTENT"
    assert said(1.75, 1.75)[2] == "CONTRADICTION"


def test_exact_sizes_are_rounded_to_three_digits(set_of):
    """Nothing has an error: a mass 1 % off is 1/0.3 of an error."""
    ball = BALL.replace("4e-3", str(1.01 * SOLID)) + DENSE
    found = set_of(ball, angle_deg=[90], impact_speed_m_s=[1])
    assert motion.check_mass(found)[0].significance == pytest.approx(1.0 / 0.3, rel=1e-9)


@pytest.mark.parametrize(("z", "said"), [(2.95, "CONSISTENT"), (3.1, "CONTRADICTION")])
def test_other_checks_share_one_false_alarm_in_two_hundred(set_of, z, said):
    """Half of it goes to the momentum: 0.0025 of chi squared with one degree lies beyond 3.02."""
    fall = math.sqrt(2.0 * 9.81 * 0.5)
    found = set_of(
        angle_deg=[90], drop_height_m=[0.5], impact_speed_m_s=[fall * (1.0 + 0.01 * z)],
        impact_speed_m_s_std=[0.01 * fall],
    )  # fmt: skip
    assert of_check(motion.check_speed(found), "speed").severity.name == said


def test_an_angle_that_stays_may_err_by_a_two_hundredth_of_the_approach():
    """Three exact numbers of a ball that do not agree by 0.01: two of them, 0.01 sqrt 2 apart."""
    ball = StrikerTable(shape="sphere", tip_radius_m=5e-3, mass_kg=4e-3)
    measured = {
        "restitution": (0.5, 0.0),
        "rebound_speed_m_s": (0.52, 0.0),
        "friction_impulse_ratio": (0.0, 0.0),
    }
    given = MomentumTrials(
        ball, np.array([[0.5 * math.pi, 0.0]]), np.array([[1.0, 1e-9]]), np.zeros(1), np.zeros(1),
        {name: np.array([pair]) for name, pair in measured.items()},
    )  # fmt: skip
    misfit, degrees = momentum_misfit(given)
    assert degrees.tolist() == [1.0]
    # each gives way by 0.01 of its 0.005: 2 * 2^2
    assert misfit[0] == pytest.approx(8.0, rel=1e-3)


def test_friction_is_judged_by_the_angle_two_of_its_deviations_aside(set_of):
    """The steeper rod sticks at less; beyond the larger of both limits only."""

    def limit(angle, std):
        found = set_of(
            ROD, angle_deg=[angle], angle_deg_std=[std], impact_speed_m_s=[1],
            friction_impulse_ratio=[0.9], noise="friction_impulse_ratio = 0.01\n",
        )  # fmt: skip
        return of_check(motion.check_friction(found), "friction").expected

    assert limit(60, 1.0) == pytest.approx(limit(58, 1e-9), rel=1e-6)


def _traced(set_of, ends, samples=41):
    """A ball that stays under a half wave of force, which begins at a part of its peak."""
    t = np.linspace(0.0, 1e-4, samples)
    force = 4e-3 * math.pi / 2.0 / 1e-4 * np.sin(math.pi * t / 1e-4)
    force[0] = ends * force.max()
    found = set_of(
        angle_deg=[90], impact_speed_m_s=[1], impact_speed_m_s_std=[1e-6], restitution=[1e-9],
        noise="restitution = 1e-6\nforce_N_relative = 0.003\n",
        trace={"time_s": t, "force_N": force},
    )  # fmt: skip
    return of_check(motion.check_trace(found), "impulse")


def test_a_trace_begins_below_a_twentieth_of_its_peak_and_has_five_samples(set_of):
    assert _traced(set_of, 0.04).severity is Severity.CONSISTENT
    assert _traced(set_of, 0.06).severity is Severity.UNCHECKED
    assert "the trace has" in _traced(set_of, 0.0, samples=4).message
    assert "under the trace" in _traced(set_of, 0.0, samples=5).message


def test_a_speed_without_an_error_is_known_to_a_fiftieth(set_of):
    """A fall of 0.5 m gives 3.13 m/s; 5 % less is 2.5 errors of what was said."""
    fall = math.sqrt(2.0 * 9.81 * 0.5)
    found = set_of(angle_deg=[90], drop_height_m=[0.5], impact_speed_m_s=[0.95 * fall])
    seen = of_check(motion.check_speed(found), "speed")
    assert seen.significance == pytest.approx(0.05 / (0.02 * 0.95), rel=1e-2)


@pytest.mark.parametrize(
    ("column", "value", "fits"),
    [
        ("rebound_spin_rad_s", 0.9e7, True), ("rebound_spin_rad_s", 1.1e7, False),
        ("rebound_speed_m_s", 1.9e4, True), ("rebound_speed_m_s", 2.1e4, False),
        ("permanent_depth_m", 0.09, True), ("permanent_depth_m", 0.11, False),
        ("contact_time_s", 90.0, True), ("contact_time_s", 110.0, False),
        ("peak_force_N", 0.9e10, True), ("peak_force_N", 1.1e10, False),
        ("friction_impulse_ratio", 19.0, True), ("friction_impulse_ratio", 21.0, False),
    ],
)  # fmt: skip
def test_a_number_that_no_contact_shows_is_of_another_unit(set_of, column, value, fits):
    with nullcontext() if fits else pytest.raises(InputError, match=column):
        set_of(angle_deg=[90], impact_speed_m_s=[1], **{column: [value]}, noise=f"{column} = 1\n")


def test_three_trials_of_a_condition_tell_its_scatter():
    """1 and 3 times the mean of 2: relative deviations of a half."""

    def scatter(values, groups):
        std = noise_of("restitution", np.array(values), None, {}, np.array(groups)).std
        return std / np.array(values)

    assert np.isnan(scatter([0.1, 0.3], [0, 0])).all()
    assert scatter([0.1, 0.2, 0.3], [0, 0, 0]) == pytest.approx(0.5)
    # a condition of two has no part in it
    assert scatter([0.1, 0.2, 0.3, 0.1, 0.9], [0, 0, 0, 1, 1]) == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("columns", "apart"),
    [
        ({"angle_deg": [60, 60.9], "impact_speed_m_s": [1, 1]}, 1),
        ({"angle_deg": [60, 61.1], "impact_speed_m_s": [1, 1]}, 2),
        ({"angle_deg": [90, 90], "impact_speed_m_s": [1, 1.019]}, 1),
        ({"angle_deg": [90, 90], "impact_speed_m_s": [1, 1.021]}, 2),
        ({"load_N": [100, 101.9]}, 1),
        ({"load_N": [100, 102.1]}, 2),
        ({"load_N": [100, 100], "press_rate_per_s": [1e-3, 1.6e-3]}, 1),
        ({"load_N": [100, 100], "press_rate_per_s": [1e-3, 1.7e-3]}, 2),
    ],
)
def test_conditions_are_one_within_a_degree_2_per_cent_and_half_a_logarithm_of_a_rate(
    set_of, columns, apart
):
    assert len(set(set_of(ROD, **columns).conditions)) == apart


@pytest.mark.parametrize(
    ("e", "std", "refused"),
    [(1.09, 0.01, False), (1.11, 0.01, True), (1.29, 0.1, False), (1.31, 0.1, True)],
)
def test_a_restitution_above_one_needs_a_reason_beyond_three_errors_and_a_tenth(
    set_of, e, std, refused
):
    row = {"angle_deg": [90], "impact_speed_m_s": [1], "restitution": [e], "restitution_std": [std]}
    with pytest.raises(InputError, match="without a reason") if refused else nullcontext():
        set_of(**row)


def test_a_press_leans_by_half_a_degree_at_the_most(set_of):
    set_of(load_N=[100], angle_deg=[89.6])
    with pytest.raises(InputError, match="angle_deg"):
        set_of(load_N=[100], angle_deg=[89.4])


@pytest.mark.parametrize(
    ("rows", "refused"),
    [
        ([0.588, 5.79, 0.585, 0.58], ["t1"]),
        ([0.588, 5.79, 5.85, 0.585, 0.58], ["t1", "t2"]),  # nor for each other
        ([0.588, 5.79, 0.585], []),  # two others tell no scatter
        ([0.7, 1.02, 1.35, 0.8, 0.6], []),
    ],
)
def test_a_restitution_above_one_does_not_vouch_for_itself(set_of, rows, refused):
    """Its own scatter would be large enough: the rows beside it say how large it is."""
    n = len(rows)
    columns = {"angle_deg": [90] * n, "impact_speed_m_s": [1] * n, "restitution": rows}
    with pytest.raises(InputError) if refused else nullcontext() as told:
        set_of(**columns)
    if refused:
        lines = str(told.value).splitlines()
        assert [line.split("trial ")[1].split(",")[0] for line in lines] == refused
        set_of(**columns, note=["moved" if f"t{i}" in refused else "" for i in range(n)])


@pytest.mark.parametrize(("wide", "said"), [(0.9, "CONSISTENT"), (1.2, "CONTRADICTION")])
def test_the_circle_of_a_dent_takes_no_more_than_all_energy_brought(set_of, wide, said):
    """0.55 p pi a^4 / 4R = m v^2 / 2 at a diameter of `wide` = 1, p = 2.84 S_y."""
    energy = 0.5 * 4e-3 * 2.0**2
    circle = 2.0 * (energy * 4 * 5e-3 / (0.55 * 2.84 * 3.5e8 * math.pi)) ** 0.25
    columns = {
        "angle_deg": [90], "impact_speed_m_s": [2.0], "impact_speed_m_s_std": [0.002],
        "dent_diameter_m": [wide * circle], "dent_diameter_m_std": [1e-7],
    }  # fmt: skip
    target = "Sy_Pa = { value = 3.5e8, std = 1e7 }\n"
    found = of_check(check_energy(set_of(target=target, **columns)), "energy")
    assert found.severity is Severity[said]
    assert 0.55 * found.value / found.expected == pytest.approx(wide**4)
    # 1.1 p pi a^4 / 4R is half of 0.36 of that energy at 0.09 of a^4
    target += "hardness_Pa = { value = 9.94e8, std = 1e7 }\n"
    small = columns | {"dent_diameter_m": [wide * 0.5 * circle], "restitution": [0.8]}
    lack = "CAUTION" if (0.5 * wide) ** 4 < 0.09 else "CONSISTENT"
    found = of_check(check_energy(set_of(target=target, **small, restitution_std=[1e-3])), "energy")
    assert found.severity is Severity[lack]
    # sliding widens a dent
    assert not check_energy(set_of(target=target, **columns, approach_tangential_m_s=[1.0]))


MASS, SPEED, TIME, E = 0.05, 2.0, 1e-4, 0.6
STRIKER = f"""shape = "sphere"
tip_radius_m = 0.0115
mass_kg = {{ value = {MASS}, std = 1e-5 }}
{STEEL}Sy_Pa = 7e8
"""
NOISE = "impact_speed_relative = 0.005\nforce_N_relative = 0.005\nrestitution = 0.005\n"


def judged(folder, *, scale=1.0, restitution=E, upto=1.0, trace=None):
    impulse = MASS * ((1.0 + E) * SPEED + 9.81 * TIME)
    t = np.linspace(0.0, upto * TIME, 401)
    force = scale * impulse * np.pi / (2.0 * TIME) * np.sin(np.pi * t / TIME)
    measured = {} if restitution is None else {"restitution": [restitution]}
    return motion.check_trace(made_set(
        folder, STRIKER, target="Sy_Pa = 3e8\n", noise=f"{NOISE}tip_height_m = 1e-6\n",
        trace=trace or {"time_s": t, "force_N": force}, angle_deg=[90], impact_speed_m_s=[SPEED],
        **measured,
    ))  # fmt: skip


@pytest.mark.parametrize(
    ("scale", "restitution", "severity"),
    [
        (1.0, E, Severity.CONSISTENT),
        (1.015, E, Severity.CONSISTENT),
        (1.1, E, Severity.CONTRADICTION),
        (0.9, E, Severity.CONTRADICTION),
        # without a restitution, anything from 1/1.6 to 2/1.6 of the true impulse may be
        (1.0, None, Severity.CONSISTENT),
        (0.7, None, Severity.CONSISTENT),
        (0.5, None, Severity.CONTRADICTION),
        (1.4, None, Severity.CONTRADICTION),
    ],
)
def test_impulse_of_a_half_sine(tmp_path, scale, restitution, severity):
    (finding,) = judged(tmp_path, scale=scale, restitution=restitution)
    assert finding.severity is severity
    # 2/pi F T of the half sine, by the trapezoidal rule of 400 panels
    assert finding.value == pytest.approx(scale * 0.05 * (1.6 * 2.0 + 9.81e-4), rel=1e-4)


def test_trace_that_stops_under_load_is_not_judged(tmp_path):
    (finding,) = judged(tmp_path, upto=0.7)
    assert finding.severity is Severity.UNCHECKED
    assert "ends at 81% of its peak" in finding.message


def test_a_trace_of_the_motion_alone_is_not_judged(tmp_path):
    heights = {"time_s": [0.0, 1e-5], "tip_height_m": [0.0, 1e-6]}
    assert judged(tmp_path, trace=heights) == []
