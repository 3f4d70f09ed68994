"""Flight with drag: terminal speeds and falls of other people, exact limits, both ways."""

import math

import numpy as np
import pytest
from dentscope.core import InputError
from dentscope.core.drag import Fluid, air, rod_drag_across
from dentscope.dynamics import Striker
from dentscope.dynamics.drag import flown
from made_scenes import ROD
from scipy.optimize import brentq

WATER = Fluid(1000.0, 1e-3)
BALL = Striker(mass=0.0027, tip_radius=0.02)


def sphere(diameter: float, density: float) -> Striker:
    volume = math.pi / 6.0 * diameter**3
    return Striker(mass=density * volume, tip_radius=0.5 * diameter)


@pytest.mark.parametrize(
    ("diameter", "fall", "speed", "rel"),
    [   # Rushton, Ward and Holdich, Solid-Liquid Filtration and Separation Technology (1996)
        (70e-6, 1e-4, 0.00406, 0.01),
        # Stokes, v = g d^2 (rho_s - rho)/(18 mu), Re = 1.5e-4
        (5e-6, 1e-9, 9.81 * 25e-12 * 1600.0 / 18e-3, 1e-4)],
    ids=["quartz", "stokes"],
)  # fmt: skip
def test_terminal_speed_of_a_grain_in_water(diameter, fall, speed, rel) -> None:
    """After a fall from rest, many times the way that it takes."""
    found = flown(sphere(diameter, 2600.0), WATER, normal=0.0, rise=-fall)
    assert -float(found.normal) == pytest.approx(speed, rel=rel)


def test_a_ping_pong_balls_drop() -> None:
    # R. M. French, Experimental Techniques, My Favorite Experiment 4: C_D = 0.445 in standard air
    # and v = v_t sqrt(1 - exp(-2 g h / v_t^2))
    fluid = Fluid(1.225, 1.789e-5)
    v_t = math.sqrt(0.0027 * 9.81 / (0.5 * 1.225 * 0.445 * math.pi * 0.02**2))
    for height in (0.5, 1.0, 2.0):
        published = v_t * math.sqrt(-math.expm1(-2.0 * 9.81 * height / v_t**2))
        found = flown(BALL, fluid, normal=0.0, rise=-height)
        assert -found.normal == pytest.approx(published, rel=0.01)
        # without air it arrives markedly faster
        assert math.sqrt(2.0 * 9.81 * height) > 1.005 * published


def test_a_grain_shot_downwards_slows() -> None:
    # C. Bell, the library fluids, test of integrate_drag_sphere with another drag curve (Barati):
    # 1 mm, 2200 kg/m3, 30 m/s in air; after 0.5 s 9.686 m/s and 7.829 m
    fluid, grain = Fluid(1.2, 1.78e-5), sphere(1e-3, 2200.0)

    def late(fall: float) -> float:
        return float(flown(grain, fluid, normal=-30.0, rise=-fall).time) - 0.5

    fall = brentq(late, 5.0, 10.0)
    assert fall == pytest.approx(7.829, rel=0.01)
    assert -flown(grain, fluid, normal=-30.0, rise=-fall).normal == pytest.approx(9.686, rel=0.01)


def test_without_a_fluid_it_is_galileis_fall() -> None:
    nothing = Fluid(1e-12, 1e-12)
    heights = np.array([0.1, 0.5, 2.0])
    found = flown(BALL, nothing, normal=0.0, rise=-heights)
    assert -found.normal == pytest.approx(np.sqrt(2.0 * 9.81 * heights), rel=1e-9)
    assert found.time == pytest.approx(np.sqrt(2.0 * heights / 9.81), rel=1e-6)
    thrown = flown(ROD, nothing, normal=3.0, tangential=1.0, rise=0.2, angle=1.0)
    assert thrown.normal == pytest.approx(math.sqrt(9.0 - 2.0 * 9.81 * 0.2), rel=1e-9)
    assert thrown.tangential == pytest.approx(1.0, rel=1e-9)


@pytest.mark.parametrize(("striker", "angle"), [(BALL, math.pi / 2), (ROD, 0.7)])
def test_there_and_back(striker: Striker, angle: float) -> None:
    down = flown(striker, air(), normal=[-0.5, -4.0], tangential=[0.3, 1.5], rise=-0.4, angle=angle)
    back = flown(
        striker, air(), normal=down.normal, tangential=down.tangential, rise=0.4, angle=angle
    )
    assert back.normal == pytest.approx([-0.5, -4.0], rel=1e-6)
    assert back.tangential == pytest.approx([0.3, 1.5], rel=1e-6)
    assert back.time == pytest.approx(-down.time, rel=1e-6)


def test_energy_goes_into_the_fluid_only() -> None:
    up = flown(BALL, air(), normal=3.0, rise=[0.1, 0.2, 0.3])
    mechanical = 0.5 * up.normal**2 + 9.81 * np.array([0.1, 0.2, 0.3])
    assert np.all(np.diff(mechanical) < 0.0)
    assert mechanical[0] < 4.5


def test_a_rod_is_barely_held_back_and_a_peak_is_not_passed() -> None:
    # drag along a steel rod is below 1e-3 of its weight here
    fall = flown(ROD, air(), normal=0.0, rise=-0.5)
    assert -fall.normal == pytest.approx(math.sqrt(2.0 * 9.81 * 0.5), rel=4e-4)
    assert np.isnan(flown(BALL, air(), normal=2.0, rise=0.5).normal)
    # the endless cylinder's plateau, Schlichting's figure 1.4: 1.0 to 1.2 from 1e3 to 2e5
    assert 1.0 < rod_drag_across(1e4, 1e6) * 1.2 / 0.98 < 1.2


def test_a_fluid_moves_along_half_of_what_a_ball_displaces() -> None:
    """Released, a ball in water falls with (m - rho V) g/(m + rho V/2) before drag is felt."""
    ball = sphere(0.02, 2600.0)
    v = -float(flown(ball, Fluid(1000.0, 1e-6), normal=0.0, rise=-2e-6).normal)
    assert v**2 / 4e-6 == pytest.approx(9.81 * 1600.0 / 3100.0, rel=1e-3)


def test_a_short_rod_across_sinks_by_the_drag_of_its_whole_length() -> None:
    """Weight less buoyancy is rho v^2/2 C_D (L + d) d, its round ends included."""
    d, L = 0.01, 0.02
    volume = math.pi * d**2 / 4.0 * L + math.pi / 6.0 * d**3
    rod = Striker(mass=2600.0 * volume, tip_radius=d / 2, length=L, radius=d / 2)
    v = -float(flown(rod, WATER, normal=0.0, rise=-3.0, angle=0.0).normal)
    held = 500.0 * v**2 * rod_drag_across(1000.0 * v * d / 1e-3, (L + d) / d) * (L + d) * d
    assert held == pytest.approx(1600.0 * volume * 9.81, rel=1e-4)


def test_a_speed_that_is_no_number_is_refused() -> None:
    with pytest.raises(InputError, match="not a number"):
        flown(BALL, air(), normal=math.nan, rise=1.0)
