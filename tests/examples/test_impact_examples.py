"""The impact examples run and show what they say."""

from __future__ import annotations

import csv
import runpy
from pathlib import Path

import numpy as np
import pytest
from dentscope.cli import run

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def table(path: Path) -> csv.DictReader[str]:
    return csv.DictReader(path.read_text(encoding="utf-8").splitlines())


def test_oblique_rod() -> None:
    found = runpy.run_path(str(EXAMPLES / "ex03_impact_oblique.py"))["main"]()
    rigid, vibrating = found[0], found[10]
    assert rigid.contacts == 1
    # The bar's vibration brings several contacts and halves the dent (Stoianovici, Hurmuzlu 1996).
    assert vibrating.contacts > 1
    assert vibrating.residual_flat_m < 0.6 * rigid.residual_flat_m
    assert abs(vibrating.energy_residual) < 1e-6


def test_set_up_of_a_rod(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["impact", str(EXAMPLES / "impact_rod.toml"), "--out", str(tmp_path)]) == 0
    rows = list(table(tmp_path / "impact_rod.csv"))
    assert [row["law"] for row in rows] == ["fitted", "jackson-green"]
    # a rigid rod that slides throughout: the ratio of the impulses is the friction (Coulomb)
    assert all(abs(float(row["friction_impulse_ratio"]) - 0.13) < 1e-6 for row in rows)


def test_scar_of_a_rod(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["inverse", str(EXAMPLES / "inverse_scar.toml"), "--out", str(tmp_path)]) == 0
    (row,) = table(tmp_path / "inverse_scar-inverse.csv")
    # Ghaednia's thesis, section 5.3.1, prints 1.40 ms for this impact
    assert float(row["duration_s"]) == pytest.approx(1.40e-3, rel=0.03)


def test_many_impacts() -> None:
    found, fall = runpy.run_path(str(EXAMPLES / "ex05_many_impacts.py"))["main"]()
    assert set(found["route"]) == {"work"}
    # from Hertz's e = 1 on ever steeper, towards Johnson's v^(-1/4) of full plasticity (11.21)
    v, e = np.log(found["impact_speed_m_s"][::10_000]), np.log(found["restitution"][::10_000])
    slopes = np.diff(e) / np.diff(v)
    assert -0.25 < slopes[-1] < -0.18 < slopes[0] < 0.0
    assert (np.diff(slopes) < 1e-3).all()
    # air holds a steel ball of 1 cm back by some per mille
    assert 0.995 * 4.429 < fall < 0.999 * 4.429
