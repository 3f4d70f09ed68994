"""Traces and profiles as numbers: one reduction for the recording, its noise and the simulation.

A curve enters the comparison through what an instrument of its frame rate and noise can hold: from
the tip's height the slopes before and after the contact, the largest depth and the time below the
undisturbed flat; from the force its peak, its impulse, its duration and the time to the peak; from
a profile the depth of the crater. Time zero is arbitrary, so only differences of times are used.
The standard deviation of each number is that of the same reduction over the curve with its noise
added again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..recordings import RecordingSet

Array = NDArray[np.float64]
Numbers = dict[str, float]

FROM_CURVES = ("peak_depth_m", "below_flat_s", "normal_impulse_Ns", "loading_time_s")
"""Numbers that only curves give; simulated by the same names."""

FEWEST = 5
"""Samples within the contact that a number of the contact needs."""

_AGAIN = 40  # copies of a curve with fresh noise
_FLOORS = {
    "peak_depth_m": 0.01, "below_flat_s": 0.005, "normal_impulse_Ns": 0.005,
    "loading_time_s": 0.02, "contact_time_s": 0.01, "peak_force_N": 0.005, "restitution": 0.002,
    "permanent_depth_m": 0.01,
}  # fmt: skip
"""What a reduction may be off by itself, as a fraction: scale of the length, ends of the force."""


@dataclass(frozen=True, eq=False)
class Readings:
    """Values of one observable over the trials.

    Parameters
    ----------
    value, std
        (n,) NaN where there is none.
    """

    value: Array
    std: Array


def readings_of(recordings: RecordingSet, notes: list[str]) -> dict[str, Readings]:
    """Return every observable that the set holds, from its columns and from its curves.

    A number in trials.csv goes before the same number from a curve.

    Parameters
    ----------
    recordings
        The set.
    notes
        Receives what could not be used, and why.
    """
    found = {
        name: Readings(recordings.values(name).copy(), recordings.std(name).copy())
        for name in recordings.observed
    }
    coarse, unknown = 0, 0
    for i, trial in enumerate(recordings.trials.trial):
        numbers: dict[str, tuple[float, float]] = {}
        if trial in recordings.traces:
            trace = recordings.trace(trial)
            noise, stated = _noise_of(trace, recordings)
            unknown += not stated
            numbers |= reduced(trace, noise, from_trace, seed=i)
            coarse += not numbers
        if trial in recordings.profiles:
            profile = recordings.profile(trial)
            numbers |= reduced(profile, {"z_m": _roughness(profile)}, from_profile, seed=i)
        for name, (value, std) in numbers.items():
            n = len(recordings.trials)
            table = found.setdefault(name, Readings(np.full(n, np.nan), np.full(n, np.nan)))
            if math.isnan(table.value[i]):
                table.value[i] = value
                table.std[i] = math.hypot(std, _FLOORS[name] * abs(value))
    if coarse:
        notes.append(f"{coarse} traces have too few samples within the contact to be used")
    if unknown:
        notes.append(
            f"{unknown} traces have no noise in set.toml (tip_height_m, force_N): the scatter of "
            "neighbouring samples is taken"
        )
    return found


def reduced(
    curve: Mapping[str, Array],
    noise: Mapping[str, float],
    reduce: Callable[[Mapping[str, Array]], Numbers],
    *,
    seed: int,
) -> dict[str, tuple[float, float]]:
    """Return the numbers of a curve, each with its standard deviation.

    Parameters
    ----------
    curve
        Columns by name, each of shape (k,).
    noise
        Standard deviation of each noisy column.
    reduce
        `from_trace` or `from_profile`.
    seed
        Of the noise that is added again.
    """
    best = reduce(curve)
    if not best:
        return {}
    rng = np.random.default_rng(seed)
    copies: dict[str, list[float]] = {name: [] for name in best}
    for _ in range(_AGAIN):
        noisy = {k: v + noise.get(k, 0.0) * rng.standard_normal(len(v)) for k, v in curve.items()}
        for name, value in reduce(noisy).items():
            if name in copies:
                copies[name].append(value)
    # what the noise often destroys was not measured
    return {
        name: (best[name], float(np.std(values)))
        for name, values in copies.items()
        if len(values) > 0.8 * _AGAIN
    }


def from_trace(trace: Mapping[str, Array]) -> Numbers:
    """Return what a trace says, by the observables' names; empty if it says nothing."""
    t = trace["time_s"]
    found: Numbers = {}
    if "tip_height_m" in trace:
        found |= _from_height(t, trace["tip_height_m"])
    if "force_N" in trace:
        found |= _from_force(t, trace["force_N"])
    return found


def _from_height(t: Array, h: Array) -> Numbers:
    lowest = int(np.argmin(h))
    depth = -float(h[lowest])
    if depth <= 0.0:
        return {}
    free = h > 0.05 * depth
    inside = np.flatnonzero(h < 0.0)
    before = np.flatnonzero(free & (np.arange(len(t)) < lowest))
    after = np.flatnonzero(free & (np.arange(len(t)) > lowest))
    found: Numbers = {}
    if len(before) >= FEWEST and len(after) >= FEWEST:
        down, up = np.polyfit(t[before], h[before], 1), np.polyfit(t[after], h[after], 1)
        if down[0] < 0.0:
            found["restitution"] = float(-up[0] / down[0])
            if len(inside) >= FEWEST:
                found["below_flat_s"] = float(-up[1] / up[0] + down[1] / down[0])
    if len(inside) >= FEWEST:
        near = inside[h[inside] < -0.6 * depth]
        if len(near) >= FEWEST:
            found["peak_depth_m"] = -_extremum(t[near], h[near])[1]
    return found


def _from_force(t: Array, f: Array) -> Numbers:
    top = int(np.argmax(f))
    level = 0.1 * f[top]
    first, last = top, top
    while first > 0 and f[first - 1] > level:
        first -= 1
    while last < len(f) - 1 and f[last + 1] > level:
        last += 1
    if last - first + 1 < FEWEST or first == 0 or last == len(f) - 1:
        return {}
    near = np.flatnonzero(f > 0.85 * f[top])
    near = near[(near >= first) & (near <= last)]
    at, peak = _extremum(t[near], f[near]) if len(near) >= FEWEST else (t[top], float(f[top]))
    # yield makes the rise straight soon after the touch; the end is that of an elastic recovery
    start = _foot(t[: top + 1], f[: top + 1], peak, power=1.0)
    end = _foot(t[top:][::-1], f[top:][::-1], peak, power=2.0 / 3.0)
    if not start < at < end:
        return {}
    within = (t >= start) & (t <= end)
    return {
        "peak_force_N": peak,
        "contact_time_s": end - start,
        "loading_time_s": at - start,
        "normal_impulse_Ns": float(np.trapezoid(np.append(f[within], 0.0),
                                                np.append(t[within], end))),
    }  # fmt: skip


def _foot(t: Array, f: Array, peak: float, *, power: float) -> float:
    """Time at which force^power, drawn through its tenth and its third of the peak, vanishes."""
    low, high = 0.1 * peak, 0.33 * peak
    above = np.flatnonzero(f > high)
    if not above.size:
        return math.nan
    k = int(above[0])
    part = slice(max(k - 1, 0), k + 1)
    t_high = float(np.interp(high, f[part], t[part]))
    below = np.flatnonzero(f[:k] <= low)
    if not below.size:
        return math.nan
    j = int(below[-1])
    t_low = float(np.interp(low, f[j : j + 2], t[j : j + 2]))
    a, b = 0.1**power, 0.33**power
    return float(t_low - (t_high - t_low) * a / (b - a))


def _extremum(t: Array, y: Array) -> tuple[float, float]:
    """Place and value of the extremum of the parabola through the samples."""
    middle, width = float(t.mean()), float(np.ptp(t)) or 1.0
    a, b, c = np.polyfit((t - middle) / width, y, 2)
    if a == 0.0:
        return middle, float(c)
    x = float(np.clip(-b / (2.0 * a), -0.5, 0.5))
    return middle + x * width, float(a * x * x + b * x + c)


def from_profile(profile: Mapping[str, Array]) -> Numbers:
    """Return the depth of a crater below the flat around it."""
    x, z = profile["x_m"], profile["z_m"]
    line = _ground(x, z)
    if line is None:
        return {}
    level = z - np.polyval(line, x)
    low = int(np.argmin(level))
    near = np.flatnonzero(level < 0.7 * level[low])
    if len(near) < FEWEST or level[low] >= 0.0:
        return {}
    return {"permanent_depth_m": -_extremum(x[near], level[near])[1]}


def _ground(x: Array, z: Array) -> Array | None:
    """Line through the undisturbed surface: the outer fifths of the profile."""
    span = float(np.ptp(x))
    outer = (x < x.min() + 0.2 * span) | (x > x.max() - 0.2 * span)
    return np.asarray(np.polyfit(x[outer], z[outer], 1)) if outer.sum() >= 4 else None


def _roughness(profile: Mapping[str, Array]) -> float:
    x, z = profile["x_m"], profile["z_m"]
    line = _ground(x, z)
    if line is None:
        return 0.0
    span = float(np.ptp(x))
    outer = (x < x.min() + 0.2 * span) | (x > x.max() - 0.2 * span)
    return float(np.std((z - np.polyval(line, x))[outer]))


def _noise_of(
    trace: Mapping[str, Array], recordings: RecordingSet
) -> tuple[dict[str, float], bool]:
    """Standard deviation of each column of a trace, and whether the set states it."""
    stated = recordings.setup.noise
    noise: dict[str, float] = {}
    if "tip_height_m" in trace and "tip_height_m" in stated:
        noise["tip_height_m"] = float(stated["tip_height_m"])
    if "force_N" in trace:
        size = float(np.max(np.abs(trace["force_N"])))
        parts = [stated.get("force_N", math.nan), size * stated.get("force_N_relative", math.nan)]
        known = [p for p in parts if not math.isnan(p)]
        if known:
            noise["force_N"] = math.hypot(*known)
    if noise:
        return noise, True
    for name in ("tip_height_m", "force_N"):
        if name in trace:
            # second differences of neighbours: 6 times the variance of white noise
            noise[name] = (
                float(np.median(np.abs(np.diff(trace[name], 2)))) / 0.6745 / math.sqrt(6.0)
            )
    return noise, False


__all__ = ["FROM_CURVES", "Readings", "from_profile", "from_trace", "readings_of", "reduced"]
