"""Compiled code is kept apart for each state of the source."""

import os
import subprocess
import sys

from dentscope.core.compiled import source_digest


def test_a_change_in_any_kernel_file_changes_the_folder(tmp_path):
    (tmp_path / "fem").mkdir()
    (tmp_path / "fem" / "a.py").write_text("x = 1\n")
    before = source_digest(tmp_path)
    assert before == source_digest(tmp_path)
    (tmp_path / "fem" / "a.py").write_text("x = 2\n")
    assert source_digest(tmp_path) != before


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
