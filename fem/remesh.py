"""From one mesh to the next, when the contact edge has left the finely meshed zone.

Both meshes stand on the same ladder of rings, so most nodes and material points of the new mesh are
nodes and points of the old one, and what is known there is copied. In between, along the lines of
nodes that lead outwards, displacements are interpolated by Akima's splines. At material points that
have never yielded the elastic strain follows from the displacements alone; where one has, the
deviator of the elastic strain and the equivalent plastic strain are interpolated linearly, and the
deviator is brought back onto the yield circle where it lies outside. The pressure always follows
from the displacements (mean dilatation). The state is therefore in equilibrium only nearly: the
next Newton solution, at the same approach, sees to that.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
from numba import njit
from scipy.interpolate import Akima1DInterpolator
from scipy.spatial import cKDTree

from .assemble import State, deformation
from .discretise import Discretisation
from .layers import Layers, layers_of
from .material import exponential, log_strain

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

_INNER, _OUTER = 0.5 - 0.5 / math.sqrt(3.0), 0.5 + 0.5 / math.sqrt(3.0)
_BODIES = (True, False)


class Transfer:
    """Carries displacements and material states from one discretisation to another.

    Parameters
    ----------
    old, new
        Two discretisations of one problem, made for different zones.
    """

    def __init__(self, old: Discretisation, new: Discretisation) -> None:
        self.old, self.new = old, new
        self._layers = [
            (layers_of(old.mesh, sphere=sphere), layers_of(new.mesh, sphere=sphere))
            for sphere in _BODIES
        ]
        self._node = np.empty(len(new.mesh.points), dtype=np.int64)
        # body by body, because a node of one may lie on one of the other
        for mine_new, mine_old in zip(_of_bodies(new), _of_bodies(old), strict=True):
            tree = cKDTree(old.mesh.points[mine_old])
            self._node[mine_new] = mine_old[tree.query(new.mesh.points[mine_new])[1]]

    def displacements(self, u: Floats) -> Floats:
        """Displacements (2 n_nodes,) on the new mesh."""
        was = u.reshape(-1, 2)
        now = was[self._node]  # right in the innermost blocks, which the meshes share
        for before, after in self._layers:
            spline = Akima1DInterpolator(before.level, was[before.nodes], axis=0)
            level = np.clip(after.level, before.level[0], before.level[-1])
            now[after.nodes] = spline(level)
            old, new = _common(before.level, after.level)
            now[after.nodes[new]] = was[before.nodes[old]]
        return now.reshape(-1)

    def state(self, state: State, u: Floats) -> State:
        """Material state on the new mesh, at whose nodes the displacements are `u`."""
        x = self.new.elements
        strain, peeq = self._interpolated(state)
        F = deformation(x.conn, x.grad, x.value, x.r, u)
        b = np.empty_like(strain)
        _settle(F, x.radius, strain, peeq, b)
        return State(F=F, b=b, strain=strain, peeq=peeq, dissipated=state.dissipated)

    def _interpolated(self, state: State) -> tuple[Floats, Floats]:
        points = _points(self.old), _points(self.new)
        data = np.concatenate([state.strain, state.peeq[..., None]], axis=-1)
        near = np.empty(points[1].shape[:1], dtype=np.int64)
        sphere = [grid.element_index < grid.mesh.n_sphere_quads for grid in (self.old, self.new)]
        for mine in _BODIES:
            old, new = (np.repeat(s == mine, 4) for s in sphere)
            if new.any():
                near[new] = np.flatnonzero(old)[cKDTree(points[0][old]).query(points[1][new])[1]]
        out = data.reshape(-1, 5)[near].reshape(-1, 4, 5)
        for before, after in self._layers:
            self._along_layers(data, out, before, after)
        return np.ascontiguousarray(out[..., :4]), np.ascontiguousarray(out[..., 4])

    def _along_layers(self, data: Floats, out: Floats, before: Layers, after: Layers) -> None:
        place = [_place(grid) for grid in (self.old, self.new)]
        if place[0][before.quads[0, 0]] < 0:
            return  # a rigid body has no material points
        for side in (0, 1):
            lines = []
            for where, layers in zip(place, (before, after), strict=True):
                quads = where[layers.quads]
                inner, outer = layers.corners[:, :, side], layers.corners[:, :, 2 + side]
                index = np.stack([4 * quads + inner, 4 * quads + outer], axis=1)
                lines.append(index.reshape(-1, quads.shape[1]))
            was = data.reshape(-1, 5)[lines[0]]
            old, new = _between(before.level), _between(after.level)
            k = np.clip(np.searchsorted(old, new) - 1, 0, len(old) - 2)
            t = np.clip((new - old[k]) / (old[k + 1] - old[k]), 0.0, 1.0)
            t[t > 1.0 - 1e-9] = 1.0
            t = t[:, None, None]
            # written so that a weight of 0 or 1 copies: plastic strain must stay exactly zero
            out.reshape(-1, 5)[lines[1]] = (1.0 - t) * was[k] + t * was[k + 1]


def _between(level: Floats) -> Floats:
    """Coordinates of the material points along the layers, shape (2 n_layers,)."""
    step = np.diff(level)
    return np.stack([level[:-1] + _INNER * step, level[:-1] + _OUTER * step], axis=1).ravel()


def _common(old: Floats, new: Floats) -> tuple[Integers, Integers]:
    """Indices of the levels that both meshes have."""
    k = np.clip(np.searchsorted(old, new), 1, len(old) - 1)
    k -= new - old[k - 1] < old[k] - new
    same = np.abs(old[k] - new) < 1e-9
    return k[same], np.flatnonzero(same)


def _of_bodies(grid: Discretisation) -> tuple[Integers, Integers]:
    n = grid.mesh.n_sphere_points
    return np.arange(n), np.arange(n, len(grid.mesh.points))


def _place(grid: Discretisation) -> Integers:
    """Number among the deforming elements of each element of the mesh, -1: rigid."""
    place = np.full(len(grid.mesh.quads), -1)
    place[grid.element_index] = np.arange(len(grid.element_index))
    return place


def _points(grid: Discretisation) -> Floats:
    """Reference coordinates of the material points, shape (4 n_elements, 2)."""
    corners = grid.mesh.points[grid.elements.conn]
    return np.asarray(np.einsum("qa,eax->eqx", grid.elements.value, corners).reshape(-1, 2))


@njit(cache=True)
def _settle(F, radius, strain, peeq, b):
    """Elastic strains at the points: from F where nothing has yielded, else as interpolated."""
    for e in range(F.shape[0]):
        for q in range(4):
            f = F[e, q]
            d0, d1, d2, d3, m = log_strain(
                f[0] * f[0] + f[1] * f[1],
                f[2] * f[2] + f[3] * f[3],
                f[0] * f[2] + f[1] * f[3],
                f[4] * f[4],
            )
            s = strain[e, q]
            if peeq[e, q] == 0.0:
                s[0] = d0
                s[1] = d1
                s[2] = d2
                s[3] = d3
            size = math.sqrt(s[0] * s[0] + s[1] * s[1] + s[3] * s[3] + 2.0 * s[2] * s[2])
            limit = radius[e] * math.exp(3.0 * m)
            if size > limit:
                for i in range(4):
                    s[i] *= limit / size
            b[e, q, 0], b[e, q, 1], b[e, q, 2], b[e, q, 3] = exponential(
                s[0] + m, s[1] + m, s[2], s[3] + m
            )
