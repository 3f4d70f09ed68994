"""Loadings and unloadings of a press: where each turns, and what the record shows of it.

A cycle is a rise of the load to a largest one and its fall after it. Where machine and test give
way together the depth that belongs to a load without rate is the one at which unloading begins,
after a hold.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.signal import find_peaks

from ...core.arrays import Array, Indices
from ..gates import Refused
from ..rules import RULES
from ..shared.regression import robust_std
from .columns import PressRecord

_HELD = 0.01
"""Part of the load by which it may vary in a hold [-]: class 1 of ISO 7500-1."""


class Cycle(NamedTuple):
    """One loading and unloading.

    Largest load [N], first reached in row `begin`; unloading begins in row `turn` and goes on to
    the least load, a part of the largest. `beyond` where it goes beyond every load before.
    """

    peak: float
    begin: int
    turn: int
    unloading: Indices
    least: float
    beyond: bool


def noise_of(values: Array) -> float:
    """Standard deviation of a sample about a smooth course."""
    return robust_std(np.diff(values, n=2)) / math.sqrt(6.0) if values.size > 4 else 0.0


def cycles_of(record: PressRecord) -> tuple[Cycle, ...]:
    """Return the cycles of a record in their order.

    Refuses a load that is not above the noise, rows without numbers at the largest load, a load
    cell at its end, and no unloading.
    """
    load, source = record.load, record.source
    if load.size < RULES.table_rows:
        raise Refused(
            f"{load.size} rows with a load and a depth", source=source, key="load",
            allowed=f"{RULES.table_rows} or more",
        )  # fmt: skip
    noise = noise_of(load)
    top = float(load.max())
    if not top > RULES.pulse_over_noise * noise:
        raise Refused(
            f"the largest load is {top / max(noise, 1e-300):.2g} times the noise",
            source=source, key="load", allowed="a press above the noise of the load cell",
        )  # fmt: skip
    deep = max(RULES.cycle_depth * top, RULES.pulse_over_noise * noise)
    padded = np.concatenate([[load.min() - deep], load, [load.min() - deep]])
    peaks = find_peaks(padded, prominence=deep)[0] - 1
    found: list[Cycle] = []
    for at, last in pairwise([*map(int, peaks), load.size]):
        before = max((c.peak for c in found), default=0.0)
        found.append(_cycle(load, at, last, noise, before))
    _check(record, found)
    return tuple(found)


def _cycle(load: Array, at: int, last: int, noise: float, before: float) -> Cycle:
    peak = float(load[at])
    held = peak - max(_HELD * peak, 3.0 * noise)
    valley = at + int(np.argmin(load[at:last]))
    near = np.flatnonzero(load[at : valley + 1] >= held)
    turn = at + int(near[-1])
    first = at - int(np.argmax(load[at::-1] < held)) + 1 if (load[:at] < held).any() else 0
    top = load[first : turn + 1]
    peak = float(np.median(top[top >= peak - 4.0 * noise]))  # the highest sample is the noise's
    return Cycle(
        peak, first, turn, np.arange(turn, valley + 1), float(load[valley]) / peak,
        peak > (1.0 + _HELD) * before,
    )  # fmt: skip


def _check(record: PressRecord, found: Sequence[Cycle]) -> None:
    """Refuse a record whose largest press is not whole."""
    largest = max(found, key=lambda c: c.peak)
    after = np.flatnonzero(record.gap[1:]) + 1
    before, missing = record.load[after - 1], record.gap[after]
    rise = (before - record.load[np.maximum(after - 6, 0)]) / np.minimum(after - 1, 5).clip(1)
    within = np.maximum(before + np.maximum(rise, 0.0) * missing, record.load[after])
    long = missing > RULES.hole * (largest.unloading[-1] - largest.begin)
    if (long | (within > (1.0 - RULES.hole) * largest.peak)).any():
        raise Refused(
            "rows without a number at the largest load, or many",
            source=record.source, key="load", allowed="a load cell whose range is not reached",
        )  # fmt: skip
    for cycle in found:
        top = record.load[cycle.begin : cycle.turn + 1]
        equal = cycle.begin + np.flatnonzero(top == record.load.max())
        grown = np.ptp(record.depth[equal]) if equal.size >= RULES.flat_samples else 0.0
        if grown > RULES.clipped_depth * np.ptp(record.depth):
            raise Refused(
                f"{equal.size} equal loads at the top while the depth grows: clipped",
                source=record.source, key="load", allowed="a load cell whose range is not reached",
            )  # fmt: skip
    if largest.least > RULES.least_unloaded:
        raise Refused(
            f"after its largest value the load falls to {largest.least:.0%} of it",
            source=record.source, key="load", allowed="a press that is taken off again",
        )  # fmt: skip


def virgin(load: Array, stop: int) -> Indices:
    """Indices up to one that load the metal further than all before."""
    before = np.maximum.accumulate(np.concatenate([[-np.inf], load[:stop]]))[:-1]
    return np.flatnonzero(load[:stop] > before)
