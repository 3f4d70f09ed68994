"""Opening and writing files: what is no file, what is too large, what cannot be written."""

import os
from pathlib import Path

import numpy as np
import pytest
from dentscope.cli import run
from dentscope.core import InputError
from dentscope.core.inputs.input_file import read_bytes
from dentscope.core.inputs.templates import template, write_new
from dentscope.core.inputs.toml_input import read_toml
from dentscope.core.output import locked, write_file
from dentscope.core.processes.confined import confined


def test_a_pipe_a_device_and_a_large_file_are_a_line_each(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="a pipe or a device, no file"):
        read_bytes(tmp_path / "pipe", most=10, allowed="a file")
    with pytest.raises(InputError, match="a pipe or a device, no file"):
        read_toml(Path("/dev/zero"))
    with (tmp_path / "large").open("wb") as file:
        file.truncate(10**12)
    with pytest.raises(InputError, match=r"1000000 MB .*up to 4 MB"):
        read_toml(tmp_path / "large")


@pytest.mark.parametrize(
    ("text", "line"),
    [("a = " + "[" * 5000, "nested too deep"), (f"a = {'9' * 5000}", "too many digits")],
)
def test_what_python_cannot_hold_is_a_line(tmp_path, text, line):
    (tmp_path / "a.toml").write_text(text)
    with pytest.raises(InputError, match=line):
        read_toml(tmp_path / "a.toml")


def test_a_hundred_thousand_bad_rows_are_twenty_lines_and_a_count(tmp_path, errs):
    folder = tmp_path / "set"
    assert run(["recordings", "new", str(folder), "--sphere"]) == 0
    head = (folder / "trials.csv").read_text().splitlines()[0]
    (folder / "trials.csv").write_text(head + "\n" + "\x1b[2J,ball,x,y,z,,\n" * 100_000)
    lines = errs("recordings", "check", folder).splitlines()
    assert len(lines) == 21
    assert lines[-1].startswith("... and ")
    assert not any("\x1b" in line for line in lines)


@pytest.mark.parametrize("name", ["a" * 300, "nul\0", "folder", "file/below"])
def test_what_cannot_be_written_is_a_line_and_leaves_nothing(tmp_path, name):
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("kept")
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(InputError) as caught:
        write_file(tmp_path / name, "text")
    assert "\n" not in str(caught.value)
    assert sorted(tmp_path.rglob("*")) == before


def test_a_name_that_is_no_text_makes_a_file(tmp_path):
    file = tmp_path / os.fsdecode(b"k\xfc.toml")
    write_new(template("ball"), file, command="impact")
    assert read_toml(file)["target"]


def test_a_replaced_file_keeps_its_mode_and_a_link_its_target(tmp_path):
    (tmp_path / "a").write_text("old")
    (tmp_path / "a").chmod(0o600)
    (tmp_path / "link").symlink_to(tmp_path / "a")
    write_file(tmp_path / "link", "new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "a").read_text() == "new"
    assert (tmp_path / "a").stat().st_mode & 0o777 == 0o600


def test_the_lock_of_a_folder_leaves_no_file(tmp_path):
    with locked(tmp_path / "set"):
        assert list(tmp_path.iterdir()) == []


def test_work_that_takes_too_much_memory_is_a_line():
    assert confined(np.ones, 10, source="book.xlsx").sum() == 10.0
    with pytest.raises(InputError, match="holds, or claims to hold, more than 1 GB"):
        confined(np.ones, 10**9, source="book.xlsx")
