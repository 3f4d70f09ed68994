"""Pairs of real recordings: a side is what the plan says, and a verdict is judged by the plan."""

import json
import math
from cmath import phase

import pytest
from dentscope.core.errors import InputError
from dentscope.discrepancy.estimates import audit_rows
from dentscope.recordings import read
from dentscope.recordings.fetch import read_catalogue
from dentscope.recordings.shipped import FOLDER
from dentscope.studies.interventions import bases, scoring
from dentscope.studies.interventions.bases import base
from dentscope.studies.interventions.edits import write_side
from dentscope.studies.interventions.page import page, scored
from dentscope.studies.interventions.plan import Side, read_plan
from dentscope.studies.interventions.scoring import right_with, right_without
from dentscope.studies.proof.apart import Answer

PAIRS = {pair.name: pair for pair in read_plan()}
KHARAZ = "kharaz-2001-oblique"


@pytest.fixture
def side(tmp_path):
    base(KHARAZ, {}, raw=tmp_path, folder=tmp_path / "made")

    def write(**what):
        write_side(Side(base=KHARAZ, **what), tmp_path / "made", tmp_path / "side")
        return read(tmp_path / "side")

    return write


def said(verdict, *mechanisms, audit=()):
    return {
        "verdict": verdict, "mechanisms": list(mechanisms), "alternatives": [],
        "audit": list(audit), "probabilities": {},
    }  # fmt: skip


def test_there_are_24_pairs_and_their_names_differ():
    assert len(PAIRS) == len(read_plan()) >= 24
    assert all(pair.fair and (pair.named or pair.verdicts) for pair in PAIRS.values())


def test_a_turned_plate_keeps_the_speed(side):
    stated = read(FOLDER / KHARAZ)
    row = list(stated.trials.trial).index("I50")
    before, now = stated.approach, side(rows=["I50"], turned_deg=4.0).approach
    was = complex(abs(before.tangential[row]), before.normal[row])
    there = complex(abs(now.tangential[0]), now.normal[0])
    assert abs(there) == pytest.approx(abs(was), rel=1e-6)
    assert phase(there) - phase(was) == pytest.approx(math.radians(4.0))


def test_what_the_plan_lacks_is_told(side):
    with pytest.raises(InputError, match="names of trials"):
        side(rows=["I99"])


def test_columns_and_keys_are_scaled_and_left_out(side):
    spin = read(FOLDER / KHARAZ).values("rebound_spin_rad_s")
    found = side(
        scaled={"rebound_spin_rad_s": 1.5}, left_out=["friction.coefficient"],
        columns_left_out=["tangential_rebound_m_s", "tangential_rebound_m_s_std"],
    )  # fmt: skip
    assert found.values("rebound_spin_rad_s")[4] == pytest.approx(1.5 * spin[4])
    assert found.setup.friction.coefficient is None
    assert "tangential_rebound_m_s" not in found.observed


def test_a_missed_verdict_is_called_missed():
    spin, mass = PAIRS["spin"], PAIRS["mass"]
    assert right_with(spin, said("outside-library"))
    assert not right_with(spin, said("adequate"))
    assert not right_with(spin, said("missing-physics", "velocity-dependent-friction"))
    assert not right_with(mass, said("adequate"))
    assert right_with(mass, said("adequate", audit=["contradiction: mass of ball: 5 %"]))
    assert right_without(said("adequate"))
    assert not right_without(said("outside-library"))
    assert not right_without(said("adequate", audit=["contradiction: mass of ball: 5 %"]))


def test_silence_has_no_point_and_a_wrong_name_loses_one():
    spin, tilt = PAIRS["spin"], PAIRS["tilt"]
    assert scoring.points(tilt, "with", said("missing-physics", "tilt")) == 1
    assert scoring.points(tilt, "with", said("missing-physics", "adhesion")) == -1
    assert [scoring.points(spin, s, said("undetermined")) for s in ("with", "without")] == [0, 0]
    outside = said("outside-library")
    assert [scoring.points(spin, s, outside) for s in ("with", "without")] == [0, -1]
    rows = [row.split(" | ") for row in scored(list(PAIRS.values()), scoring.outcomes())]
    assert (rows[1][0], rows[1][2]) == ("| always `undetermined`", "0 |")


def only_audited(folder, out, limit_s):
    """In place of a diagnosis, which takes seconds: the audit alone, and nothing named."""
    out.mkdir(parents=True)
    verdict = {**said("undetermined"), "audit": audit_rows(read(folder))}
    (out / "verdict.json").write_text(json.dumps(verdict))
    return Answer(0, "", 0.0)


def test_a_pair_is_asked_once_and_told(tmp_path, monkeypatch):
    monkeypatch.setattr(scoring, "answer", only_audited)
    record, pair = tmp_path / "outcomes.json", PAIRS["printed-mass"]
    found = list(scoring.ask([pair], raw=tmp_path, out=tmp_path, record=record))
    assert [(t.side, t.right) for t in found] == [("with", True), ("without", True)]
    text = page([pair], scoring.outcomes(record))
    assert "With the effect 1 of 1" in text
    assert "audit: mass" in text
    monkeypatch.delattr(scoring, "answer")
    assert list(scoring.ask([pair], raw=tmp_path, out=tmp_path, record=record)) == found


def test_fetched_recordings_that_are_not_there_leave_a_pair_out(tmp_path):
    record = tmp_path / "outcomes.json"
    found = list(scoring.ask([PAIRS["air"]], raw=tmp_path, out=tmp_path, record=record))
    assert [t.right for t in found] == [None, None]
    assert not record.exists()


def test_what_is_made_can_be_fetched():
    listed = {s.name: {f.to for f in s.files} for s in read_catalogue(FOLDER / "fetch.toml").source}
    assert {source for source, _ in bases.MADE.values()} <= set(listed)
    needed = {"golf_ball/data_golfball.xlsx", "first_bounce_heights.txt"}
    assert needed <= listed["ball-bounce-acoustic"]
    assert {f"a4/{k}-{n}-M.csv" for k in (1, 2, 3) for n in (14, 16)} <= listed["marble-on-paper"]


def test_heights_are_read_from_the_authors_arrays(tmp_path):
    (tmp_path / "first_bounce_heights.txt").write_text(
        "pallina3_H1 = np.array([\n [1, 2]\n])\npallina4_H1 = np.array([\n    [63.7, 64.6], \n"
        "    [72.2, 72.0]\n])\npallina4_H0 = np.array([\n    [80],\n    [90]\n])\n"
    )
    _, *rows = bases._heights(tmp_path, 4.0)
    assert rows == ["84.0,63.7,64.6", "94.0,72.2,72.0"]
