"""The parts of the verification and its cheap checks, on curves whose error is known."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from dentscope import fem
from dentscope.cli import run
from dentscope.core import InputError, Material, Pair
from dentscope.studies.commands.verify import EXIT_MISSED
from dentscope.studies.verification.bench import Bench, Effort, Solved
from dentscope.studies.verification.calculix.deck import Deck, write_deck
from dentscope.studies.verification.calculix.output import measure
from dentscope.studies.verification.checks import Check, check_named
from dentscope.studies.verification.checks.flattening import _kogut_etsion
from dentscope.studies.verification.checks.level_errors import _difference, _left, _own
from dentscope.studies.verification.checks.locking import _tube
from dentscope.studies.verification.curves import smoothed
from dentscope.studies.verification.flat_die import Die
from dentscope.studies.verification.pairs import RIGID, axis_stresses, exact_yield_constant
from dentscope.studies.verification.report import write_report
from dentscope.studies.verification.result import (
    Measurement,
    Result,
    Table,
    read_result,
    write_result,
)
from dentscope.studies.verification.runner import kept_result, run_checks


@pytest.mark.parametrize(
    ("value", "low", "high", "met", "used"),
    [(0.5, None, 2.0, True, 0.25), (3.0, None, 2.0, False, math.inf),
     (1.5, 0.0, 2.0, True, 0.5), (-0.4, -0.3, 0.3, False, math.inf),
     (math.nan, None, 0.3, False, math.inf), (2.0, 1.0, None, True, 0.5),
     (9.0, None, None, None, -1.0)],
)  # fmt: skip
def test_a_mark_is_met_or_missed_and_used_to_a_part(value, low, high, met, used):
    found = Measurement("x", value, "", low, high)
    assert found.met is met
    assert found.used == used


def result(name="patch", value=0.1):
    return Result(
        name=name, title="A title", about="How.",
        measurements=(Measurement("x", value, "%", None, 0.3, "a paper"),),
        tables=(Table("T", ("a", "b"), (("1", 2.0), ("3", 4))),),
        notes=("A note.",),
    )  # fmt: skip


def test_a_result_survives_its_file(tmp_path):
    write_result(result(), tmp_path / "r.json")
    assert read_result(tmp_path / "r.json") == result()


def check_of(name, measure):
    class Own(Check):
        def run(self, bench):
            return measure(bench)

    return Own(name, "t", "")


def test_a_check_is_measured_once_at_each_effort(tmp_path):
    calls = []
    check = check_of("patch", lambda bench: calls.append(bench.effort) or result())
    quick = Bench(tmp_path, Effort.QUICK)
    full = Bench(tmp_path, Effort.PRODUCTION)
    run_checks([check], bench=quick)
    run_checks([check], bench=quick)
    assert calls == [Effort.QUICK]
    run_checks([check], bench=full)
    assert calls == [Effort.QUICK, Effort.PRODUCTION]
    # what is measured finely needs no quick measurement any more
    run_checks([check], bench=quick)
    assert len(calls) == 2
    assert kept_result(check, folder=tmp_path).numerics_version == fem.NUMERICS_VERSION
    run_checks([check], bench=full, afresh=True)
    assert len(calls) == 3


def test_results_of_other_numerics_do_not_count(tmp_path):
    check = check_of("patch", lambda bench: result())
    write_result(result(), tmp_path / "results" / "patch-quick.json")  # numerics version 0
    assert kept_result(check, folder=tmp_path) is None


def reported(name, measured, folder, page):
    """Measure one check quickly in a folder; return the report's text and that of its rows."""
    run_checks([check_of(name, lambda bench: measured)], bench=Bench(folder, Effort.QUICK))
    return write_report(page, folder=folder).read_text(), (folder / "rows.md").read_text()


def test_the_report_shows_what_is_missed_and_what_is_absent(tmp_path):
    text, rows = reported("patch", result(value=0.7), tmp_path, tmp_path / "verification.md")
    assert "- x: 0.7 % (at most 0.3)" in text.split("## A title\n\nMissed:")[1]
    assert "| [A title](#a-title) | 0 of 1, quick |  |" in text
    assert "| x | 0.7 % | at most 0.3 | **missed** | a paper |" in rows
    assert "| 1 | 2 |" in rows
    assert "| 1 | 2 |" not in text
    assert "hertz" in text.split("Not measured yet: ")[1].splitlines()[0]


def test_a_report_is_renewed_check_by_check(tmp_path):
    report = tmp_path / "docs" / "verification.md"
    reported("patch", result(value=0.7), tmp_path / "a", report)
    text, rows = reported("hertz", result("hertz", 0.1), tmp_path / "b", report)
    assert "x: 0.7 % (" in text  # measured elsewhere, kept beside the report
    assert "| 1 of 1, quick | x: 0.1 % (" in text
    assert rows.count("| x | 0.") == 2


def test_the_page_shows_the_number_nearest_to_its_mark(tmp_path):
    many = tuple(Measurement(f"m{k}", 0.1 * k, high=1.0) for k in range(1, 7))
    made = replace(result(), measurements=many)
    text, _ = reported("patch", made, tmp_path, tmp_path / "verification.md")
    assert re.findall(r"\| (m\d):", text) == ["m6"]


def test_an_unknown_check_is_answered_with_the_known_ones():
    with pytest.raises(InputError, match="first-yield"):
        check_named("frist-yield")


@pytest.mark.parametrize(
    ("nu", "C"), [(0.25, 1.5543), (0.30, 1.6128), (0.33, 1.6492), (0.40, 1.7385)]
)
def test_exact_yield_constant(nu, C):
    """C = p_0/Sy at first yield below a Hertz contact, computed apart from this code."""
    assert exact_yield_constant(nu) == pytest.approx(C, abs=1e-4)


def test_axis_stresses_at_the_surface():
    """Johnson, Contact Mechanics, section 3.4: -p_0 and -(1 + 2 nu)/2 p_0 at the centre."""
    assert axis_stresses(0.0, 0.3) == pytest.approx((-0.8, -1.0))


def test_smoothing_takes_out_a_ripple_and_keeps_the_curve():
    delta = np.geomspace(1e-4, 1e-2, 200)
    curve = 1.4 * np.log(delta) + 0.05 * np.log(delta) ** 2
    wave = 0.01 * np.sin(2.0 * np.pi * np.log(delta) / 0.1)
    assert smoothed(delta, curve) == pytest.approx(curve, abs=1e-9)
    assert np.std(curve - smoothed(delta, curve)) < 1e-9
    assert np.std(curve + wave - smoothed(delta, curve + wave)) == pytest.approx(
        0.01 / math.sqrt(2.0), rel=0.05
    )
    assert np.abs(smoothed(delta, curve + wave) - curve)[20:-20].max() < 2e-3


@pytest.fixture(scope="module")
def deck():
    body = Material(E=200e9, nu=0.3, Sy=503e6)
    pair = Pair(sphere=body, flat=Material(E=200e9, nu=0.3), R=1e-3)
    accuracy = fem.Accuracy.smoke().with_(coarse=0.1, fine=0.05, divisions=8)
    return Deck(fem.ContactProblem(pair, (1e-5, 2e-5)), accuracy)


def section(text, keyword):
    lines = text.split(keyword, 1)[1].splitlines()[1:]
    return lines[: next(k for k, line in enumerate(lines) if line.startswith("*"))]


def test_the_deck_holds_the_mesh_the_surfaces_and_the_materials(deck):
    text = write_deck(deck)
    mesh = deck.grid.mesh
    first = section(text, "*ELEMENT, TYPE=CAX4, ELSET=ESPHERE")
    assert len(first) == mesh.n_sphere_quads
    assert len(first[0].split(",")) == 4 + 1
    assert len(section(text, "*NODE, NSET=ALL")) == len(mesh.points)
    assert len(section(text, "*SURFACE, NAME=SSLAVE")) == len(mesh.sphere_surface) - 1
    assert len(section(text, "*SURFACE, NAME=SMASTER")) == len(mesh.flat_surface) - 1
    assert text.count("*PLASTIC") == 1  # the flat is elastic
    assert text.count("*END STEP") == 2
    assert "TOP,2,2,-2e-05" in text


def printed(grid, delta, gap):
    """Output of one step as CalculiX prints it: both surfaces moved rigidly, `gap` apart."""
    mesh = grid.mesh
    lines = [" displacements (vx,vy,vz) for set SLAVE and time  0.1000000E+01", ""]
    lines += [f" {i + 1} 0.0 {-delta + gap:.6E} 0.0" for i in mesh.sphere_surface]
    lines += [" displacements (vx,vy,vz) for set MASTER and time  0.1000000E+01", ""]
    lines += [f" {i + 1} 0.0 {-gap:.6E} 0.0" for i in mesh.flat_surface]
    return [" total force (fx,fy,fz) for set TOP and time  0.1000000E+01", "",
            " 0.0 -2.500000E-03 0.0", "", *lines, ""]  # fmt: skip


def test_printed_output_is_measured_as_ours_is(deck):
    grid = deck.grid
    text = "\n".join(line for d in deck.problem.depths for line in printed(grid, d, 0.1 * d))
    found = measure(deck, text)
    assert tuple(found.delta) == deck.problem.depths
    assert found.force == pytest.approx([180.0 * 2.5e-3] * 2)  # a wedge of 2 degrees
    # the sphere's pole sank by 0.1 delta against its top, the flat by 0.1 delta
    assert found.share == pytest.approx([0.5, 0.5])
    # rigid overlap of 0.8 delta: touches up to sqrt(2 R 0.8 delta)
    assert found.radius == pytest.approx(np.sqrt(1.6 * found.delta), rel=0.01)


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
    return Solved(Pair(BODY, BODY, 1e-3), curve)


def test_known_differences_are_found_and_what_a_finer_solve_has_left():
    """First order: 4, 2 and 1 parts off; half of the error is seen, as much is left."""
    other = solved(force_factor=1.003, radius_factor=0.99, share=0.602)
    off = _difference(other, solved(), solved()["delta"]).mean(axis=1)
    assert off == pytest.approx([np.log(1.003), np.log(0.99), 0.002, np.log(1.003 / 0.99**2)])
    trio = [solved(1.0 + x, 1.0 + x, 0.6 + x) for x in (4e-4, 2e-4, 1e-4)]
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
    folder, report = tmp_path / "build", tmp_path / "docs" / "verification.md"
    asked = ["verify", "--only", "patch", "--quick", "--folder", str(folder)]
    asked += ["--report", str(report)]
    assert run(asked) == 0
    assert "Patch test" in report.read_text()
    missed = replace(result(value=2.0), effort="quick", numerics_version=fem.NUMERICS_VERSION)
    write_result(missed, folder / "results" / "patch-quick.json")
    assert run(asked) == EXIT_MISSED
    assert "missed: patch: x: 2" in capsys.readouterr().out


@pytest.fixture(scope="module")
def die() -> Die:
    return Die(1.6, 0.2, outer=1000.0)


def test_a_linear_flat_die_is_boussinesqs(die: Die) -> None:
    """Incompressible, G = 1/3: F = 8 G a d, and a sphere's contact has a^2 = R h."""
    force, surface, _ = die.velocities(np.full(die.radius.shape, 1.0 / 3.0))
    assert abs(force - 8.0 / 3.0) < 0.01 * force
    assert abs(1.0 - 2.0 * die.sunk(surface) - 0.5) < 0.005


@pytest.mark.parametrize("power", [1.0, 3.0])
def test_strain_gathered_along_a_ray(die: Die, power: float) -> None:
    """A rate that falls as x^-k gathers x^-k/(k + 1)."""
    distance = die.distance
    gathered = die.gathered(distance**-power)
    # beyond the mesh nothing is gathered: what would be is taken off
    missing = distance * 1000.0 ** -(power + 1.0) / (power + 1.0)
    expected = np.maximum(distance**-power / (power + 1.0) - missing, 1e-6)
    near = distance < 20.0
    assert np.abs(gathered / expected - 1.0)[near].max() < 0.02
    assert math.isclose(float(np.median(gathered[near] / expected[near])), 1.0, rel_tol=0.01)
