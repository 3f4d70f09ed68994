"""Parameters and files for other programs: exact balances, and LAMMPS, MuJoCo, YADE, Drake."""

import math
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
import tomlkit
from dentscope.core import InputError, Material, Pair
from dentscope.core.inputs.second_sphere import StruckSphere
from dentscope.core.inputs.templates import template
from dentscope.dynamics import strike
from dentscope.dynamics.export import simulators
from dentscope.dynamics.export.collisions import DASHPOT, HUNT, TSUJI, blow_on, damping_for
from dentscope.dynamics.export.discrete_elements import substitutes, two_balls
from dentscope.dynamics.export.lammps import lammps_lines
from dentscope.models import LAWS
from dentscope.start.ball_file import read_ball
from made_blows import ball_setup
from made_files import changed, put, rows_of
from scipy.integrate import solve_ivp

STEEL = Material(E=200e9, nu=0.3, Sy=600e6, density=7800.0)
HARD = Material(E=210e9, nu=0.3, Sy=1500e6)
PAIR = Pair(STEEL, HARD, 5e-3)
MASS = 4.0 / 3.0 * math.pi * PAIR.R**3 * 7800.0


@pytest.fixture(scope="module")
def rows():
    return substitutes(LAWS["fitted"], PAIR, mass=MASS, speeds=[0.1, 0.5, 3.0])


def test_an_elastic_ball_is_hertz_impact():
    """Johnson (1985), 11.4: depth (15 m v^2/(16 E' R^(1/2)))^(2/5), time 2.94 depth/v, e = 1."""
    pair = Pair(Material(E=200e9, nu=0.3), Material(E=200e9, nu=0.3), 5e-3)
    (row,) = substitutes(LAWS["hertz"], pair, mass=MASS, speeds=[1.0])
    depth = (15.0 * MASS / (16.0 * pair.E_reduced * math.sqrt(pair.R))) ** 0.4
    own = row.substitutes[0]
    assert own.blow.depth == pytest.approx(depth, rel=1e-4)
    assert own.blow.time == pytest.approx(2.943 * depth, rel=1e-3)
    assert own.blow.restitution == pytest.approx(1.0, abs=1e-4)
    assert max(abs(x) for x in own.missed(row.law)) < 1e-3


def test_each_substitute_returns_what_the_law_returns(rows):
    for row in rows:
        _, soft, linear, *_ = row.substitutes
        for s in row.substitutes:
            assert s.blow.restitution == pytest.approx(row.law.restitution, abs=1e-4)
        assert soft.blow.depth == pytest.approx(row.law.depth, rel=1e-3)
        assert linear.blow.depth == row.law.depth
        # work done by the linear loading is the kinetic energy
        assert 0.5 * linear.stiffness * linear.blow.depth**2 == pytest.approx(
            0.5 * MASS * row.law.speed**2
        )
        # of a force that grows as depth^n the peak is (n + 1) W/depth, of a straight one 2 W/depth
        assert 0.79 * row.law.force < linear.blow.force < row.law.force
    assert rows[-1].substitutes[0].blow.depth < 0.85 * rows[-1].law.depth  # nothing yields in it


def test_a_restitution_below_what_the_damping_can_do_is_one_line():
    with pytest.raises(InputError, match=r"0.001 by hertz-tsuji .*least of this damping: lower"):
        damping_for(TSUJI, 1e-3)


def test_a_damping_that_cannot_is_left_out_and_the_others_get_theirs():
    soft = Material(E=200e9, nu=0.3, Sy=6e6, density=7800.0)
    (row,) = substitutes(LAWS["fitted"], Pair(soft, HARD, 5e-3), mass=MASS, speeds=[30.0])
    assert row.law.restitution < 0.11
    assert set(row.left_out) == {"hertz-tsuji", "hertz-tsuji-softened"}
    assert [s.name for s in row.substitutes] == [
        "linear-hysteretic", "spring-dashpot", "hunt-crossley"
    ]  # fmt: skip
    text = lammps_lines([row], PAIR, mass=MASS)
    assert text.startswith("# 30 m/s: no hertz-tsuji-softened: restitution: ")
    assert len(text.splitlines()) == 1


def test_command_writes_table_and_fragments(tmp_path, errs, prints):
    text = ("radius_m = 0.005\n[sphere]\nE_Pa = 200e9\nnu = 0.3\nSy_Pa = 600e6\n"
            "density_kg_m3 = 7800\n[flat]\nE_Pa = 210e9\nnu = 0.3\nSy_Pa = 1500e6\n"
            "[load]\nmax_delta_over_R = 0.01\n")  # fmt: skip
    file, out = put(tmp_path / "pair.toml", text), tmp_path / "dem"
    assert "hertz-tsuji-softened" in prints("export", "dem", file, "--speed", "0.5,3", "--out", out)
    table = rows_of(out / "dem.csv")
    assert len(table) == 2 * 2 * 6
    by_speed = [float(r["restitution"]) for r in table if r["model"] == "fitted"]
    assert by_speed[0] > by_speed[1]
    lines = (out / "lammps.in").read_text()
    assert len(laws_of(lines, "flat")) == len(laws_of(lines, "balls")) == 2
    told = prints("export", "dem", file, "--speed", "0.5,2e3", "--out", out)
    assert "fitted: 1 of 2 impacts go so deep, to" in " ".join(told.split())
    for line in (["--speed", "10:1"], ["--speed", "1e5"], ["--mass", "-1"], ["--mass", "nan"]):
        assert len(errs("export", "dem", file, *line).splitlines()) == 1


def laws_of(lines, name):
    given = lines.split(f"variable {name} index &")[1].split("\nvariable")[0].split("\nlabel")[0]
    return [part.split() for part in given.split('"')[1::2]]


def number_of(lines, name):
    return float(lines.split(f"variable {name} index ")[1].split()[0])


def test_two_balls_have_half_the_mass_and_half_the_radius():
    """Hertz (Johnson 11.4) for two balls of 2.5 mm and 0.1 g: depth and time from m/2 and R/2."""
    elastic = Material(E=70e9, nu=0.33, density=2700.0)
    pair, mass = two_balls(Pair(elastic, HARD, 2.5e-3), 1e-4)
    (row,) = substitutes(LAWS["hertz"], pair, mass=mass, speeds=[1.0])
    reduced = 70e9 / (2.0 * (1.0 - 0.33**2))
    depth = (15.0 * 0.5e-4 / (16.0 * reduced * math.sqrt(1.25e-3))) ** 0.4
    assert row.law.depth == pytest.approx(depth, rel=1e-4)


BALL = {
    "target": {"E_Pa": {"value": 6.89e10, "std": 1e9}, "nu": 0.33, "Sy_Pa": 2.76e8},
    "strikers": {"ball": {"shape": "sphere", "tip_radius_m": 0.003, "E_Pa": 1.93e11, "nu": 0.29,
                          "Sy_Pa": 7.0e8, "density_kg_m3": 8000}},
    "friction": {"coefficient": 0.3},
    "impact": {"impact_speed_m_s": 1.0},
}  # fmt: skip


def written(tmp_path, changes):
    return put(tmp_path / "ball.toml", tomlkit.dumps(changed(BALL, changes)))


def test_the_file_of_an_impact_gives_wall_balls_and_friction(tmp_path, prints):
    """LAMMPS returned 0.92622, 0.69347 and 0.45486 with these parameters."""
    speeds = {"from": 0.1, "to": 10, "count": 21, "spacing": "log"}
    more = {"target.density_kg_m3": 2700, "impact.support": "half-space"}
    file = written(tmp_path, {**more, "sweep.impact_speed_m_s": speeds})
    told = prints("export", "dem", file, "--out", tmp_path)
    assert "target.E_Pa.std = 1e+09" in told
    assert "impact.support = half-space" in told
    table = rows_of(tmp_path / "dem.csv")
    ours = [float(r["restitution"]) for r in table
            if r["model"] == "fitted" and r["contact"] == "ball on flat"]  # fmt: skip
    assert ours[::3] == pytest.approx([0.9262, 0.6935, 0.4549], abs=1e-4)
    walls = laws_of((tmp_path / "lammps.in").read_text(), "flat")
    assert len(walls) == 7
    # Mindlin's 8 G* over Hertz's (4/3) E', by hand, whatever the softening
    shear = sum((2 - nu) * 2 * (1 + nu) / E for E, nu in ((6.89e10, 0.33), (1.93e11, 0.29)))
    reduced = 1.0 / ((1 - 0.33**2) / 6.89e10 + (1 - 0.29**2) / 1.93e11)
    for words in walls:
        k, kt = float(words[words.index("hertz") + 1]), float(words[words.index("tangential") + 2])
        assert kt / k == pytest.approx(8.0 / shear / (4.0 / 3.0 * reduced), rel=1e-6)
        assert words[words.index("damping") - 1] == "0.3"


def lammps_blow(coefficients, *, R, mass, speed):
    """Restitution, depth and time of LAMMPS's `hertz K E ... damping tsuji`, from its manual.

    F = K R^(1/2) d^(3/2) + eta d', eta = alpha(E) (m F_e/d)^(1/2); no force where d < 0.
    """
    k, entered = coefficients
    powers = (1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218)
    alpha = sum(c * entered**n for n, c in enumerate(powers))
    k *= math.sqrt(R)
    scale = (mass * speed**2 / k) ** 0.4  # of depth; time in scale/speed

    def rates(_t, state):
        x, v = max(state[0], 0.0), state[1]
        return [v, -(x**1.5) - alpha * x**0.25 * v]

    def parts(_t, state):
        return state[0]

    parts.terminal, parts.direction = True, -1.0
    found = solve_ivp(rates, (0.0, 1e3), [1e-12, 1.0], events=parts, rtol=1e-9, atol=1e-12)
    return -found.y[1, -1], scale * found.y[0].max(), scale / speed * found.t[-1]


ELASTIC = {"E_Pa": 2e11, "nu": 0.3}
GRAINS = {
    "a rigid wall": ({"rigid": True}, {**ELASTIC, "Sy_Pa": 4e8}, 3e-3, 7800.0, 2.0),
    "a softer ball": ({**ELASTIC, "Sy_Pa": 2e9}, {**ELASTIC, "Sy_Pa": 3e8}, 3e-3, 7800.0, 2.0),
    "equal bodies": ({**ELASTIC, "Sy_Pa": 4e8}, {**ELASTIC, "Sy_Pa": 4e8}, 3e-3, 7800.0, 1.0),
    "elastic": (ELASTIC, ELASTIC, 3e-3, 7800.0, 1.0),
    "dust": ({**ELASTIC, "Sy_Pa": 1e9}, ELASTIC, 5e-7, 7800.0, 30.0),
    "a boulder": ({"E_Pa": 5e10, "nu": 0.2, "Sy_Pa": 2e8}, {"E_Pa": 5e10, "nu": 0.2}, 1.0, 2700.0,
                  5.0),
    "rubber": (ELASTIC, {"E_Pa": 2e6, "nu": 0.49, "Sy_Pa": 4e5}, 0.02, 1100.0, 3.0),
    "barely yielding": ({**ELASTIC, "Sy_Pa": 1e9}, ELASTIC, 5e-3, 7800.0, 0.2),
    "fast": ({"E_Pa": 7e10, "nu": 0.33, "Sy_Pa": 1e8}, ELASTIC, 2e-3, 7800.0, 50.0),
}  # fmt: skip


@pytest.mark.parametrize(("flat", "ball", "R", "density", "speed"), GRAINS.values(), ids=GRAINS)
def test_what_lammps_makes_of_the_lines(flat, ball, R, density, speed, tmp_path, prints):
    ball = {"density_kg_m3": density, **ball}
    given = ball_setup(target=flat, ball=ball, radius=R, speed=speed).content
    prints("export", "dem", put(tmp_path / "b.toml", tomlkit.dumps(given)), "--out", tmp_path)
    mass = 4.0 / 3.0 * math.pi * R**3 * density
    table = rows_of(tmp_path / "dem.csv")
    lines = (tmp_path / "lammps.in").read_text()
    two = "two balls" in lines
    for wall in (True, False)[: 1 + two]:
        (words,) = laws_of(lines, "flat" if wall else "balls")
        at = words.index("hertz") + 1
        half = 1.0 if wall else 0.5
        e, depth, time = lammps_blow(
            [float(x) for x in words[at : at + 2]], R=half * R, mass=half * mass, speed=speed
        )
        place = "ball on flat" if wall else "two balls"
        (law,) = (
            r for r in table
            if r["model"] in ("fitted", "jackson-green") and r["contact"] == place
        )  # fmt: skip
        assert e == pytest.approx(float(law["restitution"]), abs=2e-4)
        assert 1.2 * time < math.prod(number_of(lines, name) for name in ("dt", "steps"))
        assert depth == pytest.approx(float(law["depth_m"]), rel=1e-2)


def test_metals_that_harden_are_told_by_the_law_that_follows_them(tmp_path, prints):
    curve, laws = {"law": "swift", "K_Pa": 5e8, "n": 0.2}, ["fitted", "hardening"]
    file = written(tmp_path, {"target.hardening": curve, "impact.laws": laws})
    assert read_ball(file).law == "hardening"
    told = prints("export", "dem", file, "--law", "fitted", "--out", tmp_path)
    assert "fitted takes the first strength of each metal" in told


def test_a_mechanism_of_the_file_acts_on_the_parameters(tmp_path, prints):
    rate = {"strain-rate-hardening": {"rise_at_1000_per_s": 1.9, "rate_exponent": 0.2}}
    found = {}
    for name, changes in (("without", {}), ("with", {"mechanisms": rate})):
        file = written(tmp_path, changes)
        ball, told = read_ball(file), prints("export", "dem", file, "--out", tmp_path)
        assert ("no rate is stated; with that of" in told) == (name == "without")
        assert ("with strain-rate-hardening; the lines for two" in told) == (name == "with")
        (row,) = substitutes(
            LAWS["fitted"], ball.pair, mass=ball.mass, speeds=ball.speeds, asked=ball.asked
        )
        found[name] = row.law.restitution
        blow = strike(ball.setup.scene(LAWS["fitted"]))
        assert found[name] == pytest.approx(blow.restitution, rel=1e-3)
    assert found["with"] > 1.2 * found["without"]


def test_heights_of_a_sweep_are_the_speeds_of_their_falls(tmp_path):
    falls = {"impact_speed_m_s": None, "drop_height_m": 1.0}
    ball = read_ball(written(tmp_path, {"impact": falls, "sweep.drop_height_m": [0.05, 0.2]}))
    assert ball.speeds == pytest.approx([math.sqrt(0.981), math.sqrt(3.924)], rel=1e-12)
    assert not any("drop_height_m" in key for key in ball.unused)


def test_a_rod_is_no_ball_of_a_discrete_element_code(tmp_path, errs):
    file = put(tmp_path / "rod.toml", template("rod"))
    assert 'strikers.rod.shape: a rod (allowed: "sphere")' in errs("export", "dem", file)


STAINLESS = Material(E=193e9, nu=0.29, Sy=700e6, density=8000.0)
ALLOY = Material(E=68.9e9, nu=0.33, Sy=276e6)
DROPPED = Pair(STAINLESS, ALLOY, 3e-3)
BALL_MASS = 4.0 / 3.0 * math.pi * DROPPED.R**3 * 8000.0
CONTACT = simulators.BodiesMet(DROPPED.R, BALL_MASS, 0.3)
SPEEDS = [0.1, 1.0, 10.0]


@pytest.fixture(scope="module")
def drops():
    return substitutes(LAWS["fitted"], DROPPED, mass=BALL_MASS, speeds=SPEEDS)


def test_a_dashpot_that_lets_go_returns_schwager_and_poeschels_formula():
    """exp(-b/w (pi - arctan(2 b w/(w^2 - b^2)))) below the critical damping (Eq. 21)."""
    for c in (0.1, 0.5, 1.0):
        b = 0.5 * c
        w = math.sqrt(1.0 - b * b)
        turn = math.atan2(2.0 * b * w, w * w - b * b)
        found = blow_on(DASHPOT, 1.0, c, 1.0, 1.0)
        assert found.restitution == pytest.approx(math.exp(-b / w * (math.pi - turn)), rel=1e-6)


def test_hunt_and_crossleys_ball_obeys_its_own_integral():
    """What the damping takes: (e + 1) x = ln((1 + x)/(1 - e x)) with x = chi v, exactly."""
    for x in (0.05, 0.5, 3.0):
        e = blow_on(HUNT, 1.0, x, 1.0, 1.0).restitution
        assert (1.0 + e) * x == pytest.approx(math.log((1.0 + x) / (1.0 - e * x)), rel=1e-5)


def test_each_program_gets_the_restitution_and_the_depth(drops):
    for row in drops:
        for law in (DASHPOT, HUNT):
            s = row.named(law.name)
            assert s.blow.restitution == pytest.approx(row.law.restitution, abs=1e-4)
            assert s.blow.depth == pytest.approx(row.law.depth, rel=1e-6)
        assert damping_for(DASHPOT, row.law.restitution) < 2.0


def printed(text):
    found = re.findall(r"v = (\S+) m/s: restitution ([-.\d]+)(?:, of two balls ([-.\d]+))?", text)
    return {float(v): [float(e) for e in es if e] for v, *es in found}


def dropped(drops, files, command, folder):
    """What a program prints of a drop at each speed is the restitution of its row."""
    for name, text in files.items():
        (folder / name).write_text(text)
    ended = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
    assert printed(ended.stdout) == {
        v: [pytest.approx(r.law.restitution, rel=1e-3)] for v, r in zip(SPEEDS, drops, strict=True)
    }


def test_mujoco_drops_what_was_written(drops, tmp_path):
    pytest.importorskip("mujoco")
    files = simulators.mujoco_files(drops, CONTACT)
    dropped(drops, files, [sys.executable, "mujoco_drop.py"], tmp_path)


def test_yade_drops_what_was_written(drops, tmp_path):
    yade = shutil.which("yade") or pytest.skip("yade is not installed")
    files = {"yade_drop.py": simulators.yade_script(drops, CONTACT)}
    dropped(drops, files, [yade, "-n", "-x", "yade_drop.py"], tmp_path)


def test_lammps_drops_what_was_written(drops, tmp_path):
    """On the flat and of two balls; of two spheres from either side, one held."""
    lammps = pytest.importorskip("lammps")
    pair, half = two_balls(DROPPED, BALL_MASS)
    two = substitutes(LAWS["fitted"], pair, mass=half, speeds=SPEEDS)
    held = StruckSphere(radius=4.0 * DROPPED.R)
    free = replace(held, mass=9 * BALL_MASS)
    inputs = {
        "flat": (lammps_lines(drops, DROPPED, mass=BALL_MASS, friction=0.3, of_balls=two), two),
        "held": (lammps_lines(drops, DROPPED, mass=BALL_MASS, second=held), ()),
        "free": (lammps_lines(drops, DROPPED, mass=BALL_MASS, second=free), ()),
    }
    for name, (text, others) in inputs.items():
        file, log = tmp_path / name, tmp_path / f"{name}.log"
        file.write_text(text)
        try:
            solver = lammps.lammps(cmdargs=["-screen", "none", "-log", str(log)])
        except OSError as error:
            pytest.skip(str(error))
        solver.file(str(file))
        solver.close()
        both = zip(drops, others or drops, strict=True)
        wanted = [[a.law.restitution, b.law.restitution][: 1 + bool(others)] for a, b in both]
        found = printed(log.read_text())
        assert list(found.values()) == [pytest.approx(e, abs=2e-4) for e in wanted], name


def test_drake_returns_what_the_table_says(drops):
    pytest.importorskip("pydrake")
    from pydrake.geometry import AddContactMaterial, HalfSpace, ProximityProperties, Sphere
    from pydrake.math import RigidTransform
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, CoulombFriction
    from pydrake.multibody.tree import SpatialInertia
    from pydrake.systems.analysis import Simulator
    from pydrake.systems.framework import DiagramBuilder

    row = drops[1]
    s = row.named(HUNT.name)
    line = simulators.drake_lines([row], CONTACT).splitlines()[-1]
    props = ProximityProperties()
    eval(line, {"AddContactMaterial": AddContactMaterial, "props": props,
                "CoulombFriction": CoulombFriction})  # fmt: skip
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, time_step=0.0)
    ball = plant.AddRigidBody("ball", SpatialInertia.SolidSphereWithMass(BALL_MASS, DROPPED.R))
    plant.RegisterCollisionGeometry(ball, RigidTransform(), Sphere(DROPPED.R), "ball", props)
    floor = plant.world_body()
    plant.RegisterCollisionGeometry(floor, RigidTransform(), HalfSpace(), "floor", props)
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, 0.0])
    plant.Finalize()
    diagram = builder.Build()
    simulator = Simulator(diagram)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    plant.SetFreeBodyPose(context, ball, RigidTransform([0.0, 0.0, DROPPED.R * (1.0 + 1e-9)]))
    velocity = np.zeros(6)
    velocity[5] = -row.law.speed
    plant.SetVelocities(context, velocity)
    integrator = simulator.get_mutable_integrator()
    integrator.request_initial_step_size_target(s.blow.time / 500)
    integrator.set_maximum_step_size(s.blow.time / 500)
    simulator.AdvanceTo(1.5 * s.blow.time)
    back = plant.GetVelocities(context)[5] / row.law.speed
    assert back == pytest.approx(row.law.restitution, rel=0.01)


def test_yades_plastic_limit_lies_at_the_depth_of_the_blow(drops):
    """Luding (2008), Eq. 7, with the harmonic mean of two like radii."""
    row_of_five = rf"^    \({', '.join([r'([-+.e0-9]+)'] * 5)}\),"
    found = re.findall(row_of_five, simulators.yade_script(drops, CONTACT), re.MULTILINE)
    for row, numbers in zip(drops, found, strict=True):
        _, k1, k2, phi, _ = map(float, numbers)
        assert phi * DROPPED.R * k2 / (k2 - k1) == pytest.approx(row.law.depth, rel=1e-4)
        assert math.sqrt(k1 / k2) == pytest.approx(row.law.restitution, rel=1e-5)


def test_mujocos_model_has_a_class_for_each_speed(drops):
    tree = ET.fromstring(simulators.mujoco_files(drops, CONTACT)["mujoco.xml"])
    assert [one.get("class") for one in tree.iter("default")] == [None, "v0.1", "v1", "v10"]


def test_the_formula_holds_as_far_as_it_says():
    found = simulators.formula_of(LAWS["fitted"], DROPPED, mass=BALL_MASS, speeds=SPEEDS)
    (row,) = substitutes(LAWS["fitted"], DROPPED, mass=BALL_MASS, speeds=[2.5])
    assert found(2.5) == pytest.approx(row.law.restitution, abs=1.5 * found.missed)
    assert found.missed < 0.015
