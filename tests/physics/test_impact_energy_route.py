"""Normal impacts by work alone, against exact solutions and against the time steps."""

import math
from functools import partial

import numpy as np
import pytest
from dentscope.core import Pair
from dentscope.dynamics import Approach, Friction, Settings, Support, strike
from dentscope.dynamics.tabulated.energy_route import NAMES, energy_impacts, why_not
from dentscope.models import LAWS
from made_scenes import IRON, STEEL, on_iron
from scipy.special import gamma

PAIR = Pair(STEEL, IRON, 0.0088)


def by_work(law, speeds, *, mass=0.4607, pair=PAIR, gravity=9.81):
    n = len(speeds)
    rows = energy_impacts(law, pair, np.full(n, mass), np.asarray(speeds, float), gravity=gravity)
    return dict(zip(NAMES, rows.T, strict=True))


def test_hertz_exactly() -> None:
    speeds = np.geomspace(0.01, 3.0, 12)
    mass = 0.02
    found = by_work(LAWS["hertz"], speeds, mass=mass, gravity=0.0)
    # d_m = (5 m v^2 / (4 K))^(2/5), T = 2.9433 d_m / v (Hertz 1882, Johnson 1985 11.24)
    K = 4.0 / 3.0 * PAIR.E_reduced * math.sqrt(PAIR.R)
    peak = (1.25 * mass * speeds**2 / K) ** 0.4
    factor = 2.0 * math.sqrt(math.pi) * gamma(1.4) / gamma(0.9)
    assert found["peak_depth_m"] == pytest.approx(peak, rel=1e-7)
    assert found["peak_force_N"] == pytest.approx(K * peak**1.5, rel=1e-7)
    assert found["contact_time_s"] == pytest.approx(factor * peak / speeds, rel=1e-7)
    assert found["restitution"] == pytest.approx(np.ones(12), abs=1e-8)


def test_fully_plastic_restitution_falls_as_the_fourth_root_of_speed() -> None:
    # Johnson 1985 (11.21): e ~ v^(-1/4) deep in yield, for a law of constant pressure
    found = by_work(LAWS["johnson"], np.array([1.0, 2.0, 4.0, 8.0]), gravity=0.0)
    slopes = np.diff(np.log(found["restitution"])) / math.log(2.0)
    assert slopes == pytest.approx(np.full(3, -0.25), abs=0.005)


@pytest.mark.parametrize("name", ["fitted", "ghaednia", "kogut-etsion", "jackson-green", "stronge"])
def test_the_time_steps_end_alike(name: str) -> None:
    # 0.05 m/s: gravity does 4 % of the work; 10 m/s: a tenth of the radius deep
    speeds = np.geomspace(0.05, 10.0, 7)
    found = by_work(LAWS[name], speeds)
    for k, speed in enumerate(speeds):
        scene = on_iron(LAWS[name], approach=Approach(float(speed)))
        stepped = strike(scene, Settings(tolerance=1e-12))
        for key in NAMES:
            theirs = getattr(stepped, key)
            scale = stepped.peak_depth_m if key.startswith("residual") else abs(theirs)
            off = abs(found[key][k] - theirs) / scale
            assert off < 2e-7, (key, speed, off)


def test_energy_and_momentum_balance() -> None:
    speeds = np.geomspace(0.05, 10.0, 50)
    found = by_work(LAWS["fitted"], speeds)
    m, g = 0.4607, 9.81
    before = 0.5 * m * speeds**2
    fallen = m * g * (found["residual_flat_m"] + found["residual_sphere_m"])
    after = 0.5 * m * found["rebound_speed_m_s"] ** 2 + found["contact_work_J"]
    assert np.abs(before + fallen - after).max() < 1e-12 * before.max()
    impulse = found["normal_impulse_Ns"] - m * g * found["contact_time_s"]
    assert impulse == pytest.approx(m * (speeds + found["rebound_speed_m_s"]), rel=1e-12)


def test_what_the_route_leaves_to_the_time_steps() -> None:
    found = by_work(LAWS["fitted"], [1e-3, 1.0, 5e3])
    # so slow that gravity does most of the work; deeper than half the radius
    assert np.isnan(found["restitution"]).tolist() == [True, False, True]

    scene = partial(on_iron, LAWS["fitted"])
    assert why_not(scene(friction=Friction(0.3))) == ""
    assert why_not(scene(approach=Approach(1.0, math.radians(45)))) == "a leaning rod"
    assert why_not(scene(approach=Approach(1.0, spin=3.0))) == "spin"
    assert why_not(scene(support=Support(mass=2.0, stiffness=1e7))) == "a support that moves"
