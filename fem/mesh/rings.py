"""Radii of the element rings: fine about the contact edge, growing smoothly inside and outside.

All rings stand on one ladder of radii in constant ratio, four rungs to a fine ring. Meshes made for
different contact radii share the fine rings that both have, and what is known there passes from one
to the other without interpolation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array
from ..rules import RULES


@dataclass(frozen=True)
class Zone:
    """Range of radii through which the contact edge may pass on one mesh [R]."""

    low: float
    high: float

    def allowed(self, r: float, *, fine: float, coarse: float) -> float:
        """Largest ring width over radius at radius `r`: doubled step by step away from the zone."""
        if self.low <= r <= self.high:
            return fine
        if r > self.high:
            return max(fine, coarse * widening(r / self.high))
        inside = self.low / r
        twice, all_coarse = RULES.inside_zone
        if inside <= twice:
            return min(2.0 * fine, coarse)
        return coarse if inside <= all_coarse else 2.0 * coarse


def widening(x: float) -> float:
    """Ring width over radius at `x` times where the edge may come, in units of the coarse one.

    The strain energy of a shell falls as 1/r, and what a ring of relative width h adds to the
    stiffness as h^2 of that: least in sum, for so many rings, where h grows as r^(1/3).
    """
    return min(0.4 * math.cbrt(x), 1.2)


def ladder_rings(zone: Zone, *, core: float, end: float, fine: float, coarse: float) -> Array:
    """Ring radii from about `core` to `end`, increasing, shape (n,) [R].

    The first is moved to the next rung below. `fine` and `coarse` are ring widths over radius in
    the zone, and beyond twice its neighbourhood.
    """
    ring = RULES.ring_divisions
    rung = math.log1p(fine) / ring
    first = math.floor(math.log(core / end) / rung)
    low = max(ring * math.floor(math.log(zone.low / end) / (rung * ring)), first)
    high = min(ring * math.ceil(math.log(zone.high / end) / (rung * ring)), 0)

    def strides(start: int, stop: int, direction: int) -> list[int]:
        k, stride, found = start, ring, []
        while k * direction < stop * direction:
            width = zone.allowed(end * math.exp(rung * k), fine=fine, coarse=coarse)
            widest = max(ring, int(width / fine * ring * 1.001))
            stride = min(max(stride + 1, int(RULES.ring_growth * stride)), widest)
            k += direction * stride
            found.append(k)
        if found:  # the last ring ends where it must; a thin one is joined to its neighbour
            found[-1] = stop
            if len(found) > 1 and abs(stop - found[-2]) < stride // 2:
                del found[-2]
        return found

    inside = strides(low, first, -1)[::-1]
    middle = [*range(low, high, ring), high]
    rungs = np.array(inside + middle + strides(high, 0, 1), dtype=float)
    return np.asarray(end * np.exp(rung * rungs))


def outer_rings(start: float, end: float, *, coarse: float) -> Array:
    """Ring radii from `start` (included) to `end`, their relative width growing outwards.

    The deepest contacts reach nearly up to `start`, hence the same law, a half wider.
    """
    radii = [start]
    while radii[-1] < end:
        radii.append(radii[-1] * (1.0 + 1.5 * coarse * widening(radii[-1] / start)))
    r = np.array(radii)
    return np.asarray(start * (r / start) ** (math.log(end / start) / math.log(r[-1] / start)))
