"""The mesh as layers around the first contact point: what the transfer between meshes walks along.

Outside of its innermost block each body is a stack of layers with the same number of elements: the
rings, and above the sphere's last ring the layers up to the top face.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array, Integers
from .bodies import Mesh


@dataclass(frozen=True)
class Layers:
    """Nodes and elements of one body, layer by layer.

    - `nodes`: node numbers, from the innermost block outwards and from the surface to the axis,
      shape (n_layers + 1, divisions + 1).
    - `quads`: element numbers, shape (n_layers, divisions).
    - `corners`: which of its four nodes an element has at (inner, surface side), (inner, axis
      side), (outer, surface side) and (outer, axis side), shape (n_layers, divisions, 4).
    - `level`: coordinate along the layers: a ring's radius, then counted on by the layer; shape
      (n_layers + 1,).
    """

    nodes: Integers
    quads: Integers
    corners: Integers
    level: Array


def layers_of(mesh: Mesh, *, sphere: bool) -> Layers:
    """Walk through the layers of one body, from its innermost block outwards."""
    radii = mesh.rings if sphere else np.concatenate([mesh.rings, mesh.far_rings])
    mine = (np.arange(len(mesh.points)) < mesh.n_sphere_points) == sphere
    chord = np.hypot(mesh.points[:, 0], mesh.points[:, 1])
    first = np.flatnonzero(mine & (np.abs(chord / radii[0] - 1.0) < 1e-6))
    row = first[np.argsort(np.abs(mesh.points[first, 1]))]
    inside = mine & (chord < radii[0] * (1.0 - 1e-6))
    of_body = np.arange(len(mesh.quads)) < mesh.n_sphere_quads
    ahead = np.flatnonzero((of_body == sphere) & ~inside[mesh.quads].any(axis=1))
    edges = _Edges(mesh, ahead)
    rows, quads, corners = [row], [], []
    while (layer := edges.next_layer(row)) is not None:
        corner = _corners(mesh.quads[layer], row)
        nodes = np.take_along_axis(mesh.quads[layer], corner, axis=1)
        row = np.append(nodes[:, 2], nodes[-1, 3])
        rows.append(row)
        quads.append(layer)
        corners.append(corner)
    beyond = 1.0 + np.arange(len(rows) - len(radii))
    level = np.concatenate([radii, radii[-1] + beyond])
    return Layers(np.array(rows), np.array(quads), np.array(corners), level)


class _Edges:
    """Elements by their edges; each is given away once."""

    def __init__(self, mesh: Mesh, quads: Integers) -> None:
        self._n = len(mesh.points)
        nodes = mesh.quads[quads]
        key = self._key(nodes.ravel(), np.roll(nodes, -1, axis=1).ravel())
        order = np.argsort(key, kind="stable")
        self._key_of, self._quad = key[order], np.repeat(quads, 4)[order]
        self._given = np.zeros(len(mesh.quads), dtype=np.bool_)

    def _key(self, a: Integers, b: Integers) -> Integers:
        return np.asarray(np.minimum(a, b) * self._n + np.maximum(a, b))

    def next_layer(self, row: Integers) -> Integers | None:
        """Elements beyond a row of nodes; none at the end of the body."""
        key = self._key(row[:-1], row[1:])
        one = self._quad[np.searchsorted(self._key_of, key)]
        other = self._quad[np.searchsorted(self._key_of, key, side="right") - 1]
        layer = np.where(self._given[one], other, one)
        if self._given[layer].any():
            return None
        self._given[layer] = True
        return layer


def _corners(quads: Integers, row: Integers) -> Integers:
    """Places of the nodes (inner, inner, outer, outer) x (surface, axis side), shape (n, 4)."""
    place = np.arange(4)
    a = (quads == row[:-1, None]) @ place
    b = (quads == row[1:, None]) @ place
    # the nodes go round the element: those opposite to a and b are two places on
    return np.stack([a, b, (b + 2) % 4, (a + 2) % 4], axis=1)
