"""Uncertainty from two solves, on curves whose difference is known."""

from dataclasses import replace

import numpy as np
import pytest
from dentscope.fem import Accuracy, Curve, coarser, discretisation_uncertainty

N = 20


def curve(n=N, force=1.0, sphere=1.0):
    line = np.geomspace(1.0, 30.0, n) if n == N else np.geomspace(1.0, 30.0, N)[:n]
    made = Curve(**dict.fromkeys(Curve.__dataclass_fields__, line))
    return replace(made, force=force * line, sphere=sphere * line)


def test_a_constant_relative_difference_is_the_uncertainty():
    made = discretisation_uncertainty(curve(), curve(force=1.02))
    assert made.force == pytest.approx(0.02 * curve().force)
    assert made.radius == pytest.approx(np.zeros(N))


def test_the_share_differs_absolutely():
    made = discretisation_uncertainty(curve(), curve(sphere=1.1))
    assert made.sphere_share == pytest.approx(np.full(N, 1.1 / 2.1 - 0.5))


def test_a_ripple_that_crosses_zero_leaves_no_gap():
    ripple = 1.0 + 0.01 * np.sin(1.3 * np.arange(N))
    made = discretisation_uncertainty(curve(), curve(force=ripple))
    relative = made.force / curve().force
    assert relative[3:-3].min() > 0.004
    assert relative.max() < 0.01


def test_an_early_end_carries_the_last_difference_on():
    made = discretisation_uncertainty(curve(), curve(n=5, force=0.97))
    assert made.force == pytest.approx(0.03 * curve().force)
    none = discretisation_uncertainty(curve(), curve(n=0))
    assert np.isnan(none.force).all()


@pytest.mark.parametrize("level", [Accuracy.production, Accuracy.quick, Accuracy.smoke])
def test_the_second_solve_is_coarser_in_every_respect(level):
    fine, rough = level(), coarser(level())
    assert rough.fine == 2.0 * fine.fine
    assert rough.coarse >= rough.fine
    assert rough.coarse > fine.coarse
    assert rough.divisions < fine.divisions
    assert rough.divisions % 2 == 0
    assert rough.step_ratio > fine.step_ratio
