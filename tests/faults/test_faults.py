"""Injected faults, in the size of a test; each script beside this one runs them at length."""

import errno
import hashlib
import json
import os
import re
import runpy
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import disk_faults
import fuzz
import pytest
import watched
from dentscope.campaigns import read_curves
from dentscope.core import InputError
from dentscope.core.output import PENDING, finish
from dentscope.models import law_named

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize(
    ("name", "every"),
    [
        ("put", 2), ("put, new run", 3), ("put, tried again", 2), ("publish", 7),
        ("reduce --into", 9), ("fit --publish", 9), ("report files", 9), ("files together", 1),
    ],
)  # fmt: skip
def test_no_failed_call_and_no_loss_of_power_loses_or_changes_anything(tmp_path, name, every):
    made = disk_faults.writers(tmp_path)[name]()
    failed = disk_faults.faults(made, tmp_path / "faults", codes=(errno.EIO,), every=every)
    lost = disk_faults.losses(made, tmp_path / "losses", every=every)
    assert failed.total() >= 2
    assert lost.total() >= 10
    assert len(lost) == 5  # states that a disk may be in


def test_the_model_of_a_disk_sees_a_writer_that_does_not_synchronise(tmp_path):

    def careless(place):
        disk = disk_faults.Disk()
        (place / "draft").unlink(missing_ok=True)
        file = disk.create(place / "draft")
        disk.write(file, b"2" * 5000)
        disk.close(file)
        disk.rename(place / "draft", place / "a")

    def check(place):
        found = (place / "a").read_text()
        assert found in ("1" * 5000, "2" * 5000)
        return "new" if found[0] == "2" else "old"

    one = disk_faults.Writer(
        "careless", lambda p: (p / "a").write_text("1" * 5000), careless, check
    )
    with pytest.raises(AssertionError):
        disk_faults.losses(one, tmp_path)


def test_malformed_input_is_one_line_soon_and_in_little_memory():
    counts, faults, most, _longest = fuzz.run(360, 11)
    assert faults == []
    assert all(found.total() == 20 for found in counts.values())
    assert most < watched.MEMORY_MB


def test_damaged_raw_recordings_are_reduced_or_refused_in_a_line():
    counts, faults, *_ = fuzz.run(2 * len(fuzz.RAW), 5, raw=True)
    assert faults == []
    assert sum(found.total() for found in counts.values()) == 2 * len(fuzz.RAW)
    assert {"read", "refused with a line"} <= set(sum(counts.values(), Counter()))


@pytest.mark.parametrize("name", ["../victim", "sub/../../victim", "link/victim", "\0", 400 * "x"])
def test_a_folder_from_somebody_else_writes_nowhere_else(tmp_path, name):
    folder, victim = tmp_path / "set", tmp_path / "victim"
    folder.mkdir()
    (folder / "link").symlink_to(tmp_path)
    victim.write_text("mine")
    head = json.dumps([[name, 5, hashlib.sha256(b"mine").hexdigest()]]).encode()
    body = b"dentscope-pending-1\n" + len(head).to_bytes(8, "little") + head + b"yours"
    (folder / PENDING).write_bytes(body + hashlib.sha256(body).digest())
    with pytest.raises(InputError, match="is no file within this folder"):
        finish(folder)
    assert victim.read_text() == "mine"
    assert {p.name for p in tmp_path.iterdir()} == {"set", "victim"}


def test_a_pipe_in_place_of_a_file_is_not_waited_for(tmp_path):
    for name in ("c.h5", "law.json", PENDING):
        os.mkfifo(tmp_path / name)
    with pytest.raises(InputError, match=r"c\.h5: a pipe or a device"):
        read_curves(tmp_path / "c.h5")
    with pytest.raises(InputError, match=r"law\.json: a pipe or a device"):
        law_named(str(tmp_path / "law.json"))
    with pytest.raises(InputError, match="a pipe or a device"):
        finish(tmp_path)


WRITES = re.compile(
    r"\.write_(text|bytes)\(|\.open\(\"[wax]|savefig\((?!stream)|\.rename\(|copyfile"
)


def test_everything_is_written_by_the_one_writer():
    stages = "core models fem campaigns fitting dynamics recordings discrepancy start cli".split()
    found = {
        f"{path.relative_to(ROOT)}: {line.strip()}"
        for stage in stages
        for path in (ROOT / stage).rglob("*.py")
        for line in path.read_text(encoding="utf-8").splitlines()
        if WRITES.search(line) and path.name not in ("disk.py", "output.py")
    }
    # a set is checked before it is written, what is fetched is held to a checksum, and what goes
    # to the null device is kept nowhere; what is compiled can be compiled again
    allowed = ("recording_set.py: path.write_bytes(content", "fetch.py", "DISK.rename",
               "Path(os.devnull).open(", "core/compiled.py")  # fmt: skip
    assert [one for one in found if not any(word in one for word in allowed)] == []


fuzz_keys = SimpleNamespace(**runpy.run_path(str(ROOT / "tools" / "benchmarks" / "fuzz_keys.py")))
QUICK = ("inverse", "case", "recordings", "export")


def test_the_same_seed_makes_the_same_input():
    first, second = (fuzz_keys.one(4, 7) for _ in range(2))
    assert first["text"] == second["text"]
    assert first["kind"] == "inverse"


@pytest.mark.parametrize("number", range(60))
def test_an_extreme_file_is_answered_or_refused(number):
    found = fuzz_keys.one(number, 11, kinds=QUICK)
    assert found["told"] in ("answered", "refused", "not ended"), found["text"] + found["where"]


@pytest.mark.parametrize(
    ("code", "out", "err", "told"),
    [(0, "a  nan", "", "NAN"), (0, "e = inf", "", "NAN"), (0, "banana infinite", "", "answered"),
     (0, "0.5", "", "answered"), (2, "", "a.toml: target.nu: 0.7\n", "refused"),
     (2, "", "", "UNSAID"), (2, "", "depth: a depth is not a number", "UNSAID"),
     (1, "", "Traceback (most recent call last)", "TRACEBACK"), (3, "", "budget", "not ended")],
)  # fmt: skip
def test_faults_are_told_from_refusals(code, out, err, told):
    assert fuzz_keys.judged("impact", code, out, err) == told
