"""Every option and argument of every command acts, or is refused beside what rules it out."""

import ast
import inspect
import textwrap
from functools import cache
from pathlib import Path

import dentscope.reduce
import pytest
import typer.main
from dentscope.cli import run
from dentscope.cli.app import app
from dentscope.core.inputs.templates import CASE, INVERSE, template
from dentscope.reduce.output.row import Row


def commands(command, name=""):
    context = command.context_class(command)
    for last in getattr(command, "list_commands", lambda _: ())(context):
        found = command.get_command(context, last)
        yield from commands(found, f"{name} {last}".strip())
    if not hasattr(command, "list_commands"):
        yield name, command


COMMANDS = dict(commands(typer.main.get_command(app)))


@cache
def read_by_reductions():
    folder = Path(inspect.getfile(dentscope.reduce)).parent
    return {
        node.attr
        for file in folder.rglob("*.py")
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load)
    }


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_reads_every_option(name):
    work = inspect.unwrap(COMMANDS[name].callback)
    tree = ast.parse(textwrap.dedent(inspect.getsource(work)))
    read = {
        node.id for node in ast.walk(tree)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)
    }  # fmt: skip
    known = set(inspect.signature(COMMANDS[name].callback).parameters)
    if name.startswith("reduce "):
        read |= read_by_reductions() | set(Row.model_fields)  # the row: a column of trials.csv each
    assert [p.name for p in COMMANDS[name].params if p.name in known - read] == []


@pytest.mark.parametrize(
    ("line", "option"),
    [
        ("impact --new ball --law hertz", "--law"),
        ("impact --new ball --exact", "--exact"),
        ("case --new --picture", "--picture"),
        ("inverse --new --out some", "--out"),
        ("fit --judge some --only hardening", "--only"),
        ("fit some --judge some", "CAMPAIGNS"),
        ("verify --list --quick", "--quick"),
        ("verify --list --only patch", "--only"),
        ("campaign run --scheduler tcp://nowhere:1 --workers 2", "--workers"),
    ],
)
def test_what_does_nothing_beside_another_option_is_refused(line, option, errs):
    (told,) = errs(*line.split()).splitlines()
    assert f"{option}: does nothing" in told


ACTS = (
    ("impact ball.toml --law fitted --exact", "impact ball.toml --law hertz --exact"),
    ("impact ball.toml --law fitted --exact", "impact ball.toml --law fitted"),
    ("impact --new ball new.toml", "impact --new rod new.toml"),
    ("case --new new.toml", "case --new other.toml"),
    ("inverse --new new.toml", "inverse --new other.toml"),
    ("inverse inverse.toml --out one", "inverse inverse.toml --out two"),
    ("laws compare case.toml --law hertz", "laws compare case.toml --law fitted"),
    ("laws compare case.toml --law hertz", "laws compare case.toml --law hertz --out two"),
    ("laws show hertz", "laws show fitted"),
    ("export dem case.toml --speed 1", "export dem case.toml --speed 2"),
    ("export dem case.toml --speed 1", "export dem case.toml --speed 1 --mass 1e-3"),
    ("export dem case.toml --speed 1", "export dem case.toml --speed 1 --law thornton"),
    ("export dem case.toml --speed 1", "export dem case.toml --speed 1 --out two"),
    ("export law fitted", "export law compact"),
    ("keys case", "keys inverse"),
    ("materials steel-1010-hot-rolled", "materials steel-1018-hot-rolled"),
    ("recordings new one", "recordings new one --rod"),
    ("recordings check kharaz-2001-oblique", "recordings check thesis-chapter-4"),
    ("recordings audit kharaz-2001-oblique", "recordings audit kharaz-2001-oblique --all"),
    ("examples --to one", "examples --to two"),
)
"""Two uses that differ in an option or an argument, of the commands that are quick."""


@pytest.mark.parametrize(("one", "other"), ACTS, ids=lambda line: line)
def test_an_option_changes_what_is_printed_or_written(one, other, tmp_path, monkeypatch, capsys):
    told = []
    for number, line in enumerate((one, other)):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "ball.toml").write_text(template("ball").partition("[sweep]")[0])
        (folder / "case.toml").write_text(CASE)
        (folder / "inverse.toml").write_text(INVERSE)
        monkeypatch.chdir(folder)
        assert run(line.split()) == 0
        files = {
            str(p.relative_to(folder)): p.read_bytes()
            for p in folder.rglob("*") if p.is_file() and p.suffix != ".h5"
        }  # fmt: skip
        told.append((capsys.readouterr().out, files))
    assert told[0] != told[1]
