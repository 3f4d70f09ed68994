"""Motion of a rigid body in free flight: centre of mass on a parabola, constant spin.

X(t) = X0 + V τ + g τ²/2 is the centre of mass and R(t) = exp([w τ]) R0 the rotation; the centroid
of the markers is at X - R b, with b the centre of mass seen from the centroid. A constant spin is
exact about a principal axis (a rod that tumbles, any spin of a sphere or a cube).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from ...core.arrays import Array, Indices
from .rigid import Poses, cross_matrices

SHARED, OWN = 3, 12
"""Parameters: b; and for each flight X0, V, rotation about R0, w."""


@dataclass(frozen=True)
class Prior:
    """What is known beforehand about b, the centre of mass seen from the centroid (3,) [m].

    `std` is its standard deviation along `way`, the axis (3,) of a rod, and `across` it [m]; in all
    directions where that is zeros.
    """

    value: Array
    std: float
    way: Array = field(default_factory=lambda: np.zeros(3))
    across: float = math.inf

    @property
    def scale(self) -> Array:
        """The matrix that makes a deviation of b one of standard size, (3, 3) [1/m]."""
        along = np.outer(self.way, self.way)
        if not self.way.any():
            return np.asarray(np.eye(3) / self.std)
        return np.asarray(along / self.std + (np.eye(3) - along) / self.across)


@dataclass(frozen=True)
class Motion:
    """State of one flight at its reference time: X0, V, R0 (3, 3), w; g is downwards."""

    reference: float
    place: Array
    speed: Array
    turn: Array
    spin: Array
    gravity: Array

    def place_at(self, time: Array) -> Array:
        """Return the centre of mass, (n, 3) [m]."""
        tau = (np.asarray(time) - self.reference)[:, None]
        return np.asarray(self.place + self.speed * tau + 0.5 * self.gravity * tau**2)

    def speed_at(self, time: float) -> Array:
        """Return the velocity of the centre of mass, (3,) [m/s]."""
        return np.asarray(self.speed + self.gravity * (time - self.reference))

    def turn_at(self, time: Array) -> Array:
        """Return the rotations, (n, 3, 3)."""
        tau = (np.asarray(time) - self.reference)[:, None]
        return np.asarray(Rotation.from_rotvec(self.spin * tau).as_matrix() @ self.turn)

    def moved(self, step: Array) -> Motion:
        """Return the motion after a step of the twelve parameters."""
        turn = Rotation.from_rotvec(step[6:9]).as_matrix() @ self.turn
        return Motion(
            self.reference, self.place + step[:3], self.speed + step[3:6], turn,
            self.spin + step[9:12], self.gravity,
        )  # fmt: skip


def deviations(poses: Poses, index: Indices, motion: Motion, offset: Array) -> Array:
    """Return the whitened deviation of poses from a motion, (n, 6), in metres of a marker."""
    time = poses.time[index]
    turn = motion.turn_at(time)
    origin = motion.place_at(time) - turn @ offset
    rotation = Rotation.from_matrix(poses.turn[index] @ np.swapaxes(turn, 1, 2)).as_rotvec()
    off = np.concatenate([poses.origin[index] - origin, rotation], axis=1)
    return np.asarray(np.einsum("kij,kj->ki", poses.whiten[index], off))


def jacobian(poses: Poses, index: Indices, motion: Motion, offset: Array) -> Array:
    """Return the whitened derivatives of a pose by b and the twelve parameters, (n, 6, 15)."""
    n = index.size
    time = poses.time[index]
    tau = time - motion.reference
    turn = motion.turn_at(time)
    arm = cross_matrices(turn @ offset).reshape(n, 3, 3)
    carried = Rotation.from_rotvec(motion.spin * tau[:, None]).as_matrix()
    spun = tau[:, None, None] * _left_jacobian(motion.spin * tau[:, None])
    whole = np.zeros((n, 6, SHARED + OWN))
    whole[:, :3, :3] = -turn
    whole[:, :3, 3:6] = np.eye(3)
    whole[:, :3, 6:9] = tau[:, None, None] * np.eye(3)
    whole[:, :3, 9:12] = arm @ carried
    whole[:, :3, 12:15] = arm @ spun
    whole[:, 3:, 9:12] = carried
    whole[:, 3:, 12:15] = spun
    return np.asarray(poses.whiten[index] @ whole)


def _left_jacobian(vectors: Array) -> Array:
    """Return J with exp([v + d]) = exp([J d]) exp([v]) to first order, (n, 3) to (n, 3, 3)."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    safe = np.maximum(angle, 1e-6)
    cross = cross_matrices(vectors).reshape(-1, 3, 3)
    one = np.where(angle < 1e-3, 0.5 - angle**2 / 24.0, (1.0 - np.cos(safe)) / safe**2)
    two = np.where(angle < 1e-3, 1.0 / 6.0 - angle**2 / 120.0, (safe - np.sin(safe)) / safe**3)
    return np.asarray(np.eye(3) + one * cross + two * (cross @ cross))


def first_guess(poses: Poses, span: tuple[int, int], gravity: Array) -> Motion:
    """Return a motion near that of the poses in a span."""
    index = np.arange(span[0], span[1] + 1)
    time = poses.time[index]
    middle = int(index[index.size // 2])
    reference = float(poses.time[middle])
    turned = poses.turn[index[1:]] @ np.swapaxes(poses.turn[index[:-1]], 1, 2)
    steps = Rotation.from_matrix(turned).as_rotvec() / np.diff(time)[:, None]
    tau = time - reference
    line = np.polyfit(tau, poses.origin[index] - 0.5 * gravity * tau[:, None] ** 2, 1)
    spin = np.median(steps, axis=0)
    return Motion(reference, line[1], line[0], poses.turn[middle], spin, gravity)
