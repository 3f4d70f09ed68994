"""Cells: one observable at one condition, the mean of its repeats and its standard error."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.observables import OBSERVABLES
from .conditions import Condition
from .curves import Readings
from .drift import Drift, drift_of

Array = NDArray[np.float64]
Ints = NDArray[np.intp]

# what repeats cannot average away: gauges, definitions; of the value, and of one reading's noise
_FLOOR, _FLOOR_OF_NOISE = 0.004, 0.5
_ENOUGH = 8  # repeats beyond the first from which their own scatter is trusted


@dataclass(frozen=True, eq=False)
class Cells:
    """The measured numbers, m of them.

    Parameters
    ----------
    condition, observable
        Index of the condition and name of the observable.
    value, std
        Mean (of the logarithm where logarithmic) and its standard error.
    count
        Trials behind it.
    """

    condition: Ints
    observable: tuple[str, ...]
    value: Array
    std: Array
    count: Ints

    def __len__(self) -> int:
        return len(self.value)

    @cached_property
    def is_log(self) -> NDArray[np.bool_]:
        """Whether each cell is a logarithm."""
        return np.array([OBSERVABLES[name].log for name in self.observable], dtype=bool)


NO_CELLS = Cells(
    np.zeros(0, dtype=np.intp), (), np.zeros(0), np.zeros(0), np.zeros(0, dtype=np.intp)
)


class _Mean(NamedTuple):
    """One cell before the floor of its standard error."""

    condition: int
    observable: str
    value: float
    std: float
    trials: int


class _Repeats(NamedTuple):
    """Repeats of one observable at one condition, at the condition's mean speed: (n,) each."""

    place: Array
    value: Array
    std: Array


class _Compared(NamedTuple):
    """One observable over all conditions: means, the repeats behind them, how many fell out."""

    means: list[_Mean]
    repeats: list[_Repeats]
    dropped: int
    note: str


def compared(name: str, values: Array) -> Array:
    """Return values as they are compared: their logarithm, where the observable asks for it."""
    return np.log(np.maximum(values, 1e-12)) if OBSERVABLES[name].log else values


def cells_of(
    readings: Mapping[str, Readings], speeds: Array, order: Array, conditions: Sequence[Condition]
) -> tuple[Cells, tuple[Drift, ...], tuple[str, ...]]:
    """Return the cells of a set, what drifts over the order of testing, and notes.

    Parameters
    ----------
    readings
        Every observable's values over the trials.
    speeds, order
        Normal speed [m/s] and place in the order of testing of every trial, shape (n,).
    conditions
        The nominal impacts.
    """
    place = order / np.nanmax(order) if np.isfinite(order).any() else np.full(len(speeds), np.nan)
    found = {name: _compared(name, r, speeds, place, conditions) for name, r in readings.items()}
    notes = [one.note for one in found.values() if one.note]
    dropped = sum(one.dropped for one in found.values())
    if dropped:
        notes.append(f"{dropped} single values lie far off their repeats and were left out")
    drifts = [drift_of(n, one.repeats, observables=len(found)) for n, one in found.items()]
    means = [mean for one in found.values() for mean in one.means]
    size = {n: _rms([m.value for m in one.means]) for n, one in found.items() if one.means}
    std = np.array([m.std for m in means])
    of_value = np.array([
        _FLOOR * (1.0 if OBSERVABLES[m.observable].log else size[m.observable]) for m in means
    ])  # fmt: skip
    one_reading = std * np.sqrt([m.trials for m in means])
    floor = np.minimum(of_value, _FLOOR_OF_NOISE * one_reading)
    cells = Cells(
        np.array([m.condition for m in means], dtype=np.intp),
        tuple(m.observable for m in means),
        np.array([m.value for m in means]),
        np.hypot(std, floor),
        np.array([m.trials for m in means], dtype=np.intp),
    )
    return cells, tuple(d for d in drifts if d is not None), tuple(notes)


def _compared(
    name: str, read: Readings, speeds: Array, place: Array, conditions: Sequence[Condition]
) -> _Compared:
    values = read.value
    # a value of zero with a fractional noise is not exact
    std = np.maximum(read.std, 0.01 * np.sqrt(np.nanmean(values**2)) * (read.std <= 0.0))
    log = OBSERVABLES[name].log
    means, repeats, dropped = [], [], 0
    squares, degrees = 0.0, 0
    for k, c in enumerate(conditions):
        index = np.array([i for i in c.trials if np.isfinite(values[i])], dtype=np.intp)
        if log:
            index = index[values[index] > 0.0]
        if index.size == 0:
            continue
        y = np.log(values[index]) if log else values[index]
        s = std[index] / np.abs(values[index]) if log else std[index]
        # to the condition's mean speed, with the power that a plastic contact has
        y = y - _power(name, y) * np.log(speeds[index] / c.speed)
        keep = _kept(y, s)
        dropped += int(np.sum(~keep))
        y, s = y[keep], s[keep]
        repeats.append(_Repeats(place[index[keep]], y, s))
        weight = 1.0 / s**2
        mean = float(np.sum(weight * y) / np.sum(weight))
        squares += float(np.sum(((y - mean) / s) ** 2))
        degrees += len(y) - 1
        means.append(_Mean(k, name, mean, float(np.sum(weight) ** -0.5), len(y)))
    ratio = squares / degrees if degrees >= _ENOUGH else 1.0
    if ratio <= 1.0 + 3.0 * math.sqrt(2.0 / max(degrees, 1)):
        return _Compared(means, repeats, dropped, "")
    wider = [m._replace(std=m.std * math.sqrt(ratio)) for m in means]
    note = (
        f"{name}: repeats scatter {math.sqrt(ratio):.1f} times as much as stated; their scatter is "
        "used"
    )
    return _Compared(wider, repeats, dropped, note)


def _rms(values: Sequence[float]) -> float:
    return float(np.sqrt(np.mean([x**2 for x in values])))


def _power(name: str, y: Array) -> Array:
    """D y / d ln v, y a logarithm or not."""
    row = OBSERVABLES[name]
    return np.full(y.shape, row.power) if row.log else row.power * y


def _kept(y: Array, s: Array) -> NDArray[np.bool_]:
    """Repeats (three or more) that lie within 5 standard deviations of their median.

    Where most of four or more do not, the stated noise is too small and says nothing of single
    ones; of three the middle one stands.
    """
    near = np.abs(y - np.median(y)) < 5.0 * s
    if len(y) < 3 or (len(y) > 3 and 2 * np.sum(near) < len(y)):
        return np.ones(len(y), dtype=bool)
    return np.asarray(near)
