"""Compiled code is kept apart for each state of the source."""

import os
import stat
import subprocess
import sys
from pathlib import Path

from dentscope.core import compiled
from dentscope.core.compiled import source_digest


def test_the_folder_follows_compiled_files_and_what_they_import(tmp_path):
    (tmp_path / "fem").mkdir()
    (tmp_path / "core").mkdir()
    kernel = tmp_path / "fem" / "kernel.py"
    constants = tmp_path / "core" / "constants.py"
    other = tmp_path / "fem" / "other.py"
    kernel.write_text("from numba import njit\nfrom ..core.constants import X\n")
    constants.write_text("X = 1\n")
    other.write_text("y = 1\n")
    before = source_digest(tmp_path)
    other.write_text("y = 2\n")
    assert source_digest(tmp_path) == before
    constants.write_text("X = 2\n")
    renewed = source_digest(tmp_path)
    assert renewed != before
    kernel.write_text(kernel.read_text() + "# changed\n")
    assert source_digest(tmp_path) != renewed


def test_numba_is_pointed_there_and_a_choice_of_the_user_is_kept(tmp_path):
    code = "import dentscope, numba; print(numba.config.CACHE_DIR)"
    plain = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"}

    def answer(**extra):
        return subprocess.run(
            [sys.executable, "-c", code],
            env=plain | extra,
            capture_output=True,
            text=True,
            check=True,
        ).stdout.strip()

    assert answer(XDG_CACHE_HOME=str(tmp_path)).startswith(str(tmp_path / "dentscope"))
    assert answer(NUMBA_CACHE_DIR="/elsewhere") == "/elsewhere"


def test_a_folder_that_others_may_write_is_passed_over(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    planted = tmp_path / "dentscope"
    planted.mkdir()
    planted.chmod(0o777)
    compiled.keep_compiled_code()
    chosen = Path(os.environ["NUMBA_CACHE_DIR"])
    assert chosen.parent == tmp_path / "dentscope-2"
    assert stat.S_IMODE(chosen.stat().st_mode) == 0o700
    # a link to elsewhere is no folder of one's own either
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    (tmp_path / "dentscope-2").rename(tmp_path / "kept")
    (tmp_path / "dentscope-2").symlink_to(tmp_path / "kept")
    compiled.keep_compiled_code()
    assert Path(os.environ["NUMBA_CACHE_DIR"]).parent == tmp_path / "dentscope-3"
