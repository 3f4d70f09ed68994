"""A strength that is constant is a pair of that strength, whichever mechanism gives it.

Every mechanism that changes the metal's strength has values at which its factor does not depend on
depth or rate. The impact must then be that of two bodies of that strength: in force, restitution,
depths, diameter of the dent, time of contact.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from dentscope.core import Material
from dentscope.dynamics import Approach, Scene, Striker, scene_of, strike_batch
from dentscope.dynamics.mechanisms import MECHANISMS, NAMELESS, Surroundings
from dentscope.dynamics.mechanisms.strength.flow_stress import FlowMechanism
from dentscope.dynamics.stepping.layout import OBSERVABLES
from dentscope.dynamics.strength import strength_table
from dentscope.models import LAWS

R = 5e-3
HARD = Material(E=208e9, nu=0.3, Sy=2e9, density=7830.0)
MILD = Material(E=206e9, nu=0.29, Sy=3e8, density=7850.0)
SOFT = Material(E=70e9, nu=0.33, Sy=2e8, density=2700.0)
NEAR = Material(E=206e9, nu=0.29, Sy=3.6e8, density=7850.0)
PAIRS = {"hard on mild": (HARD, MILD), "mild on hard": (MILD, HARD), "near": (NEAR, MILD),
         "hard on soft": (HARD, SOFT)}  # fmt: skip
COLD = Surroundings(heat_capacity=1e12, melting=1500.0, ambient=300.0)
UNIFORM = {
    "strain-rate-hardening": lambda f: (
        {"rise_at_1000_per_s": f - 1.0, "rate_exponent": 0.0, "strength_kept": 1.0}, COLD),
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
    striker = Striker(mass=7830.0 * 4.0 / 3.0 * math.pi * R**3, tip_radius=R)
    scene = scene_of(
        LAWS["fitted"], sphere=sphere, flat=flat, striker=striker, approach=Approach(speed)
    )
    # an edge that is read at the flat itself: a scan's level reads shallow dents too narrow
    return scene.with_(instrument=replace(scene.instrument, scan_height=1e-9, scan_step=1e-6))


def columns_of(rows):
    return {name: rows[:, k] for k, name in enumerate(OBSERVABLES)}


def test_every_mechanism_of_strength_is_held_to_this():
    assert set(UNIFORM) == set(STRENGTHS)


@pytest.mark.parametrize("name", UNIFORM)
def test_a_constant_factor_is_a_pair_of_that_strength(name):
    given, expected = [], []
    for sphere, flat in PAIRS.values():
        for factor in (0.5, 0.8) if name in FALLS else (1.25, 2.0, 2.5, 3.0):
            values, around = UNIFORM[name](factor)
            bodies = sphere.strengthened(factor), flat.strengthened(factor)
            for speed in (0.2, 3.0):
                scene = STRENGTHS[name].attach(impact_of(sphere, flat, speed), values, around)
                profile = scene.strengths(strength_table(scene.law, scene.pair))
                assert profile == pytest.approx(np.full(profile.shape, factor), rel=1e-6)
                given.append(scene)
                expected.append(impact_of(*bodies, speed))
    seen, pair = (columns_of(strike_batch(s)) for s in (given, expected))
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
