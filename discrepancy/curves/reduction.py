"""Numbers of one curve: what a trace or a profile says by itself."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from ...core.arrays import Array, Mask
from ...recordings.rules import RULES as RECORDINGS

Numbers = dict[str, float]


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
    if len(before) >= RECORDINGS.trace_samples and len(after) >= RECORDINGS.trace_samples:
        down, up = np.polyfit(t[before], h[before], 1), np.polyfit(t[after], h[after], 1)
        if down[0] < 0.0:
            found["restitution"] = float(-up[0] / down[0])
            if len(inside) >= RECORDINGS.trace_samples:
                found["below_flat_s"] = float(-up[1] / up[0] + down[1] / down[0])
    if len(inside) >= RECORDINGS.trace_samples:
        near = inside[h[inside] < -0.6 * depth]
        if len(near) >= RECORDINGS.trace_samples:
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
    if last - first + 1 < RECORDINGS.trace_samples or first == 0 or last == len(f) - 1:
        return {}
    near = np.flatnonzero(f > 0.85 * f[top])
    near = near[(near >= first) & (near <= last)]
    at, peak = (
        _extremum(t[near], f[near])
        if len(near) >= RECORDINGS.trace_samples
        else (t[top], float(f[top]))
    )
    # yield makes the rise straight soon after the touch; the end is that of an elastic recovery
    start = foot(t[: top + 1], f[: top + 1], peak, power=1.0)
    end = foot(t[top:][::-1], f[top:][::-1], peak, power=2.0 / 3.0)
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


def foot(t: Array, f: Array, peak: float, *, power: float) -> float:
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
    level, outer = _levelled(x, z)
    if not outer.any():
        return {}
    low = int(np.argmin(level))
    near = np.flatnonzero(level < 0.7 * level[low])
    if len(near) < RECORDINGS.trace_samples or level[low] >= 0.0:
        return {}
    return {"permanent_depth_m": -_extremum(x[near], level[near])[1]}


def _levelled(x: Array, z: Array) -> tuple[Array, Mask]:
    """Height over the line through the undisturbed surface, and where that is: the outer fifths.

    Nowhere where it has fewer than four points.
    """
    span = float(np.ptp(x))
    outer = (x < x.min() + 0.2 * span) | (x > x.max() - 0.2 * span)
    if outer.sum() < 4:
        return z, np.zeros_like(outer)
    return z - np.polyval(np.polyfit(x[outer], z[outer], 1), x), outer


def roughness(profile: Mapping[str, Array]) -> float:
    """Return the scatter of a profile's undisturbed surface about its line."""
    level, outer = _levelled(profile["x_m"], profile["z_m"])
    return float(np.std(level[outer])) if outer.any() else 0.0
