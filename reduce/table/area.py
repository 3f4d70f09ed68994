"""The area under a pulse, with what a soft foot and a ringing add to it.

Between the ends of its flanks lies the pulse of two bodies that touch; a felt, a cable or a table
that rings moves the striker before and after. The area is taken from where the level is left; after
a ringing it is the mean over the swings. What is added widens the error.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import cumulative_trapezoid

from ...core.arrays import Array
from ..measured import Measured
from ..rules import RULES
from .level import Level
from .shape import Shape


class Area(NamedTuple):
    """Area [unit s], how much earlier the contact may begin [s], and what was done."""

    area: Measured
    early: float
    notes: tuple[str, ...]


def area_of(
    time: Array, clear: Array, level: Level, shape: Shape, ends: tuple[Measured, Measured]
) -> Area:
    """Return the area under a pulse.

    Parameters
    ----------
    time, clear
        (n,): the record, its level before the pulse taken off, the pulse upwards.
    level, shape
        What is before and beside the pulse.
    ends
        Where its flanks meet zero [s].
    """
    start, end = (e.value for e in ends)
    long, step = end - start, float(np.median(np.diff(time)))
    inside = (time >= start) & (time <= end)
    core = float(np.trapezoid(clear[inside], time[inside]))
    scatter = level.noise * step * math.sqrt(max(int(inside.sum()), 1))
    drift, late = level.std * long, 0.5 * shape.level_after * abs(clear.max()) * long
    area, std = core, math.hypot(scatter, drift, late, RULES.form * core)
    notes: list[str] = []
    early, foot = 0.0, 0.0
    if level.samples and level.last < time.size and time[level.last] < start:
        before = (time >= time[level.last]) & (time < start)
        foot = float(np.trapezoid(clear[before], time[before])) if before.sum() > 1 else 0.0
        sure = 3.0 * level.noise * step * math.sqrt(max(int(before.sum()), 1))
        sure = math.hypot(sure, 3.0 * level.std * (start - float(time[level.last])))
        if abs(foot) > max(sure, RULES.foot_part * abs(core)):
            early = 0.5 * (start - float(time[level.last])) if foot > 0.0 else 0.0
            area, std = area + foot, math.hypot(std, 0.25 * foot)
            notes.append(
                f"a foot before the flank, {foot / core:+.0%} of the area, is part of it: the "
                "contact may begin with it"
            )
        else:
            foot = 0.0
    if shape.ringing:
        mean, spread, reach = _after(time, clear, shape, start, end)
        area, std = foot + mean, math.hypot(std, spread, 0.25 * (mean - core), level.std * reach)
        notes.append(f"the area is the mean over the swings after it, {mean / core - 1.0:+.0%}")
    return Area(Measured(area, std), early, tuple(notes))


def _after(
    time: Array, clear: Array, shape: Shape, start: float, end: float
) -> tuple[float, float, float]:
    """Mean and half the spread of the area up to the instants of the ringing; their mean age."""
    last = end + RULES.ring_reach * (end - start)
    # another blow ends the ringing of this one
    last = min([last, *(t - (end - start) for t in shape.others if t > end)])
    part = (time >= start) & (time <= max(last, end))
    whole = cumulative_trapezoid(clear[part], time[part], initial=0.0)
    swings = whole[time[part] >= end]
    age = 0.5 * (float(time[part][-1]) - end)
    return float(swings.mean()), 0.5 * float(swings.std()), age
