"""Random impacts by their balances: what must hold of every one, whatever strikes whatever."""

import math
from dataclasses import replace

import numpy as np
from dentscope.core import Material
from dentscope.dynamics import (
    Approach,
    ForceTransform,
    Friction,
    Modes,
    Settings,
    Striker,
    Support,
    rod_modes,
    scene_of,
    traced,
)
from dentscope.dynamics.support import half_space_radiation
from dentscope.models import LAWS

COUNT = 120  # 20,000 for a whole night
ACCURACY = Settings(tolerance=1e-8)
BALANCE = 1e-6
HIDDEN = 1e-9  # depth without force [m] that counts
DEEPEST = 0.3  # depth over tip radius beyond which no law reaches: then half the speed


def even(rng, low, high):
    return float(np.exp(rng.uniform(math.log(low), math.log(high))))


def random_scene(rng):
    """Balls and rods of 10 to 600 mm on rigid, sprung and radiating flats, 0.05 to 20 m/s."""
    is_rod = rng.random() < 0.7
    length = even(rng, 0.01, 0.6)
    radius = length * even(rng, 1 / 60, 1 / 8) if is_rod else 0.5 * length
    sphere = Material(E=float(rng.uniform(60e9, 210e9)), nu=0.3, density=7800.0,
                      Sy=even(rng, 3e8, 2e9))  # fmt: skip
    flat = Material(E=float(rng.uniform(60e9, 210e9)), nu=0.3, density=7800.0,
                    Sy=even(rng, 1e8, 2e9))  # fmt: skip
    volume = math.pi * radius**2 * length if is_rod else 4.0 / 3.0 * math.pi * radius**3
    striker = Striker(mass=7800.0 * volume, tip_radius=radius, radius=radius,
                      length=length if is_rod else 0.0)  # fmt: skip
    angle = math.radians(rng.uniform(10.0, 90.0)) if is_rod else math.pi / 2.0
    speed = even(rng, 0.05, 20.0)
    along = 0.0 if is_rod else speed / math.tan(math.radians(rng.uniform(10.0, 90.0)))
    scene = scene_of(
        LAWS["fitted"], sphere=sphere, flat=flat, striker=striker,
        approach=Approach(speed, angle, tangential=along),
        friction=Friction(float(rng.choice([0.0, rng.uniform(0.0, 0.5)]))),
    )  # fmt: skip
    if is_rod:
        scene = scene.with_(modes=random_modes(rng, striker, sphere))
    kind = rng.integers(3)
    if kind == 1:
        mass, stiffness = striker.mass * even(rng, 1.0, 100.0), even(rng, 1e6, 1e9)
        scene = scene.with_(support=Support(mass, stiffness, 0.04 * math.sqrt(stiffness * mass)))
    if kind == 2:
        scene = scene.with_(force=ForceTransform(radiation=half_space_radiation(flat)))
    return scene


def random_modes(rng, striker, material):
    """None, the axial ones of a rod, or all."""
    kind, count = rng.integers(3), int(rng.integers(2, 16))
    if kind == 0:
        return Modes()
    found = rod_modes(
        striker.length, striker.radius, material, mass=striker.mass, count=count,
        loss_factor=float(rng.choice([0.0, 0.01])),
    )  # fmt: skip
    keep = [i for i, a in enumerate(found.axial) if a != 0.0]
    still = (0.0,) * len(keep)
    axial = Modes(tuple(found.frequencies[i] for i in keep), tuple(found.axial[i] for i in keep),
                  still, still, found.loss_factor)  # fmt: skip
    return found if kind == 2 else axial


def struck(rng):
    """A random impact and its history, at half the speed until a law reaches."""
    scene = random_scene(rng)
    while (trace := traced(scene, ACCURACY, points=60)).impact.peak_depth_m > (
        DEEPEST * scene.striker.tip_radius
    ):
        a = scene.approach
        slower = replace(a, speed=0.5 * a.speed, tangential=0.5 * a.tangential)
        scene = scene.with_(approach=slower)
    return scene, trace


def broken(scene, trace):
    """What an impact breaks, in words.

    A push turns a leaning rod, and the wall of its crater throws a grazing ball upwards: either may
    leave faster than it came though energy is lost (Stronge, Impact Mechanics, 2000, chapter 3).
    """
    hit = trace.impact
    came = hit.kinetic_before_J + hit.gravity_work_J
    kept = hit.kinetic_after_J + hit.modal_energy_J + hit.support_energy_J
    straight = hit.contacts == 1 and (
        scene.striker.length == 0.0 or scene.approach.angle > 0.5 * math.pi - 1e-9
    )
    brought = 0.5 * scene.striker.mass * scene.approach.speed**2
    gap = trace.column("clearance_m")[trace.column("normal_force_N") == 0.0]
    told = {
        "unfinished": not hit.outcome.completed,
        "energy": abs(hit.energy_residual) > BALANCE,
        "momentum": max(hit.momentum_residual, hit.angular_residual) > BALANCE,
        "ends below the surface": hit.clearance_m < -HIDDEN,
        "ends moving into it": hit.clearance_rate_m_s < 0.0 or hit.restitution < 0.0,
        "a contact returns more than it took": hit.energetic_restitution > 1.0 + BALANCE,
        "gains energy": kept - came > BALANCE * hit.kinetic_before_J,
        "restitution above 1": straight
        and hit.restitution**2 - 1.0 - hit.gravity_work_J / brought > BALANCE,
        "depth without force": scene.force.radiation == 0.0 and gap.min(initial=0.0) < -HIDDEN,
    }
    return [what for what, wrong in told.items() if wrong]


def test_random_impacts_balance_and_end_above_the_surface() -> None:
    several = 0
    for number in range(COUNT):
        scene, trace = struck(np.random.default_rng([7, number]))
        assert not broken(scene, trace), number
        several += trace.impact.contacts > 1
    assert several > 5
