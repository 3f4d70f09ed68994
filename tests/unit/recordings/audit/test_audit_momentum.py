"""Rigid bodies of the audit: identities, impulses, a sphere that is struck, the thesis's sets."""

import math
import sys
import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from dentscope.core import InputErrors
from dentscope.core.inputs.second_sphere import StruckSphere
from dentscope.core.rig import Quantity, StrikerTable
from dentscope.recordings import Severity, audit, read
from dentscope.recordings.checks.contact import check_duration
from dentscope.recordings.checks.limits import bending_period, wave_limit
from dentscope.recordings.checks.momentum import MomentumTrials, momentum_misfit
from dentscope.recordings.checks.rigid import measured_after, touch
from dentscope.recordings.rules import RULES
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import least_squares

DATA = Path(__file__).parents[4] / "data" / "recordings"
ROD = StrikerTable(
    shape="rod", tip_radius_m=8.8e-3, radius_m=8.8e-3, length_m=0.3048, mass_kg=0.4607, E_Pa=200e9,
    density_kg_m3=7800.0,
)  # fmt: skip


BALL = StrikerTable(shape="sphere", tip_radius_m=8.8e-3, mass_kg=0.02)
NAMES = (
    "restitution", "friction_impulse_ratio", "rebound_spin_rad_s", "rebound_speed_m_s",
    "tangential_rebound_m_s",
)  # fmt: skip


def after(body, angle, normal, tangential, spin, px, py):
    """Rigid-body mechanics of one trial, written out once more; the flat is y = 0."""
    rod = body.shape == "rod"
    arm = 0.5 * body.length_m.value if rod else 0.0
    R, m = body.tip_radius_m.value, body.mass_kg.value
    inertia = m * ((2 * arm) ** 2 / 12 + R**2 / 4) if rod else 0.4 * m * R**2
    tip = np.array([-arm * math.cos(angle), -arm * math.sin(angle) - R])
    centre = np.array([tangential, -normal + spin * arm * math.cos(angle)])

    def at_tip(v, w):
        return v + w * np.array([-tip[1], tip[0]])

    v = centre + np.array([px, py]) / m
    w = spin + (tip[0] * py - tip[1] * px) / inertia
    e = -at_tip(v, w)[1] / at_tip(centre, spin)[1]
    return dict(zip(NAMES, (e, abs(px) / py, w, v[1], v[0]), strict=True))


@pytest.mark.parametrize("body", [ROD, BALL], ids=["rod", "ball"])
def test_misfit_is_the_one_that_scipy_finds(body):
    rng, n = np.random.default_rng(5), 40
    angle = rng.uniform(0.3, 1.5, n) if body is ROD else np.full(n, math.pi / 2)
    normal, tangential = rng.uniform(0.5, 4.0, n), rng.uniform(-3.0, 3.0, n)
    spin, arm = rng.uniform(-30.0, 30.0, n), 0.1524 if body is ROD else 8.8e-3
    angle_std = np.full(n, 0.02 if body is ROD else 0.0)
    m = body.mass_kg.value
    impulse = np.stack([rng.uniform(-0.3, 0.3, n), rng.uniform(0.4, 1.8, n)], 1) * m
    impulse *= normal[:, None] * (0.3 if body is ROD else 1.0)
    true = [
        after(body, *given, *p)
        for *given, p in zip(angle, normal, tangential, spin, impulse, strict=True)
    ]
    measured = {}
    for name in NAMES:
        value = np.array([t[name] for t in true])
        std = 0.02 * np.abs(value) + 1e-3
        value += std * rng.standard_normal(n)
        value[rng.random(n) < 0.25] = np.nan
        measured[name] = np.stack([value, std], axis=1)
    found, degrees = momentum_misfit(
        MomentumTrials(
            body, np.stack([angle, angle_std], 1), np.stack([normal, 0.02 * normal], 1),
            tangential, spin, measured,
        )
    )  # fmt: skip
    assert degrees.sum() > n

    for k in range(n):
        known = [name for name in NAMES if np.isfinite(measured[name][k, 0])]
        assert degrees[k] == max(len(known) - 2, 0)
        if len(known) < 3:
            assert found[k] == 0.0
            continue
        unit = {name: normal[k] if name.endswith("_m_s") else 1.0 for name in known}
        unit["rebound_spin_rad_s"] = normal[k] / arm

        def residuals(x, k=k, known=known, unit=unit):
            stretch = 1.0 + 0.02 * x[2]
            got = after(
                body, angle[k] + angle_std[k] * x[3], normal[k] * stretch,
                tangential[k] * stretch, spin[k], x[0] * m, x[1] * m,
            )  # fmt: skip
            left = [x[2], x[3]]
            for name in known:
                value, std = measured[name][k]
                left.append((got[name] - value) / math.hypot(std, RULES.frozen_angle * unit[name]))
            return left

        best = min(
            2.0 * least_squares(residuals, [*start, 0.0, 0.0], x_scale="jac").cost
            for start in (impulse[k] / m, impulse[k] / m * [-1.0, 1.0])
        )
        assert found[k] == pytest.approx(best, rel=1e-5, abs=1e-6)


def test_an_audit_grows_no_faster_than_its_rows(tmp_path):
    source = DATA / "kharaz-2001-oblique"
    head, *rows = (source / "trials.csv").read_text().splitlines()
    calls, peaks = [], []
    for n in (500, 4000):
        folder = tmp_path / str(n)
        folder.mkdir()
        (folder / "set.toml").write_bytes((source / "set.toml").read_bytes())
        named = [row.split(",", 1) for row in (rows * (n // len(rows) + 1))[:n]]
        lines = [f"{name}-{k},{rest}" for k, (name, rest) in enumerate(named)]
        (folder / "trials.csv").write_text("\n".join([head, *lines]) + "\n")
        found = read(folder)
        count, peak = work_of(lambda found=found: audit(found))
        calls.append(count)
        peaks.append(peak)
    # eight times the rows; what grew with their square would be 64 times as much
    assert calls[1] < 12.0 * calls[0]
    assert peaks[1] < 12.0 * peaks[0]


def work_of(do):
    """Calls and most bytes held while `do` runs: unlike seconds, the same on a busy machine."""
    count = 0

    def counted(_frame, event, _arg):
        nonlocal count
        count += event in ("call", "c_call")

    tracemalloc.start()
    sys.setprofile(counted)
    try:
        do()
    finally:
        sys.setprofile(None)
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    return count, peak


@given(
    angle=st.floats(0.05, math.pi / 2),
    e=st.floats(0.0, 1.0),
    mu=st.floats(0.0, 0.3),
    tangential=st.floats(-3.0, 3.0),
    spin=st.floats(-50.0, 50.0),
    ball=st.booleans(),
)
def test_momentum_energy_and_restitution_hold_exactly(angle, e, mu, tangential, spin, ball):
    before = touch(BALL if ball else ROD, angle=angle, normal=2.0, tangential=tangential, spin=spin)
    assume(not ball or abs(before.tip[0]) > 1e-6)
    impulse = np.array(before.impulse(e, mu))
    after = before.after(impulse)
    scale = before.energy
    # the contact point leaves with e times its approach, and friction is mu times the normal part
    assert after.tip[1] == pytest.approx(-e * before.tip[1], abs=1e-9)
    assert abs(impulse[0]) == pytest.approx(mu * impulse[1], rel=1e-9, abs=1e-15)
    # the normal velocity of the contact point changes by its mobility times the impulse
    change = before.across * impulse[0] + before.along * impulse[1]
    assert after.tip[1] - before.tip[1] == pytest.approx(change, abs=1e-9)
    # work of an impulse is impulse times mean velocity of the point where it acts
    work = float(impulse @ np.add(before.tip, after.tip)) / 2.0
    assert after.energy - before.energy == pytest.approx(work, abs=1e-9 * scale)


def test_thesis_rod_has_the_published_stick_ratio_mass_and_bending_period():
    # thesis-data: I = m L^2/12; stick friction 0.762, 0.589, 0.257; effective tip mass with the
    # friction of the experiments 0.1346, 0.2013, 0.3690 kg; first bending period 1.17 ms; 33 kN
    # wave limit at 3.45 m/s (rho c v A)
    inertia = 0.4607 * 0.3048**2 / 12.0
    thin = StrikerTable.model_validate({**ROD.model_dump(), "inertia_kg_m2": inertia})
    rows = ((20, 0.20, 0.762, 0.1346), (45, 0.13, 0.589, 0.2013), (70, 0.10, 0.257, 0.3690))
    for angle, mu, ratio, mass in rows:
        before = touch(thin, angle=math.radians(angle), normal=1.0, tangential=0.0, spin=0.0)
        assert before.stick_ratio == pytest.approx(ratio, abs=1e-3)
        assert before.impulse(0.0, mu)[1] == pytest.approx(mass, rel=1e-3)
    assert bending_period(ROD) == pytest.approx(1.17e-3, rel=5e-3)
    assert wave_limit(ROD, 3.45) == pytest.approx(33e3, rel=0.01)


def test_thesis_sets_contradict_themselves_in_the_mass():
    for chapter, stated, low, high in ((3, 0.255, 0.151, 0.157), (5, 0.4607, 0.5784, 0.6007)):
        found = audit(read(DATA / f"thesis-chapter-{chapter}"))
        mass = next(f for f in found.findings if f.check == "mass of rod")
        assert mass.severity is Severity.CONTRADICTION
        assert mass.value == stated
        assert low * 0.999 <= mass.expected <= high * 1.001


def test_thesis_audit_names_the_open_questions():
    lines = "\n".join(str(f) for f in audit(read(DATA / "thesis-chapter-5")).findings)
    assert "look for a sink outside the contact" in lines
    assert "first bending period" in lines
    upright = "\n".join(str(f) for f in audit(read(DATA / "thesis-chapter-3")).findings)
    assert "the contact reaches the edge" in upright
    assert "wave limit" in upright


@pytest.mark.parametrize(("trips", "rigid"), [(2.9, False), (3.1, True)])
def test_a_rod_is_rigid_from_three_round_trips_of_a_wave_on(trips, rigid):
    stated = read(DATA / "thesis-chapter-5")
    (name, rod), *_ = stated.setup.strikers.items()

    def durations(modulus):
        body = rod.model_copy(update={"E_Pa": Quantity(value=modulus)})
        strikers = {**stated.setup.strikers, name: body}
        setup = stated.setup.model_copy(update={"strikers": strikers})
        found = check_duration(replace(stated, setup=setup))
        return [f for f in found if "round trip" in f.check]

    first = durations(rod.E_Pa.value)[0]
    # the round trip goes as one over the root of the modulus; the contact times are measured
    moved = rod.E_Pa.value * (trips * first.expected / first.value) ** 2
    again = durations(moved)[0]
    assert again.value / again.expected == pytest.approx(trips, rel=1e-6)
    assert (again.severity is Severity.CONSISTENT) == rigid


@pytest.mark.parametrize("folder", sorted(p.parent.name for p in DATA.glob("*/set.toml")))
def test_every_shipped_set_reads_and_names_its_source(folder):
    found = read(DATA / folder)
    assert found.name == folder
    assert found.setup.source
    assert found.setup.licence
    assert found.setup.description
    assert not found.notes


LIGHT = StrikerTable(shape="sphere", tip_radius_m=5e-3, mass_kg=4e-3)
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
    before = touch(LIGHT, angle=0.5 * math.pi, normal=2.0, tangential=0.7, spin=30.0, second=second)
    impulse = before.impulse(0.4, 0.1)
    after = before.after(impulse)
    assert measured_after(before, impulse)["restitution"] == pytest.approx(0.4, abs=1e-12)
    if math.isfinite(mass):
        momentum = LIGHT.mass_kg.value * after.vy + mass * after.struck_vy
        assert momentum == pytest.approx(-2.0 * LIGHT.mass_kg.value, rel=1e-12)
    own = second.parted(LIGHT.mass_kg.value, 2.0, 0.4)[0]
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
