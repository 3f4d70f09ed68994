"""Commands of recording sets, adding, fetching; sets made in memory that survive their files."""

import hashlib
import re
import subprocess
import sys
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from shutil import copytree

import numpy as np
import pytest
from dentscope.cli import run
from dentscope.core import InputError, InputErrors
from dentscope.core.observables import OBSERVABLES
from dentscope.core.rig import Quantity, StrikerTable, TargetTable
from dentscope.recordings import CONDITIONS, MEASURED, RecordingSet, SetFile, Trials, read, write
from dentscope.recordings.adding import add_trials
from dentscope.recordings.fetch import fetch_sources, read_catalogue
from dentscope.recordings.shipped import set_folder
from hypothesis import given, settings
from hypothesis import strategies as st
from made_processes import python

DATA = Path(__file__).parents[3] / "data" / "recordings"


@pytest.mark.parametrize(("option", "count"), [([], 10), (["--rod"], 12)])
def test_template_is_a_set_to_fill_in(tmp_path, option, count, errs, prints):
    prints("recordings", "new", tmp_path / "set", *option)
    header = (tmp_path / "set" / "trials.csv").read_text()
    assert ",restitution,permanent_depth_m,dent_diameter_m," in header
    lines = errs("recordings", "check", tmp_path / "set").splitlines()
    assert sum("to fill in" in line for line in lines) == count
    assert "no trial" in lines[-1]
    assert len(lines) == count + 1


def test_audit_prints_contradictions_and_all_checks_on_request(prints):
    text = prints("recordings", "audit", DATA / "thesis-chapter-5")
    assert "contradiction: mass of rod: 0.4607 kg stated" in text
    assert "friction" not in text
    text = prints("recordings", "audit", DATA / "thesis-chapter-5", "--all")
    assert "consistent: friction of A20" in text


def test_list_names_every_set(prints):
    text = prints("recordings", "list", DATA)
    assert len(text.splitlines()) == len(list(DATA.glob("*/set.toml")))
    assert "thesis-chapter-3: 3 trials; restitution, permanent_depth_m" in text


numbers = st.floats(1e-6, 1.0, allow_nan=False)
moduli = st.floats(1e7, 1e11).map(lambda value: Quantity(value=value))
words = st.text(st.characters(exclude_categories=["Cs", "Cc"]), max_size=20).filter(
    lambda s: s != "?"  # asks to be filled in
)
names = st.text("abcdefgh 0123456789-_.", min_size=1, max_size=8).filter(
    lambda s: s == s.strip() and s not in (".", "..")
)


def test_list_goes_on_after_a_set_that_is_not_sound(tmp_path, errs, prints):
    assert "no set in it" in errs("recordings", "list", tmp_path)
    for name in ("a", "b"):
        write(read(DATA / "leeb-steel-300hv"), tmp_path / name)
    (tmp_path / "a" / "trials.csv").write_text("trial\n")
    first, second = prints("recordings", "list", tmp_path).splitlines()
    assert first.startswith("a: ")
    assert "row 1, column striker: missing" in first
    assert second.startswith("b: ")


@settings(max_examples=40, deadline=None)
@given(data=st.data())
def test_any_sound_set_comes_back_from_its_files(data, tmp_path_factory):
    # known to its own size at the worst
    quantity = st.builds(
        lambda value, share: Quantity(value=value, std=share * value),
        numbers,
        st.just(0.0) | st.floats(1e-6, 1.0),
    )
    rod = StrikerTable(
        shape="rod",
        # a name close to a listed one, without what that would give, is refused as mistyped
        material=data.draw(words.map(lambda word: f"made up, {word}")),
        tip_radius_m=data.draw(quantity),
        mass_kg=data.draw(quantity),
        radius_m=data.draw(quantity),
        length_m=data.draw(quantity),
        E_Pa=data.draw(st.none() | moduli),
    )
    observable = data.draw(st.sampled_from([k for k in MEASURED if "impact" in OBSERVABLES[k].of]))
    striker = data.draw(names)
    setup = SetFile(
        format="recording-set/1",
        description=data.draw(words),
        target=TargetTable(E_Pa=data.draw(st.none() | moduli), law=data.draw(st.sampled_from(
            ["elastic-plastic", "table", "elastic", "measured-restitution"]))),
        strikers={striker: rod},
        noise={observable: data.draw(numbers)},
    )  # fmt: skip
    trial = data.draw(st.lists(names, min_size=1, max_size=4, unique=True))
    n = len(trial)
    # no dent is wider than the tip
    read_off = st.floats(1e-6, min(0.1, 2.0 * rod.tip_radius_m.value))
    values = data.draw(st.lists(read_off | st.just(np.nan), min_size=n, max_size=n))
    trials = Trials(
        trial=tuple(trial),
        striker=(striker,) * n,
        angle_deg=np.array(data.draw(st.lists(st.floats(0.1, 90), min_size=n, max_size=n))),
        drop_height_m=np.array(data.draw(st.lists(numbers, min_size=n, max_size=n))),
        # a restitution above 1 needs a reason
        note=("made up",) * n,
        observables={observable: np.array(values)},
    )
    folder = tmp_path_factory.mktemp("set")
    write(RecordingSet(setup, trials), folder)
    found = read(folder)
    assert found.setup == setup
    assert found.trials.trial == trials.trial
    np.testing.assert_array_equal(found.trials.angle_deg, trials.angle_deg)
    np.testing.assert_array_equal(found.trials.drop_height_m, trials.drop_height_m)
    np.testing.assert_array_equal(found.values(observable), trials.observables[observable])


def test_the_documentation_names_every_key_and_column_and_its_block_runs(monkeypatch):
    text = (DATA.parents[1] / "docs" / "recording-set.md").read_text(encoding="utf-8")
    for name in (*CONDITIONS, *MEASURED, *TargetTable.model_fields, *StrikerTable.model_fields):
        assert f"`{name}`" in text or f"`{name} =" in text, name
    (block,) = re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)
    monkeypatch.chdir(DATA.parents[1])
    names = {}
    exec(compile(block, "recording-set.md", "exec"), names)
    assert names["found"].setup.strikers["rod"].mass_kg.value == 0.4607


def test_help_on_a_reduction_loads_nothing_that_reduces():
    listed = "import sys; from dentscope.reduce.kinds import KINDS, load_kind; "
    listed += "import dentscope.reduce.output.row; [load_kind(k) for k in KINDS]; "
    listed += "heavy = {'scipy', 'matplotlib', 'numba', 'skimage'} & set(sys.modules); "
    python("-c", listed + "assert not heavy, heavy", check=True)


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *args):
        pass


@pytest.fixture
def server(tmp_path):
    folder = tmp_path / "served"
    (folder / "a b").mkdir(parents=True)
    (folder / "a b" / "x, 1.csv").write_bytes(b"1,2\n")
    http = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(folder)))
    thread = threading.Thread(target=http.serve_forever, daemon=True)
    thread.start()
    yield f"http://127.0.0.1:{http.server_port}/"
    http.shutdown()
    thread.join()
    http.server_close()


def catalogue(tmp_path, base, sha, path="a b/x, 1.csv"):
    file = tmp_path / "fetch.toml"
    file.write_text(
        f'[[source]]\nname = "one"\nlicence = "none stated"\nbase = "{base}"\n'
        f'[[source.files]]\npath = "{path}"\nto = "sub/x.csv"\nsha256 = "{sha}"\n'
    )
    return read_catalogue(file)


def test_file_arrives_once_and_is_kept(tmp_path, server):
    found = catalogue(tmp_path, server, hashlib.sha256(b"1,2\n").hexdigest())
    (got,) = fetch_sources(found, tmp_path / "out", [])
    assert got.files[0].read_bytes() == b"1,2\n"
    before = got.files[0].stat().st_mtime_ns
    (again,) = fetch_sources(found, tmp_path / "out", ["one"])
    assert again.files[0].stat().st_mtime_ns == before


def test_other_checksum_missing_file_and_unknown_name_are_lines(tmp_path, server):
    wrong = catalogue(tmp_path, server, "0" * 64)
    with pytest.raises(InputError, match="another checksum"):
        list(fetch_sources(wrong, tmp_path / "out", []))
    assert not (tmp_path / "out" / "one" / "raw" / "sub" / "x.csv").exists()
    gone = catalogue(tmp_path, server, "0" * 64, path="nothing.csv")
    with pytest.raises(InputError, match="cannot be fetched"):
        list(fetch_sources(gone, tmp_path / "out", []))
    with pytest.raises(InputError, match=r"no source 'two'.*one"):
        list(fetch_sources(gone, tmp_path / "out", ["two"]))


def test_a_path_that_leaves_the_folder_is_refused(tmp_path):
    file = tmp_path / "fetch.toml"
    file.write_text(
        '[[source]]\nname = "one"\nlicence = ""\nbase = "https://example.org/"\n'
        f'[[source.files]]\npath = "x"\nto = "../x"\nsha256 = "{"0" * 64}"\n'
    )
    with pytest.raises(InputError, match="inside the source's folder"):
        read_catalogue(file)


def test_shipped_list_is_sound_and_pinned_to_commits():
    sources = read_catalogue(DATA / "fetch.toml").source
    assert len(sources) >= 4
    for source in sources:
        assert any(len(part) == 40 for part in source.base.split("/"))


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
