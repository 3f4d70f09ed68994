"""Keys, templates, commands of the documentation, shipped sets and examples."""

import re
import shlex
import tomllib
from pathlib import Path

import pytest
import typer
from dentscope.cli import app as assembly
from dentscope.cli import run, studies
from dentscope.cli.shared.keys import FILES, keys_of
from dentscope.core import InputError
from dentscope.core.inputs.templates import CASE, INVERSE, KINDS, template
from dentscope.recordings.shipped import set_folder, shipped_sets
from made_files import put, rows_of
from typer.testing import CliRunner


@pytest.mark.parametrize("kind", FILES)
def test_every_key_says_what_it_means_and_allows(kind):
    found = keys_of(kind)
    assert len(found) > 10
    for key in found:
        assert len(key.meaning) > 5, key
        assert key.allowed, key
    assert len({(k.table, k.name) for k in found}) == len(found)


def test_ranges_units_and_defaults_come_from_the_schema():
    found = {(k.table, k.name): k for k in keys_of("impact")}
    assert found["[target]", "E_Pa"].allowed == "a quantity from 1000 to 2e+12 [Pa]"
    assert found["[target]", "nu"].allowed == "a quantity 0 <= nu < 0.5"
    assert found["[impact]", "angle_deg"].allowed == "a number above 0 and up to 90 [degrees]"
    assert found["[impact]", "modes"].default == "default: 0"
    assert found["[strikers.NAME]", "tip_radius_m"].default == ""
    assert '"half-space"' in found["[impact]", "support"].allowed
    assert {k.name: k for k in keys_of("trials")}["press_rate_per_s"].allowed.endswith("[1/s]")


@pytest.mark.parametrize(
    ("kind", "text"),
    [("case", CASE), ("inverse", INVERSE), *(("impact", template(kind)) for kind in KINDS)],
)
def test_a_template_uses_keys_that_there_are(kind, text):
    known = {k.name for k in keys_of(kind)} | {"value", "std", "from", "to", "count", "spacing"}
    # also what is commented out
    lines = [line.removeprefix("# ") for line in text.splitlines()]
    written = {line.split("=")[0].strip() for line in lines if " = " in line and line[0] != "#"}
    written = {name for name in written if name.replace("_", "").isalnum() and " " not in name}
    assert len(written) > 8
    assert written - known == set()


@pytest.mark.fe
def test_the_template_of_a_case_is_solved_as_it_is(tmp_path, prints):
    file = tmp_path / "mine.toml"
    assert f"dentscope case {file}" in prints("case", "--new", file)
    # the same pair, less deep: a test has seconds
    turns = [2e-4, 5e-4, 1e-3]
    text = file.read_text().replace("= 0.01  ", "= 0.001  ")
    text = text.replace("[0.001, 0.003, 0.01]  ", f"{turns}  ")
    assert tomllib.loads(text)["load"] == {"max_delta_over_R": 0.001, "unload_from": turns}
    prints("case", put(file, text), "--out", tmp_path / "out")
    first = rows_of(tmp_path / "out" / "curve.csv")[0]
    # Hertz at the first depth, below yield: 4/3 E' sqrt(R) d^1.5
    reduced = 1.0 / (0.91 / 2.1e11 + 0.91 / 2.0e11)
    d = 0.005 * float(first["delta_over_R"])
    hertz = 4.0 / 3.0 * reduced * (0.005 * d**3) ** 0.5
    assert (first["phase"], float(first["force_N"])) == ("load", pytest.approx(hertz, rel=0.01))
    assert (tmp_path / "out" / "law.json").exists()


def test_the_template_of_an_inverse_runs_as_it_is(tmp_path: Path, monkeypatch, errs, prints):
    monkeypatch.chdir(tmp_path)
    assert run(["inverse", "--new"]) == 0
    assert "T01" in prints("inverse", "inverse.toml")
    assert "exists" in errs("inverse", "--new")


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


def group():
    app = typer.Typer()
    app.command("beside")(lambda: None)
    for name in ("verify", "proof"):
        studies.add(app, name)
    return app


def test_workshop_commands_appear_in_a_checkout():
    help_ = CliRunner().invoke(group(), ["--help"]).output
    assert "verify" in help_
    assert "proof" in help_


@pytest.mark.parametrize(
    "line", [["verify", "--only", "x"], ["verify", "--help"], ["proof", "run"]]
)
def test_workshop_commands_elsewhere_are_hidden_and_say_where_to_get_them(monkeypatch, line):
    monkeypatch.setattr(studies, "present", lambda: False)
    app = group()
    assert "verify" not in CliRunner().invoke(app, ["--help"]).output
    with pytest.raises(InputError, match=rf"`dentscope {line[0]}` .* checkout"):
        CliRunner().invoke(app, line, catch_exceptions=False, standalone_mode=False)


def test_a_shipped_set_is_found_by_name_from_anywhere(tmp_path, monkeypatch, prints):
    monkeypatch.chdir(tmp_path)
    # Kharaz et al. 2001: twelve angles
    assert "12 trials" in prints("recordings", "check", "kharaz-2001-oblique")
    assert "kharaz-2001-oblique" in prints("recordings", "list")


@pytest.mark.parametrize(
    "command", [["diagnose"], ["recordings", "check"], ["recordings", "audit"]]
)
def test_a_wrong_name_lists_the_shipped_sets(tmp_path, monkeypatch, errs, command):
    monkeypatch.chdir(tmp_path)
    told = errs(*command, "kharaz-2002")
    assert len(told.splitlines()) == 1
    assert all(name in told for name in shipped_sets())


def test_a_folder_of_the_user_goes_before_a_shipped_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "leeb-steel-300hv").mkdir()
    (tmp_path / "other").mkdir()
    for name in ("leeb-steel-300hv", "other"):
        assert set_folder((tmp_path / name).relative_to(tmp_path)).resolve() == tmp_path / name
    assert set_folder(tmp_path / "absent" / "set") == tmp_path / "absent" / "set"
    results = tmp_path / "leeb-steel-300hv" / "verdict.json"  # of diagnose --out leeb-steel-300hv
    results.write_text("{}")
    assert set_folder(Path("leeb-steel-300hv")).parent.name == "recordings"
    results.with_name("set.toml").write_text("")
    assert set_folder(Path("leeb-steel-300hv")).resolve() == results.parent


def test_examples_are_listed_and_copied(tmp_path, prints):
    assert "case_steel.toml" in prints("examples")
    assert run(["examples", "--to", str(tmp_path / "new")]) == 0
    assert "radius_m" in (tmp_path / "new" / "case_steel.toml").read_text()
