"""Traces and profiles as numbers: one reduction for the recording, its noise and the simulation.

A curve enters the comparison through what an instrument of its frame rate and noise can hold: from
the tip's height the slopes before and after the contact, the largest depth and the time below the
undisturbed flat; from the force its peak, its impulse, its duration and the time to the peak; from
a profile the depth of the crater. Time zero is arbitrary, so only differences of times are used.
The standard deviation of each number is that of the same reduction over the curve with its noise
added again. What the reduction itself is off (a peak between samples, a blurred end) is found on
the baseline's own curve, read off at the recording's instants, and taken off; what is left of it
is part of the uncertainty.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..impact import Scene, Settings, reference_impact
from ..recordings import RecordingSet

Array = NDArray[np.float64]
Numbers = dict[str, float]

FROM_CURVES = ("peak_depth_m", "below_flat_s", "normal_impulse_Ns", "loading_time_s")
"""Numbers that only curves give; simulated by the same names."""

FEWEST = 5
"""Samples within the contact that a number of the contact needs."""

_ACCURACY, _POINTS = Settings(tolerance=1e-7), 200
_AGAIN = 40  # copies of a curve with fresh noise
_SCALE = {"peak_depth_m": 0.01, "permanent_depth_m": 0.01}
"""Error of the length's scale, as a fraction, where a column of its own would state it."""
_LEFT, _LEAST, _MOST = 0.25, 0.003, 0.25
"""Of a reduction's own error: share that stays, least that stays, most that is corrected."""
_INSTANTS = (-0.4, -0.2, 0.0, 0.2, 0.4)
"""Touch before or after the one found, in samples: the trace itself does not know it better."""


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


def readings_of(
    recordings: RecordingSet, scenes: Sequence[Scene], notes: list[str]
) -> dict[str, Readings]:
    """Return every observable that the set holds, from its columns and from its curves.

    A number in trials.csv goes before the same number from a curve.

    Parameters
    ----------
    recordings
        The set.
    scenes
        The baseline's scene of every trial.
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
            numbers = _corrected(numbers, own_errors(trace, scenes[i]))
        if trial in recordings.profiles:
            profile = recordings.profile(trial)
            numbers |= reduced(profile, {"z_m": _roughness(profile)}, from_profile, seed=i)
        for name, (value, std) in numbers.items():
            n = len(recordings.trials)
            table = found.setdefault(name, Readings(np.full(n, np.nan), np.full(n, np.nan)))
            if math.isnan(table.value[i]):
                table.value[i] = value
                table.std[i] = math.hypot(std, _SCALE.get(name, 0.0) * abs(value))
    if coarse:
        notes.append(f"{coarse} traces have too few samples within the contact to be used")
    if unknown:
        notes.append(
            f"{unknown} traces have no noise in set.toml (tip_height_m, force_N): the scatter of "
            "neighbouring samples is taken"
        )
    return found


def own_errors(trace: Mapping[str, Array], scene: Scene) -> dict[str, tuple[float, float]]:
    """Return what a reduction is off: reduced over true number, and its standard deviation.

    Found on the baseline's curve, read off at the trace's instants; the touch lies anywhere
    within a sample.
    """
    t, start = trace["time_s"], _touch(trace)
    if math.isnan(start):
        return {}
    model = _Model.of(scene)
    sample = float(np.median(np.diff(t)))
    ratios: dict[str, list[float]] = {}
    for shift in _INSTANTS:
        for name, value in from_trace(model.read(t - start + shift * sample, trace)).items():
            ratios.setdefault(name, []).append(value / model.exact[name])
    return {
        name: (float(np.mean(r)), math.hypot(float(np.std(r)), _LEFT * abs(np.mean(r) - 1.0)))
        for name, r in ratios.items()
        if len(r) == len(_INSTANTS)
    }


def _corrected(
    numbers: dict[str, tuple[float, float]], errors: dict[str, tuple[float, float]]
) -> dict[str, tuple[float, float]]:
    found = {}
    for name, (value, std) in numbers.items():
        ratio, spread = errors.get(name, (math.nan, 0.0))
        if abs(ratio - 1.0) < _MOST and spread < _MOST:
            found[name] = (value / ratio, math.hypot(std, max(spread, _LEAST) * value) / ratio)
    return found


@dataclass(frozen=True, eq=False)
class _Model:
    """One simulated impact as a curve, with the numbers that its reduction should give."""

    time: Array
    height: Array
    force: Array
    leaving: float
    speed: float
    exact: Numbers

    @classmethod
    def of(cls, scene: Scene) -> _Model:
        trace = reference_impact(scene, _ACCURACY, points=_POINTS)
        t, order = np.unique(trace.column("time_s"), return_index=True)
        e, impact = trace.impact.restitution, trace.impact
        leaving = e * scene.approach.speed
        exact = {
            "restitution": e, "peak_depth_m": impact.peak_depth_m,
            "below_flat_s": impact.contact_time_s + impact.residual_flat_m / max(leaving, 1e-9),
            "peak_force_N": impact.peak_force_N, "contact_time_s": impact.contact_time_s,
            "loading_time_s": impact.loading_time_s,
            "normal_impulse_Ns": impact.normal_impulse_Ns,
        }  # fmt: skip
        return cls(
            t, trace.column("tip_height_m")[order], trace.column("normal_force_N")[order], leaving,
            scene.approach.speed, exact,
        )  # fmt: skip

    def read(self, t: Array, trace: Mapping[str, Array]) -> dict[str, Array]:
        """Return the curve at times after the touch, with the columns of a trace."""
        found = {"time_s": t}
        last = self.time[-1]
        if "tip_height_m" in trace:
            h = np.interp(t, self.time, self.height)
            h = np.where(t < 0.0, -self.speed * t, h)
            found["tip_height_m"] = np.where(
                t > last, self.height[-1] + self.leaving * (t - last), h
            )
        if "force_N" in trace:
            inside = (t >= 0.0) & (t <= last)
            found["force_N"] = np.where(inside, np.interp(t, self.time, self.force), 0.0)
        return found


def _touch(trace: Mapping[str, Array]) -> float:
    """Time of first touch, to about a sample."""
    t = trace["time_s"]
    if "tip_height_m" in trace:
        h = trace["tip_height_m"]
        below = np.flatnonzero(h < 0.0)
        k = int(below[0]) if below.size else 0
        if k > 0:
            return float(np.interp(0.0, [-h[k - 1], -h[k]], [t[k - 1], t[k]]))
    if "force_N" in trace:
        f = trace["force_N"]
        top = int(np.argmax(f))
        return _foot(t[: top + 1], f[: top + 1], float(f[top]), power=1.0)
    return math.nan


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
