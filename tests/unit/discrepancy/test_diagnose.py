"""The whole way from a folder to a verdict, and the metal that it starts from."""

import json
import math
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from dentscope.cli.diagnose import report_folder
from dentscope.core import InputError
from dentscope.core.inputs.flow_curve import SPECIMENS
from dentscope.discrepancy import diagnose
from dentscope.discrepancy.baseline import solve
from dentscope.discrepancy.comparison.forward import Point, Simulator
from dentscope.discrepancy.comparison.problem import Problem, problem_of
from dentscope.discrepancy.inference.fit import fit
from dentscope.discrepancy.report import story_of
from dentscope.discrepancy.report.series import points_of
from dentscope.dynamics import Approach, Scene, Striker, strike
from dentscope.fitting.hardening import hardening_records
from dentscope.fitting.table import read_sources
from dentscope.models.table import PairTable, table_law
from dentscope.models.uncertainty import METAL, WITH_CURVE
from dentscope.recordings import read
from dentscope.recordings.shipped import FOLDER
from dentscope.studies.proof.generators import folder, truth
from made_cases import table_of
from made_files import rows_of
from made_processes import python
from made_sets import made_set

KEYS = """format set seed version audit verdict mechanisms wrong_inputs family
alternatives inclusion probabilities scores located parameters nuisance_pulls surprise
excluded limits improvement misfit correction next_experiment history notes""".split()
SOFT = 1
"""Seed of a set whose surface is soft."""


def close(one: Any, other: Any) -> bool:
    """Whether two verdicts are the same but for the round-off of other thread counts."""
    if isinstance(one, dict):
        return list(one) == list(other) and all(close(one[k], other[k]) for k in one)
    if isinstance(one, list):
        return len(one) == len(other) and all(map(close, one, other))
    if isinstance(one, float):
        return math.isclose(one, other, rel_tol=1e-6, abs_tol=1e-9)
    return bool(one == other)


def written(place: Path, kind: str, seed: int, name: str = "") -> Path:
    case = truth.draw(np.random.default_rng(seed), kind, name=name)
    folder.write_set(case, place / "set", name="set")
    return place / "set"


def test_one_folder_in_one_command_a_verdict(tmp_path: Path) -> None:
    case = written(tmp_path, "single", 5, "adhesion")
    out = tmp_path / "out"
    answer = python("-m", "dentscope", "diagnose", case, "--out", out, "--quiet")
    assert answer.returncode == 0, answer.stderr
    verdict = json.loads((out / "verdict.json").read_text())
    assert list(verdict) == KEYS
    assert verdict["format"] == "verdict/1"
    assert math.isclose(sum(verdict["probabilities"].values()), 1.0, rel_tol=1e-6)
    parts = verdict["misfit"]
    took = parts["sheet"] + parts["law"] + parts["metal"] + parts["rest"]
    assert math.isclose(took, 1.0, rel_tol=1e-9)
    _is_readable(out, Page((out / "report.html").read_text()))
    assert answer.stdout.startswith("set: ")
    again = diagnose(read(case), seed=0).to_dict()
    assert close(json.loads(json.dumps(again)), verdict)


_EMPTY = {"meta", "path", "use", "rect", "input", "br"}


class Page(HTMLParser):
    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.attributes: list[tuple[str, dict[str, str | None]]] = []
        self.seen = ""
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.attributes.append((tag, dict(attrs)))
        if tag not in _EMPTY:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.attributes.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        if tag not in _EMPTY:
            assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if not {"details", "script", "style", "title"} & set(self.open):
            self.seen += data

    def of(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.attributes if name == tag]


def _is_readable(out: Path, page: Page) -> None:
    """The report stands alone, its figures and files show every number, its words are plain."""
    for link in (a["href"] for a in page.of("a")):
        assert link is not None
        assert link.startswith("data:")
    assert not page.of("link")
    assert "src" not in {key for _, attributes in page.attributes for key in attributes}
    for word in ("nats", "cells", "discrimination", " z ="):
        assert word not in page.seen
    for part in ("probability", "Measured beside simulated", "What to do next"):
        assert part in page.seen
    points = json.loads((out / "report.json").read_text())["points"]
    rows = rows_of(out / "report.csv")
    assert [float(r["measured"]) for r in rows] == [p["measured"] for p in points]
    drawn = [a for a in page.of("g") if a.get("class") == "point"]
    assert len(drawn) >= len(points) > 5
    assert all(p["low"] < p["measured"] < p["high"] for p in points)
    # what is drawn first is what stands first in the files; every figure has its own ids
    ids = [a["id"] for _, a in page.attributes if "id" in a]
    assert len(set(ids)) == len(ids)


def test_strength_off_by_14_percent_is_a_stated_number_not_physics(tmp_path: Path) -> None:
    verdict = diagnose(read(written(tmp_path, "strength-error", 3)))
    assert verdict.verdict == "adequate"
    # 14 % is 2.8 of the stated 5 %
    assert abs(verdict.surprise["target.Sy_Pa"]) > 2.0
    assert any("target.Sy_Pa wants to be" in note for note in verdict.notes)
    # the legend says what the drawn simulation took: each number that it moved, and its chi2
    _, told, _ = story_of(verdict).series
    assert f"chi2 {verdict.scores['baseline']['chi2']:.3g}, " in told
    pull = verdict.nuisance_pulls["target.Sy_Pa"]
    assert f"yield strength of the flat {pull:+.1f}" in told
    # in the stated standard deviations of 5 %; a strength is shifted as a logarithm
    strength = next(n for n in verdict.problem.nuisances if n.name == "target.Sy_Pa")
    shift = verdict.parameters["target.Sy_Pa"]["value"] / strength.value
    assert math.isclose(pull, math.log(shift) / 0.05, rel_tol=0.1)


def test_a_soft_surface_has_no_name_but_the_report_says_what_it_is_like(tmp_path: Path) -> None:
    """Not the asperities that it passed for; the generator's layer has another shape than ours."""
    verdict = diagnose(read(written(tmp_path, "outside", SOFT, "crushed-layer")))
    assert verdict.verdict == "outside-library"
    assert any("as if the surface is softer than the bulk" in text for text in verdict.reasons)
    finding = story_of(verdict).finding
    assert "it behaves as if the surface is softer than the bulk" in finding
    assert "nothing that dentscope knows" not in finding
    assert "softer-surface" not in {*verdict.inclusion, *verdict.probabilities, *verdict.excluded}
    assert math.isclose(sum(verdict.probabilities.values()), 1.0, rel_tol=1e-6)


def test_each_set_has_a_folder_of_its_own(tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(tmp_path)
    places = [Path(name) for name in ("a/set", "b/set", "a", ".", "/a/set", "/b/set")]
    found = [report_folder(place) for place in (*places, FOLDER / "leeb-steel-800hv")]
    assert len(set(found)) == len(found)
    assert all(one.parts[:2] == ("build", "diagnose") for one in found)
    assert found[0] == Path("build/diagnose/a/set")
    assert found[-1] == Path("build/diagnose/leeb-steel-800hv")


def test_a_second_blow_meets_the_crater_of_the_first(tmp_path, set_of_balls):
    def blows(name: str, *given: tuple[str, float]) -> Problem:
        rows = [f"t{k},ball,90,{v!r},{spot},2e-5" for k, (spot, v) in enumerate(given)]
        head = "trial,striker,angle_deg,impact_speed_m_s,spot,permanent_depth_m"
        trials = "\n".join([head, *rows]) + "\n"
        noise = {"permanent_depth_m": 1e-7}
        return problem_of(read(set_of_balls(tmp_path / name, trials, noise=noise)))

    twice = blows("a", ("x", 1.0), ("x", 1.0), ("y", 1.0))
    assert [c.after for c in twice.conditions] == [-1, 0]
    assert twice.conditions[0].trials == (0, 2)
    seen = Simulator(twice).observe((), [Point(np.zeros(twice.n_z))])
    e = float(seen["restitution"][0, 0])
    # the second blow must first give back what the first left in the metal: energy 2 - e^2
    once = blows("b", ("x", math.sqrt(2.0 - e * e)))
    alone = Simulator(once).observe((), [Point(np.zeros(once.n_z))])
    for name in ("permanent_depth_m", "peak_force_N"):
        assert seen[name][0, 1] == pytest.approx(alone[name][0, 0], rel=1e-4)
        assert seen[name][0, 1] > 1.1 * seen[name][0, 0]


def test_repeats_that_scatter_beyond_their_stated_noise_are_all_kept(tmp_path: Path) -> None:
    """Two bounces each on a thick and a thin plate under one name: no majority is an outlier."""
    e = [0.4, 0.41, 0.6, 0.61]
    given = made_set(
        tmp_path, target='law = "measured-restitution"\n', angle_deg=[90] * 4,
        impact_speed_m_s=[2.0] * 4, restitution=e, restitution_std=[0.001] * 4,
    )  # fmt: skip
    cells = problem_of(given).cells
    assert cells.count.tolist() == [4]
    assert cells.value == pytest.approx(np.mean(e), rel=1e-9)


ROD = """shape = "rod"
tip_radius_m = 9.0e-3
radius_m = 9.0e-3
length_m = 0.3
mass_kg = 0.6193
E_Pa = 2.0e11
nu = 0.3
Sy_Pa = 7.5e8
"""
NOISE = "restitution = 0.01\npermanent_depth_m = 1.0e-6\nimpact_speed_relative = 0.005\n"


def test_one_trial_is_too_little_to_say_anything(tmp_path: Path) -> None:
    numbers = {"restitution": [0.5], "permanent_depth_m": [95e-6]}
    given = made_set(tmp_path, ROD, noise=NOISE, angle_deg=[90], drop_height_m=[0.05], **numbers)
    verdict = diagnose(given)
    found = json.loads(json.dumps(verdict.to_dict(), allow_nan=False))
    assert found["verdict"] == "undetermined"
    assert found["notes"][0].startswith("too few")
    # with a single condition nothing can be left out and predicted
    assert found["improvement"]["held_out_baseline"] is None
    assert story_of(verdict).prediction == ""


def test_trials_without_a_measured_number_are_refused_in_one_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"no measured number .* one or more of restitution"):
        diagnose(made_set(tmp_path, ROD, noise=NOISE, angle_deg=[90], drop_height_m=[0.05]))


DATA = Path(__file__).parents[3] / "data" / "campaign" / "validation-hardening-1.h5"
BALL, FLAT = "ball.csv", "flat.csv"
READ_TO = "restitution = 0.004\npermanent_depth_m_relative = 0.008\n"


@pytest.fixture(scope="module")
def solved() -> PairTable:
    """Finite elements of a flat that hardens, which no fit has read."""
    records = hardening_records(read_sources([DATA]), held_out=True)
    record = next(r for r in records if r.case.name.endswith("-05"))
    return table_of(record, error=1e-3)


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
        text = f"E_Pa = {metal.E}\nnu = {metal.nu}\n"
        if metal.flow is None:
            return f"{text}Sy_Pa = {metal.Sy}\n"
        strain = np.append(0.0, np.geomspace(1e-4, 1.0, 40))
        lines = ["plastic_strain,true_stress_Pa"]
        lines += [f"{p:.6g},{metal.flow.curve(p):.8g}" for p in strain]
        if curves:
            (folder / name).write_text("\n".join(lines) + "\n")
            text += f'flow_curve = "{name}"\n'
        if stated:
            Sy = stated * metal.flow.curve(0.002)
            text += f"Sy_Pa = {{ value = {Sy}, std = {0.05 * Sy} }}\n"
        return text

    (folder / "set.toml").write_text(
        'format = "recording-set/1"\nname = "flow"\n'
        f'[noise]\n{READ_TO}[target]\nshape = "flat"\n{body(pair.flat, FLAT)}'
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
