"""The two surfaces that may touch: their nodes, areas and contact stiffness."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...core.arrays import Array, Integers

POINTS = np.array([-math.sqrt(0.6), 0.0, math.sqrt(0.6)])
"""Points of a slave edge, from -1 to 1."""

WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18.0
"""Their weights."""


class Surfaces(NamedTuple):
    """The two surfaces that may touch (constants of a solve).

    - `slave`, `master`: node numbers ordered from the axis outwards.
    - `weight`: reference area of the slave points, shape (n_edges, 3).
    - `mass`: int N_A dA, shape (n_slave,).
    - `stiffness`: penalty stiffness eps_A, shape (n_slave,) [E'/R].
    - `sign`: 1 if the sphere is the slave side, -1 if the flat is.
    - `slave_shape`, `master_shape`: how the slopes at the ends of a segment, in units of its
      length, follow from the differences between its four nodes, shape (n_slave - 1, 4) and
      (n_master - 1, 4).
    - `friction`: Coulomb's coefficient.
    """

    slave: Integers
    master: Integers
    weight: Array
    mass: Array
    stiffness: Array
    slave_shape: Array
    master_shape: Array
    sign: float = 1.0
    friction: float = 0.0

    @property
    def sphere(self) -> Integers:
        """Surface nodes of the sphere."""
        return self.slave if self.sign > 0.0 else self.master

    @property
    def flat(self) -> Integers:
        """Surface nodes of the flat."""
        return self.master if self.sign > 0.0 else self.slave

    @classmethod
    def build(
        cls,
        points: Array,
        *,
        sphere: Integers,
        flat: Integers,
        penalty: float,
        flat_is_slave: bool,
        friction: float = 0.0,
    ) -> Surfaces:
        """Set up the two surfaces.

        - `points`: node coordinates, shape (n_nodes, 2) [R].
        - `sphere`, `flat`: their surface nodes from the axis outwards.
        - `penalty`: contact stiffness in E' over the edge length.
        - `flat_is_slave`: which side is which.
        - `friction`: Coulomb's coefficient.
        """
        slave, master = (flat, sphere) if flat_is_slave else (sphere, flat)
        if flat_is_slave:  # as far as the sphere's surface lies above it
            slave = slave[points[slave, 0] < 0.98 * points[master[-1], 0]]
        r = points[slave, 0]
        length = np.diff(r)
        s = 0.5 * (1.0 + POINTS)
        weight = 2.0 * math.pi * (r[:-1, None] + length[:, None] * s) * length[:, None] * WEIGHTS
        mass = np.zeros(len(r))
        mass[:-1] += (weight * (1.0 - s)).sum(axis=1)
        mass[1:] += (weight * s).sum(axis=1)
        edge = np.maximum(np.append(length, 0.0), np.insert(length, 0, 0.0))
        slave_shape, master_shape = _slopes(r), _slopes(points[master, 0])
        sign = -1.0 if flat_is_slave else 1.0
        return cls(
            slave, master, weight, mass, penalty / edge, slave_shape, master_shape, sign, friction
        )


def _slopes(r: Array) -> Array:
    """Weights of the node differences in the segments' end slopes: exact for a parabola in r."""
    length = np.diff(r)
    before = np.insert(length[:-1], 0, length[0])  # the mirror image beyond the axis
    after = np.append(length[1:], length[-1])
    shape = np.stack(
        [
            length**2 / (before * (before + length)),
            before / (before + length),
            after / (length + after),
            length**2 / (after * (length + after)),
        ],
        axis=1,
    )
    shape[-1, 2:] = 1.0, 0.0  # no node beyond the last
    return shape
