"""Files for other programs, run by LAMMPS, MuJoCo, YADE and Drake where they are installed."""

import math
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
from dentscope.core import Material, Pair
from dentscope.core.inputs.second_sphere import StruckSphere
from dentscope.dynamics.export.collisions import DASHPOT, HUNT, blow_on, damping_for
from dentscope.dynamics.export.discrete_elements import substitutes, two_balls
from dentscope.dynamics.export.lammps import lammps_lines
from dentscope.dynamics.export.simulators import (
    BodiesMet,
    drake_lines,
    formula_of,
    mujoco_files,
    yade_script,
)
from dentscope.models import LAWS

STEEL = Material(E=193e9, nu=0.29, Sy=700e6, density=8000.0)
ALLOY = Material(E=68.9e9, nu=0.33, Sy=276e6)
PAIR = Pair(STEEL, ALLOY, 3e-3)
MASS = 4.0 / 3.0 * math.pi * PAIR.R**3 * 8000.0
CONTACT = BodiesMet(PAIR.R, MASS, 0.3)
SPEEDS = [0.1, 1.0, 10.0]


@pytest.fixture(scope="module")
def rows():
    return substitutes(LAWS["fitted"], PAIR, mass=MASS, speeds=SPEEDS)


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


def test_each_program_gets_the_restitution_and_the_depth(rows):
    for row in rows:
        for law in (DASHPOT, HUNT):
            s = row.named(law.name)
            assert s.blow.restitution == pytest.approx(row.law.restitution, abs=1e-4)
            assert s.blow.depth == pytest.approx(row.law.depth, rel=1e-6)
        assert damping_for(DASHPOT, row.law.restitution) < 2.0


def printed(text):
    found = re.findall(r"v = (\S+) m/s: restitution ([-.\d]+)(?:, of two balls ([-.\d]+))?", text)
    return {float(v): [float(e) for e in es if e] for v, *es in found}


def dropped(files, command, folder):
    for name, text in files.items():
        (folder / name).write_text(text)
    ended = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
    return printed(ended.stdout)


def test_mujoco_drops_what_was_written(rows, tmp_path):
    pytest.importorskip("mujoco")
    found = dropped(mujoco_files(rows, CONTACT), [sys.executable, "mujoco_drop.py"], tmp_path)
    assert found == {v: [pytest.approx(r.law.restitution, rel=1e-3)]
                     for v, r in zip(SPEEDS, rows, strict=True)}  # fmt: skip


def test_yade_drops_what_was_written(rows, tmp_path):
    yade = shutil.which("yade") or pytest.skip("yade is not installed")
    command = [yade, "-n", "-x", "yade_drop.py"]
    found = dropped({"yade_drop.py": yade_script(rows, CONTACT)}, command, tmp_path)
    assert found == {v: [pytest.approx(r.law.restitution, rel=1e-3)]
                     for v, r in zip(SPEEDS, rows, strict=True)}  # fmt: skip


def test_lammps_drops_what_was_written(rows, tmp_path):
    """On the flat and of two balls; of two spheres from either side, one held."""
    lammps = pytest.importorskip("lammps")
    pair, half = two_balls(PAIR, MASS)
    two = substitutes(LAWS["fitted"], pair, mass=half, speeds=SPEEDS)
    held = StruckSphere(radius=4.0 * PAIR.R)
    inputs = {
        "flat": (lammps_lines(rows, PAIR, mass=MASS, friction=0.3, of_balls=two), two),
        "held": (lammps_lines(rows, PAIR, mass=MASS, second=held), ()),
        "free": (lammps_lines(rows, PAIR, mass=MASS, second=replace(held, mass=9 * MASS)), ()),
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
        both = zip(rows, others or rows, strict=True)
        wanted = [[a.law.restitution, b.law.restitution][: 1 + bool(others)] for a, b in both]
        found = printed(log.read_text())
        assert list(found.values()) == [pytest.approx(e, abs=2e-4) for e in wanted], name


def test_drake_returns_what_the_table_says(rows):
    pytest.importorskip("pydrake")
    from pydrake.geometry import AddContactMaterial, HalfSpace, ProximityProperties, Sphere
    from pydrake.math import RigidTransform
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, CoulombFriction
    from pydrake.multibody.tree import SpatialInertia
    from pydrake.systems.analysis import Simulator
    from pydrake.systems.framework import DiagramBuilder

    row = rows[1]
    s = row.named(HUNT.name)
    line = drake_lines([row], CONTACT).splitlines()[-1]
    props = ProximityProperties()
    eval(line, {"AddContactMaterial": AddContactMaterial, "props": props,
                "CoulombFriction": CoulombFriction})  # fmt: skip
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, time_step=0.0)
    ball = plant.AddRigidBody("ball", SpatialInertia.SolidSphereWithMass(MASS, PAIR.R))
    plant.RegisterCollisionGeometry(ball, RigidTransform(), Sphere(PAIR.R), "ball", props)
    floor = plant.world_body()
    plant.RegisterCollisionGeometry(floor, RigidTransform(), HalfSpace(), "floor", props)
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, 0.0])
    plant.Finalize()
    diagram = builder.Build()
    simulator = Simulator(diagram)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    plant.SetFreeBodyPose(context, ball, RigidTransform([0.0, 0.0, PAIR.R * (1.0 + 1e-9)]))
    velocity = np.zeros(6)
    velocity[5] = -row.law.speed
    plant.SetVelocities(context, velocity)
    integrator = simulator.get_mutable_integrator()
    integrator.request_initial_step_size_target(s.blow.time / 500)
    integrator.set_maximum_step_size(s.blow.time / 500)
    simulator.AdvanceTo(1.5 * s.blow.time)
    back = plant.GetVelocities(context)[5] / row.law.speed
    assert back == pytest.approx(row.law.restitution, rel=0.01)


def test_yades_plastic_limit_lies_at_the_depth_of_the_blow(rows):
    """Luding (2008), Eq. 7, with the harmonic mean of two like radii."""
    number = r"([-+.e0-9]+)"
    found = re.findall(
        rf"^    \({', '.join([number] * 5)}\),", yade_script(rows, CONTACT), re.MULTILINE
    )
    for row, numbers in zip(rows, found, strict=True):
        _, k1, k2, phi, _ = map(float, numbers)
        assert phi * PAIR.R * k2 / (k2 - k1) == pytest.approx(row.law.depth, rel=1e-4)
        assert math.sqrt(k1 / k2) == pytest.approx(row.law.restitution, rel=1e-5)


def test_mujocos_model_has_a_class_for_each_speed(rows):
    tree = ET.fromstring(mujoco_files(rows, CONTACT)["mujoco.xml"])
    assert [one.get("class") for one in tree.iter("default")] == [None, "v0.1", "v1", "v10"]


def test_the_formula_holds_as_far_as_it_says():
    found = formula_of(LAWS["fitted"], PAIR, mass=MASS, speeds=SPEEDS)
    (row,) = substitutes(LAWS["fitted"], PAIR, mass=MASS, speeds=[2.5])
    assert found(2.5) == pytest.approx(row.law.restitution, abs=1.5 * found.missed)
    assert found.missed < 0.015
