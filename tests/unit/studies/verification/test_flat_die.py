"""The self-similar indentation's parts against what is known exactly."""

import math

import numpy as np
import pytest
from dentscope.studies.verification.flat_die import Die


@pytest.fixture(scope="module")
def die() -> Die:
    return Die(1.6, 0.2, outer=1000.0)


def test_a_linear_flat_die_is_boussinesqs(die: Die) -> None:
    """Incompressible, G = 1/3: F = 8 G a d, and a sphere's contact has a^2 = R h."""
    force, surface, _ = die.velocities(np.full(die.radius.shape, 1.0 / 3.0))
    assert abs(force - 8.0 / 3.0) < 0.01 * force
    assert abs(1.0 - 2.0 * die.sunk(surface) - 0.5) < 0.005


@pytest.mark.parametrize("power", [1.0, 3.0])
def test_strain_gathered_along_a_ray(die: Die, power: float) -> None:
    """A rate that falls as x^-k gathers x^-k/(k + 1)."""
    distance = die.distance
    gathered = die.gathered(distance**-power)
    # beyond the mesh nothing is gathered: what would be is taken off
    missing = distance * 1000.0 ** -(power + 1.0) / (power + 1.0)
    expected = np.maximum(distance**-power / (power + 1.0) - missing, 1e-6)
    near = distance < 20.0
    assert np.abs(gathered / expected - 1.0)[near].max() < 0.02
    assert math.isclose(float(np.median(gathered[near] / expected[near])), 1.0, rel_tol=0.01)
