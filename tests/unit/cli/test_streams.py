"""Output that is closed, full or of no width, and a matplotlib set up oddly: sound, or one line."""

import os
import subprocess
import sys
from pathlib import Path

import pytest


def _run(command: str, cwd: Path, **env: str) -> subprocess.CompletedProcess[str]:
    program = f'"{sys.executable}" -P -m dentscope {command}'
    return subprocess.run(
        ["bash", "-c", program], cwd=cwd, env=os.environ | env, capture_output=True, text=True,
        check=False,
    )  # fmt: skip


def test_a_full_output_is_one_line(tmp_path: Path) -> None:
    answer = _run("laws list > /dev/full", tmp_path)
    assert answer.returncode == 2
    assert answer.stderr == "standard output: No space left on device\n"


@pytest.mark.parametrize("end", [">&-", "| true"])
def test_files_are_written_whoever_reads(tmp_path: Path, end: str) -> None:
    answer = _run(f"impact --new ball {end}", tmp_path)
    assert answer.stderr == ""
    assert (tmp_path / "ball.toml").exists()


def test_no_width_and_no_colour(tmp_path: Path) -> None:
    answer = _run("laws list", tmp_path, COLUMNS="0", NO_COLOR="1", MPLBACKEND="nonsense")
    assert (answer.returncode, answer.stderr) == (0, "")
    assert "ghaednia" in answer.stdout
    assert "\x1b" not in answer.stdout
