"""The cheap checks are run, and the estimates of the long ones on curves whose error is known."""

import math

import numpy as np
import pytest
from dentscope import fem
from dentscope.core import Material, Pair
from dentscope.studies.verification.bench import Branch, Effort, Solved
from dentscope.studies.verification.checks.convergence import difference, ordered_cases, plan_of
from dentscope.studies.verification.checks.flattening import _kogut_etsion
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


def test_known_differences_are_found_and_ripple_is_kept_apart():
    other = solved(force_factor=1.003, radius_factor=0.99, share=0.602)
    off, waves = difference(other, solved(wave=0.01))
    # H = F/(pi a^2): 0.3 % + 2 % of 1 %; the ripple leaves little in the smoothed curves
    assert off[[1, 2]] == pytest.approx([1.005, 0.002], rel=0.02)
    assert off[0] == pytest.approx(0.3, abs=0.25)
    assert off[3] == pytest.approx(2.3, abs=0.25)
    assert waves[0] == pytest.approx(100.0 * 0.01 / math.sqrt(2.0), rel=0.1)
    assert waves[1] < 1e-6


def test_all_cases_of_table_2_1_are_planned_once_and_companions_are_coarser():
    cases = ordered_cases()
    assert len(cases) == len(set(cases)) == 15
    for effort in Effort:
        plan = plan_of(effort)
        assert plan.coarser.fine == pytest.approx(2.0 * plan.base.fine)
        assert plan.coarser.step_ratio == plan.base.step_ratio
        assert plan.bolder.step_ratio == pytest.approx(plan.base.step_ratio**2)
        assert plan.bolder.fine == plan.base.fine
    assert plan_of(Effort.PRODUCTION).base == fem.Accuracy.production()


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
