"""Sub-pixel edges along rays: a blurred step between the local levels of body and ground."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import map_coordinates
from scipy.special import ndtr

from ...core.arrays import Array, Mask
from ..rules import RULES

# limit: rounds of the edge and the circle at most [-]
_TIP_ROUNDS = 12


@dataclass(frozen=True)
class Edge:
    """Edge points in order along the body: column, row, blur [pixel] and whether they settled."""

    x: Array
    y: Array
    blur: Array
    good: Mask


def find_edges(grey: Array, x: Array, y: Array, dx: Array, dy: Array) -> Edge:
    """Find the edge near points (x, y) along outward directions (dx, dy), all (n,)."""
    reach = 9.0
    for _ in range(2):
        t = np.arange(-reach, reach + 0.5 * RULES.edge_step, RULES.edge_step)
        places = [y[:, None] + t * dy[:, None], x[:, None] + t * dx[:, None]]
        values = map_coordinates(grey, places, order=1, mode="nearest")
        p, settled = _steps(values, t)
        blur = float(np.median(p[settled, 3])) if settled.any() else 2.0
        reach = float(np.clip(5.0 * blur + 2.0, 5.0, 15.0))
    inside = (places[0] > 0.0) & (places[0] < grey.shape[0] - 1.0)
    inside &= (places[1] > 0.0) & (places[1] < grey.shape[1] - 1.0)
    good = settled & inside.all(axis=1)
    if good.any():
        contrast = float(np.median(p[good, 2]))
        good &= (p[:, 2] > 0.3 * contrast) & (p[:, 3] < 3.0 * blur)
    return Edge(x + p[:, 0] * dx, y + p[:, 0] * dy, p[:, 3], good)


def _steps(values: Array, t: Array) -> tuple[Array, Mask]:
    """Fit place, ground, contrast, blur of falling steps (n, s) by Gauss-Newton, all at once."""
    low, high = values[:, -4:].mean(axis=1), values[:, :4].mean(axis=1)
    bright = np.clip((values - low[:, None]) / np.maximum(high - low, 1.0)[:, None], 0.0, 1.0)
    p = np.stack(
        [t[0] + bright.sum(axis=1) * RULES.edge_step, low, high - low, np.full(len(low), 1.5)],
        axis=1,
    )
    move = np.full(len(p), np.inf)
    for _ in range(_TIP_ROUNDS):
        z = (p[:, :1] - t) / p[:, 3:]
        step = ndtr(z)
        slope = p[:, 2:3] * np.exp(-0.5 * z**2) / (math.sqrt(2.0 * math.pi) * p[:, 3:])
        jacobian = np.stack([slope, np.ones_like(z), step, -slope * z], axis=2)
        residual = values - p[:, 1:2] - p[:, 2:3] * step
        normal = np.swapaxes(jacobian, 1, 2) @ jacobian + 1e-9 * np.eye(4)
        change = np.linalg.solve(normal, (np.swapaxes(jacobian, 1, 2) @ residual[:, :, None]))
        change = np.clip(change[:, :, 0], [-1.0, -50.0, -50.0, -0.5], [1.0, 50.0, 50.0, 0.5])
        p = p + change
        p[:, 3] = np.clip(p[:, 3], 0.3, 0.3 * (t[-1] - t[0]))
        p[:, 0] = np.clip(p[:, 0], t[0], t[-1])
        move = np.abs(change[:, 0])
    return p, (move < 0.02) & (p[:, 2] > 5.0) & (np.abs(p[:, 0]) < 0.8 * t[-1])
