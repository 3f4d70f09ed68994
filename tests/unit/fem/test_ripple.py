"""Curves freed of what repeats from ring to ring."""

import dataclasses

import numpy as np
import pytest
from dentscope.fem.results.measure import Reading
from dentscope.fem.results.ripple import RippleTrack


def path(n=120, *, ratio=1.035, ripple=0.003, share=0.5):
    """A force that bends and a radius, both with a part that repeats from ring to ring."""
    readings, truth = [], []
    for k in range(n):
        x = np.log(ratio) * k
        force, radius = np.exp(1.3 * x - 0.02 * x**2), np.exp(0.5 * x + 0.01 * np.sin(2 * x))
        place = np.log(radius) / np.log(1.025)
        turn = 2.0 * np.pi * place
        tooth = ripple * (np.sin(turn) + 0.4 * np.sin(2.0 * turn + 1.0))
        clean = Reading(
            delta=1e-4 * np.exp(x), force=force, radius=radius, radius_last_node=radius,
            sphere=share, flat=1.0 - share, force_defect=0.0, place=place,
        )  # fmt: skip
        truth.append(clean)
        readings.append(
            dataclasses.replace(clean, force=force * (1 + tooth), radius=radius * (1 - tooth / 2))
        )
    return readings, truth


def departures(smooth, truth, name):
    return np.array(
        [getattr(a, name) / getattr(b, name) - 1.0 for a, b in zip(smooth, truth, strict=True)]
    )


def test_the_ripple_goes_and_the_curve_stays():
    readings, truth = path()
    smooth = RippleTrack(readings).smooth(readings)
    before, after = (departures(r, truth, "force")[8:-8] for r in (readings, smooth))
    assert np.std(before) > 1e-3
    assert np.std(after) < 0.1 * np.std(before)
    assert np.abs(departures(smooth, truth, "radius")[8:-8]).max() < 2e-4
    assert np.abs(departures(smooth, truth, "force")).max() < 1e-3


def test_a_curve_without_ripple_is_left_alone():
    readings, truth = path(ripple=0.0)
    smooth = RippleTrack(readings).smooth(readings)
    assert np.abs(departures(smooth, truth, "force")).max() < 1e-5


@pytest.mark.parametrize("rings", [0.25, 0.48, 0.5, 0.52, 0.7, 0.95, 1.0])
def test_no_length_of_the_steps_upsets_the_curve(rings):
    """At half a ring or a whole one a step the ripple seems to stand still."""
    ratio = 1.025 ** (2.0 * rings)
    readings, truth = path(int(2.0 / np.log(ratio)), ratio=ratio)
    smooth = RippleTrack(readings).smooth(readings)
    raw = np.abs(departures(readings, truth, "force")).max()
    assert np.abs(departures(smooth, truth, "force")).max() < 1.3 * raw


@pytest.mark.parametrize("share", [0.0, 1.0])
def test_the_share_of_a_rigid_body_stays_what_it_is(share):
    readings, _ = path(share=share)
    for reading in RippleTrack(readings).smooth(readings):
        assert reading.sphere == pytest.approx(share, abs=1e-12)
        assert reading.flat == pytest.approx(1.0 - share, abs=1e-12)


def test_few_steps_are_not_smoothed():
    readings, _ = path(20, ratio=1.3)
    assert RippleTrack(readings).smooth(readings) == readings
