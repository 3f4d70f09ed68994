"""Craters by those of the nearest published pairs, each pair judged by the others."""

import math

import numpy as np
import pytest
from dentscope.core import Material, Pair
from dentscope.fitting import crater_shape as craters
from dentscope.fitting.crater_shape import PLACES, Left, crater_shape
from dentscope.models import LAWS


def judged(every, *, by_law=False):
    for number, pair, left, heights in craters._read()[::every]:
        whole, told = left.sphere + left.flat, left
        if whole < 0.1 * left.depth:
            continue
        if by_law:
            law = LAWS["fitted" if pair.perfectly_plastic else "hardening"]
            sphere, flat = (float(x) for x in law.residual(pair, left.depth))
            radius = float(law.contact_radius(pair, left.depth))
            told = Left(radius, left.depth, sphere, flat)
        for body, solved in heights.items():
            if left.of(body) < 0.05 * whole or not told.of(body) > 0.0:
                continue
            shape = crater_shape(pair, told, body, without=number)
            seen = np.interp(PLACES * told.radius, PLACES * left.radius, solved) * left.of(body)
            off = np.max(np.abs(shape.height * told.of(body) - seen)) / left.of(body)
            if shape.near:
                yield pair, body, off


def test_a_crater_is_that_of_its_neighbours():
    """From pole over wall and rim to 1.5 a: what the module says of itself."""
    off = [x for _, _, x in judged(20)]
    assert len(off) > 100
    assert np.percentile(off, 50) < 0.02
    assert np.percentile(off, 90) < 0.07
    assert np.percentile(off, 95) < 0.10


def test_what_a_law_leaves_is_drawn_as_finite_elements_have_it():
    """Depth and radius of the law, shape of the others: 7 % where one body is clearly weaker."""
    off = {"plastic": [], "hardens": []}
    for pair, body, x in judged(12, by_law=True):
        own, other = (pair.flat, pair.sphere) if body == "flat" else (pair.sphere, pair.flat)
        if other.strength > 1.3 * own.strength:
            off["plastic" if pair.perfectly_plastic else "hardens"].append(x)
    assert min(map(len, off.values())) > 20
    assert np.percentile(off["plastic"], 95) < 0.07
    assert np.percentile(off["hardens"], 90) < 0.07


HARD, SOFT = Material(2.1e11, 0.3, 2e9), Material(2.0e11, 0.3, 3e8)


def test_a_soft_flat_has_a_rim_at_the_contact():
    left = Left(radius=0.1e-3, depth=6e-6, sphere=0.0, flat=4.6e-6)
    shape = crater_shape(Pair(HARD, SOFT, 1e-3), left, "flat")
    assert shape.near
    assert shape.height[0] == pytest.approx(-1.0, abs=0.01)
    top = int(shape.height.argmax())
    assert 0.95 <= PLACES[top] <= 1.15
    assert 0.1 < shape.height[top] < 0.4
    assert np.all(np.diff(shape.height[: top + 1]) > 0.0)
    assert np.all(shape.std[1:] > 0.0)


def test_a_rigid_ball_leaves_what_finite_elements_say():
    """`dentscope case`, level smoke, to 0.008 R: 5 % of the depth, of no published pair."""
    pair = Pair(Material(math.nan, math.nan, rigid=True), Material(2e11, 0.3, 3.05e8), 5e-3)
    shape = crater_shape(pair, Left(0.67486e-3, 40e-6, 0.0, 34.510e-6), "flat")
    solved = [-1.0, -0.971, -0.885, -0.740, -0.540, -0.281, 0.030, 0.214, 0.139, 0.080, 0.048]
    assert shape.near
    assert shape.height[::3] == pytest.approx(solved, abs=0.055)


def test_a_pair_like_no_published_one_is_said_to_be_far():
    rubber = Material(1e7, 0.45, 5e6)
    left = Left(radius=0.3e-3, depth=0.1e-3, sphere=0.0, flat=0.02e-3)
    assert not crater_shape(Pair(HARD, rubber, 1e-3), left, "flat").near


def test_a_body_keeps_nothing_below_a_thousandth():
    left = Left(radius=1e-4, depth=1e-5, sphere=8e-9, flat=9e-6)
    assert left.of("sphere") == 0.0
    assert left.of("flat") == 9e-6
    assert math.isclose(left._replace(sphere=1e-8).of("sphere"), 1e-8)
