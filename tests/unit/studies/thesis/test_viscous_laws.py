"""The rate-dependent laws of chapter 1 against their equations of motion."""

import math

import pytest
from dentscope.core import InputError
from dentscope.studies.thesis.viscous import alpha_for, hunt_crossley, kelvin_voigt, paradox
from scipy.integrate import solve_ivp

MASS, STIFFNESS, DAMPING, SPEED = 0.05, 2e6, 120.0, 1.3


def impact(force, crossing):
    def motion(_t, y):
        return [y[1], -float(force(y[0], y[1])) / MASS]

    crossing.terminal, crossing.direction = True, -1.0
    return solve_ivp(motion, (0.0, 1.0), [0.0, SPEED], events=crossing, rtol=1e-10, atol=1e-13)


def test_kelvin_voigt_pushes_before_it_touches_and_pulls_before_it_lets_go():
    told = paradox(mass=MASS, stiffness=STIFFNESS, damping=DAMPING, speed=SPEED)
    assert told.force_at_touch == pytest.approx(156.0)  # 120 * 1.3, with nothing pressed in

    def law(d, v):
        return kelvin_voigt(d, v, stiffness=STIFFNESS, damping=DAMPING)

    _, rate = impact(law, lambda _t, y: y[0]).y_events[0][0]
    assert told.restitution_at_return == pytest.approx(-rate / SPEED, rel=1e-6)
    assert told.pull_at_return == pytest.approx(float(law(0.0, rate)), rel=1e-6)
    assert told.pull_at_return < 0.0


def test_kelvin_voigt_parted_at_zero_force_leaves_a_dent_without_plasticity():
    told = paradox(mass=MASS, stiffness=STIFFNESS, damping=DAMPING, speed=SPEED)

    def law(d, v):
        return kelvin_voigt(d, v, stiffness=STIFFNESS, damping=DAMPING)

    depth, rate = impact(law, lambda _t, y: float(law(y[0], y[1]))).y_events[0][0]
    assert told.depth_at_zero_force == pytest.approx(depth, rel=1e-5)
    assert told.restitution_at_zero_force == pytest.approx(-rate / SPEED, rel=1e-6)
    assert depth > 0.0
    assert told.restitution_at_zero_force > told.restitution_at_return


def test_no_damping_is_no_paradox():
    told = paradox(mass=MASS, stiffness=STIFFNESS, damping=0.0, speed=SPEED)
    assert told.restitution_at_return == pytest.approx(1.0)
    assert told.depth_at_zero_force == pytest.approx(0.0, abs=1e-15)


def test_a_crawling_return_is_refused():
    with pytest.raises(InputError, match="damping ratio"):
        paradox(mass=1.0, stiffness=1.0, damping=2.0, speed=1.0)


@pytest.mark.parametrize("alpha", [0.02, 0.05])
def test_hunt_crossley_restitution(alpha):
    """e = 1 - alpha v to first order, and no force at touch and parting (Hunt, Crossley)."""

    def law(d, v):
        return hunt_crossley(d, v, stiffness=1e9, alpha=alpha)

    _, rate = impact(law, lambda _t, y: y[0]).y_events[0][0]
    e = -rate / SPEED
    assert alpha_for(e, speed=SPEED) == pytest.approx(alpha, rel=1e-5)
    assert e == pytest.approx(1.0 - alpha * SPEED, abs=1.5 * (alpha * SPEED) ** 2)
    assert float(law(0.0, SPEED)) == 0.0
    # exact first integral: e and v satisfy ln((1 + u)/(1 - u e)) = u (1 + e) with u = 1.5 alpha v
    u = 1.5 * alpha * SPEED
    assert math.log((1.0 + u) / (1.0 - u * e)) == pytest.approx(u * (1.0 + e), rel=1e-6)
