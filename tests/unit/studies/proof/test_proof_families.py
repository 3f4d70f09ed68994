"""The generators against exact results: Hertz's impact, momentum, energy, Hunter's share."""

import math

import numpy as np
import pytest
from dentscope.studies.proof.generators import (
    base_laws,
    benches,
    cavity,
    effects,
    flow,
    foundation,
    metals,
    normal,
    simulate,
    truth,
)
from dentscope.studies.proof.generators import parameters as at
from dentscope.studies.proof.generators.truth import FAMILIES

LAWS = [at.CAVITY, at.FOUNDATION]


def put(p, **given):
    for key, value in given.items():
        p[0, getattr(at, key)] = value
    return p


def row(law, *, speed=2.0, angle=90.0, length=0.3, strength=300e6, **more):
    p = np.zeros((1, at.N_PARAMETERS))
    p[0, at.CAVITY_LAW : at.ROW_LAW] = cavity.COEFFICIENTS
    p[0, at.ROW_LAW :] = foundation.COEFFICIENTS
    radius = 4.5e-3
    mass = 7800.0 * math.pi * radius**2 * 0.3
    inertia = mass * (length**2 / 12.0 + radius**2 / 4.0)
    usual = {
        "MASS": mass, "LENGTH": length, "INERTIA": inertia, "TIP": 9e-3,
        "THETA": math.radians(angle), "NORMAL_SPEED": speed, "LAW": law, "MODULUS": 110e9,
        "STRENGTH": strength, "MU": 0.15, "STEPS": 1500, "FOLLOW": 1e-6,
    }  # fmt: skip
    return put(p, **usual | more)


def with_beam(p, *, E=200e9, radius=4.5e-3):
    area = math.pi * radius**2
    return put(
        p, BEAM=30, BEAM_EA=E * area, BEAM_EI=E * math.pi * radius**4 / 4.0,
        BEAM_GA=E / 2.6 * area * 0.886, BEAM_ROTARY=7800.0 * math.pi * radius**4 / 4.0,
        BEAM_LOSS=0.0, FOLLOW=4e-4,
    )  # fmt: skip


@pytest.mark.parametrize("law", LAWS)
def test_elastic_impact_is_hertz(law):
    p = row(law, speed=0.1, strength=math.inf)
    out = simulate.results_of(p)[0]
    depth = (15.0 * p[0, at.MASS] * 0.01 / (16.0 * math.sqrt(9e-3) * 110e9)) ** 0.4
    assert out[at.RESTITUTION] == pytest.approx(1.0, abs=2e-4)
    assert out[at.TIME] == pytest.approx(2.9432 * depth / 0.1, rel=2e-3)
    force = 4.0 / 3.0 * 110e9 * math.sqrt(9e-3) * depth**1.5
    assert out[at.PEAK_FORCE] == pytest.approx(force, rel=2e-3)


def test_a_flat_tip_recovers_between_sphere_and_punch():
    """The rigid punch of radius b has F = 2 E' b d: the dent gives F^2/(4 E' b) back."""
    E, Y, R, depth = 110e9, 300e6, 9e-3, 1e-6
    c = cavity.COEFFICIENTS
    W = depth / R * (E / Y) ** 2
    for flat, off in ((1e-9, 1e-3), (0.08 * R, 0.02)):
        force, a, left = cavity.dent(depth, E, R, Y, flat, c)
        n = cavity.exponent(W, flat**2 / (R * depth), c)
        round_force, _, round_left = cavity.dent(depth, E, R, Y, 0.0, c)
        sphere = round_force * (depth - round_left) / (cavity.exponent(W, 0.0, c) + 1.0)
        wanted = sphere if flat < 1e-6 else force**2 / (4.0 * E * a)
        assert force * (depth - left) / (n + 1.0) == pytest.approx(wanted, rel=off)
    assert n == pytest.approx(1.0, abs=0.01)
    assert a == pytest.approx(flat, rel=0.01)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("angle", [90.0, 40.0])
def test_momentum_and_energy_balance(law, angle):
    p = row(law, angle=angle)
    out = simulate.results_of(p)[0]
    assert out[at.COMPLETED] == 1.0
    mass = p[0, at.MASS]
    assert out[at.NORMAL_IMPULSE] == pytest.approx(mass * (out[at.REBOUND] + 2.0), rel=1e-9)
    assert out[at.TANGENTIAL_IMPULSE] == pytest.approx(mass * out[at.TANGENTIAL_REBOUND], abs=1e-12)
    lost = out[at.ENERGY_IN] - out[at.ENERGY_OUT]
    assert -out[at.WORK] == pytest.approx(lost, rel=1e-3)


@pytest.mark.parametrize("law", LAWS)
def test_step_does_not_matter(law):
    coarse, fine = (simulate.results_of(row(law, STEPS=n))[0] for n in (1200, 4800))
    for place in (at.RESTITUTION, at.DEPTH, at.TIME, at.PEAK_FORCE):
        assert coarse[place] == pytest.approx(fine[place], rel=2e-3)


def test_chain_keeps_energy_of_an_elastic_contact():
    p = with_beam(row(at.CAVITY, speed=0.5, strength=math.inf))
    out = simulate.results_of(p)[0]
    # the work of the contact ends up in rigid motion and vibration: more is lost from the first
    assert out[at.NORMAL_IMPULSE] == pytest.approx(
        p[0, at.MASS] * (out[at.REBOUND] + 0.5), rel=1e-9
    )
    assert out[at.RESTITUTION] < 1.0
    assert abs(out[at.WORK]) < 1e-3 * out[at.ENERGY_IN]


def test_stiff_chain_is_the_rigid_rod():
    rigid = row(at.CAVITY, angle=55.0)
    stiff = put(with_beam(rigid.copy(), E=2e17), FOLLOW=1e-6)
    a, b = simulate.results_of(stiff)[0], simulate.results_of(rigid)[0]
    # lumped mass and small rotation: a few per mille
    for place in (at.RESTITUTION, at.DEPTH, at.PEAK_FORCE, at.REBOUND_SPIN):
        assert a[place] == pytest.approx(b[place], rel=1e-2)


def test_half_space_takes_hunters_share():
    # Hunter 1957: lambda = 1.04 (v/c0)^(3/5) of a steel ball on a steel half-space
    steel = benches.HARD
    rig = next(
        rig
        for rig in (benches.balls_elastic(np.random.default_rng(k)) for k in range(20))
        if rig.target is steel
    )
    p = rig.rows(at.CAVITY, {})
    effects.EFFECTS["half-space-waves"].put(
        p, rig, effects.Effect("half-space-waves", "cone", {"scale": 1.0})
    )
    out = simulate.results_of(p)
    lost = 1.0 - out[:, at.RESTITUTION] ** 2
    c0 = math.sqrt(steel.E / steel.density)
    hunter = 1.04 * (rig.speed / c0) ** 0.6
    assert np.all(lost / hunter > 0.6)
    assert np.all(lost / hunter < 1.6)


@pytest.mark.parametrize("law", LAWS)
def test_overstress_raises_force_and_cuts_depth(law):
    still = simulate.results_of(row(law))[0]
    fast = simulate.results_of(row(law, RATE_KIND=1.0, RATE_A=40.4, RATE_B=5.0))[0]
    assert fast[at.PEAK_FORCE] > 1.15 * still[at.PEAK_FORCE]
    assert fast[at.DEPTH] < 0.85 * still[at.DEPTH]
    assert fast[at.RESTITUTION] > still[at.RESTITUTION]


def ball(law, speed, **more):
    """A steel ball of 8 mm on the metal of docs/verification.md, "what hardening and rate make"."""
    mass = 7800.0 * 4.0 / 3.0 * math.pi * 8e-3**3
    modulus = 1.0 / ((1.0 - 0.33**2) / 70e9 + (1.0 - 0.3**2) / 210e9)
    given = {"MASS": mass, "INERTIA": 0.4 * mass * 8e-3**2, "TIP": 8e-3, "MODULUS": modulus} | more
    out = simulate.results_of(row(law, speed=speed, length=0.0, **given))[0]
    return np.log(out[[at.RESTITUTION, at.PEAK_FORCE, at.DEPTH]])


@pytest.mark.parametrize("law", LAWS)
def test_a_rate_acts_as_in_finite_elements(law):
    """Cowper and Symonds' law, 1108 1/s and 5.94: restitution, peak force, dent at two speeds."""
    rate = {"RATE_KIND": flow.POWER, "RATE_A": 1108.0, "RATE_B": 5.94}
    solid = {0.67: (0.157, 0.071, -0.504), 4.5: (0.224, 0.130, -0.350)}
    rises = []
    for speed, wanted in solid.items():
        change = ball(law, speed, **rate) - ball(law, speed)
        ratio = change / np.log1p(wanted)
        assert np.all((ratio > 0.5) & (ratio < 1.6)), ratio
        rises.append(change[0])
    # a contact that is nearly elastic has little to gain; a row of springs of the static pile-up
    # and pressure limit gained most there
    assert rises[1] > 1.2 * rises[0]


def test_a_metal_weaker_at_a_rate_digs_deeper_and_gives_less_back_in_both_families():
    falls = {"RATE_KIND": flow.FALLING, "RATE_A": 0.04, "RATE_B": 1.0}
    one, other = (ball(law, 1.7, **falls) - ball(law, 1.7) for law in LAWS)
    assert one[0] < 0.0
    assert one[1] < 0.0
    assert one[2] > 0.0
    assert one == pytest.approx(other, rel=0.1)


@pytest.mark.parametrize("family", FAMILIES)
def test_null_has_no_effect(family):
    rig = benches.balls_normal(np.random.default_rng(3))
    law = FAMILIES[family]
    assert simulate.size_of(rig, [], family=law, z={}) == 0.0
    plain = simulate.rows_of(rig, [], family=law, z={})
    assert np.array_equal(plain, rig.rows(law, {}))


def test_families_are_the_same_contact_within_a_few_per_cent():
    rig = benches.rods_normal(np.random.default_rng(5))
    one, two = (
        simulate.observables(rig, simulate.rows_of(rig, [], family=law, z={})) for law in LAWS
    )
    for name in rig.noise:
        spread = np.abs(np.log(one[name] / two[name]))
        assert 1e-4 < spread.max() < 0.10, name


@pytest.mark.parametrize("name", [*effects.EFFECTS, *effects.OUTSIDE])
def test_every_effect_is_seen_somewhere(name):
    kind = (effects.EFFECTS | effects.OUTSIDE)[name]
    rng = np.random.default_rng(7)
    largest = 0.0
    for k in range(4):
        rig = truth.told(rng, benches.BENCHES[kind.benches[0]](rng), (name,))
        law = LAWS[k % 2]
        largest = max(largest, simulate.size_of(rig, [kind.draw(rng, rig, law)], family=law, z={}))
        if largest > 3.0:
            break
    assert largest > 3.0


def test_a_support_with_play_is_within_the_library_and_a_flat_that_softens_is_not():
    rig = benches.balls_normal(np.random.default_rng(3))
    heavy = max(s.mass for s in rig.strikers)
    numbers = {"mass": 12.0 * heavy, "stiffness": 12.0 * heavy * (2.0 * np.pi / 6e-4) ** 2}
    numbers["damping"] = 0.02 * np.sqrt(numbers["mass"] * numbers["stiffness"])
    tight = effects.Effect("support-compliance", "spring-with-play", numbers | {"gap": 1e-12})
    law = LAWS[0]
    seen = simulate.Visibility.of(rig, family=law, z={})
    plain = seen.size(seen.change([tight]))
    beyond = simulate.beyond_library(np.random.default_rng(1), seen, tight)
    assert plain > 20.0
    assert beyond < 0.1 * plain
    softening = effects.Effect("strain-softening", "saturating", {"fall": 0.5, "strain": 0.01})
    beyond = simulate.beyond_library(np.random.default_rng(1), seen, softening)
    assert 5.0 < beyond <= seen.size(seen.change([softening]))


def test_what_another_effect_of_unknown_size_may_be_is_taken_out():
    rig = benches.balls_normal(np.random.default_rng(3))
    loss = effects.Effect("impact-speed-loss", "share", {"loss": 0.05})
    less = effects.Effect("impact-speed-loss", "share", {"loss": 0.03})
    layer = effects.Effect("hardened-layer", "exponential", {"rise": 0.5, "thickness": 1e-4})
    alone = simulate.size_of(rig, [loss], family=LAWS[0], z={})
    beside = simulate.size_of(rig, [loss], family=LAWS[0], z={}, keep=[layer])
    assert 2.0 < beside < alone
    # of two of one kind the other one, 3 % within a factor of e, is three fifths of it
    twice = simulate.size_of(rig, [loss], family=LAWS[0], z={}, keep=[less])
    assert twice == pytest.approx(alone / np.hypot(1.0, 0.6 * alone), rel=0.1)


@pytest.mark.parametrize("law", list(base_laws.LAWS))
@pytest.mark.parametrize("target", benches.TARGETS, ids=lambda metal: metal.name)
def test_base_laws_follow_the_finite_elements_of_each_pair(target, law):
    entry = base_laws.stored()[f"{benches.BEARING_STEEL.name} on {target.name}"]
    curve = base_laws.Curve(
        **{k: np.asarray(entry[k]) if k != "stiffness" else entry[k]
           for k in ("stiffness", "depth", "force", "turn", "left", "back")}
    )  # fmt: skip
    of_pair, usual = base_laws.LAWS[law]
    for constants, mark in ((np.array(entry[law]["constants"]), 0.015), (usual, 0.12)):
        force = [of_pair(constants, curve.stiffness, d)[0] for d in curve.depth]
        back = [of_pair(constants, curve.stiffness, d)[2] for d in curve.turn]
        assert np.sqrt(np.mean(np.log(force / curve.force) ** 2)) < mark
        assert np.sqrt(np.mean(np.log(back / curve.back) ** 2)) < mark


@pytest.mark.parametrize("law", LAWS)
def test_a_modulus_that_falls_gives_more_back_and_digs_no_deeper(law):
    """The energy that returns goes with the compliance of the unloading (a spring's F^2/(2k))."""
    soft = row(law, CHORD=0.2, CHORD_STRAIN=1e-6)
    one, two = (simulate.results_of(p)[0] for p in (row(law), soft))
    assert (two[at.RESTITUTION] / one[at.RESTITUTION]) ** 2 == pytest.approx(1.2, abs=0.03)
    assert two[at.PEAK_FORCE] == pytest.approx(one[at.PEAK_FORCE], rel=5e-3)


def test_another_unloading_is_that_of_its_source():
    """Etsion, Kligerman and Kadin: what is left of a dent of 100 times the depth of first yield."""
    p = row(at.CAVITY, OTHER_UNLOADING=1.0)[0]
    first = normal._first_yield(p)
    _, _, left = normal._dent(p, 100.0 * first, 0.0)
    x = 100.0
    assert left / (100.0 * first) == pytest.approx((1.0 - x**-0.28) * (1.0 - x**-0.69), rel=1e-9)
    assert normal._dent(p, 0.5 * first, 0.0)[2] == 0.0


@pytest.mark.parametrize("law", LAWS)
def test_metals_are_as_far_off_as_was_drawn(law):
    rng = np.random.default_rng(8)
    for _ in range(3):
        rig = metals.draw_metal(rng, benches.balls_normal(rng), family=law, z={})
        assert metals.OFF[0] * 0.85 < rig.metal_told["metal_off"] < metals.OFF[1] * 1.15
    glass = benches.balls_elastic(rng)
    assert metals.draw_metal(rng, glass, family=law, z={}) is glass


def places_of_dents(change):
    rig = benches.balls_normal(np.random.default_rng(2))
    seen = simulate.Visibility.of(rig, family=at.CAVITY, z={})
    n = len(seen.rig)
    changed = np.zeros(len(seen.weight))
    depth = list(rig.noise).index("permanent_depth_m")
    changed[depth * n : (depth + 1) * n] = change(np.log(seen.rig.speed))
    return seen.places(changed)


def test_an_effect_is_placed_where_its_readings_change():
    """A lost share of the speed: every dent smaller alike, nothing along the radius."""
    first = places_of_dents(lambda speed: 9.0 * (speed - speed.mean()))[0]
    assert first[:2] == ("permanent_depth_m", "impact speed")


def test_an_effect_has_no_place_where_its_readings_do_not_change():
    """Friction moves no restitution, though the strength that would repair a dent moves both."""
    score = {(name, along): z for name, along, z in places_of_dents(lambda speed: 9.0)}
    assert score["permanent_depth_m", "overall"] > 1.0
    assert max(z for (name, _), z in score.items() if name != "permanent_depth_m") == 0.0
