"""Injected faults, in the size of a test; each script beside this one runs them at length."""

import errno
import importlib.util
import random
import re
import sys
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def script(name):
    if name not in sys.modules:
        place = Path(__file__).with_name(f"{name}.py")
        spec = importlib.util.spec_from_file_location(name, place)
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)
    return sys.modules[name]


@pytest.mark.parametrize(
    ("name", "every"),
    [
        ("put", 4), ("put, new file", 6), ("publish", 7), ("reduce --into", 9),
        ("fit --publish", 9), ("report files", 9), ("files together", 1),
    ],
)  # fmt: skip
def test_no_failed_call_and_no_loss_of_power_loses_or_changes_anything(tmp_path, name, every):
    faults = script("disk_faults")
    made = faults.writers(tmp_path)[name]()
    failed = faults.faults(made, tmp_path / "faults", codes=(errno.EIO,), every=every)
    lost = faults.losses(made, tmp_path / "losses", every=every)
    assert failed.total() >= 2
    assert lost.total() >= 10
    assert len(lost) == 5  # states that a disk may be in


def test_the_model_of_a_disk_sees_a_writer_that_does_not_synchronise(tmp_path):
    faults = script("disk_faults")

    def careless(place):
        disk = faults.Disk()
        (place / "draft").unlink(missing_ok=True)
        file = disk.create(place / "draft")
        disk.write(file, b"2" * 5000)
        disk.close(file)
        disk.rename(place / "draft", place / "a")

    def check(place):
        found = (place / "a").read_text()
        assert found in ("1" * 5000, "2" * 5000)
        return "new" if found[0] == "2" else "old"

    one = faults.Writer("careless", lambda p: (p / "a").write_text("1" * 5000), careless, check)
    with pytest.raises(AssertionError):
        faults.losses(one, tmp_path)


def test_no_flipped_bit_and_no_blank_block_gives_a_number(tmp_path):
    flips = script("bit_flips")
    for words, read, path, expected, before in flips.targets(tmp_path):
        found = flips.inspect(
            read, path, expected, random.Random(3), bits=25, blocks=5, before=before
        )
        assert set(found) <= {"refused with a line", "all as it was"}, (words, found)
        assert found["refused with a line"] >= 20


def test_malformed_input_is_one_line_soon_and_in_little_memory():
    counts, faults, most = script("fuzz").run(102, 11)
    assert faults == []
    assert sum(found.total() for found in counts.values()) == 102
    assert most < 1000.0


def test_damaged_raw_recordings_are_reduced_or_refused_in_a_line():
    counts, faults, _most = script("fuzz").run(44, 5, raw=True)
    assert faults == []
    assert sum(found.total() for found in counts.values()) == 44
    assert {"read", "refused with a line"} <= set(sum(counts.values(), Counter()))


WRITES = re.compile(
    r"\.write_(text|bytes)\(|\.open\(\"[wax]|savefig\((?!stream)|\.rename\(|copyfile"
)


def test_everything_is_written_by_the_one_writer():
    stages = "core models fem campaigns fitting impact recordings discrepancy start cli".split()
    found = {
        f"{path.relative_to(ROOT)}: {line.strip()}"
        for stage in stages
        for path in (ROOT / stage).rglob("*.py")
        for line in path.read_text(encoding="utf-8").splitlines()
        if WRITES.search(line) and path.name not in ("disk.py", "output.py")
    }
    # a set is checked before it is written, what is fetched is held to a checksum, a lock is empty
    allowed = ("into_set.py", "fetch.py", "DISK.rename", "store.py: handle")
    assert [one for one in found if not any(word in one for word in allowed)] == []
