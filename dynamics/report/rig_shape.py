"""The rig of a blow to scale: outlines of what strikes and of what is struck."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...core.arrays import Array

if TYPE_CHECKING:
    from ..files.setup import Setup


class RigShape(NamedTuple):
    """Outlines in the plane of the motion, the touch at the origin, the normal along y [m]."""

    striker: Array  # (n, 2) corners
    struck: Array  # (n, 2)
    window: float  # half the width that shows the rig
    thickness: float  # of the flat; infinite where the file states none, or a sphere is struck


def rig_shape(setup: Setup, place: Array, height: Array) -> RigShape:
    """Return a blow's outlines; `height` (n,) at `place` is over the surface that was there [m]."""
    body, target = setup.file.strikers[setup.file.striker], setup.file.target
    R, r = body.tip_radius_m.value, body.body_radius
    rod = body.shape == "rod"
    window = 2.6 * max(R, 2.0 * r if rod else r)
    angle = math.radians(setup.file.impact.angle_deg)
    t = np.linspace(0.0, 2.0 * math.pi, 181)
    circle = R * np.column_stack([np.cos(t), np.sin(t)])
    striker = (_rod(R, r, body.length, angle) if rod else circle) + np.array([0.0, R])
    if setup.second is not None:
        struck = _struck_sphere(setup.second.radius, place, height, 2.0 * window)
        return RigShape(striker, struck, window, math.inf)
    thickness = target.thickness_m.value if target.thickness_m else math.inf
    far, below = 2.0 * window, -min(thickness, 2.0 * window)
    top = [(-far, 0.0), *zip(place, height, strict=True), (far, 0.0)]
    struck = np.array([*top, (far, below), (-far, below)])
    return RigShape(striker, struck, window, thickness)


def _rod(R: float, r: float, length: float, angle: float) -> Array:
    """A shank of radius r between two caps of radius R, `length` between their centres [m]."""
    along = np.array([math.cos(angle), math.sin(angle)])
    beside = np.array([-along[1], along[0]])
    half = math.asin(min(r / R, 1.0))
    t = np.linspace(half, -half, 91)[:, None]
    cap = R * (beside * np.sin(t) - along * np.cos(t))
    outline = np.vstack([cap, length * along - cap])
    if 0.5 * math.pi - angle > half:  # it leans on the edge of its round end
        outline -= outline[np.argmin(outline[:, 1])] + np.array([0.0, R])
    return outline


def _struck_sphere(radius: float, place: Array, height: Array, far: float) -> Array:
    """A second sphere, or the block around a seat, with its dent."""
    R = abs(radius)
    reach = min(R, far)
    x = np.unique(np.concatenate([np.linspace(-reach, reach, 361), place[np.abs(place) < reach]]))
    bowed = R - np.sqrt(np.maximum(R**2 - x**2, 0.0))
    dent = np.interp(x, place, height, left=0.0, right=0.0) if len(place) else 0.0
    top = np.column_stack([x, dent - math.copysign(1.0, radius) * bowed])
    if radius < 0.0:
        block = [(far, top[-1, 1]), (far, -far), (-far, -far), (-far, top[0, 1])]
        return np.vstack([top, block])
    t = np.linspace(0.0, -math.pi, 181)
    below = np.column_stack([R * np.cos(t), R * np.sin(t) - R])
    return np.vstack([top, below[np.abs(below[:, 0]) <= reach] if reach < R else below])
