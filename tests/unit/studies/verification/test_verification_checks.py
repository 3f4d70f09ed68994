"""The cheap checks are run, and the estimates of the long ones on curves whose error is known."""

import math

import numpy as np
import pytest
from dentscope import fem
from dentscope.core import Material, Pair
from dentscope.studies.verification.bench import Branch, Solved
from dentscope.studies.verification.checks.flattening import _kogut_etsion
from dentscope.studies.verification.checks.level_errors import _difference, _left, _own
from dentscope.studies.verification.checks.locking import _tube
from dentscope.studies.verification.pairs import RIGID

BODY = Material(E=200e9, nu=0.3, Sy=500e6)


def test_limit_pressure_of_a_thick_tube():
    """Hill: 2/sqrt(3) Sy ln(b/a) in plane strain."""
    assert _tube(4) == pytest.approx(2.0 / math.sqrt(3.0) * math.log(2.0), rel=0.01)


def solved(force_factor=1.0, radius_factor=1.0, share=0.6, wave=0.0):
    delta = np.geomspace(1e-7, 1e-5, 500)
    ripple = 1.0 + wave * np.sin(2.0 * np.pi * np.log(delta) / 0.1)
    curve = {
        "delta": delta,
        "force": 1e3 * (delta / 1e-5) ** 1.2 * force_factor * ripple,
        "radius": 1e-4 * (delta / 1e-5) ** 0.5 * radius_factor,
        "sphere": share * delta,
        "flat": (1.0 - share) * delta,
    }
    return Solved(Pair(BODY, BODY, 1e-3), Branch(curve), (), {}, True, "")


def test_known_differences_are_found_and_what_a_finer_solve_has_left():
    """First order: 4, 2 and 1 parts off; half of the error is seen, as much is left."""
    other = solved(force_factor=1.003, radius_factor=0.99, share=0.602)
    off = _difference(other, solved(), solved()["delta"]).mean(axis=1)
    assert off == pytest.approx([np.log(1.003), np.log(0.99), 0.002, np.log(1.003 / 0.99**2)])
    trio = [
        solved(
            1.0 + x,
            1.0 + x,
            0.6 + x,
        )
        for x in (4e-4, 2e-4, 1e-4)
    ]
    assert _left([trio]) == pytest.approx(1.0, abs=1e-2)
    assert _own(*trio[1:], _left([trio]), "").error[2] == pytest.approx(2e-4, rel=1e-2)


def test_kogut_and_etsion_meet_hertz_at_first_yield_and_their_own_branches():
    """The power laws of 2002: within 3 % of Hertz at w = 1, of each other at w = 6."""
    pair = Pair(BODY, RIGID, 1e-3)
    critical = (math.pi * (0.454 + 0.41 * 0.3) * 2.8 * 500e6 / (2.0 * pair.E_reduced)) ** 2 * 1e-3
    F, a, w = _kogut_etsion(pair, critical * np.array([1.0, 5.999999, 6.000001]))
    hertz = 4.0 / 3.0 * pair.E_reduced * math.sqrt(1e-3) * critical**1.5
    assert w[0] == pytest.approx(1.0)
    assert F[0] == pytest.approx(1.03 * hertz)
    assert F[2] == pytest.approx(F[1], rel=0.03)
    assert a[2] == pytest.approx(a[1], rel=0.03)


def test_the_command_measures_writes_and_answers_with_its_exit_code(tmp_path, capsys):
    from dentscope.cli import run
    from dentscope.studies.commands.verify import EXIT_MISSED
    from dentscope.studies.verification.result import Measurement, Result, write_result

    folder, report = tmp_path / "build", tmp_path / "docs" / "verification.md"
    asked = ["verify", "--only", "patch", "--quick", "--folder", str(folder)]
    asked += ["--report", str(report)]
    assert run(asked) == 0
    assert "Patch test" in report.read_text()
    missed = Result(
        name="patch", title="t", about="a", effort="quick",
        numerics_version=fem.NUMERICS_VERSION,
        measurements=(Measurement("x", 2.0, "", None, 1.0),),
    )  # fmt: skip
    write_result(missed, folder / "results" / "patch-quick.json")
    assert run(asked) == EXIT_MISSED
    assert "missed: patch: x: 2" in capsys.readouterr().out
