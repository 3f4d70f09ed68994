"""Chapter 5's inverse: where nothing slides, what is refused, the command."""

import math
from pathlib import Path

import pytest
from dentscope.cli import run
from dentscope.core import InputError
from dentscope.core.inputs.templates import INVERSE
from dentscope.dynamics.files.inverse_file import read_inverse
from dentscope.dynamics.inverse import MeasuredScar, alpha, infer, mobility
from dentscope.studies.thesis.chapter5 import thesis_rod, thesis_rows


def test_where_the_tip_sticks_and_what_is_objected() -> None:
    """No sliding at either end of the angles for mu = 0.5 (7.3 and 52), never for mu = 1."""
    rod, rows = thesis_rows()
    for angle in (7.3, 52.0):
        assert alpha(rod, math.radians(angle), mu=0.5) == pytest.approx(0.0, abs=0.01)
    steepest = max(mobility(rod, math.radians(a)).stick_friction for a in range(1, 90))
    assert steepest == pytest.approx(0.77, abs=0.01)
    for row in rows:
        assert row.inferred.objections
        assert row.inferred.return_duration < row.inferred.duration


def test_friction_that_sticks_is_a_mistake() -> None:
    with pytest.raises(InputError, match="stick"):
        infer(thesis_rod(), MeasuredScar(math.radians(70), 3.0, 0.5, 0.4, 1e-4, 2e-4))


def test_more_back_than_came_and_a_depth_beyond_the_tip_are_told() -> None:
    found = infer(thesis_rod(), MeasuredScar(math.radians(45), 2.0, 0.1, 1.5, 0.026, 1e-3))
    assert any("restitution 1.5: more comes back" in line for line in found.objections)
    assert any("0.026 m is above the tip's radius" in line for line in found.objections)


def test_file_and_command(tmp_path: Path, errs) -> None:
    file = tmp_path / "trials.toml"
    file.write_text(INVERSE)
    row = read_inverse(file)[0]
    assert row.inferred.duration == pytest.approx(1.38e-3, rel=0.01)
    assert run(["inverse", str(file), "--out", str(tmp_path)]) == 0
    assert (tmp_path / "trials-inverse.csv").exists()
    file.write_text(INVERSE.replace("0.13", "0.9"))
    told = errs("inverse", file, "--out", tmp_path)
    assert "trial T01: friction_impulse_ratio: 0.9 makes the tip stick" in told
