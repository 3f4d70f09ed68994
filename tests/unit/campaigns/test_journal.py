"""A change of an HDF5 file is whole or not there, wherever its writer stops."""

import signal
import subprocess
import sys

import h5py
import numpy as np
import pytest
from dentscope.campaigns import journal
from dentscope.core import InputError
from dentscope.core.disk import Disk


def write(path, name, value):
    with journal.changing(path) as file:
        file[name] = np.full(3000, value)


def read(path):
    with h5py.File(path, "r") as file:
        return {name: float(file[name][0]) for name in file}


def test_changes_add_up_and_leave_an_ordinary_file(tmp_path):
    path = tmp_path / "a.h5"
    for k in range(5):
        write(path, f"x{k}", k)
    with journal.changing(path) as file:
        del file["x3"]
    assert read(path) == {"x0": 0, "x1": 1, "x2": 2, "x4": 4}
    assert [p.name for p in tmp_path.iterdir()] == ["a.h5"]


def test_a_change_that_fails_leaves_every_byte(tmp_path):
    path = tmp_path / "a.h5"
    write(path, "x", 1)
    before = path.read_bytes()

    def fail():
        with journal.changing(path) as file:
            file["y"] = np.ones(5000)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert path.read_bytes() == before


def test_a_change_beyond_what_is_read_is_refused_and_nothing_is_lost(tmp_path, monkeypatch):
    path = tmp_path / "a.h5"
    write(path, "x", 1)
    before = path.read_bytes()
    monkeypatch.setattr(journal, "MOST_BYTES", len(before) + 1000)
    with pytest.raises(InputError, match=r"would hold .* all that it holds is kept"):
        write(path, "y", 2)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["a.h5"]


@pytest.mark.parametrize("torn", [0, 1, 3, 1000])
def test_a_writer_that_dies_while_writing_is_finished_by_the_next(tmp_path, monkeypatch, torn):
    path = tmp_path / "a.h5"
    write(path, "x", 1)
    with monkeypatch.context() as patch:
        patch.setattr(journal, "recover", lambda path: None)  # dies when the journal is there
        write(path, "y", 2)
    before = path.stat().st_size
    change = journal._read_journal(journal.journal_of(path))
    with path.open("r+b") as file:  # and had written some of the pages, the last one torn
        for number, (offset, _, page) in enumerate(change.pages[:torn], start=1):
            file.seek(offset)
            page = page[: change.size - offset]
            file.write(page if number < torn else page[:1536])
    assert change.size > before
    journal.recover(path)
    assert read(path) == {"x": 1, "y": 2}
    assert path.stat().st_size == change.size
    assert not journal.journal_of(path).exists()


def test_a_damaged_journal_is_named_and_changes_nothing(tmp_path, monkeypatch):
    path = tmp_path / "a.h5"
    write(path, "x", 1)
    monkeypatch.setattr(journal, "recover", lambda path: None)
    write(path, "y", 2)
    monkeypatch.undo()
    place = journal.journal_of(path)
    place.write_bytes(place.read_bytes()[:-100])
    with pytest.raises(InputError, match=r"a\.h5\.journal: damaged"):
        journal.recover(path)
    assert read(path) == {"x": 1}


@pytest.mark.parametrize("other", ["older", "newer", "another", "longer", "none"])
def test_a_journal_touches_no_file_but_its_own(tmp_path, monkeypatch, other):
    path = tmp_path / "a.h5"
    write(path, "w", 0)
    older = path.read_bytes()
    write(path, "x", 1)
    with monkeypatch.context() as patch:
        patch.setattr(journal, "recover", lambda path: None)  # dies when the journal is there
        write(path, "y", 2)
    place = journal.journal_of(path)
    kept = place.read_bytes()
    own = path.read_bytes()
    place.unlink()
    if other == "older":
        path.write_bytes(older)
    elif other == "newer":
        write(path, "z", 3)
    elif other == "another":
        path.unlink()
        write(path, "b", 4)
    elif other == "longer":
        path.write_bytes(own + bytes(10**6))
    else:
        path.unlink()
    before = path.read_bytes() if path.exists() else None
    place.write_bytes(kept)
    with pytest.raises(InputError, match=r"a\.h5\.journal: belongs to another a\.h5"):
        journal.recover(path)
    assert (path.read_bytes() if path.exists() else None) == before
    path.write_bytes(own)  # the file that it belongs to
    journal.recover(path)
    assert read(path) == {"w": 0, "x": 1, "y": 2}


def died_when_journalled(path, name, value, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(journal, "recover", lambda path: None)
        write(path, name, value)


def test_a_first_change_that_another_process_finishes_meanwhile_is_no_fault(tmp_path, monkeypatch):
    path = tmp_path / "a.h5"
    died_when_journalled(path, "x", 1, monkeypatch)
    seen = []

    def read_late(place):  # the first change is done, and the next one's journal is there
        if not seen:
            seen.append(place)
            journal.recover(path)
            died_when_journalled(path, "y", 2, monkeypatch)
        return real(place)

    real = journal._read_journal
    monkeypatch.setattr(journal, "_read_journal", read_late)
    journal.recover(path)
    assert read(path) == {"x": 1, "y": 2}
    assert not journal.journal_of(path).exists()


def test_a_file_that_another_process_makes_at_the_same_moment_is_no_fault(tmp_path, monkeypatch):
    path = tmp_path / "a.h5"
    died_when_journalled(path, "x", 1, monkeypatch)
    create = Disk.create

    def create_late(disk, place, *mode):
        place.touch()
        return create(disk, place, *mode)

    monkeypatch.setattr(Disk, "create", create_late)
    journal.recover(path)
    assert read(path) == {"x": 1}


def test_a_file_put_in_its_place_while_its_lock_is_awaited_is_the_one_that_counts(
    tmp_path, monkeypatch
):
    path, other = tmp_path / "a.h5", tmp_path / "b.h5"
    write(path, "x", 1)
    write(other, "x", 2)
    died_when_journalled(other, "y", 3, monkeypatch)
    journal.journal_of(path).touch()  # of a change that another process finishes
    lock = journal.lock

    def lock_late(file, kind):
        if other.exists():
            other.rename(path)
            journal.journal_of(other).rename(journal.journal_of(path))
        lock(file, kind)

    monkeypatch.setattr(journal, "lock", lock_late)
    journal.recover(path)
    assert read(path) == {"x": 2, "y": 3}


LIMITED = """
import resource, signal, sys
from pathlib import Path
import numpy as np
from dentscope.campaigns import journal
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]), resource.RLIM_INFINITY))
for k in range(100):
    try:
        with journal.changing(Path(sys.argv[1])) as file:
            file[f"x{k}"] = np.full(3000, k)
    except (OSError, ValueError) as error:
        print(k, error)
        break
"""


def test_a_file_that_may_not_grow_keeps_all_that_was_told_complete(tmp_path):
    path = tmp_path / "a.h5"
    answer = subprocess.run(
        [sys.executable, "-c", LIMITED, str(path), "200000"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    number, _, told = answer.stdout.partition(" ")
    complete = int(number)
    assert "File too large" in told or "a file may not be larger here" in told
    assert 3 < complete < 20
    assert set(read(path)) >= {f"x{k}" for k in range(complete)}
    write(path, "more", 1)  # with room again, the change that was journalled is there too
    assert set(read(path)) == {"more", *(f"x{k}" for k in range(complete + 1))}


DYING = """
import os, random, signal, sys, threading, time
from pathlib import Path
import numpy as np
from dentscope.campaigns import journal
path, k = Path(sys.argv[1]), int(sys.argv[2])
def die():
    time.sleep(random.uniform(0.0, 0.15))
    os.kill(os.getpid(), signal.SIGKILL)
threading.Thread(target=die, daemon=True).start()
while True:
    with journal.changing(path) as file:
        file[f"x{k}"] = np.full(3000, k)
    print(k, flush=True)
    k += 1
"""


def test_kills_in_the_middle_of_writing_damage_nothing(tmp_path):
    # no pause between changes: almost every kill falls into one
    path, told = tmp_path / "a.h5", []
    for _ in range(5):
        start = len(read(path)) if path.exists() else 0
        answer = subprocess.run(
            [sys.executable, "-c", DYING, str(path), str(start)],
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert answer.returncode == -signal.SIGKILL, answer.stderr
        told += [int(line) for line in answer.stdout.splitlines()]
        journal.recover(path)
        # killed before the first change was whole: no file, and nothing told
        stored = set(read(path)) if path.exists() else set()
        assert stored >= {f"x{k}" for k in told}
    assert len(told) == len(set(told)) > 0
