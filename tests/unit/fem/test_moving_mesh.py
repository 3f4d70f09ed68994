"""The mesh that follows the contact: its rings, what one hands to the next, what meshing leaves."""

from dataclasses import replace

import numpy as np
import pytest
from dentscope import fem
from dentscope.core import Material, Pair
from dentscope.fem.assemble import advance, bulk_forces
from dentscope.fem.contact import Surfaces, Triplets, contact_forces, take_hold
from dentscope.fem.discretise import discretise, with_linear
from dentscope.fem.elements import State
from dentscope.fem.loading import Loading, Tally
from dentscope.fem.material import EXACT
from dentscope.fem.mesh import Zone, ladder_rings
from dentscope.fem.remesh import Transfer, moved_outwards
from made_processes import python

STEEL = Material(E=200e9, nu=0.3, Sy=500e6)
ELASTIC = Material(E=200e9, nu=0.3)
SETTINGS = fem.Accuracy.smoke()


@pytest.fixture(scope="module")
def grids():
    problem = fem.ContactProblem(Pair(STEEL, STEEL, 1e-3), (1e-4, 0.04))
    return [discretise(problem, SETTINGS, Zone(low, 3.0 * low)) for low in (0.02, 0.03)]


def virgin(grid):
    return State.virgin(len(grid.elements.conn))


@pytest.mark.parametrize("low", [0.001, 0.02, 0.2])
def test_rings_are_fine_in_the_zone_and_grow_smoothly(low):
    zone = Zone(low, 2.9 * low)
    rings = ladder_rings(zone, core=0.0007, end=0.65, fine=0.025, coarse=0.1)
    width = np.diff(np.log(rings))
    ahead = (rings[:-1] >= zone.low) & (rings[1:] <= zone.high)
    assert np.allclose(width[ahead], np.log(1.025))
    growth = np.maximum(width[1:] / width[:-1], width[:-1] / width[1:])
    assert growth[1:-1].max() <= 1.55  # a thin last ring is joined to its neighbour
    assert width.max() < 0.31


def test_meshes_for_two_zones_share_core_end_and_fine_rings():
    small, large = (
        ladder_rings(Zone(low, 3.0 * low), core=0.0007, end=0.65, fine=0.025, coarse=0.1)
        for low in (0.02, 0.03)
    )
    assert small[0] == large[0]
    assert small[-1] == large[-1]
    both = small[(small > 0.031) & (small < 0.059)]
    assert np.abs(both[:, None] / large - 1.0).min(axis=1).max() < 1e-12


def test_layers_cover_all_but_the_innermost_block(grids):
    for grid in grids:
        mesh = grid.mesh
        layers = grid.layers
        met = np.concatenate([x.quads.ravel() for x in layers])
        assert len(np.unique(met)) == len(met)
        core = np.setdiff1d(np.arange(len(mesh.quads)), met)
        assert np.hypot(*mesh.points[mesh.quads[core]].reshape(-1, 2).T).max() <= mesh.rings[0] * (
            1.0 + 1e-9
        )
        flat = layers[1]
        assert len(flat.level) == len(mesh.rings) + len(mesh.far_rings)
        corner = np.take_along_axis(mesh.quads[flat.quads], flat.corners, axis=-1)
        assert np.array_equal(corner[:, :, 0], flat.nodes[:-1, :-1])
        assert np.array_equal(corner[:, :, 3], flat.nodes[1:, 1:])


def test_transfer_to_the_same_mesh_copies_all_but_the_innermost_block(grids):
    grid = grids[0]
    rng = np.random.default_rng(1)
    u = rng.normal(0.0, 1e-6, grid.n_dofs)
    state, _ = advance(grid.elements, u, state=virgin(grid), rule=EXACT)
    assert state.peeq.max() > 0.0
    carry = Transfer(grid, grid)
    nodes, quads = (
        np.concatenate([getattr(x, n).ravel() for x in grid.layers]) for n in ("nodes", "quads")
    )
    carried = carry.displacements(u).reshape(-1, 2)[nodes]
    assert np.array_equal(carried, u.reshape(-1, 2)[nodes])
    again = carry.state(state, u)
    assert np.array_equal(again.peeq[quads], state.peeq[quads])
    assert again.F == pytest.approx(state.F, abs=1e-15)
    assert again.strain[quads] == pytest.approx(state.strain[quads], abs=1e-13)


def test_a_linear_field_is_carried_into_the_innermost_block_and_the_new_rings(grids):
    old, new = grids
    strain = np.array([-1e-4, 3e-4])
    carried = Transfer(old, new).displacements((strain * old.mesh.points).ravel())
    exact = strain * new.mesh.points
    near = np.hypot(*new.mesh.points.T) < 0.3
    scale = 3e-4 * new.mesh.rings[0]
    assert carried.reshape(-1, 2)[near] == pytest.approx(exact[near], rel=2e-3, abs=1e-4 * scale)


def test_an_increment_moves_outwards_with_the_contact(grids):
    """A tenth on, what stood at 1 stands at 1.1; the innermost block and what is held do not."""
    grid = grids[0]
    inner = grid.mesh.rings[0]
    values = np.repeat(np.hypot(*grid.mesh.points.T), 2)
    moved = moved_outwards(grid, values, 1.1)
    free = np.zeros(grid.n_dofs, bool)
    free[grid.free] = True
    near = free & (values > 1.2 * inner) & (values < 0.3)
    assert moved[near] == pytest.approx(values[near] / 1.1, rel=1e-9)
    stays = (values < 0.999 * inner) | ~free
    stays[grid.driven] = False
    assert np.array_equal(moved[stays], values[stays])


def test_what_has_never_yielded_keeps_no_memory_of_the_old_mesh(grids):
    old, new = grids
    x, y = (grid.mesh.points for grid in grids)
    strain = np.array([-1e-4, 3e-4])
    state, _ = advance(old.elements, (strain * x).ravel(), state=virgin(old), rule=EXACT)
    exact = (strain * y).ravel()
    carried = Transfer(old, new).state(state, exact)
    force, untouched = np.zeros(new.n_dofs), np.zeros(new.n_dofs)
    bulk_forces(new.elements, exact, state=carried, rule=EXACT, force=force)
    bulk_forces(new.elements, exact, state=virgin(new), rule=EXACT, force=untouched)
    assert force == pytest.approx(untouched, abs=1e-12 * np.abs(untouched).max())


def test_an_elastic_path_over_several_meshes_ends_where_the_direct_solution_does():
    problem = fem.ContactProblem(Pair(ELASTIC, Material(E=70e9, nu=0.3), 1e-3), (1e-5, 2e-4))
    tally = Tally()
    walk = Loading(problem, SETTINGS, tally)
    # each point with the radius that its mesh was made for
    moved, radius = [(point, walk._radius) for point in walk.points()][-1]
    assert tally.meshes >= 3
    loading = Loading(problem, SETTINGS, Tally())
    loading._radius = radius
    direct = list(loading.points())[-1]
    assert direct.grid.mesh.digest == moved.grid.mesh.digest
    for name in ("force", "radius", "sphere", "flat"):
        ours, plain = (getattr(p.record.reading, name) for p in (moved, direct))
        assert ours == pytest.approx(plain, rel=1e-5)


def test_the_linear_far_field_agrees_with_finite_strain_where_strains_are_small(grids):
    grid = grids[0]
    n = len(grid.elements.conn)
    nonlinear = grid.elements._replace(linear=np.full(n, -1))
    everywhere = with_linear(nonlinear, np.ones(n, dtype=bool))
    u = np.random.default_rng(2).normal(0.0, 1e-9, grid.n_dofs)
    forces = []
    for elements in (nonlinear, everywhere):
        force = np.zeros(grid.n_dofs)
        bulk_forces(elements, u, state=virgin(grid), rule=EXACT, force=force)
        forces.append(force)
    assert forces[1] == pytest.approx(forces[0], abs=1e-5 * np.abs(forces[0]).max())
    assert (grid.elements.linear >= 0).any()


def surfaces_of(mesh, **given):
    return Surfaces.build(
        mesh.points, sphere=mesh.sphere_surface, flat=mesh.flat_surface, penalty=10.0, **given
    )


@pytest.mark.parametrize("lifted", [0.0, 3e-3])
@pytest.mark.parametrize("flat_is_slave", [False, True])
def test_contact_tangent_is_the_derivative_of_the_contact_forces(grids, flat_is_slave, lifted):
    """Pushed, and pulled where closed nodes are lifted."""
    grid = grids[0]
    surfaces = surfaces_of(grid.mesh, flat_is_slave=flat_is_slave)
    rng = np.random.default_rng(3)
    x = grid.mesh.points.copy()
    n = grid.mesh.n_sphere_points
    x[:n, 1] += lifted - 2e-3
    x += rng.normal(0.0, 1e-7, x.shape)
    closed = np.arange(len(surfaces.slave)) < 20
    x[grid.mesh.points[:, 0] == 0.0, 0] = 0.0
    triplets = Triplets.for_surfaces(surfaces)
    force = np.zeros(grid.n_dofs)
    contact, m = contact_forces(surfaces, x, force=force, tangent=triplets, closed=closed)
    assert m > 1000
    assert (contact.pressure.min() < 0.0) == (lifted > 0.0)
    assert contact.force == pytest.approx(-force[1 : 2 * n : 2].sum(), rel=1e-12)
    tangent_is_the_derivative(surfaces, x, triplets, m, rng, step=1e-9, closed=closed)


def tangent_is_the_derivative(surfaces, x, triplets, m, rng, *, step, **given):
    """Along a direction that leaves the axis where it is, by central differences."""
    direction = rng.normal(0.0, 1.0, x.shape)
    direction[x[:, 0] == 0.0, 0] = 0.0
    change = np.zeros(x.size)
    np.add.at(change, triplets.row[:m], triplets.value[:m] * direction.ravel()[triplets.col[:m]])
    sides = []
    for sign in (1.0, -1.0):
        f = np.zeros(x.size)
        contact_forces(surfaces, x + sign * step * direction, force=f, **given)
        sides.append(f)
    numeric = (sides[0] - sides[1]) / (2.0 * step)
    assert change == pytest.approx(numeric, abs=2e-4 * np.abs(numeric).max())


def test_exchanging_slave_and_master_changes_little(monkeypatch):
    pair = Pair(STEEL, replace(STEEL, Sy=450e6), 1e-3)
    problem = fem.ContactProblem(pair, (2e-4, 2e-3, 4e-3))
    curves = []
    for flat_is_slave in (True, False):
        monkeypatch.setattr(
            "dentscope.fem.discretise._flat_is_slave", lambda pair, side=flat_is_slave: side
        )
        curves.append(fem.solve(problem, accuracy=SETTINGS).loading)
    assert curves[0].force == pytest.approx(curves[1].force, rel=0.02)
    assert curves[0].radius == pytest.approx(curves[1].radius, rel=0.03)
    assert curves[0].sphere / curves[0].delta == pytest.approx(
        curves[1].sphere / curves[1].delta, abs=0.005
    )


@pytest.mark.parametrize("flat_is_slave", [False, True])
def test_friction_s_tangent_is_the_derivative_of_its_forces(grids, flat_is_slave):
    mesh = grids[0].mesh
    surfaces = surfaces_of(mesh, flat_is_slave=flat_is_slave, friction=1e-3)
    rng = np.random.default_rng(5)
    axis = mesh.points[:, 0] == 0.0
    before = mesh.points.copy()
    before[: mesh.n_sphere_points, 1] -= 2e-3
    held = rng.normal(0.0, 1e-4, len(surfaces.slave))
    grip = take_hold(surfaces, before, held)
    x = before + rng.normal(0.0, 1e-6, before.shape)
    x[axis, 0] = 0.0
    triplets = Triplets.for_surfaces(surfaces)
    force = np.zeros(x.size)
    contact, m = contact_forces(surfaces, x, force=force, tangent=triplets, grip=grip)
    limit = 1e-3 * contact.pressure
    active = contact.pressure > 0.0
    slides = np.isclose(np.abs(contact.traction), limit, rtol=1e-12) & active
    assert slides.any()
    assert (active & ~slides).any()
    # action and reaction, of each body's nodes together
    n = 2 * mesh.n_sphere_points
    assert force[1:n:2].sum() == pytest.approx(-force[n + 1 :: 2].sum(), rel=1e-12)
    assert contact.force == pytest.approx(-force[1:n:2].sum(), rel=1e-12)
    # of springs in both directions
    stress = contact.pressure**2 + np.where(active, contact.traction, 0.0) ** 2
    stored = 0.5 * np.sum(surfaces.mass * stress / surfaces.stiffness)
    assert contact.energy == pytest.approx(stored, rel=1e-9)
    tangent_is_the_derivative(surfaces, x, triplets, m, rng, step=1e-10, grip=grip)


BROKEN = """
import os, threading
from dentscope.fem.mesh.bodies import _session

def mesh():
    with _session():
        pass

if {thread}:
    one = threading.Thread(target=mesh)
    one.start()
    one.join()
else:
    mesh()
reads, writes = os.pipe()
os.close(reads)
try:
    os.write(writes, b"1")
except BrokenPipeError:
    print("told")
"""


def test_a_broken_pipe_after_meshing_is_an_error_and_not_the_end():
    for thread in (False, True):
        answer = python("-c", BROKEN.format(thread=thread))
        assert (answer.returncode, answer.stdout) == (0, "told\n"), (thread, answer)
