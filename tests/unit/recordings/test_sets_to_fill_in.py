"""Recording sets: what comes back, presses, what is to be filled in, what may be wrong."""

import math

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.core.inputs.flow_curve import read_flow_curve
from dentscope.core.rig import Quantity
from dentscope.recordings import Severity, audit, read, write
from dentscope.recordings.questions import questions_of
from dentscope.recordings.setup_file import SetFile, setup_text
from dentscope.reduce.measured import Measured, Trial
from dentscope.reduce.output.into_set import store
from dentscope.reduce.output.row import Row
from dentscope.reduce.reduced import Reduced
from made_sets import STEEL, made_set

SET = """# my notes
format = "recording-set/1"
name = "one"   # of the house

[target]
E_Pa = 2.0e11
nu = 0.3
# to be asked for: density
Sy_Pa = 3.0e8

[strikers.ball]
shape = "sphere"
tip_radius_m = 9.0e-3  # by gauge
mass_kg = "?"
E_Pa = 2.0e11
nu = 0.3

[noise]
restitution = 0.01
"""
TRIALS = "trial,striker,angle_deg,impact_speed_m_s,restitution,x_sheets,note\n"


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "set.toml").write_text(SET)
    (tmp_path / "trials.csv").write_text(TRIALS + "a,ball,90,1.5,0.6,one,\nb,ball,90,1.5,0.5,9,\n")
    return tmp_path


def _reduced(path, restitution=0.61, **keys):
    path.write_text(f"{restitution}")
    return Reduced(
        source=path, values={}, draw=lambda to: to.write_bytes(b""),
        trials=(Trial({"impact_speed_m_s": Measured(1.4, 0.01),
                       "restitution": Measured(restitution, 0.01)}),), **keys,
    )  # fmt: skip


def test_what_is_to_be_filled_in_is_listed_and_nothing_else_reads_the_set(folder):
    with pytest.raises(InputError, match=r"strikers\.ball\.mass_kg: to fill in"):
        read(folder)
    assert read(folder, unfinished=True).to_fill == ("strikers.ball.mass_kg",)


def test_comments_survive_what_is_measured(folder):
    mass = {"mass_kg": Measured(0.0238, 1e-5)}
    store(_reduced(folder / "c.txt", striker=mass, noise={"frame_rate_hz": 500.0}), folder, Row(),
          kind="table", options={})  # fmt: skip
    text = (folder / "set.toml").read_text()
    added = ["mass_kg = {value = 0.0238, std = 1e-05}", "frame_rate_hz = 500.0"]
    assert [line for line in text.splitlines() if line not in SET.splitlines()] == added
    assert [line for line in SET.splitlines() if line not in text.splitlines()] == ['mass_kg = "?"']
    found = read(folder)
    assert found.trials.trial == ("a", "b", "c")
    assert found.setup.strikers["ball"].mass_kg == Quantity(value=0.0238, std=1e-5)
    # what was varied stays beside its trial, and makes conditions of its own
    assert found.trials.varied == {"x_sheets": ("one", "9", "")}
    assert len(set(found.conditions[:2])) == 2


def test_a_ball_is_written_for_a_ball(tmp_path):
    options = {"mass_kg": 0.0027, "diameter_m": 0.04}
    done = store(_reduced(tmp_path / "a.txt"), tmp_path / "new", Row(), kind="sound",
                 options=options)  # fmt: skip
    assert "to fill in: target.E_Pa" in done.notes[0]
    body = read(tmp_path / "new", unfinished=True).setup.strikers["ball"]
    assert (body.shape, body.mass_kg.value, body.tip_radius_m.value) == ("sphere", 0.0027, 0.02)


def test_impossible_rows_are_findings(folder):
    (folder / "set.toml").write_text(SET.replace('"?"', "0.02"))
    rows = TRIALS + "a,ball,90,1.5,4.02,1,\nb,ball,90,1.5,1.02,1,\n"
    (folder / "trials.csv").write_text(rows)
    with pytest.raises(InputError, match=r"trial a, column restitution: 4\.02 above 1") as one:
        read(folder)
    assert len(str(one.value).splitlines()) == 1  # 1.02 ± 0.01 may be 1
    (folder / "trials.csv").write_text(rows.replace("4.02,1,", "4.02,1,a charge went off"))
    assert len(read(folder).trials) == 2


def test_one_raw_file_under_two_names_is_a_finding(folder):
    (folder / "set.toml").write_text(SET.replace('"?"', "0.02"))
    for name in ("c", "d"):
        reduced = _reduced(folder / "same.txt")
        store(reduced, folder, Row(trial=name), kind="table", options={"holds": "height"})
    with pytest.raises(InputError, match=r"trial d: the raw file of trial c again"):
        read(folder)


def test_a_flow_curve_gives_the_strength_and_comes_along(folder, tmp_path):
    text = SET.replace('"?"', "0.02").replace("Sy_Pa = 3.0e8", 'flow_curve = "flat.csv"')
    (folder / "set.toml").write_text(text)
    rows = "0,3.0e8,0.001,293\n0.004,3.2e8,0.001,293\n0,3.5e8,1000,293\n0.1,5e8,1000,293\n"
    head = "plastic_strain,true_stress_Pa,strain_rate_per_s,temperature_K\n"
    (folder / "flat.csv").write_text(head + rows)
    found = read(folder)
    assert found.setup.target.Sy_Pa.value == pytest.approx(3.1e8)
    assert [t.tolist() for t in found.flows["target"].tests] == [[0, 1], [2, 3]]
    write(found, tmp_path / "copy")
    (rise,) = found.flows["target"].rises
    # 353 over 310 MPa at 0.2 %, 356 over 320 at 0.4 %, the last that both reach
    assert rise == pytest.approx((1000.0, 1.126), rel=2e-3)
    assert read(tmp_path / "copy").flows["target"].stress == pytest.approx([3e8, 3.2e8, 3.5e8, 5e8])
    (tmp_path / "copy" / "flat.csv").unlink()
    with pytest.raises(InputError, match=r"target.flow_curve: no such file 'flat.csv'"):
        read(tmp_path / "copy")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("plastic_strain\n0\n1\n", "true_stress_Pa: missing"),
        ("plastic_strain,true_stress_Pa\n0,3e8\n", "one row at its rate"),
        ("plastic_strain,true_stress_Pa\n0,3e8\n0,4e8\n", "row 3.*0 after 0"),
        ("plastic_strain,true_stress_Pa\n-1,3e8\n0,4e8\n", "row 2.*-1"),
        ("plastic_strain,true_stress_Pa\n0,0\n1,4e8\n", "row 2.*true_stress_Pa: 0 .*from 1000"),
        ("plastic_strain,true_stress_Pa\n0,300\n1,4e8\n", r"row 2.*300 MPa would be 3e\+08"),
        ("plastic_strain,true_stress_Pa\n0,3e8\n20,4e8\n", "row 3.*20 % would be 0.2"),
        ("plastic_strain,true_stress_Pa\n0,3e8\n8.76,4e8\n", "to 3; 8.76 % would be 0.0876"),
        ("plastic_strain,true_stress_Pa\n0,\n1,4e8\n", "row 2.*empty"),
        ("plastic_strain,true_stress_Pa\n0,3e8\n1,abc\n", r"^[^\n]*row 3[^\n]*'abc'[^\n]*$"),
    ],
)
def test_mistakes_in_a_flow_curve_name_their_row(tmp_path, text, words):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(InputError, match=words):
        read_flow_curve(tmp_path / "a.csv")


def test_an_environment_of_its_own(folder):
    air = '\n[environment]\nfluid = "argon"\ndensity_kg_m3 = 1.66\npressure_Pa = 101325\n'
    (folder / "set.toml").write_text(SET.replace('"?"', "0.02") + air)
    assert read(folder).setup.environment.density_kg_m3.value == 1.66


def test_writing_changes_only_what_differs():
    setup = SetFile.model_validate({
        "format": "recording-set/1", "target": {},
        "strikers": {"b": {"shape": "sphere", "tip_radius_m": 0.01, "mass_kg": 0.02}},
    })  # fmt: skip
    text = "# first\n" + setup_text(setup)
    assert setup_text(setup, before=setup, text=text) == text


HEAD = ("trial", "angle_deg", "impact_speed_m_s", "restitution", "permanent_depth_m")
USUAL = {
    "target": "", "noise": "restitution = 0.01\npermanent_depth_m = 1e-6\n",
    "more": "[gauge]\npermanent_depth_m = 0.05\n",
}  # fmt: skip


@pytest.fixture
def asked(tmp_path):
    def make(*rows, **stated):
        columns = zip(HEAD, zip(*(row.split(",") for row in rows), strict=True), strict=True)
        return questions_of(made_set(tmp_path, **(USUAL | dict(columns) | stated)))

    return make


def test_nothing_is_asked_of_a_usual_set(asked):
    # one number alone may well come twice
    assert asked("a,90,1,0.55,1e-5", "b,90,1,0.55,1.1e-5", "c,90,1,0.55,",
                 "d,90,1,0.55,") == []  # fmt: skip


def test_rows_that_say_the_same_are_asked_about(asked):
    (line,) = asked("a,90,1,0.55,1e-5", "b,90,1,0.55,1e-5", "c,90,2,0.55,1e-5")
    assert line.startswith("every number of 1 trials stands in another too (b as a)")


@pytest.mark.parametrize(
    ("stated", "words"),
    [
        ({"head": "gravity_m_s2 = 981\n"}, "gravity_m_s2 981: is it in cm/s"),
        ({"more": "[gauge]\npeak_force_N = 0.05\n"}, "gauge.peak_force_N is not used"),
        ({"target": 'material = "hard steel"\n'},
         "target: no material of the table is called 'hard steel'; assumed: Sy_Pa"),
        ({"permanent_depth_m": ("1e-2",)}, "permanent_depth_m 0.01 of a is above the tip's radius"),
        ({"contact_time_s": ("0.05",), "noise": f"{USUAL['noise']}contact_time_s = 1e-3\n"},
         "contact_time_s 0.05 of a is above the time of 5 radii, "),
    ],
)  # fmt: skip
def test_a_number_in_another_unit_and_one_without_use_are_told(asked, stated, words):
    (line,) = asked("a,90,1,0.55,1e-5", **stated)
    assert words in line


TWO = """
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
SIX = """trial,striker,angle_deg,drop_height_m,impact_speed_m_s,restitution,permanent_depth_m
a,rod,90,0.2,,0.5,1.0e-5
b,rod,90,0.2,,0.51,1.1e-5
c,rod,90,0.2,,,1.2e-5
d,rod,45,0.4,,0.4,
e,steel ball,30,0.4,,0.4,
f,steel ball,30,,1.5,0.4,
"""


@pytest.fixture
def sound(tmp_path):
    (tmp_path / "set.toml").write_text(TWO)
    (tmp_path / "trials.csv").write_text(SIX)
    (tmp_path / "traces").mkdir()
    (tmp_path / "traces" / "a.csv").write_text("time_s,tip_height_m\n0,1e-3\n1e-3,0\n2e-3,\n")
    (tmp_path / "profiles").mkdir()
    (tmp_path / "profiles" / "d.csv").write_text("x_m,z_m\n0,0\n1e-6,-1e-6\n")
    return tmp_path


def test_what_is_written_comes_back(sound):
    first = read(sound)
    write(first, sound / "again")
    second = read(sound / "again")
    assert second.setup == first.setup
    assert second.trials.trial == first.trials.trial
    for name, column in first.trials.observables.items():
        np.testing.assert_array_equal(second.trials.observables[name], column)
    np.testing.assert_array_equal(second.trace("a")["tip_height_m"], [1e-3, 0.0, np.nan])
    np.testing.assert_array_equal(second.profile("d")["z_m"], [0.0, -1e-6])
    assert first.notes == second.notes
    assert first.notes[0].startswith("noise.peak_force_N")


def test_height_is_the_normal_speed_of_a_rod_and_the_total_speed_of_a_sphere(sound):
    found = read(sound).approach
    fall = math.sqrt(2 * 9.8 * 0.4)
    np.testing.assert_allclose(found.normal[3:], [fall, fall / 2, 1.5], rtol=1e-14)
    np.testing.assert_allclose(
        found.tangential[3:], [0.0, -fall * math.sqrt(0.75), -1.5 * math.sqrt(3.0)], rtol=1e-14
    )
    np.testing.assert_allclose(found.angle[3:], [math.pi / 4, math.pi / 2, math.pi / 2])


def test_noise_comes_from_set_or_repeats(sound):
    found = read(sound)
    assert found.observed == ("restitution", "permanent_depth_m")
    np.testing.assert_allclose(found.std("restitution")[0], math.hypot(0.01, 0.01))
    assert np.isnan(found.std("restitution")[2])
    depth = found.noise("permanent_depth_m")
    # three repeats 10, 11, 12 um: standard deviation 1 um
    np.testing.assert_allclose(depth.std[1], 1e-6)
    assert depth.degrees == 2


def test_taking_rows_leaves_curves_of_the_others_out(sound):
    some = read(sound).take([0, 5])
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
PRESSED = ("trial", "impact_speed_m_s", "angle_deg", "load_N", "press_rate_per_s",
        "permanent_depth_m", "dent_diameter_m", "recovered_depth_m")  # fmt: skip


PRESSURE, MODULUS = 1.0e9, 2.0e11 / 0.91 / 2.0


def press(name, load, *, diameter=1.0, recovered=1.0):
    a = math.sqrt(load / (math.pi * PRESSURE))
    back = 0.75 * load / (MODULUS * a)
    return name, "", "", load, 1e-3, a**2 / 0.01, diameter * 2.0 * a, recovered * back


def pressed(place, *rows):
    columns = dict(zip(PRESSED, zip(*rows, strict=True), strict=True))
    gauge = "[gauge]\npermanent_depth_m = 0.02\n"
    return made_set(place, STRIKER, target=TARGET, noise=NOISE, more=gauge, **columns)


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
