"""Two spheres: what the equivalent sphere on a flat must answer, and how far it holds."""

import math

import numpy as np
import pytest
from dentscope.core import InputError, InputErrors, Material, Pair
from dentscope.core.flow import Flow, swift
from dentscope.dynamics import Approach, Friction, Scene, Striker, impacts, strike
from dentscope.dynamics.files.second import SecondSphere, radius_error
from dentscope.dynamics.report.band import last_blow
from dentscope.dynamics.report.beside import error_of
from dentscope.models import LAWS
from dentscope.models.turned import similar
from made_blows import ball_setup
from made_files import changed

STEEL = Material(E=205e9, nu=0.3, Sy=600e6, density=7800.0)
HARD = Material(E=205e9, nu=0.3, density=7800.0)
BALL = Striker(mass=4.084e-3, tip_radius=5e-3)

METAL = {"E_Pa": 2.05e11, "nu": 0.3, "Sy_Pa": 6.0e8, "density_kg_m3": 7800}
TWIN = {**METAL, "shape": "sphere", "radius_m": 0.005, "mass_kg": 0.004084070449666731}


def met(target=TWIN, *, Sy=6.0e8, **given):
    """A ball of 5 mm that meets its twin, or another body, by the fitted law."""
    ball = changed(METAL, {"Sy_Pa": Sy, "mass_kg": TWIN["mass_kg"]})
    return ball_setup(target=target, ball=ball, **{"law": "fitted", **given})


def scene(flat=STEEL, *, speed=1.0, law="fitted", angle=0.5 * math.pi, mu=0.0, spin=0.0):
    pair = Pair(flat, flat, BALL.tip_radius)
    approach = Approach(speed * math.sin(angle), tangential=speed * math.cos(angle), spin=spin)
    return Scene(LAWS[law], pair, BALL, approach, gravity=0.0, friction=Friction(mu))


@pytest.mark.parametrize(
    ("radius", "mass", "modulus", "speed"),
    [
        (5e-3, 4.084e-3, 205e9, 1.0),  # alike
        (5e-3, None, 205e9, 1.0),  # alike, held
        (1e-3, 3e-5, 205e9, 0.5),  # struck: a bead
        (0.1, 32.0, 205e9, 3.0),  # a cannon ball
        (0.02, None, 3e9, 2.0),  # a knob of plastic
        (2e-3, 1e-2, 70e9, 0.1),  # heavier than it is large
        (-6e-3, None, 205e9, 1.0),  # seats: tight, wide, soft and free
        (-0.05, None, 205e9, 1.0),
        (-0.015, 0.2, 3e9, 0.3),
    ],
)
def test_elastic_spheres_from_a_file_are_hertzs(radius, mass, modulus, speed):
    """T, delta = (15 m v^2/(16 E' R^(1/2)))^(2/5), F = (4/3) E' R^(1/2) delta^(3/2), by hand."""
    flat = {"radius_m": radius, "mass_kg": mass, "E_Pa": modulus, "Sy_Pa": None}
    found = strike(met(changed(TWIN, flat), Sy=None, speed=speed).scene(LAWS["hertz"]))
    R = 1.0 / (1.0 / 5e-3 + 1.0 / radius)
    m = 1.0 / (1.0 / 0.004084070449666731 + (1.0 / mass if mass else 0.0))
    E = 1.0 / ((1.0 - 0.09) / 205e9 + (1.0 - 0.09) / modulus)
    depth = (15.0 * m * speed**2 / (16.0 * E * math.sqrt(R))) ** 0.4
    assert found.contact_time_s == pytest.approx(2.9432 * depth / speed, rel=1e-3)
    assert found.peak_depth_m == pytest.approx(depth, rel=1e-4)
    assert found.peak_force_N == pytest.approx(4.0 / 3.0 * E * math.sqrt(R) * depth**1.5, rel=1e-4)
    assert found.restitution == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("mass", [1e-3, 4.084e-3, math.inf])
def test_momentum_and_energy_are_kept(mass):
    second = SecondSphere(3e-3, mass)
    for e in (0.0, 0.4, 1.0):
        own, other = second.parted(BALL.mass, 2.0, e)
        assert own - other == pytest.approx(-2.0 * e, abs=1e-12)
        if math.isinf(mass):
            assert other == 0.0
            continue
        assert BALL.mass * own + mass * other == pytest.approx(BALL.mass * 2.0, rel=1e-12)
        before, after = BALL.mass * 4.0, BALL.mass * own**2 + mass * other**2
        lost = second.reduced(BALL.mass) * 4.0 * (1.0 - e * e)
        assert before - after == pytest.approx(lost, rel=1e-12, abs=1e-15)


def test_a_sweep_has_the_strikers_own_mass_and_rebound():
    """Of two equal spheres the striker goes on with (1 - e) v/2, and takes half of what slides."""
    sweep = {"impact_speed_m_s": [0.5, 2.0], "approach_tangential_m_s": [0.3]}
    two = met(sweep=sweep, friction={"coefficient": 0.1})
    found = two.swept(LAWS["fitted"])
    taken = (0.3 - found["tangential_rebound_m_s"]) * found["mass_kg"]
    assert taken == pytest.approx(np.abs(found["tangential_impulse_Ns"]), rel=1e-6)
    assert found["mass_kg"] == pytest.approx(0.004084070449666731)
    on = 0.5 * (1.0 - found["restitution"]) * found["impact_speed_m_s"]
    assert found["rebound_speed_m_s"] == pytest.approx(-on)


def test_spheres_that_slide_on_each_other_keep_the_impulse_of_friction():
    """Sliding throughout takes mu (1 + e) v of the speed of one along the other."""
    two = SecondSphere(BALL.tip_radius, BALL.mass).facing(
        scene(HARD, law="hertz", angle=math.radians(20.0), speed=2.0, mu=0.05)
    )
    found = strike(two)
    v = 2.0 * math.sin(math.radians(20.0))
    lost = 2.0 * math.cos(math.radians(20.0)) - found.tangential_rebound_m_s
    assert lost == pytest.approx(0.05 * 2.0 * v, rel=1e-3)


def test_two_equal_spheres_are_each_others_mirror():
    """Each is a sphere on a rigid flat at half the depth: finite elements of that, level quick."""
    body = Material(E=205e9, nu=0.3, Sy=205e9 / 341.0)
    deep = np.array([1e-3, 3e-3, 0.01, 0.02, 0.04, 0.08, 0.1])
    solved = np.array([0.001, 0.0, 0.007, 0.027, 0.071, 0.178, 0.261])
    off = radius_error(Pair(body, body, 2.5e-3), deep * 2.5e-3, 2.0)
    assert off == pytest.approx(solved, abs=0.015)
    assert radius_error(Pair(HARD, HARD, 2.5e-3), 1e-9, 2.0) == pytest.approx(0.0, abs=1e-4)
    assert radius_error(Pair(body, body, 2.5e-3), 0.0, 2.0) == pytest.approx(0.0, abs=1e-4)


@pytest.mark.parametrize(
    ("strengths", "radii", "forces"),
    [  # of the smaller over the larger; larger over smaller; F/(E' R^2) at 0.01, 0.02, 0.05 R
        (0.3, 1.0, (8.300e-4, 1.9197e-3, 5.3658e-3)),
        (0.3, 2.0, (8.287e-4, 1.9041e-3, 5.2213e-3)),
        (0.8, 2.0, (8.111e-4, 1.8657e-3, 5.1716e-3)),
        (1.0, 1.0, (7.763e-4, 1.7889e-3, 5.1196e-3)),
        (1.0, 2.0, (7.770e-4, 1.7908e-3, 5.0454e-3)),
        (1.25, 2.0, (8.149e-4, 1.8948e-3, 5.4426e-3)),
        (3.3, 2.0, (8.353e-4, 1.9494e-3, 5.5560e-3)),
        (3.3, 1.0, (8.312e-4, 1.9258e-3, 5.4212e-3)),
    ],
)
def test_two_spheres_carry_what_their_finite_elements_do(strengths, radii, forces):
    """Of E/Sy 300, level quick, good to 0.4 %; from either side."""
    weak = Material(E=200e9, nu=0.3, Sy=200e9 / 300.0)
    small, large = (
        weak.with_(Sy=weak.Sy * max(x, 1.0)) for x in (strengths, 1.0 / strengths)
    )  # fmt: skip
    R = 1e-3 / (1.0 + 1.0 / radii)
    pair, depth = Pair(small, large, R), R * np.array([0.01, 0.02, 0.05])
    here, there = SecondSphere(radii * 1e-3), SecondSphere(1e-3)
    law = here.faced(LAWS["fitted"], pair)
    found = law.loading(pair, depth) / (pair.E_reduced * R * R)
    off = np.abs(found / np.array(forces) - 1.0)
    known = np.hypot(
        error_of(law, pair, depth).force, here.departure(law, pair, depth)
    )  # fmt: skip
    assert (off < 2.0 * known + 0.004).all()
    assert off.max() < (0.011 if strengths <= 1.0 else 0.05)
    turned = there.faced(LAWS["fitted"], pair.turned).loading(pair.turned, depth)
    assert turned == pytest.approx(law.loading(pair, depth), rel=1e-12)


def test_a_law_at_another_radius_keeps_small_contacts_work_and_strains():
    """First yield, energy and a hardening metal's strains go over; published laws know R alone."""
    curve = swift(Sy=3e8, K=9e8, n=0.2)
    soft = Material(E=200e9, nu=0.3, Sy=curve.strength, flow=Flow(curve=curve))
    hard = Material(E=200e9, nu=0.3, Sy=2e9)
    R = 0.5e-3
    for name, metal in (("fitted", STEEL), ("hardening", soft)):
        plain, pair = LAWS[name], Pair(metal, hard, R)
        law = similar(plain, 2.0)
        small = np.array([1e-5, 1e-4, 1e-3]) * R
        assert law.loading(pair, small) == pytest.approx(plain.loading(pair, small), rel=0.03)
        peak = 0.03 * R
        assert float(law.loading(pair, peak) / plain.loading(pair, peak)) > 1.03
        assert law.unloading(pair, peak, peak) == pytest.approx(law.loading(pair, peak), rel=1e-9)
        kept = sum(law.residual(pair, peak))
        assert law.unloading(pair, 0.999 * kept, peak) == 0.0 < kept < peak
    for other in ("jackson-green", "hertz"):
        assert similar(LAWS[other], 2.0) is LAWS[other]


def test_two_balls_lose_more_than_one_on_a_flat():
    """Both by finite elements (quick): 0.427 and 0.470 at 10 m/s, between their unloadings."""
    for speed, low, high in ((1.0, 0.08, 0.12), (10.0, 0.075, 0.115)):
        two, one = (
            strike(met(x, speed=speed).scene(LAWS["fitted"])).restitution for x in (TWIN, METAL)
        )
        assert low < 1.0 - two / one < high


def test_equal_spheres_keep_equal_dents_and_unequal_ones_what_finite_elements_have():
    """The smaller's part at 0.02 and 0.05 R with R_2 = 2 R_1: 0.524 and 0.616 (E/300)."""
    for speed in (1.0, 10.0):
        found = last_blow(met(speed=speed), LAWS["fitted"])
        assert found.residual_flat_m == pytest.approx(found.residual_sphere_m, rel=1e-9) != 0.0
    metal = Material(E=200e9, nu=0.3, Sy=200e9 / 300.0)
    R = 1e-3 / 1.5
    pair = Pair(metal, metal, R)
    law = SecondSphere(2e-3).faced(LAWS["fitted"], pair)
    found = law.share(pair, R * np.array([0.02, 0.05]))
    assert found == pytest.approx([0.524, 0.616], abs=0.01)


def test_below_first_yield_there_is_no_scar():
    """A smooth law leaves some 1e-16 m; by steps, and by work alone."""
    hard = Material(E=205e9, nu=0.3, Sy=3e9, density=7800.0)
    for angle in (0.5 * math.pi, 1.0):
        found = strike(scene(hard, speed=0.02, angle=angle, mu=0.1))
        assert 0.0 < found.residual_flat_m < 1e-6 * found.peak_depth_m
        assert found.scar_length_m == found.scar_width_m == 0.0
    table = impacts(scene(hard), speeds=np.array([0.02, 2.0]))
    assert table["scar_width_m"][0] == 0.0 < table["scar_width_m"][1]


def test_rough_spheres_that_slide_are_the_same_from_either_side():
    """Asperities stay flat in either body, and the smaller one takes its dent along."""
    rough = {"roughness": {"roughness_m": 2e-6}}
    small, large = (0.004, 4e8), (0.005, 6e8)
    here, there = (
        last_blow(
            met({**TWIN, "radius_m": R, "Sy_Pa": strong}, radius=r, Sy=Sy, speed=10.0,
                mechanisms=rough, impact={"angle_deg": 30.0}),
            LAWS["fitted"],
        )
        for (R, strong), (r, Sy) in ((small, large), (large, small))
    )  # fmt: skip
    assert there.restitution == pytest.approx(here.restitution, rel=1e-6)
    assert there.residual_flat_m == pytest.approx(here.residual_sphere_m, rel=1e-6)
    assert there.residual_sphere_m == pytest.approx(here.residual_flat_m, rel=1e-6)


def test_what_only_one_shape_has_is_refused_for_the_other():
    for target, impact, key in (
        (changed(TWIN, {"radius_m": None}), {}, "target.radius_m"),
        ({**METAL, "radius_m": 0.01}, {}, "target.radius_m"),
        ({**METAL, "mass_kg": 0.01}, {}, "target.mass_kg"),
        ({**TWIN, "thickness_m": 0.01}, {}, "target.thickness_m"),
        (TWIN, {"support": "half-space"}, "impact.support"),
        ({**TWIN, "radius_m": -0.004}, {}, "target.radius_m"),
    ):
        with pytest.raises((InputError, InputErrors)) as told:
            met(target, impact=impact).scene(LAWS["fitted"])
        assert key in str(told.value)


def test_a_seat_carries_what_finite_elements_of_it_do():
    """1.1, 4.7 and 12.8 % less than a flat at 0.01, 0.02 and 0.04 R, three radii wide (E/341)."""
    body, R = Material(E=205e9, nu=0.3, Sy=205e9 / 341.0), 1.5e-3
    pair, depth = Pair(body, body, R), R * np.array([0.01, 0.02, 0.04])
    law = SecondSphere(-3e-3).faced(LAWS["fitted"], pair)
    less = law.loading(pair, depth) / LAWS["fitted"].loading(pair, depth) - 1.0
    assert less == pytest.approx([-0.011, -0.047, -0.128], abs=0.012)
