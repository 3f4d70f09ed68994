"""How noisy each measured number is: from its own column, from set.toml, or from repeats."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..core.arrays import Array, Indices
from ..core.observables import RELATIVE_SUFFIX
from .rules import RULES


@dataclass(frozen=True, slots=True)
class Noise:
    """Standard deviation of an observable, shape (n,), and where it comes from in words.

    `std` is NaN where the observable was not measured; `degrees` counts the degrees of freedom
    when repeats gave it, and is infinite for a stated noise.
    """

    std: Array
    origin: str
    degrees: float = float("inf")


def noise_of(
    name: str, values: Array, stated: Array | None, table: Mapping[str, float], groups: Indices
) -> Noise:
    """Return the noise of one observable (n,): column, then set.toml, then repeats.

    `stated` is the column `NAME_std` (n,) or `None`; in `table`, `[noise]` of set.toml, `NAME` and
    `NAME_relative` add as squares; `groups` numbers the condition of each row (n,). Repeats: the
    standard deviation within conditions that have at least three trials, pooled over them; as a
    fraction of the mean if every value is above zero, as a number otherwise. NaN at measured rows
    when nothing gives a noise.
    """
    std = np.full(values.shape, np.nan)
    origins, degrees = [], float("inf")
    measured = ~np.isnan(values)
    if stated is not None:
        std = np.where(measured, stated, np.nan)
        if not np.isnan(std).all():
            origins.append("column")
    rest = measured & np.isnan(std)
    keys = [key for key in (name, name + RELATIVE_SUFFIX) if key in table]
    if rest.any() and keys:
        absolute = table.get(name, 0.0)
        fraction = table.get(name + RELATIVE_SUFFIX, 0.0) * np.abs(values)
        std = np.where(rest, np.hypot(absolute, fraction), std)
        origins.append("set.toml")
    elif rest.any():
        scatter, degrees = _scatter(values, groups)
        if degrees > 0:
            std = np.where(rest, scatter, std)
            origins.append(f"repeats ({degrees:.0f} degrees of freedom)")
        else:
            degrees = float("inf")
    return Noise(std, " and ".join(origins) or "unknown", degrees)


def _scatter(values: Array, groups: Indices) -> tuple[Array, float]:
    positive = bool(np.all(values[~np.isnan(values)] > 0.0))
    squares, degrees = 0.0, 0
    known = np.flatnonzero(~np.isnan(values))
    order = known[np.argsort(groups[known], kind="stable")]
    starts = np.flatnonzero(np.diff(groups[order])) + 1
    for inside in np.split(values[order], starts):
        if inside.size >= RULES.repeats:
            mean = inside.mean()
            squares += float(np.sum(((inside - mean) / (mean if positive else 1.0)) ** 2))
            degrees += inside.size - 1
    if degrees == 0 or squares == 0.0:
        return np.full(values.shape, np.nan), 0.0
    std = np.sqrt(squares / degrees)
    return (std * np.abs(values) if positive else np.full(values.shape, std)), float(degrees)


def bins(values: Array, *, width: float) -> Indices:
    """Number the values so that those of one bin differ by at most `width`, shape (n,).

    Bins are opened from the smallest value upward; every NaN is in bin -1.
    """
    numbers = np.full(values.shape, -1, dtype=np.intp)
    start, bin_number = -np.inf, -1
    for i in np.argsort(values):
        if np.isnan(values[i]):
            continue
        if values[i] - start > width:
            start, bin_number = values[i], bin_number + 1
        numbers[i] = bin_number
    return numbers


def numbered(*columns: Sequence[object]) -> Indices:
    """Number the distinct combinations of some columns of n entries each, shape (n,)."""
    places: dict[tuple[object, ...], int] = {}
    rows = zip(*columns, strict=True)
    return np.array([places.setdefault(row, len(places)) for row in rows], dtype=np.intp)
