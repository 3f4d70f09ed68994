"""The example files of impact and inverse run and show what they say."""

import csv
from pathlib import Path

import pytest
from dentscope.cli import run

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def table(path: Path) -> csv.DictReader:
    return csv.DictReader(path.read_text(encoding="utf-8").splitlines())


def test_set_up_of_a_rod(tmp_path: Path) -> None:
    assert run(["impact", str(EXAMPLES / "impact_rod.toml"), "--out", str(tmp_path)]) == 0
    rows = list(table(tmp_path / "impact_rod.csv"))
    assert [row["law"] for row in rows] == ["fitted", "jackson-green"]
    # a rigid rod that slides throughout: the ratio of the impulses is the friction (Coulomb)
    assert all(abs(float(row["friction_impulse_ratio"]) - 0.13) < 1e-6 for row in rows)


def test_scar_of_a_rod(tmp_path: Path) -> None:
    assert run(["inverse", str(EXAMPLES / "inverse_scar.toml"), "--out", str(tmp_path)]) == 0
    (row,) = table(tmp_path / "inverse_scar-inverse.csv")
    # Ghaednia's thesis, section 5.3.1, prints 1.40 ms for this impact
    assert float(row["duration_s"]) == pytest.approx(1.40e-3, rel=0.03)
