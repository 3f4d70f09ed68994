"""The law of one's own metal: exact where it is known, near it where numbers move."""

import numpy as np
import pytest
from dentscope.core import Material, Pair
from dentscope.core.flow import Flow, ludwik
from dentscope.models import LAWS
from dentscope.models.anchored import anchored

FITTED, HARDENING = LAWS["fitted"], LAWS["hardening"]
BALL = Material(E=200e9, nu=0.3, Sy=1.5e9)
R = 5e-3
DEPTH = R * np.geomspace(1e-6, 0.08, 40)


def hardens(factor: float) -> Pair:
    curve = ludwik(Sy=factor * 250e6, K=factor * 300e6, n=0.35)
    flat = Material(E=70e9, nu=0.33, Sy=curve.strength, flow=Flow(curve))
    return Pair(BALL, flat, R)


def sheet(factor: float) -> Pair:
    curve = hardens(factor).flat.flow.curve
    return Pair(BALL, Material(E=70e9, nu=0.33, Sy=curve(0.002)), R)


LAW = anchored(FITTED, HARDENING, at=hardens(1.0), stated=sheet(1.0), hardens=True)


def answers(law, pair):
    left = sum(law.residual(pair, DEPTH))
    half = law.unloading(pair, 0.5 * (left + DEPTH), DEPTH)
    return np.stack([law.loading(pair, DEPTH), law.contact_radius(pair, DEPTH), half]), left


def test_at_the_stated_numbers_it_is_what_is_known_of_them():
    own, dent = answers(LAW, sheet(1.0))
    known, left = answers(HARDENING, hardens(1.0))
    assert own == pytest.approx(known, rel=2e-3)
    assert dent == pytest.approx(left, rel=2e-3, abs=1e-4 * R)
    assert not np.allclose(own, answers(FITTED, sheet(1.0))[0], rtol=0.05)


@pytest.mark.parametrize("factor", [0.85, 1.15])
def test_beside_them_it_follows_a_stronger_metal(factor):
    own, dent = answers(LAW, sheet(factor))
    known, left = answers(HARDENING, hardens(factor))
    assert own == pytest.approx(known, rel=0.02)
    assert dent / DEPTH == pytest.approx(left / DEPTH, abs=0.01)


def test_far_from_them_force_and_radius_rise_and_no_cycle_gains_energy():
    for factor in (0.1, 10.0):
        pair = sheet(factor)
        force, radius = LAW.loading(pair, DEPTH), LAW.contact_radius(pair, DEPTH)
        assert np.all(np.diff(force) > 0.0)
        assert np.all(np.diff(radius) > 0.0)
        for peak in DEPTH[::8]:
            d = np.linspace(0.0, peak, 400)
            out = np.trapezoid(LAW.unloading(pair, d, np.full_like(d, peak)), d)
            assert out <= 1.002 * np.trapezoid(LAW.loading(pair, d), d)


def test_its_error_is_the_anchors_own():
    depth = np.array([1e-4])
    own = LAW.uncertainty(sheet(1.0), depth)
    assert own.force == pytest.approx(HARDENING.uncertainty(hardens(1.0), depth).force)


def test_the_metal_of_a_stronger_piece_has_its_whole_curve_scaled():
    metal = LAW.metal(sheet(1.2))
    assert metal.flat.flow.curve(0.05) == pytest.approx(1.2 * hardens(1.0).flat.flow.curve(0.05))
    assert metal.sphere is sheet(1.2).sphere


def test_a_law_of_another_metal_is_another_law_though_all_its_words_are_alike():
    other = anchored(FITTED, HARDENING, at=hardens(1.5), stated=sheet(1.5), hardens=True)
    assert (other.name, other.title, other.source) == (LAW.name, LAW.title, LAW.source)
    assert other != LAW
    assert len({LAW, other}) == 2
