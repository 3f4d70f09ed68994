"""From one mesh to the next, when the contact edge has left the finely meshed zone.

Both meshes stand on the same ladder of rings, so the nodes and material points of the fine rings
that both have are the same, and what is known there is copied. Elsewhere displacements are
interpolated along the lines of nodes that lead outwards by Akima's splines, which follow a linear
field exactly, and in the innermost block between these lines as well. At material points that have
never yielded the elastic strain follows from the displacements alone; where one has, the deviator
of the elastic strain and the equivalent plastic strain are interpolated linearly, and the deviator
is brought back onto the yield circle where it lies outside. The pressure always follows from the
displacements (mean dilatation). The state is therefore in equilibrium only nearly: the next Newton
solution, at the same approach, sees to that.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from scipy.interpolate import Akima1DInterpolator, CubicSpline

from ..core.arrays import Array, Integers
from .discretise import Discretisation
from .elements import State, deformation, radius_at_rest
from .material import exponential, log_strain
from .mesh import Layers, Mesh

_INNER, _OUTER = 0.5 - 0.5 / math.sqrt(3.0), 0.5 + 0.5 / math.sqrt(3.0)
_BODIES = (True, False)


class Transfer:
    """Carries displacements and material states from one discretisation to another.

    - `old`, `new`: two discretisations of one problem, made for different zones; the innermost
      block of the new one is not the smaller.
    """

    def __init__(self, old: Discretisation, new: Discretisation) -> None:
        self.old, self.new = old, new
        self._layers = list(zip(old.layers, new.layers, strict=True))

    def displacements(self, u: Array) -> Array:
        """Displacements (2 n_nodes,) on the new mesh."""
        was = u.reshape(-1, 2)
        now = np.empty(self.new.mesh.points.shape)
        for sphere, (before, after) in zip(_BODIES, self._layers, strict=True):
            # the pole closes each line of nodes
            surface = self.old.mesh.sphere_surface if sphere else self.old.mesh.flat_surface
            pole = np.full((1, before.nodes.shape[1]), surface[0])
            nodes = np.concatenate([pole, before.nodes])
            spline = Akima1DInterpolator(np.insert(before.level, 0, 0.0), was[nodes], axis=0)
            now[after.nodes] = spline(np.clip(after.level, 0.0, before.level[-1]))
            old, new = _common(before.level, after.level)
            now[after.nodes[new]] = was[before.nodes[old]]
            core = _core_nodes(self.new.mesh, after, sphere)
            level, place = _polar(self.new.mesh.points[core], sphere)
            lines = _places(self.old.mesh, before, sphere)
            now[core] = _cubic(lines, spline(level), place)
        return now.reshape(-1)

    def state(self, state: State, u: Array) -> State:
        """Material state on the new mesh, at whose nodes the displacements are `u`."""
        x = self.new.elements
        strain, peeq, work = self._interpolated(state)
        F = deformation(x, u)
        b = np.empty_like(strain)
        _settle(F, radius_at_rest(x, peeq, work), strain, peeq, b)
        return State(F, b, strain, peeq, work, state.dissipated)

    def _interpolated(self, state: State) -> tuple[Array, Array, Array]:
        scalars = np.stack([state.peeq, state.work], axis=-1)
        data = np.concatenate([state.strain, scalars], axis=-1).reshape(-1, 6)
        out = np.empty((4 * len(self.new.elements.conn), 6))
        points = _points(self.new)
        place = [_place(grid) for grid in (self.old, self.new)]
        for sphere, layers in zip(_BODIES, self._layers, strict=True):
            before, after = layers
            if place[0][before.quads[0, 0]] < 0:
                continue  # a rigid body has no material points
            old, new = (_lines_of_points(x, where) for x, where in zip(layers, place, strict=True))
            at_old, at_new = _between(before.level), _between(after.level)
            out[new] = _linear(at_old, data[old], at_new)
            of_body = (self.new.element_index < self.new.mesh.n_sphere_quads) == sphere
            rest = np.setdiff1d(np.flatnonzero(np.repeat(of_body, 4)), new.ravel())
            level, angle = _polar(points[rest], sphere)
            lines = _between(_places(self.old.mesh, before, sphere))
            out[rest] = _linear_each(lines, _linear(at_old, data[old], level), angle)
        parts = out.reshape(-1, 4, 6)
        strain, peeq, work = (np.ascontiguousarray(parts[..., k]) for k in (slice(4), 4, 5))
        return strain, peeq, work


def moved_outwards(grid: Discretisation, values: Array, factor: float) -> Array:
    """Nodal values (2 n_nodes,) taken away from the pole.

    What is held, and the innermost block, keep their own.
    """
    moved = values.copy()
    nodal = moved.reshape(-1, 2)
    for layers in grid.layers:
        level = layers.level
        nodal[layers.nodes] = _linear(level, nodal[layers.nodes], level / factor)
    moved[grid.held] = values[grid.held]
    return moved


def _lines_of_points(layers: Layers, place: Integers) -> Integers:
    """Material points along the layers and across them, shape (2 n_layers, 2 divisions)."""
    first = 4 * place[layers.quads][..., None] + layers.corners
    n_layers, divisions = layers.quads.shape
    return first.reshape(n_layers, divisions, 2, 2).swapaxes(1, 2).reshape(2 * n_layers, -1)


def _linear(x: Array, values: Array, at: Array) -> Array:
    """Linear interpolation along the first axis, constant beyond the ends."""
    k, t = _between_knots(x, at)
    t = t.reshape(-1, *[1] * (values.ndim - 1))
    return np.asarray((1.0 - t) * values[k] + t * values[k + 1])


def _linear_each(x: Array, values: Array, at: Array) -> Array:
    """The same along the second axis, each row of `values` at its own place: (n, m) from n."""
    k, t = _between_knots(x, at)
    row = np.arange(len(at))
    return np.asarray((1.0 - t[:, None]) * values[row, k] + t[:, None] * values[row, k + 1])


def _between_knots(x: Array, at: Array) -> tuple[Integers, Array]:
    """Knot before each place and how far it is to the next, 0 to 1.

    The ends of an interval are met exactly, so that a weight of 0 or 1 copies: plastic strain must
    stay exactly zero.
    """
    k = np.clip(np.searchsorted(x, at) - 1, 0, len(x) - 2)
    t = np.clip((at - x[k]) / (x[k + 1] - x[k]), 0.0, 1.0)
    t[t > 1.0 - 1e-9] = 1.0
    return k, t


def _cubic(x: Array, values: Array, at: Array) -> Array:
    """Cubic splines through the rows of `values` (n, n_knots, m), each at its own place `at`."""
    pieces = CubicSpline(x, values, axis=1).c
    k = np.clip(np.searchsorted(x, at) - 1, 0, len(x) - 2)
    c = pieces[:, k, np.arange(len(at))]
    t = (at - x[k])[:, None]
    return np.asarray(((c[0] * t + c[1]) * t + c[2]) * t + c[3])


def _polar(points: Array, sphere: bool) -> tuple[Array, Array]:
    """Distance from the pole and angle from the surface (0) to the axis (1)."""
    rho = np.hypot(*points.T)
    angle = np.arctan2(np.abs(points[:, 1]), points[:, 0])
    start = np.arcsin(0.5 * rho) if sphere else np.zeros(len(rho))
    return rho, np.clip((angle - start) / (0.5 * math.pi - start), 0.0, 1.0)


def _places(mesh: Mesh, layers: Layers, sphere: bool) -> Array:
    """Angles of the lines of nodes, as `_polar` counts them, shape (divisions + 1,)."""
    return _polar(mesh.points[layers.nodes[0]], sphere)[1]


def _core_nodes(mesh: Mesh, layers: Layers, sphere: bool) -> Integers:
    n = mesh.n_sphere_points
    body = np.arange(n) if sphere else np.arange(n, len(mesh.points))
    return np.setdiff1d(body, layers.nodes.ravel())


def _between(level: Array) -> Array:
    """Coordinates of the material points along the layers, shape (2 n_layers,)."""
    step = np.diff(level)
    return np.stack([level[:-1] + _INNER * step, level[:-1] + _OUTER * step], axis=1).ravel()


def _common(old: Array, new: Array) -> tuple[Integers, Integers]:
    """Indices of the levels that both meshes have."""
    k = np.clip(np.searchsorted(old, new), 1, len(old) - 1)
    k -= new - old[k - 1] < old[k] - new
    same = np.abs(old[k] / new - 1.0) < 1e-9
    return k[same], np.flatnonzero(same)


def _place(grid: Discretisation) -> Integers:
    """Number among the deforming elements of each element of the mesh, -1: rigid."""
    place = np.full(len(grid.mesh.quads), -1)
    place[grid.element_index] = np.arange(len(grid.element_index))
    return place


def _points(grid: Discretisation) -> Array:
    """Reference coordinates of the material points, shape (4 n_elements, 2)."""
    corners = grid.mesh.points[grid.elements.conn]
    return np.asarray(np.einsum("qa,eax->eqx", grid.elements.value, corners).reshape(-1, 2))


@njit(cache=True)
def _settle(F, radius, strain, peeq, b):
    """Elastic strains at the points: from F where nothing has yielded, else as interpolated."""
    for e in range(F.shape[0]):
        for q in range(4):
            f = F[e, q]
            whole, m = log_strain(
                (
                    f[0] * f[0] + f[1] * f[1],
                    f[2] * f[2] + f[3] * f[3],
                    f[0] * f[2] + f[1] * f[3],
                    f[4] * f[4],
                )
            )
            s = strain[e, q]
            if peeq[e, q] == 0.0:
                for i in range(4):
                    s[i] = whole[i]
            size = math.sqrt(s[0] * s[0] + s[1] * s[1] + s[3] * s[3] + 2.0 * s[2] * s[2])
            limit = radius[e, q] * math.exp(3.0 * m)
            if size > limit:
                for i in range(4):
                    s[i] *= limit / size
            b[e, q, 0], b[e, q, 1], b[e, q, 2], b[e, q, 3] = exponential(s, m)
