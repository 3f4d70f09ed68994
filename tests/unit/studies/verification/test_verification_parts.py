"""The parts of the verification: marks, what is kept, the report, the deck and its reading."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from dentscope import fem
from dentscope.core import InputError, Material, Pair
from dentscope.studies.verification.bench import Bench, Effort
from dentscope.studies.verification.calculix import Deck, measure, write_deck
from dentscope.studies.verification.checks import Check, check_named
from dentscope.studies.verification.curves import smoothed
from dentscope.studies.verification.pairs import axis_stresses, exact_yield_constant
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


def test_the_report_shows_what_is_missed_and_what_is_absent(tmp_path):
    check = check_of("patch", lambda bench: result(value=0.7))
    run_checks([check], bench=Bench(tmp_path, Effort.QUICK))
    text = write_report(tmp_path / "verification.md", folder=tmp_path).read_text()
    assert "- x: 0.7 % (at most 0.3)" in text.split("## A title\n\nMissed:")[1]
    assert "| [A title](#a-title) | 0 of 1, quick |  |" in text
    rows = (tmp_path / "rows.md").read_text()
    assert "| x | 0.7 % | at most 0.3 | **missed** | a paper |" in rows
    assert "| 1 | 2 |" in rows
    assert "| 1 | 2 |" not in text
    assert "hertz" in text.split("Not measured yet: ")[1].splitlines()[0]


def test_a_report_is_renewed_check_by_check(tmp_path):
    check = check_of("patch", lambda bench: result(value=0.7))
    report = tmp_path / "docs" / "verification.md"
    run_checks([check], bench=Bench(tmp_path / "a", Effort.QUICK))
    write_report(report, folder=tmp_path / "a")
    hertz = check_of("hertz", lambda bench: result("hertz", 0.1))
    run_checks([hertz], bench=Bench(tmp_path / "b", Effort.QUICK))
    text = write_report(report, folder=tmp_path / "b").read_text()
    assert "x: 0.7 % (" in text  # measured elsewhere, kept beside the report
    assert "| 1 of 1, quick | x: 0.1 % (" in text
    rows = (tmp_path / "b" / "rows.md").read_text()
    assert rows.count("| x | 0.") == 2


def test_the_page_shows_the_number_nearest_to_its_mark(tmp_path):
    many = tuple(Measurement(f"m{k}", 0.1 * k, high=1.0) for k in range(1, 7))
    check = check_of("patch", lambda bench: replace(result(), measurements=many))
    run_checks([check], bench=Bench(tmp_path, Effort.QUICK))
    text = write_report(tmp_path / "verification.md", folder=tmp_path).read_text()
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
