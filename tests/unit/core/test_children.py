"""A folder from elsewhere runs no code, whatever its files are called."""

import os
import re
from pathlib import Path

import dentscope
import pytest
from made_files import put
from made_processes import python

ROOT = Path(dentscope.__file__).parent
TRAPS = ("numpy", "threading", "gmsh", "pyvista", "pickle", "matplotlib", "pandas", "typer", "rich")

# Each way in which a command starts a process of its own.
WAYS = {
    "a file read within limits": """
from dentscope.core.processes.confined import confined
from dentscope.core.errors import printable
assert confined(printable, "a", source="x") == "a"
""",
    "a worker": """
from dentscope.campaigns.workers import answers
assert [a.value for _, a in answers(len, {"one": ("abc",)}, workers=1, timeout_s=100.0)] == [3]
""",
    "a process for a library": """
import subprocess
from dentscope.core.processes.children import python_command
subprocess.run(python_command("-c", "import numpy, pickle, threading"), check=True)
""",
    "help": """
import sys
from dentscope.__main__ import main
sys.argv = ["dentscope", "laws", "list"]
main()
""",
}


@pytest.fixture
def trapped(tmp_path: Path) -> Path:
    folder = tmp_path / "downloaded"
    trap = f"open({str(tmp_path / 'ran')!r}, 'w').write(__file__)\nraise SystemExit(99)\n"
    for name in (*TRAPS, "dentscope/__init__"):
        put(folder / f"{name}.py", trap)
    put(folder / "matplotlibrc", "backend: module://numpy\nnonsense\n")
    precious = put(tmp_path / "precious", "mine")
    (folder / ".numba_config.yaml").write_text(
        f"chrome_trace: {precious}\ncache_locator_classes: numpy.L\ndisable_jit: 1\n"
    )
    return folder


def run_in(trapped, *words, script=""):
    """What a Python says, started in the trapped folder; a script lies in another one."""
    if script:  # as the installed command
        words = (put(trapped.parent / "bin" / "script.py", script),)
    env = {k: v for k, v in os.environ.items() if k not in ("PYTHONSAFEPATH", "PYTHONPATH")}
    answer = python(*words, cwd=trapped, env=env)
    assert not (trapped.parent / "ran").exists(), (trapped.parent / "ran").read_text()
    assert answer.returncode == 0, answer.stderr
    assert (trapped.parent / "precious").read_text() == "mine"
    return answer.stderr


@pytest.mark.parametrize("way", WAYS)
def test_no_child_takes_code_from_the_current_folder(trapped: Path, way: str) -> None:
    body = WAYS[way].replace("\n", "\n    ")
    run_in(trapped, script=f"if __name__ == '__main__':\n    pass{body}\n")


def test_python_m_forgets_the_current_folder(trapped: Path) -> None:
    # a package or a module of the standard library found before is beyond reach without -P
    for name in ("dentscope/__init__", "threading", "pickle"):
        (trapped / f"{name}.py").unlink()
    (trapped / "dentscope").rmdir()
    run_in(trapped, "-m", "dentscope", "laws", "list")


LINES = (
    """
version|keys impact|materials|doctor|laws list|laws show hertz|impact --new ball
impact ball.toml --law hertz --exact --out o|case --new|case none.toml
laws compare case.toml --law hertz --out o2|export law fitted
export dem case.toml --speed 1 --out o3|inverse --new|inverse inverse.toml --out o4|examples --to ex
recordings list|recordings new mine --sphere|recordings check kharaz-2001-oblique
recordings add mine none.csv
recordings audit kharaz-2001-oblique|recordings fetch nosuch
reduce table pulse.csv --holds force --mass-kg 1 --out r1
reduce video pulse.csv --frame-rate-hz 1000 --shape sphere --out r2|reduce sound pulse.csv --out r3
reduce scan pulse.csv --unit um --step-m 1e-6 --out r4|reduce tip pulse.csv --out r5
reduce mocap pulse.csv --shape sphere --out r6|diagnose nosuch|metal nosuch|fit nosuch
figures --chapter 9|verify --list|campaign designs|campaign run --design nosuch|campaign status
campaign show nosuch|campaign refine nosuch|campaign export|campaign publish --design nosuch
campaign repair|campaign reproduction --data nosuch|proof run --list nosuch
proof score --list nosuch|proof page nosuch|proof sample s --kind nosuch|proof peers nosuch
proof laws nosuch|proof interventions nosuch|challenge get pulse.csv
challenge score nosuch pulse.csv|challenge ask nosuch one pulse.csv
challenge seal nosuch pulse.csv
""".strip()
    .replace("\n", "|")
    .split("|")
)
"""A use of every command: to its end where that is soon, else to where the first name is wrong."""

ALL = f"""
import sys, typer.main
from dentscope.cli import run
from dentscope.cli.app import app

def commands(command, name=""):
    last = getattr(command, "commands", {{}})
    return [c for k in last for c in commands(last[k], name + k + " ")] if last else [name]

if __name__ == "__main__":
    lines = {LINES!r}
    missing = [c for c in commands(typer.main.get_command(app))
               if not any((line + " ").startswith(c) for line in lines)]
    assert not missing, missing
    codes = [run(line.split()) for line in lines]
    assert set(codes) == {{0, 2}}, dict(zip(lines, codes))
"""


def test_no_command_takes_code_from_the_current_folder(trapped: Path) -> None:
    pulse = "".join(f"{1e-5 * k},{300.0 * (50 < k < 150)}\n" for k in range(400))
    put(trapped / "pulse.csv", "time_s,force_N\n" + pulse)
    told = run_in(trapped, script=ALL)
    assert "Traceback" not in told
    assert "Warning" not in told


def test_pythons_are_started_in_one_place() -> None:
    pattern = re.compile(r"sys\.executable")
    users = {
        str(path.relative_to(ROOT))
        for stage in ("core", "cli", "reduce", "recordings", "campaigns", "studies", "start", "fem",
                      "models", "dynamics", "fitting", "discrepancy")
        for path in (ROOT / stage).rglob("*.py")
        if pattern.search(path.read_text(encoding="utf-8"))
    }  # fmt: skip
    assert users == {"core/processes/children.py"}
