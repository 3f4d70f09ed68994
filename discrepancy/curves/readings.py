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

from ...core.arrays import Array
from ...core.observables import OBSERVABLES
from ...dynamics import Scene, Settings, traced
from ...recordings import RecordingSet
from ..rules import RULES
from .reduction import Numbers, foot, from_profile, from_trace, roughness

# limit: points of a simulated trace [-]; time
_TRACED = 200

_ACCURACY = Settings(tolerance=1e-7)


@dataclass(frozen=True, eq=False)
class Readings:
    """Values of one observable over the trials.

    `value`, `std`: (n,) NaN where there is none.
    """

    value: Array
    std: Array


def readings_of(
    recordings: RecordingSet, scenes: Sequence[Scene]
) -> tuple[dict[str, Readings], tuple[str, ...]]:
    """Return every observable that the set holds, from columns and curves, and notes.

    A number in trials.csv goes before the same number from a curve.

    `scenes`: the baseline's scene of every trial.
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
            numbers |= reduced(profile, {"z_m": roughness(profile)}, from_profile, seed=i)
        for name, (value, std) in numbers.items():
            n = len(recordings.trials)
            table = found.setdefault(name, Readings(np.full(n, np.nan), np.full(n, np.nan)))
            if math.isnan(table.value[i]):
                table.value[i] = value
                scale = RULES.trace_scale if name.endswith("_m") else 0.0
                table.std[i] = math.hypot(std, scale * abs(value))
    notes = []
    if coarse:
        notes.append(f"{coarse} traces have too few samples within the contact to be used")
    if unknown:
        notes.append(
            f"{unknown} traces have no noise in set.toml (tip_height_m, force_N): the scatter of "
            "neighbouring samples is taken"
        )
    return found, tuple(notes)


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
    for shift in RULES.instants:
        for name, value in from_trace(model.read(t - start + shift * sample, trace)).items():
            ratios.setdefault(name, []).append(value / model.exact[name])
    return {
        name: (
            float(np.mean(r)),
            math.hypot(float(np.std(r)), RULES.reduction_left * abs(np.mean(r) - 1.0)),
        )
        for name, r in ratios.items()
        if len(r) == len(RULES.instants)
    }


def _corrected(
    numbers: dict[str, tuple[float, float]], errors: dict[str, tuple[float, float]]
) -> dict[str, tuple[float, float]]:
    found = {}
    for name, (value, std) in numbers.items():
        ratio, spread = errors.get(name, (math.nan, 0.0))
        if abs(ratio - 1.0) < RULES.reduction_most and spread < RULES.reduction_most:
            found[name] = (
                value / ratio,
                math.hypot(std, max(spread, RULES.reduction_least) * value) / ratio,
            )
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
        trace = traced(scene, _ACCURACY, points=_TRACED)
        t, order = np.unique(trace.column("time_s"), return_index=True)
        impact = trace.impact
        leaving = impact.restitution * scene.approach.speed
        exact = {
            o.column: getattr(impact, o.simulated) for o in OBSERVABLES.values() if o.simulated
        }
        exact["below_flat_s"] = impact.contact_time_s + impact.residual_flat_m / max(leaving, 1e-9)
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
        return foot(t[: top + 1], f[: top + 1], float(f[top]), power=1.0)
    return math.nan


def reduced(
    curve: Mapping[str, Array],
    noise: Mapping[str, float],
    reduce: Callable[[Mapping[str, Array]], Numbers],
    *,
    seed: int,
) -> dict[str, tuple[float, float]]:
    """Return the numbers of a curve, each with its standard deviation.

    `curve`: columns by name, each of shape (k,); `noise`: standard deviation of each noisy column;
    `reduce`: `from_trace` or `from_profile`; `seed`: of the noise that is added again.
    """
    best = reduce(curve)
    if not best:
        return {}
    rng = np.random.default_rng(seed)
    copies: dict[str, list[float]] = {name: [] for name in best}
    for _ in range(RULES.trace_copies):
        noisy = {k: v + noise.get(k, 0.0) * rng.standard_normal(len(v)) for k, v in curve.items()}
        for name, value in reduce(noisy).items():
            if name in copies:
                copies[name].append(value)
    # what the noise often destroys was not measured
    return {
        name: (best[name], float(np.std(values)))
        for name, values in copies.items()
        if len(values) > 0.8 * RULES.trace_copies
    }


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
