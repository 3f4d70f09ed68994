"""Sets in which a sphere is struck: what they may say, and momentum and energy of both bodies."""

import math

import numpy as np
import pytest
from dentscope.core import InputErrors
from dentscope.core.inputs.second_sphere import StruckSphere
from dentscope.core.rig import StrikerTable
from dentscope.recordings import audit, read
from dentscope.recordings.checks.findings import Severity
from dentscope.recordings.checks.rigid import measured_after, touch

BALL = StrikerTable(shape="sphere", tip_radius_m=5e-3, mass_kg=4e-3)
MASS = 12e-3

SET = """format = "recording-set/1"
[target]
shape = "sphere"
radius_m = 0.010
mass_kg = 0.012
E_Pa = 1.1e11
nu = 0.34
Sy_Pa = 3.0e8
[strikers.ball]
shape = "sphere"
tip_radius_m = 0.005
mass_kg = 0.004
E_Pa = 2.05e11
nu = 0.3
Sy_Pa = 2.0e9
[noise]
restitution = 0.002
rebound_speed_m_s = 0.002
"""
HELD = SET.replace("mass_kg = 0.012\n", "")
TRIALS = """trial,striker,angle_deg,impact_speed_m_s,restitution,rebound_speed_m_s
1,ball,90,1.0,0.6,{:g}
2,ball,90,2.0,0.5,{:g}
"""
PRESSES = "trial,striker,load_N,permanent_depth_m,permanent_depth_m_std\n1,ball,500,2e-5,1e-6\n"


def own(e, speed):
    return -StruckSphere(0.01, MASS).parted(4e-3, speed, e)[0]


TOLD = TRIALS.format(own(0.6, 1.0), own(0.5, 2.0))


def written(folder, text, trials=TOLD):
    (folder / "set.toml").write_text(text)
    (folder / "trials.csv").write_text(trials)
    return folder


@pytest.mark.parametrize("mass", [2e-3, MASS, math.inf])
def test_a_struck_sphere_takes_its_part_of_momentum_and_energy(mass):
    """m_1 v = m_1 v_1 + m_2 v_2; what is lost is (1 - e^2) of the reduced mass's energy."""
    second = StruckSphere(10e-3, mass)
    before = touch(BALL, angle=0.5 * math.pi, normal=2.0, tangential=0.7, spin=30.0, second=second)
    impulse = before.impulse(0.4, 0.1)
    after = before.after(impulse)
    assert measured_after(before, impulse)["restitution"] == pytest.approx(0.4, abs=1e-12)
    if math.isfinite(mass):
        momentum = BALL.mass_kg.value * after.vy + mass * after.struck_vy
        assert momentum == pytest.approx(-2.0 * BALL.mass_kg.value, rel=1e-12)
    own = second.parted(BALL.mass_kg.value, 2.0, 0.4)[0]
    assert after.vy == pytest.approx(-own, abs=1e-12)
    # work of the impulse at the mean velocity of the contact
    mean = [0.5 * (a + b) for a, b in zip(before.tip, after.tip, strict=True)]
    work = sum(p * v for p, v in zip(impulse, mean, strict=True))
    assert after.energy - before.energy == pytest.approx(work, rel=1e-12)


def test_momentum_is_kept_with_a_free_sphere_and_a_wrong_mass_is_found(tmp_path):
    assert not audit(read(written(tmp_path, SET))).flagged
    heavier = read(written(tmp_path, SET.replace("mass_kg = 0.012", "mass_kg = 0.014")))
    assert {f.check for f in audit(heavier).of(Severity.CONTRADICTION)} == {"momentum"}


def test_the_dent_takes_the_energy_that_two_spheres_lose(tmp_path):
    """p pi R d^2 with 1/R = 1/R_1 + 1/R_2, of the energy of the reduced mass."""
    R, m, v, e = 1.0 / (1 / 5e-3 + 1 / 10e-3), 1.0 / (1 / 4e-3 + 1 / MASS), 2.0, 0.5
    depth = math.sqrt(0.5 * m * v**2 * (1 - e**2) / (2.84 * 3e8 * math.pi * R))
    head = "trial,striker,angle_deg,impact_speed_m_s,restitution,permanent_depth_m\n"
    for factor, wrong in ((1.0, False), (3.0, True)):
        trials = f"{head}1,ball,90,{v},{e},{factor * depth}\n"
        text = f"{SET}permanent_depth_m_relative = 0.02\n"
        found = audit(read(written(tmp_path, text, trials)))
        (line,) = [f for f in found.findings if f.check.startswith("energy")]
        assert found.flagged is wrong
        assert line.value == pytest.approx(factor**2 * line.expected, rel=1e-9)


@pytest.mark.parametrize(
    ("text", "trials", "told"),
    [
        (SET.replace("radius_m = 0.010", "radius_m = 0"), TOLD, "target.radius_m: 0"),
        (SET.replace("radius_m = 0.010\n", ""), TOLD, "target.radius_m: missing"),
        (SET.replace("radius_m = 0.010", "radius_m = -0.004"), TOLD, "wider than the sphere"),
        (SET.replace("radius_m = 0.010", "radius_m = { value = -0.0051, std = 1e-4 }"), TOLD,
         "surely wider"),
        (SET.replace('shape = "sphere"\nradius_m = 0.010\n', "", 1), TOLD, "target.mass_kg"),
        (SET.replace('shape = "sphere"\n', "", 1), TOLD, "target.radius_m: of a flat"),
        (SET.replace("[strikers", "thickness_m = 0.01\n[strikers"), TOLD, "target.thickness_m"),
        (SET.replace("[strikers", "support_mass_kg = 1\n[strikers"), TOLD, "of a free sphere"),
        (SET.replace("[noise]", "inertia_kg_m2 = 1e-7\n[noise]"), TOLD, "ball.inertia_kg_m2"),
        (SET.replace("[noise]", "tip_flat_radius_m = 1e-4\n[noise]"), TOLD, "tip_flat_radius_m"),
        (SET, TOLD.replace(",90,", ",60,", 1), "trial 1, column angle_deg: 60"),
        (SET, PRESSES, "target.mass_kg: of a sphere that is pressed"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_second_sphere_is_one_line(tmp_path, text, trials, told):
    with pytest.raises(InputErrors) as mistakes:
        read(written(tmp_path, text, trials))
    (line,) = [str(e) for e in mistakes.value.errors if told in str(e)]
    assert ".toml" in line or ".csv" in line


def test_a_held_sphere_is_pressed_and_a_curve_over_a_free_one_is_not_read(tmp_path):
    assert len(read(written(tmp_path, HELD, PRESSES)).presses.trials) == 1
    written(tmp_path, SET)
    (tmp_path / "traces").mkdir()
    heights = np.linspace(1e-3, -1e-5, 20)
    rows = [f"{1e-5 * i},{h}" for i, h in enumerate(heights)]
    (tmp_path / "traces/1.csv").write_text("\n".join(["time_s,tip_height_m", *rows]))
    with pytest.raises(InputErrors, match="tip_height_m"):
        read(tmp_path)
