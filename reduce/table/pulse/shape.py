"""What a record looks like that is no single, whole pulse: each is refused in its own words.

| what it looks like | how it is told |
| --- | --- |
| clipped | more samples at the largest value than the converter's steps leave on a round top |
| a step | the level afterwards is another by a third of the peak or more |
| an oscillation | six or more other half-waves beside it reach a third of the peak |
| a spike | fewer than three samples above half of the peak |

Smaller half-waves (a plate or a sensor that rings) widen the errors of peak and duration.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ....core.arrays import Array
from ...gates import Refused
from ...rules import RULES
from .level import run_of


class Shape(NamedTuple):
    """What is beside a whole pulse, as parts of its peak, and when others of its sign peak [s].

    `unrest` is what stays just after it, a swing or a level, as a root mean square beyond the
    noise. Last the number of its samples above half of the peak.
    """

    ringing: float
    level_after: float
    unrest: float
    others: tuple[float, ...]
    above_half: int


def shape_of(
    time: Array, clear: Array, top: int, ends: tuple[float, float], noise: float, *, source: str
) -> Shape:
    """Return what else a record shows beside its largest pulse, from `ends[0]` to `ends[1]` [s].

    Of a record (n,) with its level before the pulse taken off, the pulse upwards, `top` its highest
    sample, `noise` a sample's standard deviation. Refuses what is no impact, or is not whole, for
    what it looks like.
    """
    peak = float(clear[top])
    flat = _flat_top(clear, top)
    if flat:
        raise Refused(
            f"clipped: {flat} samples stand at the largest value", source=source,
            allowed="a record whose range the pulse does not reach",
        )  # fmt: skip
    if not ends[1] > ends[0]:
        raise looks_like("a ramp: it ends before it begins", source)
    half = int(run_of(clear > 0.5 * peak, top).size)
    if half < RULES.fewest_above_half:
        raise looks_like(f"a spike: {half} samples above half of its peak", source)
    long = ends[1] - ends[0]
    after = (time > ends[1] + 0.5 * long) & (time < ends[1] + 5.0 * long)
    rest = float(np.median(clear[after] if after.sum() >= 5 else clear[-5:])) / peak
    soon = (time > ends[1]) & (time < ends[1] + long)
    if soon.sum() >= RULES.fewest_level_samples:  # what comes later is another event
        rest = min(rest, float(np.median(clear[soon])) / peak, key=abs)
    square = float(np.mean(clear[soon] ** 2)) if soon.any() else 0.0
    chance = (1.0 + RULES.by_chance * math.sqrt(2.0 / max(int(soon.sum()), 1))) * noise**2
    unrest = math.sqrt(square - noise**2) / peak if square > chance else 0.0
    if abs(rest) > RULES.swing:
        raise looks_like(f"a step: {rest:+.0%} of the peak stays", source)
    wide = _wide(clear, top)
    if half >= RULES.whole_flank and wide > RULES.plateau:
        raise Refused(
            f"its top is flat over {wide:.0%} of its width at half of the peak: clipped",
            source=source, allowed="a record whose range the pulse does not reach",
        )  # fmt: skip
    reach = RULES.beside * long
    beside = (time > ends[0] - reach) & (time < ends[1] + reach)
    below = -float(clear[beside].min()) / peak
    swings = _half_waves(clear[beside] / peak, RULES.swing) - 1
    if below > RULES.swing and swings >= RULES.swings:
        raise looks_like(f"an oscillation: {swings} other half-waves beside it", source)
    least = max(RULES.ringing, RULES.pulse_over_noise * noise / peak)
    # what does not swing back is the level of a sensor that has lost its zero
    late = beside & (time > ends[1])
    rings = below > least and _half_waves(clear[late] / peak, least) > 1
    others = tuple(_others(time, clear, peak, ends))
    _single(time, clear, others, ends, source)
    return Shape(below if rings else 0.0, rest, unrest, others, half)


def _single(
    time: Array, clear: Array, others: tuple[float, ...], ends: tuple[float, float], source: str
) -> None:
    """Refuse a train of like pulses: steps of a walk, taps, a machine.

    Bounces come back lower and sooner, every time.
    """
    at = np.array(sorted([*others, 0.5 * (ends[0] + ends[1])]))
    heights = np.interp(at, time, clear) / clear.max()
    at, heights = at[heights > 0.5], heights[heights > 0.5]
    if at.size <= RULES.train:
        return
    flights = np.diff(at)
    longer = flights[1:] > RULES.same_time * flights[:-1]
    regular = flights[-1] > flights[0] / RULES.same_time
    if regular or longer.any() or (np.diff(heights) > RULES.same_height).any():
        raise looks_like(f"{at.size} like pulses that fade as no bounces do", source)


def _wide(clear: Array, top: int) -> float:
    """Return the width at 95 % of the peak in that at half of it, in a mean over the noise."""
    half = run_of(clear > 0.5 * clear[top], top)
    ordered = np.sort(clear[half])
    # the highest samples are the noise's: a tenth of them is left out of the peak
    peak = float(ordered[-1 - half.size // 10])
    return float(np.mean(ordered > 0.95 * peak))


def looks_like(what: str, source: str) -> Refused:
    """Return the refusal of a record that shows something else than a pulse."""
    return Refused(
        f"no impact: looks like {what}", source=source,
        allowed="a pulse that rises from zero and comes back (see --first-s, --last-s, --value)",
    )  # fmt: skip


def sheer(clear: Array, top: int) -> bool:
    """Return whether a pulse leaves its top for the level without a sample between, either way."""
    high = run_of(clear > 0.9 * clear[top], top)
    beside = clear[[max(high[0] - 1, 0), min(high[-1] + 1, clear.size - 1)]]
    return bool(beside.min() < RULES.flank[0] * clear[top])


def _half_waves(part: Array, least: float) -> int:
    """Return how many times a record swings beyond a part of its peak, to either side in turn."""
    sides = np.sign(part[np.abs(part) > least])
    return 1 + int(np.count_nonzero(np.diff(sides)))


def _flat_top(clear: Array, top: int) -> int:
    """Return how many samples stand at the largest value, 0 if its top is round.

    Of a round top those lie within one step of the converter that a parabola leaves there; with
    noise before the converter the cut ones are no unbroken run.
    """
    peak = float(clear[top])
    steps = np.diff(np.unique(clear))
    steps = steps[steps > 1e-9 * peak]
    near = run_of(clear > (1.0 - RULES.round_top) * peak, top)
    if steps.size == 0 or near[0] == 0 or near[-1] == clear.size - 1:
        return 0
    step = float(np.percentile(steps, 10.0))
    equal = int(np.count_nonzero(clear[near] >= peak - 0.01 * step))
    round_top = near.size * math.sqrt(min(step / (RULES.round_top * peak), 1.0))
    fine = round_top < 1.0  # none within a step of the highest one, but by chance
    return equal if equal >= max(RULES.flat_samples - fine, RULES.flat_top * round_top) else 0


def _others(time: Array, clear: Array, peak: float, ends: tuple[float, float]) -> Iterator[float]:
    """Yield when other pulses of the record peak [s]."""
    long = ends[1] - ends[0]
    high = np.flatnonzero(
        (clear > RULES.swing * peak) & ((time < ends[0] - long) | (time > ends[1] + long))
    )
    for run in np.split(high, np.flatnonzero(np.diff(time[high]) > long) + 1):
        if run.size < RULES.fewest_above_half:
            continue
        if run[0] > 0 and run[-1] < clear.size - 1:  # else a level, as of who stands on a plate
            yield float(time[run[np.argmax(clear[run])]])
