"""What a record looks like that is no single, whole pulse: each is refused in its own words.

| what it looks like | how it is told |
| --- | --- |
| clipped | the highest samples are equal, and those beside them are far below |
| a step | the level afterwards is another by a third of the peak or more |
| an oscillation | six or more other half-waves beside it reach a third of the peak |
| a spike | fewer than three samples above half of the peak |

Smaller half-waves (a plate or a sensor that rings) widen the errors of peak and duration.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ...core.errors import InputError
from ..measured import Array

_FLAT = 4
"""Equal samples at the top that are more than chance."""

_JUMP = 1.5
"""Steps of the converter by which the samples beside a clipped top lie below it."""

_STEP, _SWING, _RINGS = 0.33, 0.33, 0.1
_SWINGS, _BESIDE = 6, 8.0
_FEWEST = 3
_AGAIN = 0.3
"""Part of the peak from which on another pulse is named."""


class Shape(NamedTuple):
    """What is beside a whole pulse, as parts of its peak, and when others of its sign peak [s].

    Last the number of its samples above half of the peak.
    """

    ringing: float
    level_after: float
    others: tuple[float, ...]
    above_half: int


def shape_of(
    time: Array, clear: Array, top: int, ends: tuple[float, float], *, source: str
) -> Shape:
    """Return what else a record shows beside its largest pulse.

    Parameters
    ----------
    time, clear
        (n,): the record, its level before the pulse taken off, the pulse upwards.
    top
        Its highest sample.
    ends
        Beginning and end of the pulse [s].
    source
        The file.

    Raises
    ------
    InputError
        It is no impact, or the impact is not whole: what it looks like.
    """
    peak = float(clear[top])
    flat = _flat_top(clear, top)
    if flat:
        raise InputError(
            f"clipped: {flat} samples stand at the largest value", source=source, key="value",
            allowed="a record whose range the pulse does not reach",
        )  # fmt: skip
    if not ends[1] > ends[0]:
        raise looks_like("a ramp: it ends before it begins", source)
    half = int(_run(clear > 0.5 * peak, top).size)
    if half < _FEWEST:
        raise looks_like(f"a spike: {half} samples above half of its peak", source)
    long = ends[1] - ends[0]
    after = (time > ends[1] + 0.5 * long) & (time < ends[1] + 5.0 * long)
    rest = float(np.median(clear[after] if after.sum() >= 5 else clear[-5:])) / peak
    if abs(rest) > _STEP:
        raise looks_like(f"a step: {rest:+.0%} of the peak stays", source)
    beside = (time > ends[0] - _BESIDE * long) & (time < ends[1] + _BESIDE * long)
    below = -float(clear[beside].min()) / peak
    swings = _half_waves(clear[beside] / peak) - 1
    if below > _SWING and swings >= _SWINGS:
        raise looks_like(f"an oscillation: {swings} other half-waves beside it", source)
    ringing = below if below > _RINGS else 0.0
    return Shape(ringing, rest, tuple(_others(time, clear, peak, ends)), half)


def looks_like(what: str, source: str) -> InputError:
    """Return the refusal of a record that shows something else than a pulse."""
    return InputError(
        f"no impact: looks like {what}", source=source, key="value",
        allowed="a pulse that rises from zero and comes back (see --first-s, --last-s, --value)",
    )  # fmt: skip


def _half_waves(part: Array) -> int:
    """Return how many times a record swings beyond a third of its peak, to either side in turn."""
    sides = np.sign(part[np.abs(part) > _SWING])
    return 1 + int(np.count_nonzero(np.diff(sides)))


def _run(chosen: npt.NDArray[np.bool_], at: int) -> npt.NDArray[np.intp]:
    """Return the unbroken run of chosen samples around one of them."""
    out = np.flatnonzero(~chosen)
    low = out[out < at].max(initial=-1)
    return np.arange(low + 1, out[out > at].min(initial=chosen.size))


def _flat_top(clear: Array, top: int) -> int:
    """Return how many samples are cut off at the top, 0 if it is round."""
    run = _run(clear >= clear[top] * (1.0 - 1e-9), top)
    steps = np.diff(np.unique(clear))
    steps = steps[steps > 1e-9 * clear[top]]
    if run.size < _FLAT or steps.size == 0 or run[0] == 0 or run[-1] == clear.size - 1:
        return 0
    # a converter's smallest step makes a round top flat too, but its neighbours are one step below
    smallest = float(steps.min())
    coarse = np.abs(steps / smallest - np.round(steps / smallest)).max() < 0.02
    beside = clear[top] - max(clear[run[0] - 1], clear[run[-1] + 1])
    return 0 if coarse and beside <= _JUMP * smallest else int(run.size)


def _others(time: Array, clear: Array, peak: float, ends: tuple[float, float]) -> Iterator[float]:
    """Yield when other pulses of the record peak [s]."""
    long = ends[1] - ends[0]
    high = np.flatnonzero(
        (clear > _AGAIN * peak) & ((time < ends[0] - long) | (time > ends[1] + long))
    )
    for run in np.split(high, np.flatnonzero(np.diff(time[high]) > long) + 1):
        if run.size >= _FEWEST:
            yield float(time[run[np.argmax(clear[run])]])
