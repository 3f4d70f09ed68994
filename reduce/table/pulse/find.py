"""A pulse of force or acceleration: its peak, its ends, and the area under it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ....core.arrays import Array, Mask
from ....core.errors import InputError
from ...gates import Refused
from ...measured import Measured
from ...rules import RULES
from ...shared.flank import meets_zero
from .area import Area, area_of
from .level import Level, level_before, run_of, wide
from .ringing import ringing_within
from .shape import Shape, looks_like, shape_of, sheer


@dataclass(frozen=True)
class Pulse:
    """The largest pulse of a record (n,), its baseline taken off and the pulse upwards [s, unit].

    Peak, ends where its flanks meet zero [s], area between them [unit s], and which samples lie
    there.
    """

    time: Array
    value: Array
    baseline: float
    noise: float
    peak: Measured
    start: Measured
    end: Measured
    area: Measured
    inside: Mask
    notes: tuple[str, ...]

    @property
    def duration(self) -> Measured:
        """From the first to the last end [s]."""
        return self.end.minus(self.start)


def find_pulse(time: Array, value: Array, *, source: str) -> Pulse:
    """Return the largest pulse of a record (n,), of either sign, its times increasing.

    A record that shows no whole one above the noise is refused for what it looks like.
    """
    if time.size < RULES.table_rows:
        raise InputError(
            f"{time.size} samples", source=source, allowed=f"{RULES.table_rows} or more"
        )
    sign, top, level = _largest(value)
    noise, clear = level.noise, sign * value - level.mean
    if not clear[top] > RULES.pulse_over_noise * noise:
        raise Refused(
            f"the largest value is {clear[top] / max(noise, 1e-300):.2g} times the noise",
            source=source, allowed=f"a pulse of {RULES.pulse_over_noise:g} times the noise or more",
        )  # fmt: skip
    notes = []
    if not level.samples:
        notes.append("no level before the pulse: the record's own zero, and its error so large")
    peak, peak_time = _peak(time, clear, top, noise)
    start, used_a = _flank(time, clear, top, -1, peak.value)
    end, used_b = _flank(time, clear, top, +1, peak.value)
    shape = shape_of(time, clear, top, (start.value, end.value), noise, source=source)
    # 33 % of a half-sine lie on a flank from 6 to 90 %, more than twice as many as up to 45 %
    if sheer(clear, top) and 2 * shape.above_half >= RULES.whole_flank:
        raise looks_like("an edge: one side has no flank", source)
    _both_flanks(shape, (used_a, used_b), (peak_time - start.value, end.value - peak_time), source)
    if min(used_a, used_b) < 4:
        notes.append(f"only {min(used_a, used_b)} samples on a flank: the ends are rough")
    if shape.ringing:
        peak, start, end, part = _stilled(
            time, clear, top, (start, end), peak, noise, shape.ringing
        )
        notes.append(
            f"rings: {shape.ringing:.0%} of the peak to the other side, {part:.1%} of it within"
        )
    else:  # what stays after the pulse, or wanders before it, may lie under it too
        under = math.hypot(level.std, shape.unrest * peak.value)
        peak = peak.widened(under)
        start, end = (
            e.widened(_without(time, clear, top, way, under, peak.value).value - e.value)
            for e, way in ((start, -1), (end, 1))
        )
    if shape.others:
        when = ", ".join(f"{t:.6g}" for t in shape.others[:5])
        notes.append(
            f"the largest of {1 + len(shape.others)} pulses; others at {when} s: first_s and "
            "last_s pick one"
        )
    inside = (time >= start.value) & (time <= end.value)
    if inside[0] or inside[-1]:
        raise Refused(
            "the pulse runs over an end of the record", source=source,
            allowed="a pulse that rises from its level and comes back to it",
        )  # fmt: skip
    if abs(shape.level_after) > 0.02:
        notes.append(
            f"the level afterwards is {shape.level_after:+.0%} of the peak: the zero is the one "
            "before"
        )
    _timed(start, end, source)
    found = area_of(time, clear, level, shape, (start, end))
    if found.foot:
        start = _over_a_foot(time, clear, top, start, found, peak.value)
    return Pulse(
        time, clear, sign * level.mean, noise, peak, start, end, found.area, inside,
        (*notes, *found.notes),
    )  # fmt: skip


def _largest(value: Array) -> tuple[float, int, Level]:
    """Sign, highest sample and level before it of the pulse that rises farthest above its own."""
    both = []
    for sign in (1.0, -1.0):
        top = int(np.argmax(sign * value))
        level = level_before(sign * value, top)
        height = float(sign * value[top] - level.mean)
        # the top of a pulse is no level for what follows it
        lasts = wide(sign * value, top, level.mean + 0.5 * height)
        both.append((height if level.samples >= lasts else 0.5 * height, sign, top, level))
    middle = float(np.median(value))
    usual = 0 if value.max() - middle >= middle - value.min() else 1
    # the sign that leaves the record's middle farthest, unless the other rises much higher
    chosen = both[usual] if both[1 - usual][0] < 1.5 * both[usual][0] else both[1 - usual]
    return chosen[1], chosen[2], chosen[3]


def _both_flanks(
    shape: Shape, used: tuple[int, int], times: tuple[float, float], source: str
) -> None:
    """Refuse an edge: a side without samples, or that takes no time beside the other."""
    if min(used) == 0 and max(shape.above_half, *used) >= RULES.whole_flank:
        raise looks_like("an edge: one side has no flank", source)
    flanks = sorted(times)
    if shape.above_half >= RULES.whole_flank and flanks[1] > RULES.lopsided * max(flanks[0], 0.0):
        raise looks_like(
            f"an edge: one flank takes {flanks[1] / max(flanks[0], 1e-300):.2g} times "
            "as long as the other", source,
        )  # fmt: skip


def _timed(start: Measured, end: Measured, source: str) -> None:
    """Refuse a pulse whose ends are not known."""
    lasts = end.minus(start)
    if lasts.std > RULES.own_error * lasts.value:
        raise Refused(f"a contact of {lasts} s", source=source, allowed="ends that can be seen")


def _peak(time: Array, clear: Array, top: int, noise: float) -> tuple[Measured, float]:
    """Peak by a local parabola over the samples above 90 % of the highest one."""
    run = run_of(clear > 0.9 * clear[top], top)
    low, up = int(run[0]), int(run[-1])
    if up - low < 4:
        return Measured(float(clear[top]), max(noise, 0.02 * float(clear[top]))), float(time[top])
    width = min(up - low + 1, 51) // 2 * 2 + 1
    window = slice(max(low - width, 0), min(up + width + 1, clear.size))
    value, best, half = _smoothest(clear[window], width)
    narrow = _smoothest(clear[window], width // 2)[0]  # a plastic dent's top is no parabola
    error = math.hypot(noise * 1.5 / math.sqrt(width), RULES.form * value, value - narrow)
    return Measured(value, error), float(time[window][best + half])


def _smoothest(part: Array, width: int) -> tuple[float, int, int]:
    """Largest value of parabolas through so many neighbours, its place, and half of their number.

    (A. Savitzky, M. Golay, 1964)
    """
    half = min(width, part.size // 2 * 2 - 1) // 2
    weight = np.linalg.pinv(np.vander(np.arange(-half, half + 1.0), 3))[-1]
    smooth = np.convolve(part, weight, "valid")
    best = int(np.argmax(smooth))
    return float(smooth[best]), best, half


def _flank(time: Array, clear: Array, top: int, step: int, peak: float) -> tuple[Measured, int]:
    """Where one flank meets zero, and the number of samples that say so."""
    k, flank = top, []
    limit = clear.size - 1 if step > 0 else 0
    low, high = (part * peak for part in RULES.flank)
    while k != limit and clear[k] > low:
        k += step
        if low < clear[k] < high:
            flank.append(k)
    if len(flank) < 2:  # a flank between two samples
        return _through(time, clear, k, k - step), len(flank)
    if len(flank) < RULES.fewest:
        return _through(time, clear, flank[-1], flank[0]), len(flank)
    index = np.sort(np.array(flank))
    return meets_zero(time[index], clear[index] / peak, step), len(flank)


def _stilled(
    time: Array, clear: Array, top: int, ends: tuple[Measured, Measured], peak: Measured,
    noise: float, ringing: float,
) -> tuple[Measured, Measured, Measured, float]:  # fmt: skip
    """Return peak and both ends without the ringing, and how much was within."""
    start, end = ends
    for _ in range(2):  # a swing that cuts a flank off moves the end of the pulse
        within = ringing_within(time, clear, (start.value, end.value), peak.value, ringing)
        still = clear - within.swing
        start, end = (_flank(time, still, top, way, peak.value)[0] for way in (-1, 1))
    peak, _ = _peak(time, still, top, noise)
    unsure = within.unsure * peak.value
    # what is left of one swing moves both ends: what it does to them adds up in the time between
    both = math.sqrt(2.0) if within.swing.any() else 1.0
    start, end = (
        e.widened(both * (_without(time, still, top, way, unsure, peak.value).value - e.value))
        for e, way in ((start, -1), (end, 1))
    )
    return peak.widened(unsure), start, end, within.part


def _over_a_foot(
    time: Array, clear: Array, top: int, start: Measured, found: Area, peak: float
) -> Measured:
    """Where a contact begins: with its foot or after it, that goes on under the flank or not."""
    under = _without(time, clear, top, -1, found.foot, peak)
    half = 0.5 * (under.value - start.value)
    flank = Measured(start.value + half, math.hypot(max(start.std, under.std), half))
    return Measured(flank.value - 0.5 * found.early, flank.std).widened(0.5 * found.early)


def _without(time: Array, clear: Array, top: int, step: int, under: float, peak: float) -> Measured:
    """Where a flank meets zero if something else of some height lies under it."""
    return _flank(time, clear - under, top, step, peak - under)[0]


def _through(time: Array, clear: Array, outer: int, inner: int) -> Measured:
    """Where the line through two samples of a flank, F or an elastic one's F^(2/3), meets zero."""
    far, near = float(time[outer]), float(time[inner])
    ends = []
    for power in RULES.flank_powers:
        low, high = (max(float(clear[k]), 0.0) ** (1.0 / power) for k in (outer, inner))
        ends.append(far - low * (near - far) / (high - low) if high > low else far)
    return Measured(float(np.mean(ends)), math.hypot(0.3 * (near - far), float(np.std(ends))))
