"""New trials into a set: kept as written, all or none, and none lost between two at once."""

import subprocess
import sys
from pathlib import Path
from shutil import copytree

import pytest
from dentscope.cli import run
from dentscope.core import InputError, InputErrors
from dentscope.recordings import read
from dentscope.recordings.adding import add_trials
from dentscope.recordings.shipped import set_folder

HEAD = "trial,striker,angle_deg,impact_speed_m_s,restitution,restitution_std"
SHIPPED = set_folder(Path("kharaz-2001-oblique"))


@pytest.fixture
def folder(tmp_path):
    return copytree(SHIPPED, tmp_path / "set")


def rows(folder, text) -> Path:
    path = folder.parent / "rows.csv"
    path.write_text(text)
    return path


def test_rows_go_below_those_that_are_there(folder, prints):
    before = (folder / "trials.csv").read_text()
    first = read(folder)
    striker = first.trials.striker[0]
    path = rows(folder, f"{HEAD},x_day\nslow,{striker},90,1,0.7,0.01,2\n")
    told = prints("recordings", "add", folder, path)
    assert f"1 trial added, {len(first.trials) + 1} trials in all" in told
    now = read(folder)
    assert now.trials.trial == (*first.trials.trial, "slow")
    assert now.trials.varied["x_day"][-2:] == ("", "2")
    assert now.trials.sessions.tolist() == [1.0] * len(first.trials) + [2.0]
    *after, _ = (folder / "trials.csv").read_text().splitlines()
    assert all(x.startswith(y) for x, y in zip(after, before.splitlines(), strict=True))
    rows(folder, f"{HEAD.removeprefix('trial,')}\n{striker},90,2,0.7,0.01\n")
    assert add_trials(folder, path)[1] == ("rows-002",)  # as a sheet's without names
    blank = folder.parent / "blank.csv"  # a head copied from trials.csv
    blank.write_text(f"{HEAD},batch\nb,{striker},90,2,0.7,0.01,\nc,{striker},90,2,0.7,0.01,2\n")
    add_trials(folder, blank)
    assert read(folder).trials.sessions[-4:].tolist() == [2.0, 3.0, 4.0, 2.0]
    with pytest.raises(InputErrors, match="'rows-002' is in the set already"):
        add_trials(folder, path)


def test_a_laboratorys_sheet_is_added_in_its_own_words(folder, errs, prints):
    setup = (folder / "set.toml").read_text().partition("[noise]")
    (folder / "set.toml").write_text(f"{setup[0]}[noise]\nrestitution = 0.01{setup[2]}")
    head = "Versuch;Auftreffgeschwindigkeit [cm/s];e;spot"
    sheet = rows(folder, f"{head}\nB1;120;0,71;A\nB2;140;0,69;A\n")
    assert "'Versuch': names of the trials" in prints("recordings", "add", folder, "--from", sheet)
    now = read(folder).trials
    assert now.trial[-2:] == ("rows-B1", "rows-B2")
    assert now.impact_speed_m_s[-2:] == pytest.approx([1.2, 1.4])
    assert now.sessions[-2:].tolist() == [2.0, 2.0]
    assert now.spot[-2:] == ("A", "A")  # the second blow meets the crater of the first
    before = (folder / "trials.csv").read_bytes()
    other = folder.parent / "other.csv"  # of another ball
    other.write_text("ball diameter (mm);drop height (cm);e\n40;30;0,7\n40;30;0,71\n")
    unlike = errs("recordings", "add", folder, "--from", other)
    assert "ball.tip_radius_m: 0.02 of the sheet" in unlike
    assert "'rows-B1' is in the set already" in errs("recordings", "add", folder, "--from", sheet)
    for words in (["--from", str(sheet), "--striker", "none"], [], ["a.csv", "--sheet", "b"]):
        assert run(["recordings", "add", str(folder), *words]) == 2
    assert (folder / "trials.csv").read_bytes() == before


APPROACH = "trial,striker,angle_deg,impact_speed_m_s"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (f"{APPROACH}\nnew,nobody,90,1\n", "no striker 'nobody'"),
        (f"{APPROACH}\n{{first}},{{striker}},90,1\n", "set already"),
        (f"{APPROACH},e\nnew,{{striker}},90,1,.5\n", "column e"),
        (f"{APPROACH}\nnew,{{striker}},90,-1\n", "row 2, column impact_speed_m_s: -1 .*above"),
        ("trial,striker,angle_deg\nnew,{striker},90\n", "no approach"),
        (f"{APPROACH}\nnew,{{striker}},90,9\n", "column impact_speed_m_s: 9 m/s beyond the rig"),
        (f"{APPROACH}\nnew,{{striker}},10,1\n", "column angle_deg: 10 degrees beyond the rig"),
    ],
)
def test_what_does_not_fit_is_refused_and_nothing_is_written(folder, text, told):
    with (folder / "set.toml").open("a") as stream:
        stream.write("\n[rig]\nspeeds_m_s = [0.3, 4]\nangles_deg = [20, 90]\n")
    before = (folder / "trials.csv").read_bytes()
    trials = read(folder).trials
    path = rows(folder, text.format(first=trials.trial[0], striker=trials.striker[0]))
    with pytest.raises(InputErrors, match=told) as raised:
        add_trials(folder, path)
    assert "rows.csv" in str(raised.value)
    assert (folder / "trials.csv").read_bytes() == before


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("[rig]\nspeeds_m_s = [3, 0.4]", "rig.speeds_m_s"),
        ("[rig]\nspeed = 1", "rig.speed"),
        ("[rig]\nangles_deg = [30, 120]", "rig.angles_deg.*two increasing angles up to 90"),
        ('[rig]\nreads = ["depth"]', "'depth' is none of restitution"),
        ("[rig.minutes]\nstrike = -1", "rig.minutes.strike"),
        ("[rig.minutes]\nstrikes = 1", "rig.minutes.strikes"),
    ],
)
def test_a_rig_that_cannot_be_is_refused_by_its_key(folder, text, told):
    with (folder / "set.toml").open("a") as stream:
        stream.write(f"\n{text}\n")
    with pytest.raises(InputErrors, match=told):
        read(folder)


def test_no_folder_is_made_around_a_set_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match="no such folder"):
        add_trials(tmp_path / "a" / "b", rows(tmp_path / "set", "trial\n"))
    assert not (tmp_path / "a").exists()


@pytest.mark.parametrize("words", [["nowhere.csv"], ["--from", "nowhere.csv"]])
def test_a_table_that_is_missing_is_told_before_what_the_set_lacks(tmp_path, words, errs, prints):
    prints("recordings", "new", tmp_path / "set")
    told = errs("recordings", "add", tmp_path / "set", *words)
    assert told.startswith("nowhere.csv: no such file")


def test_two_at_once_lose_nothing(folder):
    striker = read(folder).trials.striker[0]
    n = len(read(folder).trials)
    busy = []
    for k in range(3):
        path = folder.parent / f"{k}.csv"
        path.write_text(f"{HEAD}\np{k},{striker},90,1,0.7,0.01\n")
        code = (
            "from pathlib import Path; from dentscope.recordings.adding import add_trials; "
            f"add_trials(Path({str(folder)!r}), Path({str(path)!r}))"
        )
        busy.append(subprocess.Popen([sys.executable, "-c", code]))
    assert [process.wait(60) for process in busy] == [0, 0, 0]
    assert len(read(folder).trials) == n + 3
