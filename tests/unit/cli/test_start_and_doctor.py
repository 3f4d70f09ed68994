"""The command line starts without its heavy parts; the environment check names what lacks."""

import pytest
from dentscope.cli import app as assembly
from dentscope.cli import doctor
from dentscope.cli.doctor import EnvironmentFinding
from dentscope.core import Ending, InputError, Outcome
from made_processes import python


def test_help_loads_no_numerics():
    heavy = "numpy scipy numba gmsh skfem pyvista matplotlib h5py".split()
    program = (
        f"import sys, dentscope.cli;print(*[name for name in {heavy!r} if name in sys.modules])"
    )
    assert python("-c", program, check=True).stdout.strip() == ""


@pytest.mark.parametrize(
    ("raised", "code", "line"),
    [
        (InputError("-1", source="a.toml", key="nu"), 2, "a.toml: nu: -1\n"),
        (KeyboardInterrupt(), 130, "stopped\n"),
    ],
)
def test_how_the_command_line_ends_early(monkeypatch, capsys, raised, code, line):
    def end(**options):
        raise raised

    monkeypatch.setattr(assembly, "app", end)
    assert assembly.run([]) == code
    assert capsys.readouterr().err == line


def test_a_case_that_does_not_converge_ends_with_its_reason_and_code_3(
    monkeypatch, capsys, tmp_path
):
    from dentscope import fem

    text = (
        "radius_m = 0.01\n[sphere]\nE_Pa = 2e11\nnu = 0.3\nSy_Pa = 1e9\n"
        "[flat]\nE_Pa = 2e11\nnu = 0.3\nSy_Pa = 1e9\n[load]\nmax_delta_over_R = 0.01\n"
    )
    (tmp_path / "case.toml").write_text(text)

    class Stopped:
        outcome = Outcome(Ending.NOT_CONVERGED, "first step failed.", "Take smaller steps.")

        class loading:
            delta = ()

    monkeypatch.setattr(fem, "solve", lambda *a, **k: Stopped())
    code = assembly.run(["case", str(tmp_path / "case.toml"), "--out", str(tmp_path / "out")])
    shown = " ".join(capsys.readouterr().out.split())
    assert code == 3
    assert shown == "not-converged: first step failed. Take smaller steps."


@pytest.mark.parametrize(("needed", "code"), [(True, doctor.EXIT_ENVIRONMENT), (False, 0)])
def test_doctor_names_the_remedy(monkeypatch, capsys, needed, code):
    lack = EnvironmentFinding(
        "gmsh", "no libGLU", fine=False, needed=needed, remedy="install libglu1-mesa"
    )
    monkeypatch.setattr(doctor, "examine", lambda: (EnvironmentFinding("processors", "2"), lack))
    assert doctor.doctor() == code
    assert "-> install libglu1-mesa" in capsys.readouterr().out


def test_doctor_looks_at_this_environment():
    findings = {finding.name: finding for finding in doctor.examine()}
    assert findings["gmsh"].fine
    assert "python" in findings["versions"].state
    assert findings["compiled code"].fine
