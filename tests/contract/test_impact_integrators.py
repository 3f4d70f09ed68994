"""The compiled integrator against the library's, and what every scene must keep."""

import math

import numpy as np
import pytest
from dentscope.dynamics import (
    Approach,
    Friction,
    Scene,
    Settings,
    Striker,
    Support,
    arrays_of,
    rod_modes,
    strike,
    strike_many,
    strike_rows,
)
from dentscope.dynamics.stepping import layout as c
from dentscope.models.published.ghaednia import GHAEDNIA
from dentscope.models.published.hertz import HERTZ
from dentscope.models.published.jackson_green import JACKSON_GREEN
from dentscope.models.published.kogut_etsion import KOGUT_ETSION
from dentscope.models.published.stronge import STRONGE
from dentscope.studies.oracle import oracle_impact
from made_scenes import ROD, STEEL, on_iron

LAWS = (HERTZ, JACKSON_GREEN, GHAEDNIA)
BALANCES = ("energy_residual", "momentum_residual", "angular_residual")


def random_scene(rng: np.random.Generator, number: int) -> Scene:
    """A rod or ball with any angle, spin, friction; one in five on a spring."""
    is_rod = rng.random() < 0.7
    R = 10.0 ** rng.uniform(-3.0, -1.5)
    striker = Striker(
        mass=10.0 ** rng.uniform(-2.0, 0.0), tip_radius=R, radius=R,
        length=rng.uniform(10.0, 40.0) * R if is_rod else 0.0,
    )  # fmt: skip
    approach = Approach(
        10.0 ** rng.uniform(-1.0, 0.7),
        rng.uniform(0.2, math.pi / 2.0) if is_rod else math.pi / 2.0,
        tangential=float(rng.choice([0.0, rng.normal()])),
        spin=float(rng.choice([0.0, 20.0 * rng.normal()])),
    )
    sprung = Support(mass=1.0, stiffness=1e8)
    return on_iron(
        LAWS[number % 3], striker=striker, approach=approach,
        friction=Friction(float(rng.choice([0.0, 0.1, 0.3, 0.8]))),
        support=sprung if rng.random() < 0.2 else Support(),
    )  # fmt: skip


def scales(scene: Scene, peak: float) -> dict[str, float]:
    """What each observable is small against: errors count relative to the larger of the two."""
    v, m = scene.approach.speed, scene.striker.mass
    v_t = max(v, abs(scene.approach.tangential))
    arm = math.sqrt(scene.striker.inertia / m)
    ratio = dict.fromkeys(
        ("restitution", "kinetic_restitution", "energetic_restitution", "tangential_restitution",
         "friction_impulse_ratio"), 1.0,
    )  # fmt: skip
    speed = dict.fromkeys(
        ("rebound_speed_m_s", "tangential_rebound_m_s", "tip_rebound_m_s", "clearance_rate_m_s"),
        # A tip's velocity is what is left of the centre's and of the spin's at the tip's distance.
        max(v_t, abs(scene.approach.spin) * 0.5 * scene.striker.length),
    )
    energy = {name: 0.5 * m * v_t**2 for name in c.OBSERVABLES if name.endswith("_J")}
    impulse = dict.fromkeys(("normal_impulse_Ns", "tangential_impulse_Ns"), m * v_t)
    length = dict.fromkeys(
        ("sliding_length_m", "scar_travel_m", "residual_sphere_m", "residual_flat_m",
         "scar_length_m", "scar_width_m", "scar_excess_m", "clearance_m"), peak,
    )  # fmt: skip
    return {**ratio, **speed, **energy, **impulse, **length, "rebound_spin_rad_s": v / arm}


def assert_agree(scene: Scene, tolerance: float, *, step: float = 1e-11) -> None:
    ours, theirs = strike(scene, Settings(tolerance=step)), oracle_impact(scene)
    assert ours.outcome.completed
    assert theirs.outcome.completed
    assert ours.contacts == theirs.contacts
    small = scales(scene, ours.peak_depth_m)
    for name, value in ours.observables.items():
        other = theirs.observables[name]
        if name in BALANCES or (math.isnan(value) and math.isnan(other)):
            continue
        # A tangential restitution near a vanishing approach velocity has no scale of its own.
        bound = tolerance * max(abs(value), abs(other), small.get(name, 0.0))
        assert abs(value - other) <= bound, (name, value, other, scene)
    assert abs(ours.energy_residual) < 1e-6
    assert abs(theirs.energy_residual) < 1e-6
    assert ours.momentum_residual < 1e-9


def test_compiled_and_library_integrator_agree() -> None:
    """1e-8 in every observable, events included; tools/benchmarks/bench_impact.py runs 1,000."""
    rng = np.random.default_rng(7)
    for number in range(40):
        scene = random_scene(rng, number)
        # The thesis's weights start with an infinite slope: that law gets a digit less.
        assert_agree(scene, 1e-7 if scene.law is GHAEDNIA else 1e-8)


def test_integrators_agree_on_contacts_that_give_way_sideways() -> None:
    rng = np.random.default_rng(5)
    for number in range(15):
        scene = random_scene(rng, number)
        law = (HERTZ, JACKSON_GREEN, KOGUT_ETSION)[number % 3]
        yielding = Friction(scene.friction.mu or 0.2, stiffness=float(rng.uniform(0.4, 1.4)))
        assert_agree(scene.with_(law=law, friction=yielding), 1e-8)


@pytest.mark.parametrize("tolerance", [1e-10, 1e-12, 3e-13])
def test_a_second_touch_may_turn_near_the_end_of_its_bed(tolerance: float) -> None:
    """A ball on a spring comes back before it leaves; there the depth cannot carry the motion."""
    scene = on_iron(
        STRONGE, striker=Striker(mass=0.5396, tip_radius=0.02484), approach=Approach(0.1255),
        friction=Friction(0.1), support=Support(1.0, 1e8),
    )  # fmt: skip
    assert_agree(scene, 1e-8, step=tolerance)


def test_integrators_agree_on_a_vibrating_rod_with_several_contacts() -> None:
    modes = rod_modes(ROD.length, ROD.radius, STEEL, mass=ROD.mass, count=3)
    for angle in (45.0, 70.0):
        leans = Approach(1.0, math.radians(angle))
        scene = on_iron(HERTZ, approach=leans, friction=Friction(0.15), modes=modes)
        assert_agree(scene, 2e-7, step=1e-10)
        # The flight before the last contact lasts half a look: whether the parting is a hair
        # inside or outside the flat must not decide about it.
        touching = [
            strike(scene, Settings(tolerance=10.0**-digits)).observables["touching_time_s"]
            for digits in range(9, 14)
        ]
        np.testing.assert_allclose(touching, touching[-1], rtol=1e-7)


def test_batch_gives_what_single_calls_give() -> None:
    rng = np.random.default_rng(3)
    scenes = [random_scene(rng, n) for n in range(6)]
    for a, b in zip(strike_many(scenes), map(strike, scenes), strict=True):
        np.testing.assert_array_equal([*a.observables.values()], [*b.observables.values()])
    scene = scenes[1]
    body = np.tile(arrays_of(scene).body, (4, 1))
    body[:, c.V_Y] *= [0.5, 1.0, 2.0, 3.0]
    rows = strike_rows(scene, body)
    alone = np.array([strike_rows(scene, body[i : i + 1])[0] for i in range(4)])
    np.testing.assert_array_equal(rows, alone)
    np.testing.assert_array_equal(
        rows[1, : len(c.OBSERVABLES)], list(strike(scene).observables.values())
    )
