"""Every command line of the README and the tutorial names commands and options that there are."""

import re
import shlex
from pathlib import Path

import pytest
import typer
from dentscope.cli import app as assembly

ROOT = Path(__file__).resolve().parents[3]
COMMAND = typer.main.get_command(assembly.app)
PAGES = ("README.md", "docs/tutorial.md")


def lines(page: str) -> list[str]:
    text = (ROOT / page).read_text(encoding="utf-8")
    # a fence without a language: what is typed or shown
    text = re.sub(r"^```\w+\n.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE)
    blocks = re.findall(r"^```\n(.*?)^```$", text, flags=re.DOTALL | re.MULTILINE)
    found = [line.split("#")[0] for block in blocks for line in block.splitlines()]
    return [x.split("dentscope ", 1)[1] for x in found if re.match(r"(\.venv/bin/)?dentscope ", x)]


@pytest.mark.parametrize(("page", "line"), [(p, line) for p in PAGES for line in lines(p)])
def test_a_line_can_be_typed(page, line):
    command, words = COMMAND, shlex.split(line)
    context = typer.Context(COMMAND)
    while hasattr(command, "get_command") and words and command.get_command(context, words[0]):
        command = command.get_command(context, words.pop(0))
    assert command is not COMMAND
    known = {name for p in command.params for name in (*p.opts, *p.secondary_opts)}
    assert {w for w in words if w.startswith("--")} <= known | {"--help", "-h"}


def test_there_are_lines():
    assert sum(len(lines(page)) for page in PAGES) > 15
