"""The gap at every slave point, between two surfaces smoothed to C1 curves.

The curves are cubic segments through the nodes, whose slopes there are those of parabolas through
three neighbours; the first node has its mirror image beyond the axis.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ...core.arrays import Array, Integers
from .surfaces import POINTS


class Weights(NamedTuple):
    """Weights of four nodes in a point of the curve, and their two derivatives by t, (4,) each."""

    value: Array
    first: Array
    second: Array


class SlavePoints(NamedTuple):
    """Where the slave points are, each array of shape (n_edges, 3).

    `segment`, `position`: master segment under the point, and the place on it from 0 to 1; `gap`,
    `radius`: gap and current radius [R].
    """

    segment: Integers
    position: Array
    gap: Array
    radius: Array

    @classmethod
    def room(cls, n_edges: int) -> SlavePoints:
        """Arrays for the points of so many edges."""
        return cls(np.empty((n_edges, 3), np.int64), *(np.empty((n_edges, 3)) for _ in range(3)))


@njit(cache=True)
def new_weights():
    """Room for `Weights`."""
    return Weights(np.empty(4), np.empty(4), np.empty(4))


@njit(cache=True)
def curve(t, shape, w):
    """Weights of the four nodes about a segment at `t`, with first and second derivative."""
    # cubic Hermite functions of the two ends' slopes, and the rest is H(end) = 1 - H(start)
    t2 = t * t
    t3 = t2 * t
    end = 3.0 * t2 - 2.0 * t3
    end1 = 6.0 * (t - t2)
    end2 = 6.0 - 12.0 * t
    near = t3 - 2.0 * t2 + t
    near1 = 3.0 * t2 - 4.0 * t + 1.0
    near2 = 6.0 * t - 4.0
    far = t3 - t2
    far1 = 3.0 * t2 - 2.0 * t
    far2 = 6.0 * t - 2.0
    a, b, c, d = shape
    w.value[0] = -a * near
    w.value[1] = 1.0 - end + (a - b) * near - c * far
    w.value[2] = end + b * near + (c - d) * far
    w.value[3] = d * far
    w.first[0] = -a * near1
    w.first[1] = -end1 + (a - b) * near1 - c * far1
    w.first[2] = end1 + b * near1 + (c - d) * far1
    w.first[3] = d * far1
    w.second[0] = -a * near2
    w.second[1] = -end2 + (a - b) * near2 - c * far2
    w.second[2] = end2 + b * near2 + (c - d) * far2
    w.second[3] = d * far2


@njit(cache=True)
def weighted(k, x, weights):
    """Sum of the coordinates `x` of the four nodes about segment k, by their weights: r and z."""
    first, side = (1, -1.0) if k == 0 else (k - 1, 1.0)
    r = side * weights[0] * x[first, 0]
    z = weights[0] * x[first, 1]
    for j in range(1, 4):
        node = min(k - 1 + j, x.shape[0] - 1)  # beyond the last node the weight is zero
        r += weights[j] * x[node, 0]
        z += weights[j] * x[node, 1]
    return r, z


@njit(cache=True)
def _below(r, k, xm, shape, w):
    """Place on master segment k at radius r, and the height of the curve there."""
    t = (r - xm[k, 0]) / (xm[k + 1, 0] - xm[k, 0])
    for _ in range(30):
        curve(t, shape[k], w)
        f = weighted(k, xm, w.value)[0] - r
        t -= f / weighted(k, xm, w.first)[0]
        if abs(f) < 1e-15 * r:
            break
    curve(t, shape[k], w)
    return t, weighted(k, xm, w.value)[1]


@njit(cache=True)
def find_gaps(s, xs, xm, points):
    """Fill `points` for the surfaces `s` with nodes now at `xs`, `xm`.

    False when a point has left the master surface.
    """
    w = new_weights()
    last = xm.shape[0] - 2
    k = 0
    for e in range(xs.shape[0] - 1):
        for q in range(3):
            curve(0.5 * (1.0 + POINTS[q]), s.slave_shape[e], w)
            r, z = weighted(e, xs, w.value)
            while k < last and xm[k + 1, 0] < r:
                k += 1
            while k > 0 and xm[k, 0] > r:
                k -= 1
            if xm[k + 1, 0] < r:
                return False
            t, height = _below(r, k, xm, s.master_shape, w)
            points.segment[e, q] = k
            points.position[e, q] = t
            points.gap[e, q] = s.sign * (z - height)
            points.radius[e, q] = r
    return True
