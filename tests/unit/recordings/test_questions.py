"""What a sound set may hold by mistake."""

import pytest
from dentscope.recordings.questions import questions_of
from made_sets import made_set

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
    ("row", "stated", "words"),
    [
        ("a,90,1,0.55,1e-5", {"head": "gravity_m_s2 = 981\n"}, "gravity_m_s2 981: is it in cm/s"),
        (
            "a,90,1,0.55,1e-5",
            {"more": "[gauge]\npeak_force_N = 0.05\n"},
            "gauge.peak_force_N is not used",
        ),
        (
            "a,90,1,0.55,1e-5",
            {"target": 'material = "hard steel"\n'},
            "target: no material of the table is called 'hard steel'; assumed: Sy_Pa",
        ),
        ("a,90,1,0.55,1e-2", {}, "permanent_depth_m 0.01 of a is above the tip's radius"),
        (
            "a,90,1,0.55,1e-5",
            {"contact_time_s": ("0.05",), "noise": f"{USUAL['noise']}contact_time_s = 1e-3\n"},
            "contact_time_s 0.05 of a is above the time of 5 radii, ",
        ),
    ],
)
def test_a_number_in_another_unit_and_one_without_use_are_told(asked, row, stated, words):
    (line,) = asked(row, **stated)
    assert words in line
