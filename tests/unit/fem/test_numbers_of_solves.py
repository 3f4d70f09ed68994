"""Tuned numbers of the solver, of steps and meshes where they act, worked out by hand."""

from types import SimpleNamespace

import numpy as np
import pytest
import scipy.sparse as sparse
from dentscope import fem
from dentscope.core import InputError, Material, Pair
from dentscope.fem import loading
from dentscope.fem.assemble import DISTORTED, bulk_forces
from dentscope.fem.discretise import _softened, discretise
from dentscope.fem.elements import State
from dentscope.fem.factors import Fronts
from dentscope.fem.linear import LinearSystem
from dentscope.fem.loading import Loading, _growth, _stops
from dentscope.fem.material import EXACT
from dentscope.fem.mesh import Zone
from dentscope.fem.mesh.rings import ladder_rings
from dentscope.fem.newton import Solver
from dentscope.fem.path import extrapolate
from dentscope.fem.results import measure
from dentscope.fem.results.measure import edge_of_contact
from dentscope.fem.results.ripple import _weights

STEEL = Material(E=200e9, nu=0.3, Sy=500e6)
PROBLEM = fem.ContactProblem(Pair(STEEL, STEEL, 1e-3), (1e-4, 0.04))


@pytest.fixture(scope="module")
def grid():
    return discretise(PROBLEM, fem.Accuracy.smoke(), Zone(0.02, 0.06))


def searched(unbalanced) -> int:
    """How many corrections are made where the residual is `unbalanced` and nothing converges."""
    count = []
    residuals = iter(unbalanced)
    solver = SimpleNamespace(
        grid=SimpleNamespace(driven=[]), _evaluate=lambda *_: "here", _converged=lambda *_: False,
        _unbalanced=lambda _: next(residuals), _direction=lambda _: np.ones(2),
        _search=lambda u, now, direction, state: count.append(1) or (u, now, 1.0),
    )  # fmt: skip
    assert Solver.equilibrium(solver, np.zeros(2), state=None, delta=1.0) is None
    return len(count)


def test_a_step_has_18_iterations_and_is_given_up_after_8_that_did_not_halve_it() -> None:
    assert searched([1.0, 0.51]) == 8
    assert searched([1.0, 0.49]) == 18


def test_what_was_closed_opens_only_where_forces_balance_by_a_pull() -> None:
    """Whatever the way there: the balance that is accepted pushes everywhere."""
    held = []

    def evaluated(u, state):
        held.append(solver._closed is not None)
        pressure = np.array([1.0, -0.1 if solver._closed is not None else 0.0])
        return SimpleNamespace(contact=SimpleNamespace(pressure=pressure))

    solver = SimpleNamespace(
        grid=SimpleNamespace(driven=[]), _evaluate=evaluated, _converged=lambda *_: True,
        _unbalanced=lambda _: 1.0, _direction=lambda _: np.ones(2), _reaction=lambda _: 1.0,
        _search=lambda u, now, direction, state: (u, evaluated(u, state), 1.0),
    )  # fmt: skip
    found = Solver.equilibrium(
        solver, np.zeros(2), state=None, delta=1.0, closed=np.array([True, True])
    )
    assert found.contact.pressure.tolist() == [1.0, 0.0]
    assert held == [True, True, False]


@pytest.mark.parametrize(
    ("residual", "next_move", "converged"),
    [(0.99e-4, 1.0, True), (1.01e-4, 1.0, False), (4.9e-4, 0.99e-8, True), (4.9e-4, 1.01e-8, False),
     (5.1e-4, 0.99e-8, False)],
)  # fmt: skip
def test_forces_balance_to_a_ten_thousandth_or_nothing_moves(
    residual, next_move, converged
) -> None:
    """Of a force and an approach of 1: to five times that where corrections are a 1e-8."""
    solver = SimpleNamespace(_unbalanced=lambda _: residual, grid=SimpleNamespace(round_off=0.0))
    now = SimpleNamespace(contact=SimpleNamespace(force=1.0))
    assert Solver._converged(solver, now, next_move, 1.0) == converged


def system(diagonal, factors=None) -> SimpleNamespace:
    """A diagonal matrix, and the factors of another."""
    n = len(diagonal)
    matrix = sparse.csc_matrix(np.diag(diagonal))
    fronts = Fronts(matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64))
    assert fronts.factorise(np.ones(n) if factors is None else factors)
    room = (np.empty(n, np.float32), np.empty(n), np.empty((13, n)))
    return SimpleNamespace(_matrix=matrix, _fronts=fronts, _room=room, _n_last=0, n=n)


def test_a_direction_lacks_half_a_per_cent_after_12_steps_at_the_most() -> None:
    """Of eigenvalues 1 and 2 the first step leaves the part of the second in the whole."""

    def steps(part) -> int:
        one = system([1.0, 2.0])
        assert LinearSystem._iterate(one, np.array([1.0, part])) is not None
        return one._n_last

    assert steps(0.0049) == steps(0.001)
    assert steps(0.0051) == steps(0.0049) + 1
    # of many eigenvalues far apart none is left out
    many = system(np.geomspace(1.0, 1e6, 60))
    assert LinearSystem._iterate(many, np.ones(60)) is None
    assert many._n_last == 12


@pytest.mark.parametrize(("part", "kept"), [(0.24, True), (0.26, False)])
def test_a_direction_leaves_a_fifth_of_the_residual(part, kept) -> None:
    """Factors that are blind to the second of two unknowns leave it as it is."""
    blind = system([1.0, 1.0], np.array([1.0, 1e6]))
    assert (LinearSystem._iterate(blind, np.array([1.0, part])) is not None) == kept


@pytest.mark.parametrize(("steps", "anew"), [(5, False), (6, True)])
def test_a_matrix_is_factorised_anew_after_five_steps(steps, anew) -> None:
    used = []
    given = SimpleNamespace(
        _matrix=0, n=2, _order=np.arange(2), _n_last=steps,
        _iterate=lambda v: used.append("old") or v, _factorised=lambda v: used.append("new") or v,
    )  # fmt: skip
    LinearSystem.solve(given, np.ones(2))
    assert used == ["new" if anew else "old"]


@pytest.mark.parametrize("whole", [True, False])
def test_rows_are_exchanged_where_fresh_factors_do_not_serve(whole) -> None:
    """SuperLU solves once; the next matrix is factorised anew."""
    given = SimpleNamespace(
        _matrix=sparse.csc_matrix([[0.0, 2.0], [4.0, 0.0]]), n_factorisations=0,
        _fronts=SimpleNamespace(factorise=lambda _: whole), _iterate=lambda _: None,
    )  # fmt: skip
    assert LinearSystem._factorised(given, np.array([2.0, 4.0])) == pytest.approx([1.0, 1.0])
    assert given._n_last > 5


def test_a_pattern_couples_three_master_nodes_beyond_the_segments_in_use() -> None:
    """Segment 20: its own two nodes, one and two that touch it, and three to either side."""
    surfaces = SimpleNamespace(slave=np.arange(30), master=100 + np.arange(40))
    contact = SimpleNamespace(pressure=np.zeros(30), segment=np.full(30, 20))
    seen = []
    given = SimpleNamespace(_keys=lambda rows, cols: seen.append(rows // 2))
    LinearSystem._contact_keys(given, surfaces, contact)
    master = seen[0][seen[0] >= 100]
    assert (master.min(), master.max()) == (100 + 20 - 1 - 3, 100 + 20 + 2 + 3)


def zone_of(radius, monkeypatch) -> Zone:
    zones = []
    monkeypatch.setattr(loading, "discretise", lambda problem, accuracy, zone: zones.append(zone))
    monkeypatch.setattr(loading, "Solver", lambda *_, **__: None)
    given = SimpleNamespace(
        _radius=radius, problem=None, accuracy=None, tally=SimpleNamespace(timers=None)
    )
    Loading._solver(given)
    return zones[0]


def test_a_mesh_is_fine_from_85_to_160_hundredths_of_its_contact(monkeypatch) -> None:
    """Where it serves to a radius above a fifth it is the last, and fine to the end."""
    fine = zone_of(0.1, monkeypatch)
    assert (fine.low, fine.high) == (pytest.approx(0.085), pytest.approx(0.16))
    assert zone_of(0.148, monkeypatch).high == pytest.approx(1.6 * 0.148)
    assert zone_of(0.149, monkeypatch).high == 1.0


@pytest.mark.parametrize(("radius", "serves"), [(0.134, True), (0.136, False)])
def test_a_mesh_serves_for_a_contact_a_third_wider(radius, serves) -> None:
    class New(Exception):
        pass

    def solver():
        raise New

    given = SimpleNamespace(_radius=0.1, _solver=solver)
    reading = SimpleNamespace(radius=radius)
    point = SimpleNamespace(record=SimpleNamespace(reading=reading))
    if serves:
        assert Loading._follow(given, point, None) == (point, None)
    else:
        with pytest.raises(New):
            Loading._follow(given, point, None)


def test_a_failed_step_is_cut_to_four_tenths_seven_times() -> None:
    """From 1 to 1.2 at once; then within a ratio of 1.08: in three."""
    tried = []
    point = SimpleNamespace(
        delta=1.0, equilibrium=SimpleNamespace(u=np.zeros(1)),
        balanced=lambda guess, delta: tried.append(delta),
    )  # fmt: skip
    given = SimpleNamespace(tally=SimpleNamespace(failed=0))
    found, _ = Loading._step(given, point, None, 0.1, goal=1.2, ratio=1.5)
    assert found is None
    assert len(tried) == 7
    assert tried[:2] == [1.2, pytest.approx(1.2 ** (1 / 3))]


def test_the_first_contact_starts_at_three_hundredths_of_its_stiffness() -> None:
    seen = []

    class Surfaces(SimpleNamespace):
        def _replace(self, **new):
            return Surfaces(**new)

    surfaces = Surfaces(stiffness=1.0)
    mesh = SimpleNamespace(n_sphere_points=1)
    grid = SimpleNamespace(
        n_dofs=4, mesh=mesh, surfaces=surfaces,
        elements=SimpleNamespace(conn=[0], elastic=None),
    )  # fmt: skip
    solver = SimpleNamespace(grid=grid)

    def equilibrium(guess, **_):
        seen.append(solver.surfaces.stiffness)
        return SimpleNamespace(u=guess) if len(seen) < 2 else None

    solver.equilibrium = equilibrium
    given = SimpleNamespace(_stops=[1e-4], _solver=lambda: solver)
    assert Loading._first_contact(given) is None
    assert seen == [0.03, 1.0]


def test_a_gap_is_fitted_over_five_elements_at_161_edges(monkeypatch) -> None:
    seen = []
    monkeypatch.setattr(
        measure,
        "_misfits",
        lambda edges, r, g: seen.append((edges.size, r.size)) or np.zeros(edges.size),
    )
    r = np.repeat(np.arange(20.0)[:, None], 2, axis=1)
    contact = SimpleNamespace(
        pressure=np.where(np.arange(20) < 6, 1.0, 0.0), r=r, gap=np.zeros_like(r)
    )
    edge_of_contact(contact, np.arange(20.0))
    assert seen == [(161, 5 * 2)]


def test_a_gap_that_bends_back_is_fitted_by_its_kink_alone() -> None:
    """Of g = 0.1 s - 0.003 s^1.5 the bend is no contact's: the line nearest by relative weight."""
    edge, r = 5.3, np.linspace(6.0, 11.0, 60)
    s = r - edge
    g = 0.1 * s - 0.003 * s**1.5
    weight = 1.0 / (s + 0.1 * s.max())
    alpha = np.sum(s * weight * g * weight) / np.sum((s * weight) ** 2)
    misfit = np.sum(((alpha * s - g) * weight) ** 2)
    assert measure._misfits(np.array([edge]), r, g) == pytest.approx([misfit], rel=1e-9)


def test_rings_have_four_divisions_and_grow_by_a_quarter() -> None:
    """Rungs of a quarter of a fine ring: beyond the zone 5, 6, 7, 8, 10, 12, 15 and 18 of them."""
    fine = 1e-3
    rings = ladder_rings(Zone(0.1, 0.11), core=0.05, end=1.0, fine=fine, coarse=10.0)
    rungs = np.diff(np.log(rings)) / (np.log1p(fine) / 4)
    within = (rings[:-1] >= 0.1) & (rings[1:] <= 0.11)
    assert rungs[within] == pytest.approx(np.full(within.sum(), 4.0), abs=1e-6)
    after = rungs[np.flatnonzero(within)[-1] + 1 :]
    after = after[np.rint(after) > 4][:8]
    assert np.rint(after).tolist() == [5, 6, 7, 8, 10, 12, 15, 18]


@pytest.mark.parametrize(("volume", "inverted"), [(0.021, False), (0.019, True)])
def test_an_element_of_a_fiftieth_of_its_volume_is_inverted(grid, volume, inverted) -> None:
    """All heights are that much smaller, no radius moves."""
    elements, n = grid.elements.elastic, len(grid.elements.conn)
    u = np.zeros(grid.n_dofs)
    u[1::2] = (volume - 1.0) * grid.mesh.points[:, 1]
    code = bulk_forces(
        elements, u, state=State.virgin(n), rule=EXACT, force=np.zeros(grid.n_dofs),
        tangent=np.empty((n, 8, 8)), seconds=1.0,
    )  # fmt: skip
    assert (code == DISTORTED) == inverted


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
    assert _stops(PROBLEM, 1.0)[0] == pytest.approx(0.75e-4)
    # well below first yield, where that comes sooner
    assert _stops(PROBLEM, 1e-4)[0] == pytest.approx(0.75 * 0.3e-4)


def test_rings_inside_the_zone_widen_in_three_steps() -> None:
    zone = Zone(0.1, 0.3)
    inside = [zone.allowed(0.1 / x, fine=0.02, coarse=0.1) for x in (1.4, 1.6, 3.9, 4.1)]
    assert inside == [0.04, 0.1, 0.1, 0.2]
    assert zone.allowed(0.2, fine=0.02, coarse=0.1) == 0.02


def test_the_first_ring_and_the_linear_half_space_lie_where_they_are_said(grid) -> None:
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
