"""What a terminal shows: help at any width, sound where output is closed or full, the doctor."""

import io
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from dentscope import __version__, fem
from dentscope.cli import app as assembly
from dentscope.cli import doctor
from dentscope.cli.diagnose import _progress as progress_of_diagnosis
from dentscope.cli.doctor import EnvironmentFinding
from dentscope.cli.shared.terminal import parts, say, show_table, tell_first_use
from dentscope.core import Ending, InputError, Outcome
from dentscope.core.inputs.templates import CASE
from made_commands import COMMANDS
from made_files import put
from made_processes import python
from rich.console import Console


def letters(text: str) -> str:
    return "".join(text.split())


@pytest.mark.parametrize("width", [60, 80, 120])
@pytest.mark.parametrize("names", COMMANDS, ids=" ".join)
def test_help_is_whole_at_every_width(names, width, monkeypatch, prints):
    monkeypatch.setenv("COLUMNS", str(width))
    shown = prints(*names, "-h")
    assert max(map(len, shown.splitlines())) <= width
    assert "…" not in shown
    command = COMMANDS[names]
    for told in (command.help, *(getattr(p, "help", "") for p in command.params)):
        # every sentence as it was written, its units in square brackets too
        paragraph = letters((told or "").split("\n\n")[0])
        assert paragraph in letters(shown), paragraph


def test_version_and_asking_for_nothing(prints):
    for line in (["--version"], ["version"]):
        assert prints(*line).strip() == __version__
    assert "Your own:" in prints()


@pytest.mark.parametrize("width", [60, 80])
def test_a_table_is_split_before_it_is_cut(width):
    head = ("law", *(f"quantity {k} [mm]" for k in range(6)))
    rows = [(f"law-number-{k}", *(f"{1.2345e-7 * k:.4g}" for k in range(6))) for k in range(3)]
    console = Console(width=width, markup=False, record=True, file=io.StringIO())
    tables = parts(head, rows, width=width)
    assert len(tables) > 1
    for table in tables:
        console.print(table)
    shown = console.export_text()
    assert "…" not in shown
    for cell in (*head[1:], *(c for row in rows for c in row)):
        assert cell in shown


def test_a_screen_too_narrow_for_a_number_wraps_it(capsys):
    rows = [("time to the largest force [ms]", "0.01936 +2.1e-04 -0.0032")]
    show_table(Console(width=40, markup=False), ("", "fitted"), rows)
    shown = capsys.readouterr().out
    assert "…" not in shown
    assert all(word in shown.split() for row in rows for cell in row for word in cell.split())


def test_a_file_to_start_from_needs_no_place_for_results(tmp_path, monkeypatch, errs, prints):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "build").touch()
    told = prints("impact", "--new", "ball", "my ball.toml")
    assert told.endswith("then: dentscope impact 'my ball.toml'\n")
    assert "--out" in errs("impact", "my ball.toml")


def test_a_published_case_is_shown_without_a_run(tmp_path, monkeypatch, prints):
    monkeypatch.chdir(tmp_path)
    shown = prints("campaign", "show", "space-020")
    assert "F [N]" in shown
    assert "data/campaign" in shown


def test_the_shell_completes_commands():
    told = {**os.environ, "_DENTSCOPE_COMPLETE": "complete_bash", "COMP_WORDS": "dentscope re"}
    answer = subprocess.run(
        [str(Path(sys.executable).with_name("dentscope"))],
        env={**told, "COMP_CWORD": "1"}, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert answer.stdout.split() == ["recordings", "reduce"]


def test_progress_without_a_terminal_is_a_line_a_step(capsys: pytest.CaptureFixture[str]) -> None:
    show = progress_of_diagnosis(quiet=False)
    for step in ("auditing", "screening", ""):
        show(step)
    assert capsys.readouterr().err == "auditing ...\nscreening ...\n"


def test_progress_on_a_terminal_stays_in_its_line(capsys, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", "20")
    show = progress_of_diagnosis(quiet=False)
    show("fitting one with another")
    assert capsys.readouterr().err == "\r\x1b[Kfitting one with an"


@pytest.mark.parametrize("live", [True, False])
def test_prose_is_wrapped_on_a_terminal_and_whole_in_a_file(monkeypatch, capsys, live):
    monkeypatch.setenv("COLUMNS", "44")
    monkeypatch.setattr(sys.stdout, "isatty", lambda: live)
    line = "    61 %  roughness: asperities give way before the bulk"
    say(line)
    told = capsys.readouterr().out
    if live:
        assert told == "    61 %  roughness: asperities give way\n      before the bulk\n"
    else:
        assert told == f"{line}\n"


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


def test_it_is_said_until_the_code_is_there(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    tell_first_use()
    assert capsys.readouterr().err.startswith("first use: compiling")
    folder = tmp_path / "walk_0"
    folder.mkdir()
    (folder / "compiled._impacts-131.py311.nbi").touch()
    tell_first_use()
    assert capsys.readouterr().err == ""


def test_the_name_is_that_of_the_compiled_integrator() -> None:
    from dentscope.dynamics.stepping import compiled

    assert compiled.__name__.endswith(".compiled")
    assert compiled._impacts.py_func.__name__ == "_impacts"


def test_help_loads_no_numerics():
    heavy = "numpy scipy numba gmsh skfem pyvista matplotlib h5py".split()
    program = (
        f"import sys, dentscope.cli;print(*[name for name in {heavy!r} if name in sys.modules])"
    )
    assert python("-c", program, check=True).stdout.strip() == ""


@pytest.mark.parametrize(
    ("raised", "code", "line"),
    [
        (InputError("-1", source="a.toml", key="nu"), 2, "a.toml: nu: -1\n"),
        (KeyboardInterrupt(), 130, "stopped\n"),
    ],
)
def test_how_the_command_line_ends_early(monkeypatch, capsys, raised, code, line):
    def end(**options):
        raise raised

    monkeypatch.setattr(assembly, "app", end)
    assert assembly.run([]) == code
    assert capsys.readouterr().err == line


def test_a_case_that_does_not_converge_ends_with_its_reason_and_code_3(
    monkeypatch, capsys, tmp_path
):
    put(tmp_path / "case.toml", CASE)
    stopped = Outcome(Ending.NOT_CONVERGED, "first step failed.", "Take smaller steps.")
    solved = SimpleNamespace(outcome=stopped, loading=SimpleNamespace(delta=()))
    monkeypatch.setattr(fem, "solve", lambda *a, **k: solved)
    code = assembly.run(["case", str(tmp_path / "case.toml"), "--out", str(tmp_path / "out")])
    shown = " ".join(capsys.readouterr().out.split())
    assert code == 3
    assert shown == "not-converged: first step failed. Take smaller steps."


@pytest.mark.parametrize(("needed", "code"), [(True, doctor.EXIT_ENVIRONMENT), (False, 0)])
def test_doctor_names_the_remedy(monkeypatch, capsys, needed, code):
    lack = EnvironmentFinding(
        "gmsh", "no libGLU", fine=False, needed=needed, remedy="install libglu1-mesa"
    )
    monkeypatch.setattr(doctor, "examine", lambda: (EnvironmentFinding("processors", "2"), lack))
    assert doctor.doctor() == code
    assert "-> install libglu1-mesa" in capsys.readouterr().out


def test_doctor_looks_at_this_environment():
    findings = {finding.name: finding for finding in doctor.examine()}
    assert findings["gmsh"].fine
    assert "python" in findings["versions"].state
    assert findings["compiled code"].fine
