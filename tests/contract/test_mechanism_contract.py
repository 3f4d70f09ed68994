"""What every mechanism keeps to, whichever the library holds; no names are listed here."""

import copy
import math
import pickle
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache, lru_cache
from pathlib import Path

import numpy as np
import pytest
from dentscope.core import Material, Pair
from dentscope.core.inputs.second_sphere import StruckSphere
from dentscope.discrepancy.comparison.forward import ACCURACY
from dentscope.dynamics import Approach, Friction, Scene, Striker, scene_of, strike_batch
from dentscope.dynamics.files.second import SecondSphere
from dentscope.dynamics.mechanisms import MECHANISMS, NAMELESS, Mechanism, Surroundings
from dentscope.dynamics.mechanisms.asked import SIMULATED
from dentscope.dynamics.mechanisms.base import Constants, Situation, Values, attached, observed
from dentscope.dynamics.mechanisms.strength.flow_stress import FlowMechanism
from dentscope.dynamics.stepping import layout as c
from dentscope.dynamics.stepping.layout import OBSERVABLES
from dentscope.dynamics.strength import strength_table
from dentscope.models import LAWS

Seen = Mapping[str, np.ndarray]

HARD = Material(E=208e9, nu=0.3, Sy=2e9, density=7830.0)
MILD = Material(E=206e9, nu=0.29, Sy=3e8, density=7850.0)
GEL = Material(E=2e6, nu=0.45, density=1000.0)
ROD = Striker(mass=0.2, tip_radius=0.0088, length=0.1, radius=0.0088)
OIL = Surroundings(viscosity=0.1, fluid="oil")
HOT_DROP = Surroundings(from_height=True, height_share=0.5, temperature=600.0, thickness=0.3)


def blow(striker, approach, *, sphere=HARD, flat=MILD, law="fitted", **more) -> Scene:
    return scene_of(LAWS[law], sphere=sphere, flat=flat, striker=striker, approach=approach, **more)


def ball_of(radius: float) -> Striker:
    return Striker(mass=7830.0 * 4.0 / 3.0 * math.pi * radius**3, tip_radius=radius)


def ball(radius: float, **approach: float) -> Scene:
    return blow(ball_of(radius), Approach(1.0, **approach), friction=Friction(0.15))


def rod(degrees: float) -> Scene:
    return blow(ROD, Approach(1.0, math.radians(degrees)), friction=Friction(0.15))


# what sticks and does not yield: a micrometre bead on a gel
BEAD = blow(Striker(1e-15, 1e-6), Approach(0.1), sphere=GEL, flat=GEL, law="hertz")
HOLLOW = blow(Striker(mass=0.0027, tip_radius=0.02), Approach(3.0))
RIGS: dict[str, list[Situation]] = {
    "balls": [(ball(r), OIL) for r in (2e-3, 8e-3)],
    "oblique ball": [(ball(8e-3, tangential=0.7), Surroundings())],
    "upright rod": [(rod(90.0), HOT_DROP)],
    "leaning rod": [(rod(50.0), HOT_DROP)],
    "bead": [(BEAD, Surroundings())],
    "ball on a free ball": [
        (SecondSphere(8e-3, 0.01).facing(ball(8e-3)),
         Surroundings(struck=StruckSphere(8e-3, 0.01)))
    ],
    "light ball": [(HOLLOW, Surroundings(from_height=True))],
}  # fmt: skip
"""What the mechanisms of the library meet somewhere."""


def simulated(scenes: Sequence[Scene]) -> dict[str, np.ndarray]:
    rows = strike_batch(list(scenes), ACCURACY)
    return {k: rows[:, c.OBSERVABLES.index(v)].copy() for k, v in SIMULATED.items()}


@cache
def untouched(name: str) -> Seen:
    return simulated([scene for scene, _ in RIGS[name]])


def with_mechanism(mechanism: Mechanism, rig: list[Situation], constants: Constants) -> Seen:
    scenes = [attached([mechanism], s, constants, around) for s, around in rig]
    return observed([mechanism], rig, constants, simulated(scenes))


def at(mechanism: Mechanism, rig: list[Situation], place: float) -> Values:
    return {p.name: float(p.value(place)) for p in mechanism.ranges(rig)}


def rigs_of(mechanism: Mechanism) -> dict[str, list[Situation]]:
    return {name: rig for name, rig in RIGS.items() if not mechanism.applies(rig)}


every = pytest.mark.parametrize("mechanism", [*MECHANISMS, *NAMELESS], ids=lambda m: m.name)


@every
@pytest.mark.parametrize("rig", RIGS)
def test_neutral_parameters_leave_the_impact_bit_for_bit(mechanism, rig):
    neutral = {mechanism.name: {p.name: p.neutral for p in mechanism.parameters}}
    before, after = untouched(rig), with_mechanism(mechanism, RIGS[rig], neutral)
    assert {k: v.tobytes() for k, v in after.items()} == {k: v.tobytes() for k, v in before.items()}


@every
def test_near_the_neutral_size_an_impact_is_nearly_what_it_was(mechanism):
    """So the declared neutral value is the formula's own, and no guard hides a jump there."""
    name, rig = next(iter(rigs_of(mechanism).items()))
    middle, size = at(mechanism, rig, 0.5), mechanism.parameters[0]
    if math.isinf(size.neutral):
        near = 1e4 * size.high
    else:
        near = size.neutral + 1e-5 * (middle[size.name] - size.neutral or size.high)
    values = {**middle, size.name: near}
    scenes = [mechanism.attach(s, values, around) for s, around in rig]
    after = mechanism.after(rig, values, simulated(scenes))
    for seen in ("restitution", "permanent_depth_m", "peak_force_N", "contact_time_s"):
        assert after[seen] == pytest.approx(untouched(name)[seen], rel=1e-3, abs=1e-12), seen


@every
def test_attaching_changes_nothing_that_it_was_given(mechanism):
    for rig in rigs_of(mechanism).values():
        given, values = copy.deepcopy(rig), at(mechanism, rig, 0.6)
        said = dict(values)
        scenes = [mechanism.attach(s, values, around) for s, around in rig]
        seen = simulated(scenes)
        kept = {k: v.copy() for k, v in seen.items()}
        mechanism.after(rig, values, seen)
        assert [repr(x) for x in rig] == [repr(x) for x in given]
        assert values == said
        assert {k: v.tobytes() for k, v in seen.items()} == {
            k: v.tobytes() for k, v in kept.items()
        }


@every
def test_observables_move_as_declared(mechanism):
    rigs = rigs_of(mechanism)
    assert rigs, "no rig of this test is one that the mechanism applies to"
    moved = set()
    for place, rig in rigs.items():
        before = untouched(place)
        after = with_mechanism(mechanism, rig, {mechanism.name: at(mechanism, rig, 0.6)})
        changed = {k: after[k] - before[k] for k in before}
        moved |= {k for k, v in changed.items() if np.any(v != 0.0)}
        for name, sign in mechanism.direction.items():
            # what rig and mechanism leave alone (a crater in a gel) has no direction, nor has what
            # a contact that nearly sticks changes within the integrator's accuracy: its tolerance
            # is 1e-7 a step, of which two walks are compared
            noise = 5e-7 * np.abs(before[name])
            assert np.all(sign * changed[name] >= -noise), (name, changed[name])
    assert moved
    assert set(mechanism.direction) <= moved


@every
def test_numbers_have_unit_range_neutral_value_and_source(mechanism):
    assert mechanism.title
    assert mechanism.equations
    assert re.fullmatch(r"[a-z]+(-[a-z]+)*", mechanism.name)
    assert 0.0 < mechanism.form <= 0.5
    assert mechanism.law_error >= 1.0
    assert set(mechanism.direction.values()) <= {-1, 1}
    names = [p.name for p in mechanism.parameters]
    assert len(set(names)) == len(names) > 0
    for p in mechanism.parameters:
        assert p.unit
        assert len(p.source) > 5
        assert p.low < p.high
        assert math.isfinite(p.low)
        assert math.isfinite(p.high)
        assert p.scale != "log" or p.low > 0.0
        assert not math.isnan(p.neutral)
        assert p.nodes >= (2 if p.scale == "either" else 3)
        if p.literature:
            assert p.low <= p.literature.value <= p.high
            assert len(p.literature.source) > 5
    for rig in rigs_of(mechanism).values():
        ranged = mechanism.ranges(rig)
        assert [(p.name, p.unit, p.neutral) for p in ranged] == [
            (p.name, p.unit, p.neutral) for p in mechanism.parameters[: len(ranged)]
        ]
        assert all(p.low < p.high for p in ranged)


@every
def test_what_is_ruled_out_comes_with_a_reason(mechanism):
    reasons = [mechanism.applies(rig) for rig in RIGS.values()]
    assert all(isinstance(r, str) for r in reasons)
    assert all(len(r) > 15 for r in reasons if r)
    if type(mechanism).applies is not Mechanism.applies:
        assert any(reasons), "it can be ruled out, but nothing here does"


def test_names_are_the_documented_ones_in_their_order():
    text = (Path(__file__).parents[2] / "docs" / "diagnose-method.md").read_text(encoding="utf-8")
    table = text.split("## Mechanisms")[1].split("\n\n")[1]
    documented = re.findall(r"^\| `([a-z-]+)` \|", table, flags=re.MULTILINE)
    assert documented == [m.name for m in MECHANISMS], "rows of docs/diagnose-method.md"
    assert all(m.named for m in MECHANISMS)


def test_what_has_no_name_is_documented_with_its_equation():
    text = (Path(__file__).parents[2] / "docs" / "diagnose-method.md").read_text(encoding="utf-8")
    assert not any(m.named for m in NAMELESS)
    assert not {m.name for m in NAMELESS} & {m.name for m in MECHANISMS}
    for mechanism in NAMELESS:
        assert f"{mechanism.title} | {mechanism.equations} |" in text


R = 5e-3
SOFT = Material(E=70e9, nu=0.33, Sy=2e8, density=2700.0)
NEAR = Material(E=206e9, nu=0.29, Sy=3.6e8, density=7850.0)
METALS = {"hard on mild": (HARD, MILD), "mild on hard": (MILD, HARD), "near": (NEAR, MILD),
         "hard on soft": (HARD, SOFT)}  # fmt: skip
COLD = Surroundings(heat_capacity=1e12, melting=1500.0, ambient=300.0)
UNIFORM = {
    "strain-rate-hardening": lambda f: (
        {"rise_at_1000_per_s": f - 1.0, "rate_exponent": 0.0}, COLD),
    "work-hardening": lambda f: ({"hardening_ratio": f - 1.0, "hardening_exponent": 0.0}, COLD),
    "size-effect": lambda f: ({"size_length_m": (f * f - 1.0) * R}, COLD),
    "hardened-layer": lambda f: ({"layer_hardening": f - 1.0, "layer_thickness_m": 1e9}, COLD),
    "thermal-softening": lambda f: (
        {"softening_exponent": 1.0}, replace(COLD, temperature=300.0 + 1200.0 * (1.0 - f))),
    "softer-surface": lambda f: ({"layer_softening": 1.0 - f, "layer_thickness_m": 1e9}, COLD),
    "negative-rate-sensitivity": lambda f: (
        {"fall_at_1000_per_s": 1.0 / f - 1.0, "fall_exponent": 0.0}, COLD),
    "strain-softening": lambda f: (
        {"softening_ratio": 1.0 / f - 1.0, "softening_power": 0.0}, COLD),
}  # fmt: skip
"""Values, and surroundings, at which a mechanism's factor is f at every depth."""
FALLS = {"thermal-softening", "softer-surface", "negative-rate-sensitivity", "strain-softening"}

STRENGTHS = {m.name: m for m in (*MECHANISMS, *NAMELESS) if isinstance(m, FlowMechanism)}


def impact_of(sphere: Material, flat: Material, speed: float) -> Scene:
    scene = blow(ball_of(R), Approach(speed), sphere=sphere, flat=flat)
    # an edge that is read at the flat itself: a scan's level reads shallow dents too narrow
    return scene.with_(instrument=replace(scene.instrument, scan_height=1e-9, scan_step=1e-6))


def test_every_mechanism_of_strength_is_held_to_this():
    assert set(UNIFORM) == set(STRENGTHS)


@pytest.mark.parametrize("name", UNIFORM)
def test_a_constant_factor_is_a_pair_of_that_strength(name):
    given, expected = [], []
    for sphere, flat in METALS.values():
        for factor in (0.5, 0.8) if name in FALLS else (1.25, 2.0, 2.5, 3.0):
            values, around = UNIFORM[name](factor)
            bodies = sphere.strengthened(factor), flat.strengthened(factor)
            for speed in (0.2, 3.0):
                scene = STRENGTHS[name].attach(impact_of(sphere, flat, speed), values, around)
                profile = scene.strengths(strength_table(scene.law, scene.pair))
                assert profile == pytest.approx(np.full(profile.shape, factor), rel=1e-6)
                given.append(scene)
                expected.append(impact_of(*bodies, speed))
    seen, pair = (
        dict(zip(OBSERVABLES, strike_batch(s).T, strict=False)) for s in (given, expected)
    )
    peak, dent = pair["peak_depth_m"], pair["residual_flat_m"]
    for key in ("restitution", "peak_force_N", "peak_depth_m", "contact_time_s"):
        assert seen[key] == pytest.approx(pair[key], rel=0.01), key
    for key in ("residual_sphere_m", "residual_flat_m"):
        assert np.all(np.abs(seen[key] - pair[key]) <= 0.01 * np.maximum(pair[key], 0.2 * peak)), (
            key
        )
    dented = dent > 0.1 * peak
    assert dented.sum() > 5
    assert seen["scar_width_m"][dented] == pytest.approx(pair["scar_width_m"][dented], rel=0.01)


@pytest.mark.parametrize(
    "make",
    [
        lambda: Material(E=200e9, nu=0.3, density=float("nan")),
        lambda: Pair(Material(E=200e9, nu=0.3, density=float("nan")), Material(70e9, 0.3), 0.01),
        lambda: Striker(0.1, 0.01, radius=float("nan")),
        lambda: Friction(0.2, mu_static=float("nan")),
        lambda: Surroundings(thickness=float("nan"), temperature=310.0),
    ],
)
def test_what_was_stored_is_what_is_read(make):
    one, other = make(), pickle.loads(pickle.dumps(make()))
    assert one == other
    assert hash(one) == hash(other)
    asked = []
    kept = lru_cache(lambda value: asked.append(value))
    kept(one), kept(other)
    assert len(asked) == 1


def test_a_number_that_is_stated_tells_values_apart():
    steel = Material(E=200e9, nu=0.3)
    assert steel != steel.with_(density=7800.0)
    assert steel != steel.with_(nu=0.29)
    assert steel != "steel"
    assert steel.with_(density=7800.0) == steel.with_(density=7800.0)
