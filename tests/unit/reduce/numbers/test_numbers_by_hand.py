"""Tuned numbers of the reductions where they act, in cases that are worked out by hand."""

import math

import numpy as np
import pytest
from dentscope.reduce.bounces.chain import _without_false_ends, _without_strays
from dentscope.reduce.bounces.scale import scale_of
from dentscope.reduce.images.clip import repeated_frames
from dentscope.reduce.measured import Measured
from dentscope.reduce.mocap.rigid import _is_line
from dentscope.reduce.scan.noise import autocovariance
from dentscope.reduce.shared.regression import robust_regression, unit_covariance
from scipy.linalg import hilbert


def test_a_fall_known_to_a_tenth_gives_a_scale() -> None:
    known, vague = Measured(981.0, 95.0), Measured(981.0, 100.0)
    assert scale_of(known, 9.81, None).metres.value == pytest.approx(0.01)
    assert math.isnan(scale_of(vague, 9.81, None).metres.value)


def test_two_scales_agree_within_three_deviations() -> None:
    stated = Measured(0.01, 1e-4)
    # the fall's scale has an error of 1 % as well: 1.41 % together
    near = scale_of(Measured(981.0 / 1.042, 9.81 / 1.042), 9.81, stated)
    far = scale_of(Measured(981.0 / 1.045, 9.81 / 1.045), 9.81, stated)
    assert near.origin == "gravity and what is stated"
    assert far.origin == "what is stated, against gravity"


@pytest.mark.parametrize(("late", "left"), [(0.09, 6), (0.11, 5)])
def test_an_end_that_is_a_tenth_off_is_a_knock(late, left) -> None:
    """Flights of 0.8 of the one before; the last longer by a part of itself."""
    flights = 0.8 ** np.arange(5)
    flights[-1] *= math.exp(late)
    times = np.append(0.0, np.cumsum(flights))
    kept, _, ends = _without_false_ends(times, tuple(range(6)), (True,) * 5)
    assert (len(kept), ends) == (left, 6 - left)


def test_a_shape_of_one_to_a_hundred_is_a_line() -> None:
    assert _is_line(np.diag([1.0, 0.009, 0.0]))
    assert not _is_line(np.diag([1.0, 0.011, 0.0]))


def test_a_frame_repeats_where_it_changes_by_a_third_of_its_neighbours_in_a_fifth_of_all() -> None:
    def repeats(small: int, every: int = 2) -> int:
        steps = [small if k % every == 0 else 100 for k in range(39)]
        levels = 100 + np.cumsum([0, *(s * (-1) ** k for k, s in enumerate(steps))])
        return repeated_frames(np.broadcast_to(levels[:, None, None], (40, 4, 4))).size

    assert repeats(34) == 20
    assert repeats(36) == 0
    assert repeats(34, every=6) == 0


def test_a_residual_of_four_robust_deviations_is_left_out() -> None:
    """Residuals of 1 and -1 in turn: 1.4826 of the median of their size is a deviation."""
    x = np.arange(100.0)
    y = np.resize([1.0, -1.0], 100)
    used = []
    for size in (5.7, 6.3):
        moved = y.copy()
        moved[50] = size
        used.append(bool(robust_regression(np.stack([np.ones_like(x)], axis=1), moved).used[50]))
    assert used == [True, False]


def test_a_covariance_needs_thirty_pairs() -> None:
    """Of n points on a line n - k pairs are k apart."""
    z = np.ones((32, 1))
    found = autocovariance(z, np.ones((32, 1), dtype=bool), np.array([4, 0]))
    assert (found.ravel() > 0.0).tolist() == [False, False, *[True] * 5, False, False]


def test_a_flight_eight_deviations_off_the_course_is_a_stray() -> None:
    """Flights of 0.8 of the one before, each off by a thousandth to and fro."""

    def single(off: float) -> int:
        ratio = 0.8 ** np.arange(12) * np.exp(0.001 * np.resize([1.0, -1.0], 12))
        ratio[6] *= math.exp(off)
        times = np.append(0.0, np.cumsum(ratio))
        kept, _ = _without_strays(times, tuple(range(13)), (True,) * 12)
        return sum(kept)

    assert single(0.003) == 12
    assert single(0.1) < 12


def test_a_straight_line_has_the_textbooks_covariance():
    t = np.linspace(0.0, 1.0, 50)
    found = unit_covariance(np.stack([np.ones_like(t), t - t.mean()], axis=1))
    assert found == pytest.approx(np.diag([1.0 / 50, 1.0 / np.sum((t - t.mean()) ** 2)]))


@pytest.mark.parametrize("size", [4, 8, 12, 20])
def test_no_variance_is_negative_however_alike_the_columns(size):
    covariance = unit_covariance(hilbert(size))
    assert np.array_equal(covariance, covariance.T)
    assert np.all(np.diag(covariance) >= 0.0)
    assert np.linalg.eigvalsh(covariance)[0] >= -1e-12 * np.linalg.eigvalsh(covariance)[-1]


def test_readings_almost_without_noise_have_a_covariance():
    # two unknowns that only rounding tells apart, as the spin of a body that hardly turns
    t = np.linspace(0.0, 1.0, 200)
    design = np.stack([np.ones_like(t), t, t + 1e-9 * t**2, t**2], axis=1)
    fit = robust_regression(design, design @ [1.0, 2.0, 0.0, 3.0], floor=1e-7)
    assert np.all(np.isfinite(np.sqrt(np.diag(fit.covariance))))
    assert np.all(np.isfinite(fit.prediction_std(design)))


def test_a_column_that_no_reading_sees_has_no_variance():
    design = np.stack([np.ones(10), np.zeros(10)], axis=1)
    assert unit_covariance(design) == pytest.approx(np.diag([0.1, 0.0]))
