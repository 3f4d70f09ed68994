"""A finite, worn or flattened tip and a friction that is higher at rest, against closed forms."""

import math

import numpy as np
import pytest
from dentscope.core import Material
from dentscope.dynamics import (
    Approach,
    ForceTransform,
    Friction,
    Scene,
    Settings,
    Spot,
    Striker,
    scene_of,
    strike,
)
from dentscope.dynamics.inverse import mobility
from dentscope.models.published.hertz import HERTZ
from dentscope.models.published.jackson_green import JACKSON_GREEN
from made_scenes import IRON, STEEL

ELASTIC = Material(E=200e9, nu=0.3, density=7800.0)
MASS, RADIUS = 0.1, 0.2
TIGHT = Settings(tolerance=1e-10)


def blunt(speed: float, *, edge: float = math.inf, flat: float = 0.0, **others: object) -> Scene:
    """A rod's blunt end: tip radius 0.2 m, upright."""
    return scene_of(
        HERTZ, sphere=ELASTIC, flat=ELASTIC,
        striker=Striker(mass=MASS, tip_radius=RADIUS, length=0.3, radius=0.005,
                        tip_flat_radius=flat),
        approach=Approach(speed), gravity=0.0, force=ForceTransform(edge=edge), **others,
    )  # fmt: skip


def test_edge_that_is_not_reached_changes_nothing() -> None:
    ours, plain = strike(blunt(0.1, edge=0.005)), strike(blunt(0.1))
    np.testing.assert_array_equal(list(ours.observables.values()), list(plain.observables.values()))


def test_beyond_the_edge_the_tip_is_a_flat_punch() -> None:
    """Sneddon 1965: dF/d delta = 2 E' b once the contact fills the end; the energy gives depth."""
    b, speed = 0.002, 4.0
    scene = blunt(speed, edge=b)
    E, energy = scene.pair.E_reduced, 0.5 * MASS * speed**2
    start = b * b / RADIUS
    force = 4.0 / 3.0 * E * math.sqrt(RADIUS) * start**1.5
    left = energy - 0.4 * force * start
    assert left > 0.0
    further = (-force + math.sqrt(force**2 + 4.0 * E * b * left)) / (2.0 * E * b)
    impact = strike(scene, TIGHT)
    assert impact.peak_depth_m == pytest.approx(start + further, rel=1e-7)
    assert impact.peak_force_N == pytest.approx(force + 2.0 * E * b * further, rel=1e-7)


@pytest.mark.parametrize(
    ("tip_strength", "pressure"),
    [(760e6, 760e6), (2e9, 5.69 / math.sqrt(3.0) * 305e6)],
    ids=["the rod yields", "the flat yields"],
)
def test_edge_has_a_plastic_limit(tip_strength: float, pressure: float) -> None:
    """The rod's yield force, or a punch's (5.69/sqrt 3) Sy on the flat, whichever is less."""
    scene = scene_of(
        HERTZ, sphere=STEEL.with_(Sy=tip_strength), flat=IRON,
        striker=Striker(mass=MASS, tip_radius=RADIUS, length=0.3, radius=0.005),
        approach=Approach(10.0), gravity=0.0, force=ForceTransform(edge=0.002),
    )  # fmt: skip
    limit = pressure * math.pi * 0.002**2
    assert strike(scene).peak_force_N == pytest.approx(limit, rel=1e-9)


def test_flat_on_the_tip_makes_a_linear_spring() -> None:
    """F = 2 E' b delta while the flat alone carries: half a period of contact, e = 1."""
    b = 0.002
    scene = blunt(1e-3, flat=b)
    impact = strike(scene, TIGHT)
    stiffness = 2.0 * scene.pair.E_reduced * b
    half = math.pi * math.sqrt(MASS / stiffness)
    assert impact.contact_time_s == pytest.approx(half, rel=1e-4)
    assert impact.restitution == pytest.approx(1.0, abs=1e-8)
    assert impact.peak_force_N == pytest.approx(1e-3 * math.sqrt(MASS * stiffness), rel=1e-4)


def test_flattened_tip_of_one_trial_is_the_tip_of_the_next() -> None:
    """Three blows on fresh places: the flat carries v sqrt(1 + (1 - e^2) ...) as one blow does."""
    ball = Striker(mass=0.03, tip_radius=0.01)
    scene = scene_of(
        JACKSON_GREEN, sphere=IRON, flat=STEEL, striker=ball, approach=Approach(1.0), gravity=0.0
    )
    spot, kept, given = Spot(), [], 0.0
    for _ in range(3):
        impact = strike(scene.with_(spot=spot))
        kept.append(impact.residual_sphere_m)
        # elsewhere on the flat: only what the tip keeps is carried on
        spot = Spot(impact.spot.tip_peak, impact.spot.tip_flat)
        given += 1.0 - impact.restitution**2
    assert kept[0] < kept[1] < kept[2]
    # What the metal took up in all is what one blow of the same energy takes up: v^2 = the sum of
    # all losses and the last rebound.
    last = impact.restitution
    single = strike(scene.with_(approach=Approach(math.sqrt(given + last**2))))
    assert kept[2] == pytest.approx(single.residual_sphere_m, rel=1e-6)


@pytest.mark.parametrize("angle", [45.0, 70.0])
def test_friction_at_rest_holds_what_sliding_friction_could_not(angle: float) -> None:
    """A tip that lands without sliding stays if mu_static exceeds c s/(I/m + s^2) (audit)."""
    rod = Striker(mass=0.4607, tip_radius=0.0088, length=0.3048, radius=0.0088)
    critical = mobility(rod, math.radians(angle)).stick_friction
    assert 0.2 < critical < 0.62

    def impact(friction: Friction) -> object:
        approach = Approach(0.5, math.radians(angle))
        return strike(
            scene_of(HERTZ, sphere=ELASTIC, flat=ELASTIC, striker=rod, friction=friction,
                     gravity=0.0, approach=approach)
        )  # fmt: skip

    held = impact(Friction(0.1, mu_static=1.1 * critical, speed=1e-4))
    assert held.stuck
    assert held.friction_impulse_ratio == pytest.approx(critical, rel=0.01)
    assert held.sliding_length_m == pytest.approx(0.0, abs=1e-12)
    # A little less, and it slides off with the lower coefficient.
    slid = impact(Friction(0.1, mu_static=0.9 * critical, speed=1e-4))
    assert slid.friction_impulse_ratio == pytest.approx(0.1, rel=0.05)
    assert slid.sliding_length_m > 0.0
