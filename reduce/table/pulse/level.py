"""The zero of a pulse: the level just before it, whatever the record began with.

A force plate is stood upon before the jump, a logger lies on a table before it falls: what counts
is the last stretch without change before the flank. A foot (a felt, a soft layer) is no such
stretch: a lower one lies before it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ....core.arrays import Array, Indices, Mask
from ...rules import RULES
from ...shared.regression import robust_std


class Level(NamedTuple):
    """The record's zero before a pulse, how well it is known, and a sample's deviation [unit].

    Samples `[first, last)` tell it; none where the record begins in the pulse.
    """

    mean: float
    std: float
    noise: float
    first: int
    last: int

    @property
    def samples(self) -> int:
        """How many samples tell the level."""
        return self.last - self.first


def level_before(up: Array, top: int) -> Level:
    """Return the level before the pulse that peaks upwards at sample `top` of a record (n,)."""
    noise = robust_std(np.diff(up)) / math.sqrt(2.0)
    low = float(np.percentile(up[: top + 1], 5.0))
    height = float(up[top]) - low
    below = np.flatnonzero(up[:top] < low + 0.5 * height)
    edge = int(below[-1]) + 1 if below.size else 0
    width = max(int(0.5 * wide(up, top, low + 0.5 * height)), RULES.fewest_level_samples)
    found = _quiet(up[:edge], width, noise, height, low)
    if found is None:
        few = up[: max(edge // 2, 1)]
        # a trigger leaves nothing before the flank: the record's own zero, as far as it is one
        return Level(0.0, max(noise, abs(float(few.mean()))) if edge else abs(height), noise, 0, 0)
    first, last = _stretch(up, found, width, noise, height)
    part = up[first:last]
    spread = max(float(np.std(part)), 1e-12 * height)
    drift = float(np.polyfit(np.linspace(-0.5, 0.5, part.size), part, 1)[0])
    wander = _wander(part, 2 * width, noise)
    std = math.hypot(spread / math.sqrt(part.size), 0.5 * drift, wander)
    return Level(float(part.mean()), std, spread, first, last)


def _wander(part: Array, long: int, noise: float) -> float:
    """How far means over a pulse's length scatter where it is no chance, as with a hum."""
    count = part.size // long
    if count < 2:
        return 0.0
    means = part[part.size - count * long :].reshape(count, long).mean(axis=1)
    scatter = float(np.std(means, ddof=1))
    return scatter if scatter > RULES.by_chance * noise / math.sqrt(long) else 0.0


def run_of(chosen: Mask, at: int) -> Indices:
    """Return the unbroken run of chosen samples around one of them."""
    out = np.flatnonzero(~chosen)
    low = out[out < at].max(initial=-1)
    return np.arange(low + 1, out[out > at].min(initial=chosen.size))


def wide(up: Array, top: int, half: float) -> int:
    """Return how many steps around the top lie above a value, those over its flanks among them."""
    return run_of(up >= half, top).size + 1


def _quiet(up: Array, width: int, noise: float, height: float, low: float) -> int | None:
    """Beginning of the last window without a trend; of those within a foot's reach the lowest."""
    best, mean_of_best, since = None, math.inf, 0
    for first in range(up.size - width, -1, -max(width // 4, 1)):
        since += 1
        part = up[first : first + width]
        mean = float(part.mean())
        trend = float(np.polyfit(np.linspace(-0.5, 0.5, width), part, 1)[0])
        known = 4.0 * noise * math.sqrt(12.0 / width)
        flat = abs(trend) < max(known, RULES.level_trend * height)
        quiet = flat and np.ptp(part) < max(8.0 * noise, 2.0 * RULES.level_trend * height)
        if quiet and mean < low + 0.35 * height:
            lower = mean < mean_of_best - max(known, 0.2 * RULES.level_trend * height)
            if best is None:
                if _is_level(up[slice(*_stretch(up, first, width, noise, height))], width, noise):
                    return first
            if best is None or lower:
                best, mean_of_best, since = first, mean, 0
        if best is not None and since > 4 * RULES.foot_reach:
            break
    return best


def _is_level(part: Array, width: int, noise: float) -> bool:
    """Whether a stretch is longer than a foot and does not rise as a foot does."""
    rise = float(np.polyfit(np.linspace(-0.5, 0.5, part.size), part, 1)[0])
    return part.size > 2 * width and abs(rise) < 4.0 * noise * math.sqrt(12.0 / part.size)


def _stretch(up: Array, first: int, width: int, noise: float, height: float) -> tuple[int, int]:
    """The window made longer to both sides as long as it keeps its level."""
    level = float(np.mean(up[first : first + width]))
    near = max(5.0 * noise, RULES.level_trend * height)
    away = np.abs(up - level) > near
    before, after = np.flatnonzero(away[:first]), np.flatnonzero(away[first + width :])
    start = int(before[-1]) + 1 if before.size else 0
    end = first + width + int(after[0]) if after.size else up.size
    # a flank or a foot begins before the last sample that is still quiet: a pulse's length
    unsure = max(min(3 * width, (end - start) // 2), 1)
    return start, max(end - unsure, min(start + width, end))
