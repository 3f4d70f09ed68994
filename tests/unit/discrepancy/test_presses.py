"""Quasi-static presses in a diagnosis: what acts on them, what they share with impacts."""

import re
from dataclasses import replace

import numpy as np
import pytest
from dentscope.discrepancy.comparison.forward import Point, Simulator
from dentscope.discrepancy.comparison.problem import problem_of
from dentscope.discrepancy.experiments.feasible import presses_of
from dentscope.discrepancy.experiments.next_experiment import _options
from dentscope.discrepancy.inference.fit import baseline_situations
from dentscope.discrepancy.rules import RULES
from dentscope.discrepancy.unknowns.covariates import PRESSED, covariates
from dentscope.dynamics import Approach, strike
from dentscope.dynamics.mechanisms import MECHANISMS
from dentscope.recordings import read
from dentscope.recordings.bench import Bench

NOISE = {
    "restitution": 0.004, "permanent_depth_m_relative": 0.02, "dent_diameter_m_relative": 0.01,
}  # fmt: skip
HEAD = "trial,striker,angle_deg,impact_speed_m_s,load_N,press_rate_per_s,restitution,"
HEAD += "permanent_depth_m,dent_diameter_m\n"
IMPACTS = "a,ball,90,1.0,,,0.45,8e-6,6e-4\nb,ball,90,3.0,,,0.35,2.5e-5,1.1e-3\n"
PRESSES = "p,ball,,,300,,,7e-6,6e-4\nq,ball,,,1200,{rate},,3e-5,1.2e-3\n"
BY_NAME = {m.name: m for m in MECHANISMS}


@pytest.fixture
def problem(tmp_path, set_of_balls):
    def of(rows, **noise):
        return problem_of(read(set_of_balls(
            tmp_path, HEAD + rows, noise=NOISE | noise, E="{ value = 2.0e11, std = 4e9 }",
            Sy="{ value = 3.5e8, std = 2.5e7 }", more="[gauge]\npermanent_depth_m = 0.05\n",
        )))  # fmt: skip

    return of


def cells(given, mechanism=None, **values):
    """Predictions by condition and observable, with a mechanism or none."""
    acting = () if mechanism is None else (BY_NAME[mechanism],)
    point = Point(np.zeros(given.n_z), {m.name: values for m in acting})
    found = Simulator(given).predict(acting, [point])[0]
    names = zip(given.cells.condition, given.cells.observable, strict=True)
    return dict(zip(names, found, strict=True))


def test_presses_and_impacts_share_gauge_strength_and_the_laws_error(problem):
    given = problem(IMPACTS + PRESSES.format(rate=""))
    names = [n.name for n in given.nuisances]
    plain = Simulator(given).predict((), [Point(np.zeros(given.n_z))])[0]
    for name in ("gauge.permanent_depth_m", "target.Sy_Pa"):
        z = np.zeros(given.n_z)
        z[names.index(name)] = 1.0
        moved = Simulator(given).predict((), [Point(z)])[0] - plain
        depth = np.array([o == "permanent_depth_m" for o in given.cells.observable])
        assert (np.abs(moved[depth]) > 0.01).all()
        if name.startswith("gauge"):
            assert moved[depth] == pytest.approx(np.full(4, 0.05))
            assert np.abs(moved[~depth]).max() < 1e-12
    # a press lies at the speed at which an impact goes as deep, where the law's error is one
    scene = given.scenes(np.zeros(given.n_z))[0]
    as_deep = scene.with_(approach=Approach(given.conditions[2].speed))
    assert strike(as_deep).peak_force_N == pytest.approx(300.0, rel=0.01)
    assert {PRESSED, "impact speed"} <= set(covariates(given))


def test_what_needs_motion_does_nothing_in_a_press(problem):
    given = problem(PRESSES.format(rate=""))
    situations = baseline_situations(given)
    ruled_out = {m.name for m in MECHANISMS if "nothing moves" in m.ruled_out(situations)}
    assert ruled_out == {m.name for m in MECHANISMS if not m.static}
    plain = cells(given)
    assert cells(given, "half-space-waves", wave_scale=1.0) == plain


def test_a_rate_acts_in_a_press_by_the_stated_rate_only(problem):
    given = problem(IMPACTS + PRESSES.format(rate="10"))
    rate = {"rise_at_1000_per_s": 0.5, "rate_exponent": 0.15, "strength_kept": 1.0}
    plain, with_it = cells(given), cells(given, "strain-rate-hardening", **rate)
    change = {k: with_it[k, o] - plain[k, o] for k, o in plain if o == "permanent_depth_m"}
    assert change[0] < -0.2
    assert change[1] < -0.2
    assert change[2] == 0.0
    assert -0.3 < change[3] < -0.1
    hard = cells(given, "work-hardening", hardening_ratio=2.0, hardening_exponent=0.4)
    assert all(hard[key] < value for key, value in plain.items() if key[1] != "restitution")


def test_presses_are_proposed_within_a_bench_press_and_as_deep(problem):
    found = presses_of(problem(IMPACTS))
    loads = [c.condition.press.load for c in found]
    assert len(loads) == 4
    assert RULES.bench[0] <= min(loads) < max(loads) <= RULES.bench[1]
    speeds = [c.condition.speed for c in found]
    assert speeds[::3] == pytest.approx([1.0, 3.0], rel=0.05)
    assert all("press ball slowly" in c.change for c in found)


def test_a_press_is_read_as_the_rig_reads_and_a_strength_has_its_key(problem):
    rows = "".join(re.sub(r"[^,]*(,[^,]*)$", r"\1", row) + "\n" for row in IMPACTS.split())
    given = problem(rows)
    told = [p.change for _, p in _options(Simulator(given)).options]
    assert any("press ball" in text for text in told)
    assert not any("press ball" in text and "crater depth" in text for text in told)
    assert any("the flat: hardness_Pa in place of Sy_Pa" in text for text in told)
    known = replace(problem("a,ball,90,1.0,,,0.45,,\nb,ball,90,3.0,,,0.35,,\n"), bench=Bench(
        reads=("dent_diameter_m",)))  # fmt: skip
    pressed = [p.change for _, p in _options(Simulator(known)).options if p.kind == "press"]
    assert pressed
    assert not any("crater depth" in text for text in pressed)


def test_rim_of_a_dent_is_an_unknown_of_its_own(problem):
    rows = IMPACTS + PRESSES.format(rate="")
    edge = problem(rows)
    rim = problem(rows, dent_edge='"rim"')
    assert "dent.rim" in [n.name for n in rim.nuisances]
    one, two = cells(edge), cells(rim)
    assert two[0, "dent_diameter_m"] - one[0, "dent_diameter_m"] == pytest.approx(np.log(1.05))
