"""A pulse of force or acceleration: its peak, its ends, and the area under it.

Where the bodies touch and part, the contact is elastic and the force follows the power 3/2 of the
depth: F^(2/3) meets zero along a straight line, which gives both ends below the noise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.signal import savgol_filter

from ....core.errors import InputError
from ..measured import Array, Measured
from ..regression import robust_regression, robust_std
from .shape import shape_of

_LOW, _HIGH = 0.08, 0.45
"""Part of the peak between which the flanks are taken as straight in F^(2/3)."""

_LEAST = 8.0
"""Peak in standard deviations of the noise that is still a pulse."""


@dataclass(frozen=True)
class Pulse:
    """The largest pulse of a record.

    Parameters
    ----------
    time, value
        (n,): the whole record, its baseline taken off and the pulse upwards [s, unit].
    baseline, noise
        Of the record before the pulse [unit].
    peak, peak_time
        Largest value [unit] and its time [s].
    start, end
        Where the flanks meet zero [s].
    area
        Under the pulse between both ends [unit s].
    inside
        Which samples lie between both ends, (n,).
    notes
        What the reader should know.
    """

    time: Array
    value: Array
    baseline: float
    noise: float
    peak: Measured
    peak_time: float
    start: Measured
    end: Measured
    area: Measured
    inside: npt.NDArray[np.bool_]
    notes: tuple[str, ...]

    @property
    def duration(self) -> Measured:
        """From the first to the last end [s]."""
        return self.end.minus(self.start)


def find_pulse(time: Array, value: Array, *, source: str) -> Pulse:
    """Return the largest pulse of a record, of either sign.

    Parameters
    ----------
    time, value
        (n,), time increasing.
    source
        The file.

    Raises
    ------
    InputError
        Too few samples, nothing above the noise, or no whole pulse: what it looks like.
    """
    if time.size < 20:
        raise InputError(f"{time.size} samples", source=source, allowed="20 or more")
    top = int(np.argmax(np.abs(value - np.median(value))))
    baseline, noise, before = _baseline(value, top)
    flipped = math.copysign(1.0, value[top] - baseline)
    clear = flipped * (value - baseline)
    if not clear[top] > _LEAST * noise:
        raise InputError(
            f"the largest value is {clear[top] / max(noise, 1e-300):.2g} times the noise",
            source=source, allowed=f"a pulse of {_LEAST:g} times the noise or more",
        )  # fmt: skip
    notes = []
    if before < 10:
        notes.append("fewer than 10 samples before the pulse: its zero is taken as the record's")
    peak, peak_time = _peak(time, clear, top, noise)
    start, used_a = _flank(time, clear, top, -1, peak.value)
    end, used_b = _flank(time, clear, top, +1, peak.value)
    if min(used_a, used_b) < 4:
        notes.append(f"only {min(used_a, used_b)} samples on a flank: the ends are rough")
    shape = shape_of(time, clear, top, (start.value, end.value), source=source)
    if shape.ringing:
        notes.append(
            f"rings: {shape.ringing:.0%} of the peak to the other side; peak and ends are as rough"
        )
        peak = Measured(peak.value, math.hypot(peak.std, 0.25 * shape.ringing * peak.value))
        rough = 0.1 * shape.ringing * (end.value - start.value)
        start, end = (Measured(e.value, math.hypot(e.std, rough)) for e in (start, end))
    if shape.others:
        when = ", ".join(f"{t:.6g}" for t in shape.others[:5])
        notes.append(
            f"the largest of {1 + len(shape.others)} pulses; others at {when} s: first_s and "
            "last_s pick one"
        )
    inside = (time >= start.value) & (time <= end.value)
    area = float(np.trapezoid(clear[inside], time[inside]))
    step = float(np.median(np.diff(time)))
    drift = noise / math.sqrt(max(before, 1)) * (end.value - start.value)
    late = 0.5 * shape.level_after * peak.value * (end.value - start.value)
    if abs(shape.level_after) > 0.02:
        notes.append(
            f"the level afterwards is {shape.level_after:+.0%} of the peak: a zero that drifts"
        )
    scatter = noise * step * math.sqrt(max(int(inside.sum()), 1))
    area_std = math.hypot(scatter, drift, late)
    if inside[0] and inside[-1]:
        raise InputError(
            "the record does not rise from zero and come back", source=source,
            allowed="a pulse with both of its ends",
        )  # fmt: skip
    if inside[0] or inside[-1]:
        notes.append("the pulse runs over an end of the record")
    return Pulse(
        time, clear, baseline, noise, peak, peak_time, start, end, Measured(area, area_std), inside,
        tuple(notes),
    )  # fmt: skip


def _baseline(value: Array, top: int) -> tuple[float, float, int]:
    """Level and noise before the pulse, and how many samples tell them."""
    height = abs(value[top] - np.median(value))
    level = float(np.median(value[: max(top // 2, 1)]))
    high = np.flatnonzero(np.abs(value[:top] - level) > 0.02 * height)
    # the flank itself begins a little before the last sample that is still quiet
    quiet = high[0] if high.size else top
    before = int(0.8 * quiet)
    if before < 10:
        return 0.0, robust_std(np.diff(value)) / math.sqrt(2.0), before
    part = value[:before]
    return float(np.mean(part)), max(float(np.std(part)), 1e-12 * height), before


def _peak(time: Array, clear: Array, top: int, noise: float) -> tuple[Measured, float]:
    """Peak by a local parabola over the samples above 90 % of the highest one."""
    high = clear > 0.9 * clear[top]
    low, up = top, top
    while low > 0 and high[low - 1]:
        low -= 1
    while up + 1 < clear.size and high[up + 1]:
        up += 1
    if up - low < 4:
        return Measured(float(clear[top]), max(noise, 0.02 * float(clear[top]))), float(time[top])
    width = min(up - low + 1, 51) // 2 * 2 + 1
    window = slice(max(low - width, 0), min(up + width + 1, clear.size))
    smooth = savgol_filter(clear[window], min(width, clear[window].size // 2 * 2 - 1), 2)
    best = int(np.argmax(smooth))
    return (
        Measured(float(smooth[best]), noise * 1.5 / math.sqrt(width)),
        float(time[window][best]),
    )


def _flank(time: Array, clear: Array, top: int, step: int, peak: float) -> tuple[Measured, int]:
    """Where F^(2/3) of one flank meets zero, and the number of samples that say so."""
    k, flank = top, []
    limit = clear.size - 1 if step > 0 else 0
    while k != limit and clear[k] > _LOW * peak:
        k += step
        if _LOW * peak < clear[k] < _HIGH * peak:
            flank.append(k)
    if len(flank) < 2:
        # a flank between two samples: the line through them
        outer, inner = float(time[k]), float(time[k - step])
        low, high = max(float(clear[k]), 0.0), float(clear[k - step])
        u, w = low ** (2 / 3), high ** (2 / 3)
        at = outer - u * (inner - outer) / (w - u) if w > u else outer
        return Measured(at, 0.3 * abs(inner - outer)), len(flank)
    index = np.sort(np.array(flank))
    t, y = time[index], clear[index] ** (2.0 / 3.0)
    middle = float(t.mean())
    design = np.stack([np.ones_like(t), t - middle], axis=1)
    if index.size == 2:
        c = np.linalg.solve(design, y)
        return Measured(middle - c[0] / c[1], 0.3 * float(np.ptp(t))), 2
    fit = robust_regression(design, y)
    c, v = fit.coefficients, fit.covariance
    at = -c[0] / c[1]
    gradient = np.array([-1.0 / c[1], c[0] / c[1] ** 2])
    std = math.sqrt(float(gradient @ v @ gradient))
    return Measured(middle + at, max(std, 0.1 * float(np.median(np.diff(time))))), int(index.size)
