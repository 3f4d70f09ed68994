"""Every command line of the documentation can be typed, and every link leads somewhere."""

import re
import shlex
from pathlib import Path

import pytest
import typer
from dentscope.cli import app as assembly

ROOT = Path(__file__).resolve().parents[3]
COMMAND = typer.main.get_command(assembly.app)
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", flags=re.DOTALL | re.MULTILINE)
# what a change was called then, CHANGELOG alone knows
PAGES = sorted(
    str(page.relative_to(ROOT))
    for page in (
        ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "SECURITY.md",
        *(ROOT / "docs").rglob("*.md"), *(ROOT / "data").rglob("*.md"),
    )
    if page.name != "remarks.md"  # a part of docs/proof.md
)  # fmt: skip


def lines(page: str) -> list[str]:
    text = (ROOT / page).read_text(encoding="utf-8")
    # a fence without a language: what is typed or shown
    blocks = [block.replace("\\\n", " ") for kind, block in FENCE.findall(text) if not kind]
    typed = [line for block in blocks for line in block.splitlines()]
    typed += re.findall(r"`(dentscope [^`\n]+)`", FENCE.sub("", text))
    found = [line.split("#")[0] for line in typed]
    return [x.split("dentscope ", 1)[1] for x in found if re.match(r"(\.venv/bin/)?dentscope ", x)]


@pytest.mark.parametrize(("page", "line"), [(p, line) for p in PAGES for line in lines(p)])
def test_a_line_can_be_typed(page, line):
    command, words = COMMAND, shlex.split(line.rstrip("\\ ").replace(",", " "))
    context = typer.Context(COMMAND)
    if words[0] == "COMMAND":
        return
    while hasattr(command, "get_command") and words:
        first = words[0].split("|")[0]  # reduce sound|table FILE
        if first.isupper():  # reduce KIND FILE
            first = command.list_commands(context)[0]
        if command.get_command(context, first) is None:
            break
        command = command.get_command(context, first)
        words.pop(0)
    known = {name for p in command.params for name in (*p.opts, *p.secondary_opts)}
    assert {w for w in words if w.startswith("--")} <= known | {"--help", "-h"}
    if hasattr(command, "get_command"):  # a group alone, or with an option of its own
        assert not words or words[0] in known


def test_there_are_lines():
    assert sum(len(lines(page)) for page in PAGES) > 60


def anchor(heading: str) -> str:
    """As GitHub makes it of a heading."""
    plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")


@pytest.mark.parametrize("page", [*PAGES, "CHANGELOG.md"])
def test_links_lead_to_files_and_headings(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", FENCE.sub("", (ROOT / page).read_text("utf-8"))):
        if re.match(r"\w+:", target):
            continue
        path, _, part = target.partition("#")
        there = (ROOT / page).parent / path if path else ROOT / page
        assert there.exists(), target
        if part:
            text = FENCE.sub("", there.read_text(encoding="utf-8"))
            assert part in {anchor(h) for h in re.findall(r"^#+ (.*)$", text, re.MULTILINE)}, target
