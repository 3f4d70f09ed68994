"""Rigid-body identities of the audit, and its verdict on the thesis's own sets."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from dentscope.core.rig import Quantity, StrikerTable
from dentscope.recordings import Severity, audit, read
from dentscope.recordings.checks.contact import check_duration
from dentscope.recordings.checks.limits import bending_period, wave_limit
from dentscope.recordings.checks.rigid import touch
from hypothesis import assume, given
from hypothesis import strategies as st

DATA = Path(__file__).parents[3] / "data" / "recordings"

ROD = StrikerTable(
    shape="rod", tip_radius_m=8.8e-3, radius_m=8.8e-3, length_m=0.3048, mass_kg=0.4607, E_Pa=200e9,
    density_kg_m3=7800.0,
)  # fmt: skip
BALL = StrikerTable(shape="sphere", tip_radius_m=8.8e-3, mass_kg=0.02)


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
