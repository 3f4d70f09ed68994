"""The covariance of a regression, beside designs whose covariance is known."""

import numpy as np
import pytest
from dentscope.reduce.regression import robust_regression, unit_covariance
from scipy.linalg import hilbert


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
