"""What a terminal shows: help of every command at any width, units, nothing cut, completion."""

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest
import typer
from dentscope import __version__
from dentscope.cli import app as assembly
from dentscope.cli.diagnose import _progress as progress_of_diagnosis
from dentscope.cli.shared.terminal import parts, say, show_table
from rich.console import Console

COMMAND = typer.main.get_command(assembly.app)


def letters(text: str) -> str:
    return "".join(text.split())


def commands() -> list[list[str]]:
    def below(command, name):
        found = [name]
        for one in getattr(command, "commands", {}):
            found += below(command.commands[one], [*name, one])
        return found

    return below(COMMAND, [])


def found_at(names):
    command = COMMAND
    for name in names:
        command = command.commands[name]
    return command


@pytest.mark.parametrize("width", [60, 80, 120])
@pytest.mark.parametrize("names", commands(), ids=" ".join)
def test_help_is_whole_at_every_width(names, width, monkeypatch, prints):
    monkeypatch.setenv("COLUMNS", str(width))
    shown = prints(*names, "-h")
    assert max(map(len, shown.splitlines())) <= width
    assert "…" not in shown
    command = found_at(names)
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
