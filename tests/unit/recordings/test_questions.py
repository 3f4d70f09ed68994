"""What a sound set may hold by mistake."""

import pytest
from dentscope.recordings import read
from dentscope.recordings.questions import questions_of

SET = """
format = "recording-set/1"
name = "a"
gravity_m_s2 = {gravity}
[target]
{target}
[strikers.ball]
shape = "sphere"
tip_radius_m = 0.005
mass_kg = 0.004
[noise]
restitution = 0.01
permanent_depth_m = 1e-6
[gauge]
{gauge} = 0.05
"""
HEAD = "trial,striker,angle_deg,impact_speed_m_s,restitution,permanent_depth_m\n"


@pytest.fixture
def asked(tmp_path):
    def make(*rows, **stated):
        usual = {
            "gravity": "9.81", "gauge": "permanent_depth_m", "target": "E_Pa = 2e11\nnu = 0.3"
        }  # fmt: skip
        (tmp_path / "set.toml").write_text(SET.format(**(usual | stated)))
        (tmp_path / "trials.csv").write_text(HEAD + "".join(f"{row}\n" for row in rows))
        return questions_of(read(tmp_path))

    return make


def test_nothing_is_asked_of_a_usual_set(asked):
    # one number alone may well come twice
    assert asked("a,ball,90,1,0.55,1e-5", "b,ball,90,1,0.55,1.1e-5", "c,ball,90,1,0.55,",
                 "d,ball,90,1,0.55,") == []  # fmt: skip


def test_rows_that_say_the_same_are_asked_about(asked):
    (line,) = asked("a,ball,90,1,0.55,1e-5", "b,ball,90,1,0.55,1e-5", "c,ball,90,2,0.55,1e-5")
    assert line.startswith("every number of 1 trials stands in another too (b as a)")


@pytest.mark.parametrize(
    ("row", "stated", "words"),
    [
        ("a,ball,90,1,0.55,1e-5", {"gravity": "981"}, "gravity_m_s2 981: is it in cm/s"),
        ("a,ball,90,1,0.55,1e-5", {"gauge": "peak_force_N"}, "gauge.peak_force_N is not used"),
        (
            "a,ball,90,1,0.55,1e-5",
            {"target": 'material = "hard steel"\nE_Pa = 2e11\nnu = 0.3'},
            "target: no material of the table is called 'hard steel'; assumed: Sy_Pa",
        ),
        ("a,ball,90,1,0.55,1e-2", {}, "permanent_depth_m 0.01 of a is above the tip's radius"),
    ],
)
def test_a_number_in_another_unit_and_one_without_use_are_told(asked, row, stated, words):
    (line,) = asked(row, **stated)
    assert words in line
