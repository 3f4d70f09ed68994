"""Wrong input: one clear line on standard error, exit code 2, no traceback."""

import subprocess
import sys

import pytest


def dentscope(*arguments, cwd=None):
    return subprocess.run(
        [sys.executable, "-m", "dentscope", *arguments],
        capture_output=True,
        text=True,
        cwd=cwd,
        timeout=120,
        check=False,
    )


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("nonsense",), "no command"),
        (("campaign", "run", "--design", "huge"), "smoke"),
        (("campaign", "run", "--workers", "0"), "workers"),
        (("campaign", "run", "--retry", "all"), "failed"),
        (("campaign", "show", "zz"), "no case"),
        (("campaign", "export"), "no such file"),
        (("fit", "absent.h5"), "no such file"),
        (("fit", "text.h5"), "not a campaign file"),
        (("impact", "absent.toml"), "no such file"),
    ],
)
def test_wrong_input_is_one_line_and_exit_code_2(tmp_path, arguments, word):
    (tmp_path / "text.h5").write_text("this is no HDF5 file")
    answer = dentscope(*arguments, cwd=tmp_path)
    assert answer.returncode == 2
    assert len(answer.stderr.strip().splitlines()) == 1
    assert word in answer.stderr
    assert "Traceback" not in answer.stderr + answer.stdout


def test_help_and_version_succeed():
    assert dentscope("--help").returncode == 0
    assert dentscope("version").stdout.strip() == __import__("dentscope").__version__
