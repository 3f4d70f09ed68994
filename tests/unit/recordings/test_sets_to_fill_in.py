"""Sets that a reduction begins: what is to be filled in, comments that survive, impossible rows."""

import pytest
from dentscope.core.errors import InputError
from dentscope.core.inputs.flow_curve import read_flow_curve
from dentscope.core.rig import Quantity
from dentscope.recordings import read, write
from dentscope.recordings.setup_file import SetFile, setup_text
from dentscope.reduce.measured import Measured, Trial
from dentscope.reduce.output.into_set import store
from dentscope.reduce.output.row import Row
from dentscope.reduce.reduced import Reduced

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
