"""The name of a trial or a striker never leads to another folder."""

from pathlib import Path

import pytest
from dentscope.cli import run
from dentscope.core.errors import InputError
from dentscope.core.inputs.toml_input import parse_model
from dentscope.core.rig import Rig
from dentscope.reduce.measured import Measured, Trial
from dentscope.reduce.output.into_set import store
from dentscope.reduce.output.row import Row
from dentscope.reduce.reduced import Reduced

TABLE = "drop_height_m,rebound_height_m\n0.5,0.2\n0.4,0.15\n"
PATHS = ("../x", "/tmp/x", "a/b", "..", "a\\b", "C:x", "x\x00y", "x" * 201)


@pytest.mark.parametrize("name", [n for n in PATHS if "\x00" not in n])
@pytest.mark.parametrize("place", ["--out", "--into"])
def test_an_option_names_no_other_folder(tmp_path, errs, name, place):
    raw = tmp_path / "raw.csv"
    raw.write_text(TABLE)
    command = ("reduce", "table", raw, "--holds", "trials", "--trial", name)
    told = errs(*command, place, tmp_path / "o" / "o")
    assert "trial" in told
    assert "text that can name a file" in told
    assert sorted(p.name for p in tmp_path.iterdir()) == ["raw.csv"]


@pytest.mark.parametrize("name", PATHS)
def test_a_striker_of_a_file_names_no_other_folder(name: str) -> None:
    steel = {"E_Pa": 2e11, "nu": 0.3}
    ball = {"shape": "sphere", "tip_radius_m": 0.01, **steel}
    with pytest.raises(InputError, match="text that can name a file"):
        parse_model({"target": steel, "strikers": {name: ball}}, Rig, source="set.toml")


def test_trials_without_a_label_keep_a_row_each(tmp_path: Path) -> None:
    run(["recordings", "new", str(tmp_path / "set")])
    blows = [Trial({"restitution": Measured(e, 0.01)}) for e in (0.8, 0.7)]
    (tmp_path / "gates.txt").write_text("1.0 0.8\n1.0 0.7\n")
    reduced = Reduced(tmp_path / "gates.txt", {}, tuple(blows), lambda to: None)
    row = Row(striker="ball", impact_speed_m_s=1.0)
    found = store(reduced, tmp_path / "set", row, kind="gates", options={})
    assert found.trials == ("gates-1", "gates-2")
    rows = (tmp_path / "set" / "trials.csv").read_text().splitlines()
    assert [line.split(",")[0] for line in rows[-2:]] == ["gates-1", "gates-2"]
