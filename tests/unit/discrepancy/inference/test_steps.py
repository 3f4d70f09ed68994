"""From one round of a fit to the next, where responses bend."""

from dataclasses import replace

import numpy as np
import pytest
from dentscope.discrepancy.inference.fit import Fit, expand, moved_towards, tried_steps
from dentscope.discrepancy.inference.grid import Grid

NOWHERE = np.zeros(0)


@pytest.fixture
def bench(toy):
    """One cell that shows the root of its unknown, with its sign, to a tenth."""

    class Bent(toy.Simulator):
        def predict(self, mechanisms, points):
            z = np.array([p.z for p in points])
            return np.sign(z) * np.sqrt(np.abs(z))

    given = toy.problem([0.0], derivative=[[0.0]])
    return Bent(replace(given, cells=replace(given.cells, std=np.array([0.1]))))


def expanded(bench, z: np.ndarray) -> Fit:
    return expand(bench, (), Grid(()), z, NOWHERE, None)


def test_whole_steps_swing_and_tried_ones_arrive(bench) -> None:
    """Newton's method turns the root of z into -z at every step; secants a little less."""
    whole = tried = np.array([1.0])
    for _ in range(4):
        whole, _ = moved_towards(expanded(bench, whole), whole, NOWHERE)
        tried, _, _ = tried_steps(bench, expanded(bench, tried), tried, NOWHERE)
    assert abs(whole[0]) > 0.2
    assert abs(tried[0]) < 0.2 * abs(whole[0])


def test_a_step_that_fits_worse_is_not_gone(bench) -> None:
    z = np.array([1e-4])
    found = replace(expanded(bench, z), z=np.array([-1.5]))
    after, place, settled = tried_steps(bench, found, z, NOWHERE)
    assert after == pytest.approx(z)
    assert place.size == 0
    assert settled


def test_a_step_within_what_matters_ends_the_fit(bench) -> None:
    z = np.array([0.2])
    found = replace(expanded(bench, z), z=np.array([0.1]))
    after, _, settled = tried_steps(bench, found, z, NOWHERE)
    assert after == pytest.approx([0.1])
    assert settled
