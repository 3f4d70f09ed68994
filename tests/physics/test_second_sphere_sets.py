"""A set with a second sphere is simulated as its impact file is, and known as well as its law."""

import math

import made_blows
import numpy as np
import pytest
import tomlkit
from dentscope.core import Material, Pair
from dentscope.discrepancy.comparison.forward import Point, Simulator
from dentscope.discrepancy.comparison.problem import problem_of
from dentscope.discrepancy.rank import baseline_situations
from dentscope.discrepancy.unknowns.lawerror import law_error
from dentscope.dynamics import strike
from dentscope.dynamics.files.second import SecondSphere
from dentscope.dynamics.mechanisms import MECHANISMS
from dentscope.models import LAWS
from dentscope.recordings import audit, read
from made_files import changed

RIG = {
    "target": {"shape": "sphere", "radius_m": 0.010, "mass_kg": 0.0356, "E_Pa": 1.1e11,
               "nu": 0.34, "Sy_Pa": 3.0e8, "density_kg_m3": 8500},
    "strikers": {"ball": {"shape": "sphere", "tip_radius_m": 0.005, "mass_kg": 0.004084,
                          "E_Pa": 2.05e11, "nu": 0.3, "Sy_Pa": 2.0e9, "density_kg_m3": 7800}},
}  # fmt: skip
NOISE = {"restitution": 0.005, "rebound_speed_m_s": 0.01, "permanent_depth_m": 5e-7}
HEAD = "trial,striker,angle_deg,impact_speed_m_s,restitution,permanent_depth_m,rebound_speed_m_s\n"
SPEEDS = (0.5, 1.5, 4.5)
KINDS = {
    "free": RIG, "held": changed(RIG, {"target.mass_kg": None}),
    "seat": changed(RIG, {"target": {"mass_kg": None, "radius_m": -0.015}}),
}  # fmt: skip


def problem(folder, rig):
    rows = [f"{k},ball,90,{v},0.5,1e-5,{0.5 * v}\n" for k, v in enumerate(SPEEDS)]
    content = {"format": "recording-set/1", **rig, "noise": NOISE}
    (folder / "set.toml").write_text(tomlkit.dumps(content))
    (folder / "trials.csv").write_text(HEAD + "".join(rows))
    return problem_of(read(folder))


@pytest.mark.parametrize("kind", KINDS)
def test_a_set_is_simulated_as_an_impact_file_is(tmp_path, kind):
    found = problem(tmp_path, KINDS[kind])
    law = found.laws["ball"]
    seen = Simulator(found).observe((), [Point(np.zeros(found.n_z))])
    scenes = found.scenes(np.zeros(found.n_z))
    for k, speed in enumerate(SPEEDS):
        setup = made_blows.setup(KINDS[kind] | {"impact": {"impact_speed_m_s": speed}})
        alone = strike(setup.scene(law))
        assert strike(scenes[k]).restitution == pytest.approx(alone.restitution, abs=1e-9)
        assert seen["restitution"][0, k] == pytest.approx(alone.restitution, abs=1e-4)
        assert seen["permanent_depth_m"][0, k] == pytest.approx(alone.residual_flat_m, rel=1e-4)
        e = float(seen["restitution"][0, k])
        back = -setup.second.parted(0.004084, speed, e)[0]
        assert seen["rebound_speed_m_s"][0, k] == pytest.approx(back, rel=5e-3)


@pytest.mark.parametrize(("mass", "severity"), [(0.0356, "consistent"), (0.0456, "contradiction")])
def test_a_free_sphere_is_weighed_as_a_striker_is(tmp_path, mass, severity):
    """4/3 pi (10 mm)^3 of 8500 kg/m^3 are 35.6 g."""
    problem(tmp_path, changed(RIG, {"target.mass_kg": mass}))
    said = {f.check: f for f in audit(read(tmp_path)).findings}
    found = said["mass of the second sphere"]
    assert found.severity.value == severity
    assert found.expected == pytest.approx(0.035605, rel=1e-4)
    assert said["mass of ball"].severity.value == "consistent"


def test_the_laws_error_is_that_of_two_spheres(tmp_path):
    """Squares of the law's own and of what 1/R leaves out, at each depth."""
    found = problem(tmp_path, KINDS["seat"])
    scenes = found.scenes(np.zeros(found.n_z))
    plain = law_error({"ball": scenes}).spreads["ball"]
    here = found.error.spreads["ball"]
    second, pair = SecondSphere(-0.015), scenes[0].pair
    depth = pair.R * np.exp(here.reached)
    for kind, added in (
        ("force", second.departure(scenes[0].law, pair, depth)),
        ("crater", second.crater_departure(pair, depth)),
    ):
        both, own = here.at_peaks(here.law, kind), plain.at_peaks(plain.law, kind)
        assert both == pytest.approx(np.hypot(own, added), rel=0.1)
        assert both[-1] > own[-1]


def test_the_share_of_equal_spheres_is_known_as_well_as_their_mirror():
    """Each keeps a half; the law gives the flat 46 % at 0.01 R and 27 % at 0.04 R."""
    steel = Material(E=205e9, nu=0.3, Sy=600e6)
    pair = Pair(steel, steel, 5e-3)
    for deep in (0.001, 0.01, 0.04):
        ball, flat = LAWS["fitted"].residual(pair, np.array([deep * pair.R]))
        off = math.log(0.5 * float(ball[0] + flat[0]) / float(flat[0]))
        told = float(SecondSphere(10e-3).crater_departure(pair, deep * pair.R))
        assert 0.6 * abs(off) - 1e-3 < told < 1.2 * abs(off) + 1e-3


@pytest.mark.parametrize(
    ("kind", "out"),
    [("free", {"half-space-waves", "support-compliance", "air-drag"}),
     ("held", {"half-space-waves"})],
)  # fmt: skip
def test_what_supposes_a_flat_is_ruled_out_with_its_reason(tmp_path, kind, out):
    situations = baseline_situations(problem(tmp_path, KINDS[kind]))
    told = {m.name: m.ruled_out(situations) for m in MECHANISMS}
    assert {name for name, reason in told.items() if "sphere is" in reason} == out


def test_a_held_ball_moves_on_its_support_with_its_own_mass(tmp_path):
    situations = baseline_situations(problem(tmp_path, KINDS["held"]))
    (support,) = [m for m in MECHANISMS if m.name == "support-compliance"]
    _, mass, _ = support.ranges(situations)
    assert mass.low == pytest.approx(8500 * 4 / 3 * math.pi * 0.01**3)
