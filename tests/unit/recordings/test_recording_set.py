"""Recording sets and presses in them: what is written comes back, motion and mechanics follow."""

import math

import numpy as np
import pytest
from dentscope.recordings import Severity, audit, read, write
from made_sets import STEEL, made_set

SET = """
format = "recording-set/1"
name = "two rods"
gravity_m_s2 = 9.8
[target]
E_Pa = { value = 2.0e11, std = 4.0e9 }
nu = 0.3
[strikers.rod]
shape = "rod"
tip_radius_m = 0.01
mass_kg = { value = 0.5, std = 0.001 }
radius_m = 0.01
length_m = 0.3
[strikers."steel ball"]
shape = "sphere"
tip_radius_m = 0.005
mass_kg = 4.1e-3
[noise]
restitution = 0.01
restitution_relative = 0.02
peak_force_N = 3.0
"""
TRIALS = """trial,striker,angle_deg,drop_height_m,impact_speed_m_s,restitution,permanent_depth_m
a,rod,90,0.2,,0.5,1.0e-5
b,rod,90,0.2,,0.51,1.1e-5
c,rod,90,0.2,,,1.2e-5
d,rod,45,0.4,,0.4,
e,steel ball,30,0.4,,0.4,
f,steel ball,30,,1.5,0.4,
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "set.toml").write_text(SET)
    (tmp_path / "trials.csv").write_text(TRIALS)
    (tmp_path / "traces").mkdir()
    (tmp_path / "traces" / "a.csv").write_text("time_s,tip_height_m\n0,1e-3\n1e-3,0\n2e-3,\n")
    (tmp_path / "profiles").mkdir()
    (tmp_path / "profiles" / "d.csv").write_text("x_m,z_m\n0,0\n1e-6,-1e-6\n")
    return tmp_path


def test_what_is_written_comes_back(folder):
    first = read(folder)
    write(first, folder / "again")
    second = read(folder / "again")
    assert second.setup == first.setup
    assert second.trials.trial == first.trials.trial
    for name, column in first.trials.observables.items():
        np.testing.assert_array_equal(second.trials.observables[name], column)
    np.testing.assert_array_equal(second.trace("a")["tip_height_m"], [1e-3, 0.0, np.nan])
    np.testing.assert_array_equal(second.profile("d")["z_m"], [0.0, -1e-6])
    assert first.notes == second.notes
    assert first.notes[0].startswith("noise.peak_force_N")


def test_height_is_the_normal_speed_of_a_rod_and_the_total_speed_of_a_sphere(folder):
    found = read(folder).approach
    fall = math.sqrt(2 * 9.8 * 0.4)
    np.testing.assert_allclose(found.normal[3:], [fall, fall / 2, 1.5], rtol=1e-14)
    np.testing.assert_allclose(
        found.tangential[3:], [0.0, -fall * math.sqrt(0.75), -1.5 * math.sqrt(3.0)], rtol=1e-14
    )
    np.testing.assert_allclose(found.angle[3:], [math.pi / 4, math.pi / 2, math.pi / 2])


def test_noise_comes_from_set_or_repeats(folder):
    found = read(folder)
    assert found.observed == ("restitution", "permanent_depth_m")
    np.testing.assert_allclose(found.std("restitution")[0], math.hypot(0.01, 0.01))
    assert np.isnan(found.std("restitution")[2])
    depth = found.noise("permanent_depth_m")
    # three repeats 10, 11, 12 um: standard deviation 1 um
    np.testing.assert_allclose(depth.std[1], 1e-6)
    assert depth.degrees == 2


def test_taking_rows_leaves_curves_of_the_others_out(folder):
    some = read(folder).take([0, 5])
    assert some.trials.trial == ("a", "f")
    assert set(some.traces) == {"a"}
    assert not some.profiles
    with pytest.raises(ValueError, match="read-only"):
        some.trials.angle_deg[0] = 3.0


STRIKER = f'shape = "sphere"\ntip_radius_m = 5e-3\ndensity_kg_m3 = 7800\n{STEEL}Sy_Pa = 2e9\n'
TARGET = "Sy_Pa = { value = 3.5e8, std = 2.0e7 }\nhardness_Pa = { value = 1.0e9, std = 5.0e7 }\n"
NOISE = """permanent_depth_m_relative = 0.02
dent_diameter_m_relative = 0.01
recovered_depth_m_relative = 0.02
load_N_relative = 0.005
dent_edge = "rim"
"""
HEAD = ("trial", "impact_speed_m_s", "angle_deg", "load_N", "press_rate_per_s",
        "permanent_depth_m", "dent_diameter_m", "recovered_depth_m")  # fmt: skip


PRESSURE, MODULUS = 1.0e9, 2.0e11 / 0.91 / 2.0


def press(name, load, *, diameter=1.0, recovered=1.0):
    a = math.sqrt(load / (math.pi * PRESSURE))
    back = 0.75 * load / (MODULUS * a)
    return name, "", "", load, 1e-3, a**2 / 0.01, diameter * 2.0 * a, recovered * back


def pressed(folder, *rows):
    columns = dict(zip(HEAD, zip(*rows, strict=True), strict=True))
    gauge = "[gauge]\npermanent_depth_m = 0.02\n"
    return made_set(folder, STRIKER, target=TARGET, noise=NOISE, more=gauge, **columns)


def test_a_row_with_a_load_is_a_press_and_normal(tmp_path):
    impact = ("a", 1.0, 90, "", "", 2e-5, 1e-3, "")
    found = pressed(tmp_path, impact, press("p", 400.0), press("q", 800.0))
    assert found.trials.pressed.tolist() == [False, True, True]
    assert np.isnan(found.approach.normal).tolist() == [False, True, True]
    assert found.trials.angle_deg.tolist() == [90.0, 90.0, 90.0]
    assert found.load_std[1:] == pytest.approx([2.0, 4.0])
    assert len(set(found.conditions)) == 3
    assert found.impacts.trials.trial == ("a",)
    assert found.presses.trials.trial == ("p", "q")


def test_presses_alone_need_no_angle_and_come_back(tmp_path):
    found = pressed(tmp_path, press("p", 400.0), press("q", 800.0))
    write(found, tmp_path / "two")
    again = read(tmp_path / "two")
    assert again.setup == found.setup
    assert again.setup.dent_edge == "rim"
    assert again.setup.gauge == {"permanent_depth_m": 0.02}
    assert again.trials.load_N.tolist() == [400.0, 800.0]
    assert again.trials.press_rate_per_s.tolist() == [1e-3, 1e-3]
    assert again.plot().axes[0].get_xlabel() == "load of a press [N]"
    assert "load [N]" in again._repr_html_()


@pytest.mark.parametrize(
    ("wrong", "check"),
    [({}, ""), ({"diameter": 0.5}, "load"), ({"recovered": 2.0}, "recovery")],
)
def test_audit_finds_a_radius_for_a_diameter_and_the_compliance_of_the_machine(
    tmp_path, wrong, check
):
    rows = [press(f"p{k}", load, **wrong) for k, load in enumerate((200.0, 400.0, 800.0))]
    found = audit(pressed(tmp_path, *rows))
    told = [f.check.split()[0] for f in found.of(Severity.CONTRADICTION)]
    assert told == ([check] if check else [])
    if check == "recovery":
        assert "compliance" in found.of(Severity.CONTRADICTION)[0].message
