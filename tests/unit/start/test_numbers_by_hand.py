"""Tuned numbers of the first commands where they act, in cases that are worked out by hand."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope import fem
from dentscope.core import Material, Pair
from dentscope.core.errors import Ending, Outcome
from dentscope.core.flow import Flow, tabulated
from dentscope.core.tables import thinned
from dentscope.models import LAWS
from dentscope.start.closing import _kept_out
from dentscope.start.judged import Reference, _rise, departure
from dentscope.start.measured import _dent
from dentscope.start.metal_press import _clock, _press
from dentscope.start.pair import Solved

HARD = Material(E=2e11, nu=0.3, Sy=2e9)
STEEL = Material(E=2e11, nu=0.3, Sy=4e8)
PAIR = Pair(HARD, STEEL, 1e-3)


@pytest.mark.parametrize(
    ("speeds", "out"),
    [([1.0] * 6 + [1.8, 2.0], [7]), ([1.0] * 6 + [1.82, 2.0], [6, 7]), ([1.0] * 5 + [2.0], [])],
)
def test_what_is_faster_than_nine_tenths_is_kept_out_where_six_numbers_are_left(speeds, out):
    given = SimpleNamespace(
        conditions=[SimpleNamespace(speed=v) for v in speeds],
        cells=SimpleNamespace(condition=np.arange(len(speeds))),
    )
    assert np.flatnonzero(_kept_out(given)).tolist() == out


def reference(**changed):
    given = {
        "pair": PAIR, "name": "a", "distance": 0.0, "depth": np.array([1e-5]),
        "force": np.array([1.0]), "turns": (), "deepest": 0.1,
    } | changed  # fmt: skip
    return Reference(**given)


@pytest.mark.parametrize(("part", "counts"), [(0.09, False), (0.11, True)])
def test_a_dent_says_something_of_a_law_from_a_tenth_of_the_depth(part, counts) -> None:
    turn = (1e-5, part * 1e-5, 0.5)
    found = departure(LAWS["fitted"], reference(turns=(turn,)))
    assert (found.dent > 0.0) is counts


def test_a_metals_rise_is_that_at_a_strain_of_a_tenth() -> None:
    curve = tabulated(np.array([0.0, 0.1, 0.3]), np.array([4e8, 6e8, 12e8]))
    assert _rise(Material(E=2e11, nu=0.3, Sy=4e8, flow=Flow(curve))) == pytest.approx(math.log(1.5))


def test_a_metal_is_pressed_a_quarter_deeper_than_its_deepest_press() -> None:
    scene = SimpleNamespace(law=None, pair=PAIR)
    problem = _press(scene, {}, (0.01, 0.02), ())
    assert isinstance(problem, fem.ContactProblem)
    assert max(problem.depths) == pytest.approx(0.025)


def test_the_clock_of_a_press_ends_at_a_tenth_of_the_speed() -> None:
    assert _clock(0.02, 3.0)[-1] == pytest.approx((0.02, 0.3))


def dent(r, z, ball=0.0):
    unloading = SimpleNamespace(
        depth=0.01, residual=1e-5, residual_sphere=ball * 1e-5, residual_flat=(1.0 - ball) * 1e-5,
        curve=SimpleNamespace(
            force=np.array([1000.0]), radius=np.array([3e-4]), delta=np.array([2e-5])
        ),
        crater_r=r, crater_z=z,
    )  # fmt: skip
    loading = SimpleNamespace(delta=np.array([1e-5]), force=np.array([400.0]))
    solution = SimpleNamespace(problem=SimpleNamespace(pair=PAIR), loading=loading)
    return _dent(solution, unloading)


@pytest.mark.parametrize(("ball", "read"), [(0.049, True), (0.051, False)])
def test_a_dent_has_a_brinell_hardness_where_the_ball_keeps_a_twentieth(ball, read) -> None:
    r = np.linspace(0.0, 1e-3, 20)
    found = dent(r, np.where(r < 5e-4, -1e-5, 0.0), ball)
    assert math.isfinite(found.brinell_by_contact) is read


@pytest.mark.parametrize("top", [3.1e-4, 3.3e-4, 3.5e-4])
def test_the_rim_of_a_dent_lies_between_the_nodes(top) -> None:
    r = np.append(0.0, np.geomspace(1e-4, 1e-3, 20))
    found = dent(r, np.maximum(2e-6 - 200.0 * (r - top) ** 2, -1e-5))
    assert (found.rim_diameter, found.rim_height) == pytest.approx((2.0 * top, 2e-6))


def test_a_solve_beyond_a_flow_curve_is_told() -> None:
    short = Material(2e11, 0.3, 4e8, flow=Flow(tabulated([0.0, 0.1], [4e8, 5e8])))
    last = SimpleNamespace(plastic_strain=np.array([0.2, 0.0, 0.3]), n_sphere_quads=1)
    problem = SimpleNamespace(pair=Pair(HARD, short, 1e-3))
    back = SimpleNamespace(outcome=Outcome(Ending.NOT_CONVERGED, "unloading stopped.", ""))
    solution = SimpleNamespace(problem=problem, snapshots=(last,), unloadings=(back,))
    assert "a strain of 0.1, the contact reaches about 0.3:" in Solved(solution, None).remark
    assert "unloading stopped." in Solved(solution, None).remark


@pytest.mark.parametrize("count", [0, 1, 5, 13, 23, 25, 61])
def test_a_table_that_is_thinned_ends_with_its_last_row(count) -> None:
    shown = thinned(count)
    assert shown == sorted(set(shown))
    assert len(shown) == min(count, 13)
    assert shown[:1] + shown[-1:] == ([0, count - 1] if count else [])
