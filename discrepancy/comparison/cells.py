"""Cells: one observable at one condition, the mean of its repeats and its standard error."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...core.arrays import Array, Indices, Mask
from ...core.observables import OBSERVABLES
from ...core.tables import counted
from ..curves.readings import Readings
from ..rules import RULES
from ..unknowns.repeats import Drift, Entries, Followed, drift_of, followed_of
from .conditions import Condition


@dataclass(frozen=True, eq=False)
class Cells:
    """The measured numbers, m of them.

    `condition`, `observable`: index of the condition and name of the observable; `value`, `std`:
    mean (of the logarithm where logarithmic) and its standard error; `count`: readings behind it.
    """

    condition: Indices
    observable: tuple[str, ...]
    value: Array
    std: Array
    count: Indices

    def __len__(self) -> int:
        return len(self.value)

    @cached_property
    def is_log(self) -> Mask:
        """Whether each cell is a logarithm."""
        return np.array([OBSERVABLES[name].log for name in self.observable], dtype=bool)

    def take(self, which: Mask) -> Cells:
        """Return some of them."""
        observable = tuple(n for n, here in zip(self.observable, which, strict=True) if here)
        return Cells(
            self.condition[which], observable, self.value[which], self.std[which],
            self.count[which],
        )  # fmt: skip

    def and_new(self, rows: Sequence[tuple[int, str, float]]) -> Cells:
        """Return them before cells of one reading that was not made yet.

        `rows`: condition, observable and standard error of each.
        """
        condition, observable, std = zip(*rows, strict=True) if rows else ((), (), ())
        n = len(rows)
        index, one = np.array(condition, dtype=np.intp), np.ones(n, dtype=np.intp)
        return joined([self, Cells(index, observable, np.zeros(n), np.array(std), one)])


def joined(parts: Sequence[Cells]) -> Cells:
    """Return the cells of several, one behind another."""
    condition, value, std, count = (
        np.concatenate([getattr(p, key) for p in parts])
        for key in ("condition", "value", "std", "count")
    )
    return Cells(condition, tuple(n for p in parts for n in p.observable), value, std, count)


NO_CELLS = Cells(
    np.zeros(0, dtype=np.intp), (), np.zeros(0), np.zeros(0), np.zeros(0, dtype=np.intp)
)


class Scatter(NamedTuple):
    """Repeats of one observable that differ more than their noise: how many times, on how many."""

    observable: str
    ratio: float
    degrees: int


class ReducedRepeats(NamedTuple):
    """What the readings come to: the cells, what is odd about the repeats, and notes."""

    cells: Cells
    drifts: tuple[Drift, ...]
    scatters: tuple[Scatter, ...]
    followed: tuple[Followed, ...]
    notes: tuple[str, ...]


class _Repeats(NamedTuple):
    """Repeats of one observable at one condition, at the condition's mean speed: (n,) each.

    `trial` is the row of trials.csv, `place` the place in the order of testing from 0 to 1; `std`
    is that of the reading, `apart` that by which repeats differ: with the error of their speeds,
    which moved the value to the mean speed.
    """

    trial: Indices
    place: Array
    value: Array
    std: Array
    apart: Array

    def take(self, which: Mask) -> _Repeats:
        """Return some of them."""
        return _Repeats(
            self.trial[which], self.place[which], self.value[which], self.std[which],
            self.apart[which],
        )  # fmt: skip


class _Compared(NamedTuple):
    """One observable over all conditions: cells, repeats, how many fell out, how they scatter."""

    cells: Cells
    repeats: list[_Repeats]
    dropped: int
    scatter: Scatter | None


def compared(name: str, values: Array) -> Array:
    """Return values as they are compared: their logarithm, where the observable asks for it."""
    # nothing is read below a nanometre or nanosecond, and a cliff bends what lies beside it
    return np.log(np.maximum(values, 1e-9)) if OBSERVABLES[name].log else values


def cells_of(
    readings: Mapping[str, Readings],
    speeds: Array,
    order: Array,
    conditions: Sequence[Condition],
    varied: Mapping[str, Sequence[str]],
) -> ReducedRepeats:
    """Return the cells of a set, and what its repeats say of themselves.

    - `readings`: every observable's values over the trials.
    - `speeds`, `order`: normal speed [m/s] (load of a press [N]) and place in the order of testing
      of every trial, shape (n,).
    - `conditions`: the nominal impacts.
    - `varied`: entries of the columns `x_NAME` over the trials, by the column's name.
    """
    place = order / np.nanmax(order) if np.isfinite(order).any() else np.full(len(speeds), np.nan)
    found = {name: _compared(name, r, speeds, place, conditions) for name, r in readings.items()}
    dropped = sum(one.dropped for one in found.values())
    text = f"left out, far off their repeats: {counted(dropped, 'value')}"
    notes = (text,) if dropped else ()
    drifts = [
        drift_of(n, [(r.place, r.value, r.apart) for r in one.repeats], observables=len(found))
        for n, one in found.items()
    ]
    followed = tuple(_followed(found, varied))
    known = {f.observable for f in followed}
    return ReducedRepeats(
        joined([NO_CELLS, *(one.cells for one in found.values())]),
        tuple(d for d in drifts if d is not None),
        tuple(
            one.scatter
            for name, one in found.items()
            # what a column explains is no scatter of unknown cause
            if one.scatter is not None and name not in known
        ),
        followed, notes,
    )  # fmt: skip


def _followed(
    found: Mapping[str, _Compared], varied: Mapping[str, Sequence[str]]
) -> Iterator[Followed]:
    for column, entries in varied.items():
        for name, one in found.items():
            repeats = [
                Entries(tuple(entries[i] for i in r.trial), r.value, r.apart) for r in one.repeats
            ]
            seen = followed_of(column, name, repeats, tested=len(found) * len(varied))
            if seen is not None:
                yield seen


def _compared(
    name: str, read: Readings, speeds: Array, place: Array, conditions: Sequence[Condition]
) -> _Compared:
    parted = [_repeats(name, read, speeds, place, c) for c in conditions]
    kept = [_kept(r.value, r.apart) for r in parted]
    total, dropped = sum(len(k) for k in kept), sum(int(np.sum(~k)) for k in kept)
    if dropped > max(1.0, RULES.wild * total):
        # so many are no slips: their scatter is the noise
        kept, dropped = [np.ones(len(k), dtype=bool) for k in kept], 0
    rows, repeats = [], []
    squares, degrees = 0.0, 0
    for number, (all_of, keep) in enumerate(zip(parted, kept, strict=True)):
        if not keep.any():
            continue
        r = all_of.take(keep)
        repeats.append(r)
        weight = 1.0 / r.std**2
        mean = float(np.sum(weight * r.value) / np.sum(weight))
        squares += float(np.sum(((r.value - mean) / r.apart) ** 2))
        degrees += len(keep[keep]) - 1
        rows.append((number, mean, float(np.sum(weight) ** -0.5), int(keep.sum())))
    ratio = squares / degrees if degrees >= RULES.own_scatter else 1.0
    scatter = None
    if ratio > 1.0 + 3.0 * math.sqrt(2.0 / max(degrees, 1)):
        scatter = Scatter(name, math.sqrt(ratio), degrees)
    return _Compared(_floored(name, rows, scatter), repeats, dropped, scatter)


def _floored(
    name: str, rows: Sequence[tuple[int, float, float, int]], scatter: Scatter | None
) -> Cells:
    """Cells of an observable from condition, mean, standard error and number of readings."""
    condition, value, std, count = np.array(rows).reshape(-1, 4).T
    std = std * (scatter.ratio if scatter else 1.0)
    size = 1.0
    if len(value) and not OBSERVABLES[name].log:
        size = float(np.sqrt(np.mean([x**2 for x in value.tolist()])))
    floor = np.minimum(RULES.gauge_floor * size, RULES.noise_floor * (std * np.sqrt(count)))
    return Cells(
        condition.astype(np.intp), (name,) * len(value), value, np.hypot(std, floor),
        count.astype(np.intp),
    )  # fmt: skip


def _repeats(name: str, read: Readings, speeds: Array, place: Array, c: Condition) -> _Repeats:
    """Readings of one observable at one condition, at its mean speed, as they are compared."""
    values = read.value
    # a value of zero with a fractional noise is not exact
    std = np.maximum(read.std, 0.01 * np.sqrt(np.nanmean(values**2)) * (read.std <= 0.0))
    log = OBSERVABLES[name].log
    index = np.array([i for i in c.trials if np.isfinite(values[i])], dtype=np.intp)
    if log:
        index = index[values[index] > 0.0]
    y = np.log(values[index]) if log else values[index]
    s = std[index] / np.abs(values[index]) if log else std[index]
    # with the power that a plastic contact has, d y / d ln v
    mean = c.speed if c.press is None else c.press.load
    power = OBSERVABLES[name].power * (np.ones(y.shape) if log else y)
    y = y - power * np.log(speeds[index] / mean)
    # a height that was set once is off for all alike
    off = 0.0 if c.setting else c.speed_spread * math.sqrt(len(c.trials))
    return _Repeats(index, place[index], y, s, np.hypot(s, power * off))


def _kept(y: Array, s: Array) -> Mask:
    """Repeats (three or more) that lie within 5 standard deviations of their median.

    Where most of four or more do not, the stated noise is too small and says nothing of single
    ones; of three the middle one stands.
    """
    everything = np.ones(len(y), dtype=bool)
    if len(y) < 3:
        return everything
    near = np.abs(y - np.median(y)) < 5.0 * s
    if len(y) > 3 and 2 * np.sum(near) < len(y):
        return everything
    return np.asarray(near)
