"""Random blows by what must hold of every one, and every mechanism on every form of target."""

import math
import os
from dataclasses import replace

import numpy as np
import pytest
from dentscope.core import Material, Pair
from dentscope.dynamics import Modes, Scene, Settings, Striker, rod_modes, strike, traced
from dentscope.dynamics.files.second import SecondSphere
from dentscope.dynamics.mechanisms import MECHANISMS, Surroundings
from dentscope.dynamics.mechanisms.asked import Asked
from dentscope.dynamics.scene import Approach, ForceTransform, Friction, Support, scene_of
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


DRAWS = int(os.environ.get("DRAWS", "40"))
ALONE = ("edge_radius_over_radius", "support_mass_kg")
TARGETS = ("flat", "plate", "free sphere", "held sphere", "seat")


def blow(rng, target, shape, way):
    """A scene and its surroundings; `infinite` is a held sphere of a million metres."""
    R = 10.0 ** rng.uniform(-3.0, -2.0)
    one, two = (
        Material(10.0 ** rng.uniform(10.8, 11.4), 0.3, 10.0**s, density=7800.0)
        for s in rng.uniform(8.2, 9.5, 2)
    )
    length = 30.0 * R if shape == "rod" else 0.0
    mass = 7800.0 * math.pi * R**3 * (4.0 / 3.0 + length / R)
    ball = Striker(mass, R, length=length, radius=R)
    angle = rng.uniform(0.5, 1.3) if (shape, way) == ("rod", "oblique") else 0.5 * math.pi
    speed = 10.0 ** rng.uniform(-0.5, 1.0)
    along = rng.uniform(-2.0, 2.0) * speed if (shape, way) == ("ball", "oblique") else 0.0
    spin = rng.uniform(-1.0, 1.0) * speed / (R + length) if way == "spinning" else 0.0
    mu = 0.0 if way == "upright" else rng.uniform(0.0, 0.4)
    scene = Scene(
        LAWS["fitted"], Pair(one, two, R), ball, Approach(speed, angle, along, spin),
        friction=Friction(mu),
    )  # fmt: skip
    around = {
        "fluid": "oil", "viscosity": 1e-3, "density": 900.0, "roughness": 1e-7, "melting": 1800.0,
        "heat_capacity": 470.0, "temperature": 500.0, "layer_thickness": 0.02 * R,
        "from_height": True, "thickness": 10.0 * R if target == "plate" else math.nan,
    }  # fmt: skip
    other = {"seat": -3.0 * R, "infinite": 1e6}.get(target, R * 10.0 ** rng.uniform(-0.7, 0.7))
    if target in ("flat", "plate"):
        return scene, Surroundings(**around)
    free = 7800.0 * 4.0 / 3.0 * math.pi * other**3 if target == "free sphere" else math.inf
    second = SecondSphere(other, free)
    return second.facing(scene), Surroundings(**around, struck=second)


def drawn_blow(rng):
    """A scene with its surroundings, and of what kind it is."""
    target, shape = str(rng.choice(TARGETS)), str(rng.choice(["ball", "rod"]))
    shape = shape if target in ("flat", "plate") else "ball"
    kind = target, shape, str(rng.choice(["upright", "oblique", "spinning"]))
    state = rng.bit_generator.state
    return *blow(rng, *kind), kind, state


def read(mechanism, values, scene, around):
    return read_all((mechanism,), {mechanism.name: values}, scene, around)


def read_all(mechanisms, constants, scene, around):
    asked = Asked(mechanisms, constants, around)
    asked = asked.without(*asked.idle([scene]))
    return asked.read(scene, strike(asked.attached([scene])[0])) if asked else None


def ended_well(found, scene, shape, constants):
    """Whether it ended; then energy and momentum balance, and the rebound is e v."""
    what = shape, constants
    if not found.outcome.completed:
        # a rod that spins may rock for longer than it is followed; then it has no numbers
        assert (shape, math.isnan(found.restitution)) == ("rod", True), what
        return False
    assert abs(found.energy_residual) < 1e-4, what
    assert max(found.momentum_residual, found.angular_residual) < 1e-5, what
    lost = constants.get("impact-speed-loss", {"speed_loss": 0.0})["speed_loss"]
    if shape == "ball" and "tilt" not in constants:
        back = found.restitution * scene.approach.speed * (1.0 - lost)
        assert found.rebound_speed_m_s == pytest.approx(back, rel=1e-6, abs=1e-9), what
    return True


def drawn(mechanism, rng, scene, around):
    return {p.name: float(p.value(rng.uniform())) for p in mechanism.ranges([(scene, around)])}


def nearly_neutral(mechanism, values):
    size = mechanism.parameters[0]
    none = 1e6 * size.high if math.isinf(size.neutral) else size.neutral + 1e-7 * size.low
    # an edge and a mass act without what they stand beside
    alone = {p.name: p.neutral for p in mechanism.parameters if p.name in ALONE}
    return {**values, **alone, size.name: none}


@pytest.mark.parametrize("seed", range(DRAWS))
def test_what_holds_of_every_blow(seed):
    rng = np.random.default_rng(seed)
    mechanism = MECHANISMS[seed % len(MECHANISMS)]
    scene, around, (target, shape, way), state = drawn_blow(rng)
    values = drawn(mechanism, rng, scene, around)
    found = read(mechanism, values, scene, around)
    if found is None or not ended_well(found, scene, shape, {mechanism.name: values}):
        return
    what = (mechanism.name, target, shape, way, values)
    # no effect
    none = read(mechanism, nearly_neutral(mechanism, values), scene, around)
    plain = strike(scene)
    if none is not None and plain.outcome.completed and none.outcome.completed:
        for name in ("restitution", "peak_force_N", "peak_depth_m"):
            near = pytest.approx(getattr(plain, name), rel=5e-3)
            assert getattr(none, name) == near, (name, *what)
    # a held sphere without end is a flat
    if target == "held sphere":
        rng.bit_generator.state = state
        flat, beside = blow(rng, "flat", shape, way)
        rng.bit_generator.state = state
        endless, there = blow(rng, "infinite", shape, way)
        one = read(mechanism, values, flat, beside)
        two = read(mechanism, values, endless, there)
        if one is not None and two is not None:
            assert two.restitution == pytest.approx(one.restitution, rel=1e-5), what


@pytest.mark.parametrize("seed", range(DRAWS))
def test_what_holds_of_three_mechanisms_together(seed):
    rng = np.random.default_rng(100_000 + seed)
    some = tuple(MECHANISMS[k] for k in sorted(rng.choice(len(MECHANISMS), 3, replace=False)))
    scene, around, (_, shape, _), _ = drawn_blow(rng)
    constants = {m.name: drawn(m, rng, scene, around) for m in some}
    found = read_all(some, constants, scene, around)
    if found is not None:
        ended_well(found, scene, shape, constants)
