"""Tuned numbers of the solver where they act, in cases that are worked out by hand."""

from types import SimpleNamespace

import numpy as np
import pytest
from dentscope import fem
from dentscope.core import InputError, Material, Pair
from dentscope.fem.discretise import _softened, discretise
from dentscope.fem.loading import Loading, _growth, _stops
from dentscope.fem.mesh import Zone
from dentscope.fem.path import extrapolate
from dentscope.fem.results.ripple import _weights

STEEL = Material(E=200e9, nu=0.3, Sy=500e6)


def test_a_guess_goes_on_by_two_and_a_half_of_the_last_increment_at_most() -> None:
    before, now = np.array([1.0, 2.0]), np.array([2.0, 5.0])
    point = SimpleNamespace(equilibrium=SimpleNamespace(u=now))
    assert extrapolate(point, before, 2.0).tolist() == [4.0, 11.0]
    assert extrapolate(point, before, 9.0).tolist() == [4.5, 12.5]
    assert extrapolate(point, None, 9.0).tolist() == [18.0, 45.0]


@pytest.mark.parametrize(("iterations", "power"), [(5, 1.5), (6, 1.15), (8, 1.15), (9, 1.0)])
def test_a_step_that_was_easy_lets_the_next_be_longer(iterations, power) -> None:
    point = SimpleNamespace(equilibrium=SimpleNamespace(iterations=iterations))
    assert _growth(point) == power


def test_a_path_begins_three_quarters_of_its_first_depth_in() -> None:
    problem = fem.ContactProblem(Pair(STEEL, STEEL, 1e-3), (1e-4, 0.04))
    assert _stops(problem, 1.0)[0] == pytest.approx(0.75e-4)
    # well below first yield, where that comes sooner
    assert _stops(problem, 1e-4)[0] == pytest.approx(0.75 * 0.3e-4)


def test_rings_inside_the_zone_widen_in_three_steps() -> None:
    zone = Zone(0.1, 0.3)
    inside = [zone.allowed(0.1 / x, fine=0.02, coarse=0.1) for x in (1.4, 1.6, 3.9, 4.1)]
    assert inside == [0.04, 0.1, 0.1, 0.2]
    assert zone.allowed(0.2, fine=0.02, coarse=0.1) == 0.02


def test_the_first_ring_and_the_linear_half_space_lie_where_they_are_said() -> None:
    problem = fem.ContactProblem(Pair(STEEL, STEEL, 1e-3), (1e-4, 0.04))
    grid = discretise(problem, fem.Accuracy.smoke(), Zone(0.02, 0.06))
    # 0.12 of the zone's inner end, moved to the rung below: a quarter of a fine ring at the most
    first = grid.mesh.rings[0] / (0.12 * 0.02)
    assert (1.0 + fem.Accuracy.smoke().fine) ** -0.25 < first <= 1.0
    place = grid.mesh.points[grid.elements.conn]
    reach = np.hypot(*np.moveaxis(place, -1, 0)).min(axis=1)
    assert reach[grid.elements.linear >= 0].min() > 4.0
    assert reach[grid.elements.linear < 0].max() < 4.0


def test_what_varies_within_an_element_counts_half() -> None:
    """Four gradients of 1, 1, 3 and 3 in one element of even volume: a mean of 2."""
    grad = np.array([1.0, 1.0, 3.0, 3.0]).reshape(1, 4, 1, 1)
    found = _softened(grad, np.ones((1, 4)))
    assert found.ravel().tolist() == [1.5, 1.5, 2.5, 2.5]


@pytest.mark.parametrize(("depth", "ratio"), [(0.79, 1.06), (0.81, 1.04)])
def test_steps_are_elastic_ones_up_to_four_fifths_of_the_critical_depth(depth, ratio) -> None:
    given = SimpleNamespace(_onset=1.0, accuracy=fem.Accuracy.quick())
    assert Loading._limit(given, SimpleNamespace(delta=depth)) == ratio


def test_a_solve_goes_to_half_a_radius() -> None:
    fem.ContactProblem(Pair(STEEL, STEEL, 1e-3), (1e-4, 0.49))
    with pytest.raises(InputError, match="depths"):
        fem.ContactProblem(Pair(STEEL, STEEL, 1e-3), (1e-4, 0.51))


def test_a_ripple_is_looked_for_a_third_of_a_logarithm_to_both_sides_in_eleven_steps() -> None:
    """A cubic of four numbers, two harmonics of two each, and three steps to spare."""
    x = np.linspace(-1.0, 1.0, 201)
    weights = _weights(x, 40.0 * x, 100)
    assert np.abs(x[weights != 0.0]).max() == pytest.approx(0.35)
    few = np.linspace(-0.3, 0.3, 11)
    assert _weights(few, 40.0 * few, 5) is not None
    assert _weights(few[1:], 40.0 * few[1:], 5) is None
