"""What earlier touches left, and where: the height of the flat under the tip, and its memory.

The flat keeps a list of imprints along the sliding direction, the tip one flattening that goes with
it. Three questions are answered here, for the walk and for the oracle alike:

* How deep does the tip sink at a place before it meets metal? Each touch took the depth D off its
  bottom. Beside it, at the distance d from the bottom, a tip of radius R meets the wall of a crater
  of radius R/(1 - q), q = R (elastic recovery)/a^2 (Johnson 1985, 6.4: 1/R - 1/R_crater =
  recovery/a^2). The lowest point of a sphere in such a crater lies at D eta(d/a) with

      eta(u) = 1 - u^2/q        u <= q, the wall carries the tip at a place inside the crater
             = (1-u)^2/(1-q)    u > q, its rim does

  continuous to the first derivative. Touches add: each takes its metal off what it met.
* How much of what it meets is a fitted bed? The tip rests on the wall at d/q from the bottom; the
  circles of radius a about both places share the fraction lens(d/(2 q a)) of their area. As
  contact area and depth are proportional, a bed of the area w pi a^2 is what a peak of w p leaves:
  a touch there is elastic up to w p. At d = 0 that is the old peak, so that a reload meets the
  loading curve; from d = 2 q a on no part of the contact fits, and the metal answers as fresh metal
  at the height that the tip meets it; from d = a on the height is that of the fresh flat as well.
* How much of it is the tip's own? Where the law lets the share sigma of the residual depth stay in
  the tip, the tip's peak counts with sigma everywhere, the flat's with 1 - sigma.

K. L. Johnson, Contact Mechanics, Cambridge 1985, 6.4 (shape of an unloaded indentation).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numba import njit

from ..core.arrays import Array
from .rules import RULES

# fmt: off
# The surface vector: peak and flattening of the tip, where the next impact begins, number of
# imprints, how many of them the present touch stands on; then the imprints.
TIP_PEAK, TIP_FLAT, BEGIN, COUNT, STANDING = range(5)
N_HEAD = 5
# An imprint: both ends of its bottom, how far its edges reach, the place of its peak, the depth it
# took off, the law's depth at its peak, the radius of contact there, the share q.
START, END, FIRST, LAST, DEEPEST, TAKEN, PEAK, RADIUS, GIVE = range(9)
N_IMPRINT = 9
# limit: imprints that are kept apart [-]; beyond it the two nearest become one
MOST = 24
N_SURFACE = N_HEAD + MOST * N_IMPRINT

# limit: depth of a dent over its radius that is none [-]: what a smooth law leaves below yield
NONE = 1e-6

# limit: most samples of a scan across a dent [-]: 3 m at the usual step; a law that is far out of
# its range may give a dent without end
_SAMPLES = 1e6
_STEEPEST = RULES.steepest_wall
_PLAIN = {"cache": True, "_nrt": False, "error_model": "numpy"}


@dataclass(frozen=True, slots=True)
class Imprint:
    """What one touch left on the flat.

    - `start`, `end`: ends of its bottom, over which the tip slid between peak and parting [m].
    - `first`, `last`: how far the edge of the contact reached [m].
    - `deepest`: where the peak was [m].
    - `depth`: what it took off the flat that it met [m].
    - `peak`: depth of the law at the peak [m]: the flat is hardened so far.
    - `radius`: radius of contact at the peak [m].
    - `give`: q = R (elastic recovery)/radius^2 [-].
    """

    start: float
    end: float
    first: float
    last: float
    deepest: float
    depth: float
    peak: float
    radius: float
    give: float


@dataclass(frozen=True, slots=True)
class Spot:
    """The tip and the flat that it meets next; fresh by default.

    - `tip_peak`: largest depth of the law that the tip's metal has met [m].
    - `tip_flat`: permanent flattening of the tip [m].
    - `begin`: place of the next impact's first touch along the sliding direction [m].
    - `imprints`: what earlier touches left on the flat.
    """

    tip_peak: float = 0.0
    tip_flat: float = 0.0
    begin: float = 0.0
    imprints: tuple[Imprint, ...] = ()

    def shifted(self, distance: float) -> Spot:
        """Return the same metal, met `distance` [m] further along the sliding direction."""
        return replace(self, begin=self.begin + distance)

    def row(self) -> Array:
        """Return the surface vector, shape (N_SURFACE,)."""
        row = np.zeros(N_SURFACE)
        row[:N_HEAD] = (self.tip_peak, self.tip_flat, self.begin, len(self.imprints), 0.0)
        for i, m in enumerate(self.imprints):
            first = N_HEAD + i * N_IMPRINT
            row[first : first + N_IMPRINT] = (
                m.start, m.end, m.first, m.last, m.deepest, m.depth, m.peak, m.radius, m.give)
        return row

    @classmethod
    def of(cls, row: Array) -> Spot:
        """Return the spot of a surface vector."""
        cells = row[N_HEAD : N_HEAD + int(row[COUNT]) * N_IMPRINT].reshape(-1, N_IMPRINT)
        imprints = tuple(Imprint(*(float(x) for x in cell)) for cell in cells)
        return cls(float(row[TIP_PEAK]), float(row[TIP_FLAT]), float(row[BEGIN]), imprints)


@njit(**_PLAIN)
def beside(surface, at, x):
    """Distance [m] of x from the bottom of the imprint at `at`, width of its wall, and the side."""
    if x < surface[at + START]:
        d, wall, side = surface[at + START] - x, surface[at + START] - surface[at + FIRST], -1.0
    elif x > surface[at + END]:
        d, wall, side = x - surface[at + END], surface[at + LAST] - surface[at + END], 1.0
    else:
        return 0.0, 1.0, 0.0
    return d, max(wall, _STEEPEST * surface[at + RADIUS]), side


@njit(**_PLAIN)
def height(surface, count, x):
    """Depth [m] below the fresh flat at which the tip meets the flat at x, and its slope."""
    depth, slope = 0.0, 0.0
    for i in range(int(count)):
        at = N_HEAD + i * N_IMPRINT
        d, wall, side = beside(surface, at, x)
        u, q = d / wall, surface[at + GIVE]
        if u >= 1.0:
            continue
        taken = surface[at + TAKEN]
        if u <= q:
            depth += taken * (1.0 - u * u / q)
            slope -= side * taken * 2.0 * u / (q * wall)
        else:
            depth += taken * (1.0 - u) ** 2 / (1.0 - q)
            slope -= side * taken * 2.0 * (1.0 - u) / ((1.0 - q) * wall)
    return depth, slope


@njit(**_PLAIN)
def roughest(surface, count):
    """Bounds of the slope and of the curvature [1/m] of the height, wherever the tip is."""
    slope, curvature = 0.0, 0.0
    for i in range(int(count)):
        at = N_HEAD + i * N_IMPRINT
        radius, q = surface[at + RADIUS], surface[at + GIVE]
        left = max(surface[at + START] - surface[at + FIRST], _STEEPEST * radius)
        right = max(surface[at + LAST] - surface[at + END], _STEEPEST * radius)
        wall = min(left, right)
        slope += 2.0 * surface[at + TAKEN] / wall
        curvature += 2.0 * surface[at + TAKEN] / (min(q, 1.0 - q) * wall * wall)
    return slope, curvature


@njit(**_PLAIN)
def lens(t):
    """Area that two circles share whose centres lie 2 t radii apart, over that of one."""
    if t >= 1.0:
        return 0.0
    return 2.0 / math.pi * (math.acos(t) - t * math.sqrt(1.0 - t * t))


@njit(**_PLAIN)
def bed(surface, x):
    """Depth of the law up to which the flat at x is a fitted, hardened bed [m]."""
    deepest = 0.0
    for i in range(int(surface[COUNT])):
        at = N_HEAD + i * N_IMPRINT
        d, _, _ = beside(surface, at, x)
        t = d / (2.0 * surface[at + GIVE] * surface[at + RADIUS])
        deepest = max(deepest, surface[at + PEAK] * lens(t))
    return deepest


@njit(**_PLAIN)
def press(surface, mark):
    """Enter the peak of a touch, `mark` in the form of an imprint.

    The first peak of a touch opens an imprint; a later, deeper one deepens and widens it.
    """
    if surface[COUNT] == surface[STANDING]:
        if mark[TAKEN] <= 0.0:
            return
        at = N_HEAD + int(surface[COUNT]) * N_IMPRINT
        for j in range(N_IMPRINT):
            surface[at + j] = mark[j]
        surface[COUNT] += 1.0
        return
    at = N_HEAD + int(surface[STANDING]) * N_IMPRINT
    surface[at + START] = min(surface[at + START], mark[START])
    surface[at + END] = max(surface[at + END], mark[END])
    surface[at + FIRST] = min(surface[at + FIRST], mark[FIRST])
    surface[at + LAST] = max(surface[at + LAST], mark[LAST])
    surface[at + TAKEN] += mark[TAKEN]
    for j in (DEEPEST, PEAK, RADIUS, GIVE):
        surface[at + j] = mark[j]


@njit(**_PLAIN)
def _merge(surface):
    """Make one imprint of the two whose bottoms lie nearest: as wide as both and nowhere higher."""
    count = int(surface[COUNT])
    one, other, least = 0, 1, math.inf
    for i in range(count):
        for k in range(i + 1, count):
            a, b = N_HEAD + i * N_IMPRINT, N_HEAD + k * N_IMPRINT
            gap = max(surface[a + START] - surface[b + END], surface[b + START] - surface[a + END])
            gap /= min(surface[a + RADIUS], surface[b + RADIUS])
            if gap < least:
                one, other, least = i, k, gap
    a, b = N_HEAD + one * N_IMPRINT, N_HEAD + other * N_IMPRINT
    surface[a + TAKEN] = surface[a + TAKEN] + surface[b + TAKEN]
    if surface[b + PEAK] > surface[a + PEAK]:
        for j in (DEEPEST, PEAK, RADIUS, GIVE):
            surface[a + j] = surface[b + j]
    for j in (START, FIRST):
        surface[a + j] = min(surface[a + j], surface[b + j])
    for j in (END, LAST):
        surface[a + j] = max(surface[a + j], surface[b + j])
    last = N_HEAD + (count - 1) * N_IMPRINT
    for j in range(b, last):
        surface[j] = surface[j + N_IMPRINT]
    surface[COUNT] -= 1.0


@njit(**_PLAIN)
def leave(surface, x):
    """End a touch at x: its bottom reaches to there, and the next touch stands on all of it."""
    if surface[COUNT] > surface[STANDING]:
        at = N_HEAD + int(surface[STANDING]) * N_IMPRINT
        surface[at + START] = min(surface[at + START], x)
        surface[at + END] = max(surface[at + END], x)
        wall = _STEEPEST * surface[at + RADIUS]
        surface[at + FIRST] = min(surface[at + FIRST], surface[at + START] - wall)
        surface[at + LAST] = max(surface[at + LAST], surface[at + END] + wall)
    if surface[COUNT] >= MOST:
        _merge(surface)
    surface[STANDING] = surface[COUNT]


@njit(**_PLAIN)
def dent(surface):
    """Largest depth of the flat [m] and the place of that imprint's peak."""
    deepest, place = 0.0, surface[BEGIN]
    for i in range(int(surface[COUNT])):
        at = N_HEAD + i * N_IMPRINT
        for j in (START, END):
            depth, _ = height(surface, surface[COUNT], surface[at + j])
            if depth > deepest:
                deepest, place = depth, surface[at + DEEPEST]
    return deepest, place


@njit(**_PLAIN)
def metal(surface, x, y):
    """Depth of the scar [m] at x along and y across the sliding direction: parabolic walls."""
    depth = 0.0
    for i in range(int(surface[COUNT])):
        at = N_HEAD + i * N_IMPRINT
        d, wall, _ = beside(surface, at, x)
        u, v = d / wall, y / surface[at + RADIUS]
        depth += surface[at + TAKEN] * max(0.0, 1.0 - u * u - v * v)
    return depth


@njit(**_PLAIN)
def _edge(surface, x, y, dx, dy, far, level):
    """How far from `far`, inwards along (-dx, -dy), a scan first finds the scar below `level`."""
    step = math.hypot(dx, dy)
    before, gone = 0.0, 0.0
    while gone < far:
        gone += step
        here = metal(surface, x - gone * dx / step, y - gone * dy / step)
        if here > level:
            return gone - step * (here - level) / (here - before)
        before = here
    return far


@njit(**_PLAIN)
def scar(surface, step, level):
    """Length, width at the deepest place and their difference [m].

    Of the circles of contact; or, `level` above 0, as a profilometer ends them: the scan samples
    every `step`, and the scar ends where it is first `level` below the fresh flat, between two
    samples by a straight line. Zero for a dent that is nowhere so deep, or `NONE` of its radius.
    """
    deepest, place = dent(surface)
    first, last, wide = math.inf, -math.inf, 0.0
    for i in range(int(surface[COUNT])):
        at = N_HEAD + i * N_IMPRINT
        radius = surface[at + RADIUS]
        first = min(first, surface[at + FIRST], surface[at + START] - _STEEPEST * radius)
        last = max(last, surface[at + LAST], surface[at + END] + _STEEPEST * radius)
        wide = max(wide, radius)
    if not deepest > max(level, NONE * wide):
        return 0.0, 0.0, 0.0
    far = last - first
    if level == 0.0:
        return far, 2.0 * wide, far - 2.0 * wide
    step = max(step, far / _SAMPLES)
    length = far - _edge(surface, first, 0.0, -step, 0.0, far, level)
    length -= _edge(surface, last, 0.0, step, 0.0, far, level)
    width = 2.0 * (wide - _edge(surface, place, wide, 0.0, step, wide, level))
    return length, width, length - width
