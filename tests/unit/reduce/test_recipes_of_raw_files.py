"""Recipes that turn many raw files into one set, and what they say of files that show nothing."""

import runpy
import shutil
from pathlib import Path

import numpy as np
import pytest
from dentscope.recordings import read
from dentscope.reduce.output.recipe import run_recipe

ROOT = Path(__file__).parents[3]
RAW = ROOT.parent / "shared" / "recordings"
measured = pytest.mark.skipif(not RAW.exists(), reason="the recordings are not here")


def _recipe(name):
    return runpy.run_path(str(ROOT / "data" / "recordings" / "recipes" / f"{name}.py"))["recipe"]


@measured
def test_ball_sounds_give_one_set(tmp_path):
    for file in sorted((RAW / "ball-bounce-acoustic").rglob("*65.xls"))[:3]:
        shutil.copy(file, tmp_path)
    made, left_out = _recipe("ball_sounds")(tmp_path, tmp_path / "set")
    found = read(tmp_path / "set")
    assert not left_out
    assert made == len(found.trials.trial) > 15
    e = found.values("restitution")
    # rebound heights by video, same ball and authors: 49.6 of 65 cm, e = 0.87, at the first bounce
    assert 0.8 < np.median(e) < 0.92
    # the first bounce of a run falls from 65 cm
    assert np.max(found.trials.impact_speed_m_s) == pytest.approx(
        np.sqrt(2 * 9.81 * 0.65), rel=0.01
    )


@measured
def test_marble_recipe_leaves_out_what_shows_no_bounce(tmp_path):
    folder = RAW / "marble-on-paper-a4" / "a4"
    (tmp_path / "raw").mkdir()
    for name in ("1-60-M.csv", "2-60-M.csv"):
        shutil.copy(folder / name, tmp_path / "raw")
    (tmp_path / "raw" / "3-60-M.csv").write_text((folder / "1-60-M.csv").read_text()[:2000])
    made, left_out = _recipe("marble_paper")(tmp_path / "raw", tmp_path / "set")
    assert made == 2
    assert [line.partition(":")[0] for line in left_out] == ["3-60-M.csv"]
    # SOURCE.md: about 0.54 on 60 sheets
    found = read(tmp_path / "set")
    assert found.values("restitution") == pytest.approx([0.54, 0.54], abs=0.02)
    assert found.trials.varied == {"x_sheets": ("60", "60")}


def test_a_folder_without_raw_files_gives_a_line(tmp_path):
    made, left_out = _recipe("ball_sounds")(tmp_path, tmp_path / "set")
    assert made == 0
    assert left_out == ["no raw file of the kind that the recipe reads"]
    assert not (tmp_path / "set").exists()


@pytest.mark.parametrize("given", [(), ("one",), ("one", "two", "three", "four"), ("a", "b", "c")])
def test_a_recipe_says_how_it_is_called(given, monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["recipe", *given])
    with pytest.raises(SystemExit) as end:
        run_recipe(lambda *_: (1, []), "A set.\n\n    python recipe.py RAW SET [COUNT]\n\nMore.")
    assert end.value.code == 2
    assert capsys.readouterr().err == "usage: python recipe.py RAW SET [COUNT]\n"


def test_a_recipe_tells_a_mistake_in_one_line(tmp_path, monkeypatch, capsys):
    about = "A set.\n\n    python recipe.py RAW SET [COUNT]"
    monkeypatch.setattr("sys.argv", ["recipe", str(tmp_path / "none"), str(tmp_path), "3"])
    with pytest.raises(SystemExit) as end:
        run_recipe(_recipe("tabletennis_spin"), about)
    assert end.value.code == 2
    assert capsys.readouterr().err.startswith(f"{tmp_path / 'none'}: no such file")
    (tmp_path / "none").write_text("no archive")
    with pytest.raises(SystemExit):
        run_recipe(_recipe("tabletennis_spin"), about)
    assert "no archive" in capsys.readouterr().err
