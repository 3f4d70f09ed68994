"""The surface that a blow leaves of each body, over the surface that was."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...core.arrays import Array
from ...fitting.crater_shape import PLACES, Body, Left, crater_shape
from ...models.turned import TurnedLaw
from ..result import Impact
from ..scene import Scene
from ..surface import Imprint


class LeftSurface(NamedTuple):
    """What stays in one body."""

    body: Body  # the tip, `sphere`, or what is struck, `flat`, also where that is a second sphere
    place: Array  # (n,) along the motion from the deepest place [m]
    height: Array  # (n,) over the surface that was [m], below 0 where it is pressed in
    std: Array  # (n,) [m]
    radius: float  # of the contact at its deepest [m]
    depth: float  # what stays at the deepest place [m]
    shaped: bool  # the shape between is known: else the surface is given at its deepest alone


def surfaces_left(
    scene: Scene, found: Impact, std: Callable[[str], float] | None
) -> list[LeftSurface]:
    """Return the surfaces that a blow leaves; none of a body that keeps nothing.

    Along a scar the walls of a crater are drawn out to its ends. The shape of a contact that ends
    at an edge, or that is like no published one, is not known. `std` gives the standard deviation
    of a field of `Impact`; without it no error is told.
    """
    mark = max(found.spot.imprints, key=lambda one: one.peak, default=None)
    peak = found.spot.tip_peak if mark is None else mark.peak
    if not peak > 0.0 or not found.residual_m > 0.0:
        return []
    radius = float(scene.law.contact_radius(scene.pair, peak)) if mark is None else mark.radius
    if not (0.0 < radius < math.inf and math.isfinite(found.residual_m)):
        return []  # far outside a published law
    dented = "sphere" if isinstance(scene.law, TurnedLaw) else "flat"
    edged = scene.striker.tip_flat_radius > 0.0 or radius > scene.force.edge
    left = Left(radius, peak, found.residual_sphere_m, found.residual_flat_m)
    bodies: tuple[tuple[Body, str], ...] = (
        ("flat", "residual_flat_m"), ("sphere", "residual_sphere_m"),
    )  # fmt: skip
    return [
        _surface(
            scene, left, body, mark if body == dented else None,
            None if std is None else std(name), edged=edged,
        )
        for body, name in bodies
        # a law gives a body of no strength nothing but roundings, or is out of its range
        if left.of(body) > 0.0 and getattr(scene.pair, body).strength < math.inf
    ]  # fmt: skip


def _surface(
    scene: Scene, left: Left, body: Body, mark: Imprint | None, std: float | None, *, edged: bool
) -> LeftSurface:
    depth = left.of(body)
    shape = None if edged else crater_shape(scene.pair, left, body)
    if shape is None or not shape.near:
        place = np.array([-left.radius, left.radius])
        off = np.full(2, std or 0.0)
        return LeftSurface(body, place, np.full(2, -depth), off, left.radius, depth, shaped=False)
    before, after = (left.radius, left.radius)
    start = end = 0.0
    if mark is not None:
        before, after = mark.start - mark.first, mark.last - mark.end
        start, end = mark.start - mark.deepest, mark.end - mark.deepest
    place = np.concatenate([start - before * PLACES[::-1], end + after * PLACES])
    height, own = (np.concatenate([x[::-1], x]) for x in (shape.height, shape.std))
    off = np.zeros_like(height) if std is None else np.hypot(std * height, depth * own)
    return LeftSurface(body, place, depth * height, off, left.radius, depth, shaped=True)
