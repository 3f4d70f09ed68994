"""The area under a pulse, with what a soft foot and a ringing add to it.

Between the ends of its flanks lies the pulse of two bodies that touch; a felt, a cable or a table
that rings moves the striker before and after. The area is taken from where the level is left; after
a ringing it is the mean over the swings.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import cumulative_trapezoid

from ....core.arrays import Array
from ...measured import Measured
from ...rules import RULES
from .level import Level
from .shape import Shape


class Area(NamedTuple):
    """Area [unit s], and what was done.

    Of a foot: how long before the flank it begins [s], and how high it is there [unit].
    """

    area: Measured
    early: float
    foot: float
    notes: tuple[str, ...]


def area_of(
    time: Array, clear: Array, level: Level, shape: Shape, ends: tuple[Measured, Measured]
) -> Area:
    """Return the area under a pulse that begins and ends at `ends` [s].

    Of a record (n,) with its level before the pulse taken off, the pulse upwards. Its error holds
    the noise, the level's error over the time that is taken, and the pulse's form; half of the
    level afterwards or, of a ringing, what the halves of its swings differ by.
    """
    start, end = (e.value for e in ends)
    long, step = end - start, float(np.median(np.diff(time)))
    # with one more sample on each side: the sum over all is right in the mean over their phases
    inside = (np.append(time[1:], np.inf) >= start) & (np.append(-np.inf, time[:-1]) <= end)
    core = float(np.trapezoid(clear[inside], time[inside]))
    notes: list[str] = []
    foot, height, early, since = 0.0, 0.0, 0.0, start
    before = (time >= time[min(level.last, time.size - 1)]) & (time < start) & ~inside
    if level.samples and before.sum() > 1:
        both = before | inside
        foot = float(np.trapezoid(clear[both], time[both])) - core
        reach = start - float(time[level.last])
        noise = level.noise * step * math.sqrt(int(before.sum()))
        if abs(foot) > max(3.0 * math.hypot(noise, level.std * reach), RULES.foot_part * abs(core)):
            since = start - reach
            last = (time >= min(start - 0.1 * long, float(time[before][-1]))) & before
            height = max(float(clear[last].mean()), 0.0)
            if foot > 0.0 and height > 0.0:  # it rises as a ramp does
                early = min(2.0 * foot / height, reach)
            notes.append(
                f"a foot before the flank, {foot / core:+.0%} of the area, is part of it: the "
                "contact may begin with it"
            )
        else:
            foot = 0.0
    if shape.ringing:
        core, off, reach, count = _after(time, clear, shape, float(time[inside][0]), end)
        notes.append("the area is the mean over the swings after it")
    else:
        off, reach, count = 0.5 * shape.level_after * abs(clear.max()) * long, 0.0, 0.0
    count += int(((time >= since) & (time <= end)).sum())
    scatter = level.noise * step * math.sqrt(max(count, 1.0))
    # what the phase leaves of the ends of a half-sine (L. Euler, C. Maclaurin)
    phase = math.pi**2 / 4.0 / math.sqrt(90.0) * (step / long) ** 2
    form = math.hypot(RULES.form, phase) * core
    std = math.hypot(scatter, level.std * (end - since + reach), off, form)
    return Area(Measured(core + foot, std), early, height, tuple(notes))


def _after(
    time: Array, clear: Array, shape: Shape, start: float, end: float
) -> tuple[float, float, float, float]:
    """Mean of the area up to the instants of the ringing, and half by what its halves differ.

    Then their mean age, and the samples that scatter as much as the mean of sums over them.
    """
    last = end + RULES.ring_reach * (end - start)
    # another blow ends the ringing of this one
    last = min([last, *(t - (end - start) for t in shape.others if t > end)])
    part = (time >= start) & (time <= max(last, end))
    whole = cumulative_trapezoid(clear[part], time[part], initial=0.0)
    swings = whole[time[part] >= end]
    halves = [float(half.mean()) for half in np.array_split(swings, 2) if half.size]
    age = 0.5 * (float(time[part][-1]) - end)
    return float(swings.mean()), 0.5 * (halves[-1] - halves[0]), age, swings.size / 3.0
