"""`dentscope case`: what it writes, and how it answers mistakes."""

import csv

import meshio
import numpy as np
import pytest
from dentscope.campaigns import read_curves
from dentscope.cli import run

GOOD = """
radius_m = 0.002
[sphere]
E_Pa = 200e9
nu = 0.3
Sy_Pa = 900e6
[flat]
E_Pa = 200e9
nu = 0.3
Sy_Pa = 300e6
[load]
max_delta_over_R = 3e-4
unload_from = [3e-4]
[accuracy]
level = "smoke"
"""


@pytest.mark.fe
def test_a_case_writes_its_curve_and_fields(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(GOOD)
    assert run(["case", str(path), "--out", str(tmp_path / "out")]) == 0
    with (tmp_path / "out" / "curve.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert {row["phase"] for row in rows} == {"load", "unload-1"}
    load = [row for row in rows if row["phase"] == "load"]
    assert float(load[-1]["delta_over_R"]) == pytest.approx(3e-4)
    # elastic start: Hertz's force at the first depth
    d = float(load[0]["delta_over_R"]) * 0.002
    hertz = 4.0 / 3.0 * (200e9 / 0.91 / 2.0) * np.sqrt(0.002) * d**1.5
    assert float(load[0]["force_N"]) == pytest.approx(hertz, rel=0.01)
    # the two solves differ, by no more than their coarse meshes explain
    for name in ("force_N", "contact_radius_m", "sphere_share", "hardness_over_Symin"):
        relative = [float(r[f"{name}_uncertainty"]) / float(r[name]) for r in load]
        assert 1e-5 < max(relative) < 0.15
    assert all(r["force_N_uncertainty"] == "" for r in rows if r["phase"] == "unload-1")
    (stored,) = read_curves(tmp_path / "out" / "result.h5")
    assert stored.curve["force"] == pytest.approx([float(r["force_N"]) for r in load], rel=1e-12)
    assert len(stored.unloadings) == 1
    assert stored.profiles["pressure"].shape[0] == 10
    fields = meshio.read(tmp_path / "out" / "fields-0.0003.vtu")
    flat = np.concatenate(fields.cell_data["body"]) == 1.0
    mises = np.concatenate(fields.cell_data["von_mises_Pa"])
    assert mises[flat].max() == pytest.approx(300e6, rel=0.02)
    assert mises[~flat].max() < 900e6


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("E_Pa = 200e9\nnu = 0.3\nSy_Pa = 900e6", "E_Pa = -1\nnu = 0.3", ["sphere.E_Pa", "-1"]),
        ("nu = 0.3\nSy_Pa = 300e6", "nu = 0.5\nSy_Pa = 300e6", ["flat.nu", "0.5"]),
        ("Sy_Pa = 300e6", "Sy_Pa = 0", ["flat.Sy_Pa"]),
        ("radius_m = 0.002", "radius_m = 0", ["radius_m"]),
        ("radius_m = 0.002", "", ["radius_m", "missing"]),
        ("max_delta_over_R = 3e-4", "max_delta_over_R = 3", ["load.max_delta_over_R"]),
        ("unload_from = [3e-4]", "unload_from = [0.1]", ["load.unload_from"]),
        ('level = "smoke"', 'level = "best"', ["accuracy.level", "production"]),
        ("[flat]", "[flat]\nhardness = 3", ["flat.hardness", "unknown key"]),
    ],
)
def test_a_mistake_is_one_line_with_its_key(tmp_path, capsys, old, new, words):
    path = tmp_path / "case.toml"
    path.write_text(GOOD.replace(old, new))
    assert run(["case", str(path), "--out", str(tmp_path / "out")]) == 2
    message = capsys.readouterr().err.strip()
    assert len(message.splitlines()) == 1
    for word in [str(path), *words]:
        assert word in message
    assert not (tmp_path / "out").exists()


def test_three_mistakes_are_three_lines(tmp_path, capsys):
    path = tmp_path / "case.toml"
    path.write_text(GOOD.replace("nu = 0.3", "nu = 3").replace("radius_m = 0.002", "radius_m = -1"))
    assert run(["case", str(path)]) == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 3
