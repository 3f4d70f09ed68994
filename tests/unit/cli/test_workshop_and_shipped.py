"""Commands of the workshop where it is absent; recording sets and examples that are installed."""

from pathlib import Path

import pytest
import typer
from dentscope.cli import run, studies
from dentscope.core import InputError
from dentscope.recordings.shipped import set_folder, shipped_sets
from typer.testing import CliRunner


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
