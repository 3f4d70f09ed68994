"""The metal that a diagnosis starts from: its flow curve, and its own solve."""

import math
from pathlib import Path

import numpy as np
import pytest
from dentscope.core.inputs.flow_curve import SPECIMENS
from dentscope.discrepancy import diagnose
from dentscope.discrepancy.baseline import solve
from dentscope.discrepancy.comparison.forward import Point, Simulator
from dentscope.discrepancy.comparison.problem import problem_of
from dentscope.discrepancy.inference.fit import fit
from dentscope.discrepancy.report.series import points_of
from dentscope.dynamics import Approach, Scene, Striker, strike
from dentscope.fitting.hardening import hardening_records
from dentscope.fitting.table import read_sources
from dentscope.models.table import LoadingCurve, PairTable, Turns, energy_exponent, table_law
from dentscope.models.uncertainty import METAL, WITH_CURVE
from dentscope.recordings import read

DATA = Path(__file__).parents[3] / "data" / "campaign" / "validation-hardening-1.h5"
BALL, FLAT = "ball.csv", "flat.csv"
NOISE = {"restitution": 0.004, "permanent_depth_m_relative": 0.008}


@pytest.fixture(scope="module")
def solved() -> PairTable:
    """Finite elements of a flat that hardens, which no fit has read."""
    records = hardening_records(read_sources([DATA]), held_out=True)
    record = next(r for r in records if r.case.name.endswith("-05"))
    pair, c = record.case.pair, record.curve
    rows = []
    for u in record.unloadings:
        left = u.residual_sphere + u.residual_flat
        exponent = energy_exponent(u.curve["delta"], u.curve["force"], left)
        rows.append((u.depth, left / (u.depth * pair.R), u.residual_sphere / left, exponent))
    exact = np.full(len(c["delta"]), 1e-3)
    curve = LoadingCurve(c["delta"] / pair.R, c["force"] / (pair.E_reduced * pair.R**2),
                  c["radius"] / pair.R, 0.5 + 0.0 * exact, exact, exact, exact)  # fmt: skip
    return PairTable(pair, curve, Turns(*np.array(sorted(rows)).T))


def set_of(folder, table, *, curves, stated=1.0, fastest=20.0):
    pair, R = table.pair, 5e-3
    mass = 4.0 / 3.0 * math.pi * R**3 * 7800.0
    ball = Striker(mass=mass, tip_radius=R, length=0.0, radius=R, inertia=0.4 * mass * R**2)
    law, own = table_law([table], name="truth"), type(pair)(pair.sphere, pair.flat, R)
    rows = ["trial,striker,angle_deg,impact_speed_m_s,restitution,permanent_depth_m"]
    for k, v in enumerate(np.geomspace(1.0, fastest, 6)):
        hit = strike(Scene(law, own, ball, Approach(v)))
        rows.append(f"{k},ball,90,{v:.6g},{hit.restitution:.6g},{hit.residual_flat_m:.6g}")
    folder.mkdir()
    (folder / "trials.csv").write_text("\n".join(rows) + "\n")

    def body(metal, name: str) -> str:
        if metal.flow is None:
            return f"E_Pa = {metal.E}\nnu = {metal.nu}\nSy_Pa = {metal.Sy}\n"
        strain = np.append(0.0, np.geomspace(1e-4, 1.0, 40))
        lines = ["plastic_strain,true_stress_Pa"]
        lines += [f"{p:.6g},{metal.flow.curve(p):.8g}" for p in strain]
        text = f"E_Pa = {metal.E}\nnu = {metal.nu}\n"
        if curves:
            (folder / name).write_text("\n".join(lines) + "\n")
            text += f'flow_curve = "{name}"\n'
        if stated:
            Sy = stated * metal.flow.curve(0.002)
            text += f"Sy_Pa = {{ value = {Sy}, std = {0.05 * Sy} }}\n"
        return text

    noise = "".join(f"{k} = {v}\n" for k, v in NOISE.items())
    (folder / "set.toml").write_text(
        'format = "recording-set/1"\nname = "flow"\n'
        f'[noise]\n{noise}[target]\nshape = "flat"\n{body(pair.flat, FLAT)}'
        f'[strikers.ball]\nshape = "sphere"\ntip_radius_m = {R}\ndensity_kg_m3 = 7800\n'
        f"{body(pair.sphere, BALL)}"
    )
    return folder


def misfit(problem) -> float:
    """Rms miss of the baseline as stated, in standard errors."""
    base = fit(Simulator(problem), ())
    r = base.residual
    return math.sqrt(float(r @ np.linalg.solve(base.linear.noise, r)) / len(r))


def test_a_baseline_that_follows_the_curves_meets_a_metal_that_hardens(tmp_path, solved):
    plain = problem_of(read(set_of(tmp_path / "plain", solved, curves=False)))
    curved = problem_of(read(set_of(tmp_path / "curved", solved, curves=True)), law="fitted")
    assert plain.law_name == "fitted"
    assert curved.law_name == "fitted, at hardening"
    assert misfit(curved) < 0.15 * misfit(plain)
    assert curved.error.parts["force"][1] < plain.error.parts["force"][1]
    assert WITH_CURVE["crater"] < METAL["crater"]


def test_as_stated_is_the_simulation_and_not_a_line_through_the_fit(tmp_path, solved):
    found = diagnose(read(set_of(tmp_path / "set", solved, curves=False)))
    problem = found.problem
    stated = Simulator(problem).predict((), [Point(np.zeros(problem.n_z))])[0]
    assert np.array_equal(found.stated, stated)
    points = {(p.observable, p.condition): p.as_stated for p in points_of(found)}
    cells = problem.cells
    for k, (name, c) in enumerate(zip(cells.observable, cells.condition, strict=True)):
        if name == "restitution":
            assert points[name, c + 1] == pytest.approx(stated[k], rel=1e-9)
    r = (cells.value - stated) / np.sqrt(np.diag(found.ranking.base.linear.noise))
    assert found.misfit["as_stated"] == pytest.approx(float(r @ r), rel=0.3)


def test_a_strength_read_from_a_curve_is_that_of_a_specimen(tmp_path, solved):
    found = read(set_of(tmp_path / "read", solved, curves=True, stated=0.0))
    Sy = found.setup.target.Sy_Pa
    assert Sy.value == pytest.approx(solved.pair.flat.flow.curve(0.002), rel=0.01)
    assert Sy.std == pytest.approx(SPECIMENS * Sy.value)


def test_a_curve_is_scaled_to_a_stated_strength_and_a_note_says_so(tmp_path, solved):
    found = read(set_of(tmp_path / "off", solved, curves=True, stated=1.2))
    problem = problem_of(found, law="fitted")
    assert any("scaled to the stated" in note for note in problem.notes)
    law = problem.laws["ball"]
    curve = solved.pair.flat.flow.curve
    assert law.at.flat.flow.curve(0.1) == pytest.approx(1.2 * curve(0.1), rel=0.01)


def test_the_own_pair_is_solved_once_and_kept(tmp_path, solved, monkeypatch):
    found = read(set_of(tmp_path / "own", solved, curves=True))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    asked = []

    def of_the_elements(pair, low, high, *, progress):
        asked.append(high)
        return PairTable(pair, solved.curve, solved.turns)

    monkeypatch.setattr(solve, "solved_table", of_the_elements)
    # a flow curve is enough to have the pair solved
    problem = problem_of(found)
    assert problem.law_name.endswith("finite elements of the pair")
    # what is left is that these turning points are two, not five
    assert misfit(problem) < 2.0
    assert problem.error.parts["force"][0] < 2e-3
    again = problem_of(found, law="table")
    assert len(asked) == 1
    assert misfit(again) == pytest.approx(misfit(problem), rel=1e-6)
    kept = next((tmp_path / "cache").rglob("pairs/*.json"))
    kept.write_text(kept.read_text()[:500])
    problem_of(found)
    assert len(asked) == 2
    assert problem_of(found, law="fitted").law_name == "fitted, at hardening"
    assert len(asked) == 2


def test_a_strength_that_is_assumed_is_not_worth_a_solve(tmp_path, solved, monkeypatch):
    monkeypatch.setattr(solve, "solved_table", lambda *_, **__: pytest.fail("solved"))
    folder = set_of(tmp_path / "bare", solved, curves=False, stated=0.0)
    problem = problem_of(read(folder), law="table")
    assert problem.law_name == "fitted"
    assert any("target.Sy_Pa is not stated" in note for note in problem.notes)


@pytest.mark.fe
def test_finite_elements_take_the_place_of_the_closed_form(tmp_path, solved, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    said = []
    found = read(set_of(tmp_path / "fe", solved, curves=True, fastest=5.0))
    problem = problem_of(found, progress=said.append)
    assert any(line.endswith("%") for line in said)
    assert not any("not solved" in note for note in problem.notes)
    assert misfit(problem) < 2.5
