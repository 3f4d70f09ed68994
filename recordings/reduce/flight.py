"""Bounces in the track of a falling body: free flights on both sides, velocities at the contact.

Between contacts a body in flight follows a parabola. Each flight is fitted robustly over as many
samples as the parabola describes, from near the contact outwards, so that contact, release and
drag stay out; the velocities are read at the instant in which both parabolas meet.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.ndimage import median_filter
from scipy.signal import find_peaks

from .measured import Array, Measured, propagate
from .regression import Regression, robust_regression, robust_std

Indices = npt.NDArray[np.int_]

_CORE_FROM, _CORE_TO = 0.10, 0.45
"""Share of a flight's samples, counted from the contact, with which its fit begins."""

_NEAR_LIMIT = 4.0
_FAR_LIMIT = 2.0
_RESOLVED = 4
"""Samples within the contact from which on its two ends are told apart."""

_MARGIN = 2
"""Samples left out between the flight and the first one that deviates from it."""

_SAME_FALL = 0.3
"""Largest relative difference of the accelerations on both sides of a contact: drag makes some."""

_MOST_CUTS = 6


@dataclass(frozen=True)
class Track:
    """Heights of a point against time; the unit of length is the caller's.

    Parameters
    ----------
    time
        (n,), increasing [s].
    height
        (n,), upwards [length].
    along
        (n,), tangential position in the plane of motion [length].
    floor
        Smallest error of a position that is believed [length].
    """

    time: Array
    height: Array
    along: Array
    floor: float = 0.0


@dataclass(frozen=True)
class Flight:
    """One fitted flight: height and tangential position as polynomials in `time - reference`."""

    first: int
    last: int
    reference: float
    height: Regression
    along: Regression
    acceleration: float | None
    """The acceleration that was given; None if it is the third coefficient."""

    def heights(self, time: Array) -> Array:
        """Return the fitted height at `time`, (n,) [length]."""
        tau = np.asarray(time) - self.reference
        return _height(self.height.coefficients, tau, self.acceleration)

    def along_at(self, time: Array) -> Array:
        """Return the fitted tangential position at `time`, (n,) [length]."""
        tau = np.asarray(time) - self.reference
        return np.asarray(self.along.coefficients[0] + self.along.coefficients[1] * tau)

    @property
    def fitted_acceleration(self) -> Measured | None:
        """The fitted acceleration [length/s²], None if it was given."""
        if self.acceleration is not None:
            return None
        c, v = self.height.coefficients, self.height.covariance
        return Measured(float(c[2]), float(np.sqrt(v[2, 2])))


@dataclass(frozen=True)
class Bounce:
    """One contact: velocities just before and after, in the track's unit of length per second."""

    time: Measured
    approach: Measured
    """Downward speed of the point at the contact."""
    rebound: Measured
    restitution: Measured
    along_before: Measured
    along_after: Measured
    turning: int
    """Index of the lowest sample."""
    before: Flight
    after: Flight


def contact_samples(track: Track) -> list[int]:
    """Return the indices of the lowest samples of every contact.

    A free flight has no minimum of height, so each clear minimum is a contact.
    """
    smooth = median_filter(track.height, 3, mode="nearest")
    noise = robust_std(np.diff(smooth, 2)) / np.sqrt(6.0)
    prominence = max(0.01 * float(np.ptp(smooth)), 8.0 * noise)
    if prominence <= 0.0:
        return []
    peaks, _ = find_peaks(-smooth, prominence=prominence)
    # the filter widens a sharp minimum: go back to the lowest sample itself
    found = []
    for peak in peaks:
        low, high = max(peak - 1, 0), min(peak + 2, smooth.size)
        found.append(low + int(np.argmin(track.height[low:high])))
    return found


def bounces(track: Track, *, acceleration: float | None) -> list[Bounce]:
    """Return every contact that has a usable flight on both sides.

    Parameters
    ----------
    track
        The point that is followed.
    acceleration
        Downward acceleration in flight [length/s²]; None fits it for each flight, which takes up
        an unknown scale and, to first order, air drag.
    """
    contacts = contact_samples(track)
    edges = [-1, *contacts, track.time.size]
    result = []
    for k, turning in enumerate(contacts, start=1):
        ends = (edges[k - 1] + 1, edges[k + 1] - 1)
        before, after = _both_sides(track, turning, ends, acceleration=acceleration)
        if before is not None and after is not None:
            result.append(_bounce(track, turning, before, after))
    return [b for b in result if b.approach.value > 0.0 and b.rebound.value > 0.0]


def _both_sides(
    track: Track, turning: int, ends: tuple[int, int], *, acceleration: float | None
) -> tuple[Flight | None, Flight | None]:
    """Fit the flights on both sides without rest, or bounces too small to see, behind them.

    Gravity is the same on both sides of a contact: where the fitted accelerations differ, the side
    of the smaller one is cut to half its length.
    """
    (low, high), whole = ends, ends
    for _ in range(_MOST_CUTS):
        before, after = (fit_flight(track, turning, e, acceleration=None) for e in (low, high))
        if before is None or after is None:
            break
        slower = _slower_fall(before, after)
        if slower == 0:
            whole = (low, high)
            break
        if slower < 0:
            low = turning - (turning - low) // 2
        else:
            high = turning + (high - turning) // 2
    if acceleration is None and whole == (low, high):
        return before, after
    first, last = (fit_flight(track, turning, e, acceleration=acceleration) for e in whole)
    return first, last


def _slower_fall(before: Flight, after: Flight) -> int:
    """Return the side with the smaller acceleration, -1 or 1; 0 where they agree."""
    a, b = before.fitted_acceleration, after.fitted_acceleration
    assert a is not None
    assert b is not None
    allowed = max(4.0 * math.hypot(a.std, b.std), _SAME_FALL * max(a.value, b.value))
    if abs(a.value - b.value) <= allowed:
        return 0
    return -1 if a.value < b.value else 1


def scale_from_fall(found: Sequence[Bounce], gravity: float) -> tuple[Measured, str]:
    """Return metres in the track's unit of length from gravity, nan if not known to 10 %."""
    values = [f.fitted_acceleration for b in found for f in (b.before, b.after)]
    pairs = np.array([(v.value, v.std) for v in values if v is not None and v.value > 0.0])
    if pairs.size == 0:
        return Measured(math.nan, math.nan), "nothing"
    weight = 1.0 / pairs[:, 1] ** 2
    mean = float(np.sum(weight * pairs[:, 0]) / weight.sum())
    # flights that disagree by more than their errors widen the uncertainty (Birge's ratio)
    spread = float(np.sum(weight * (pairs[:, 0] - mean) ** 2)) / max(len(pairs) - 1, 1)
    std = math.sqrt(max(1.0, spread) / float(weight.sum()))
    if not mean > 10.0 * std:
        return Measured(math.nan, math.nan), "nothing"
    return Measured(gravity / mean, gravity * std / mean**2), "gravity"


def fit_flight(
    track: Track, contact: int, end: int, *, acceleration: float | None
) -> Flight | None:
    """Fit the flight that lies between sample `contact` and sample `end`, on either side.

    Returns
    -------
    Flight or None
        None where there are too few samples for a fit.
    """
    step = 1 if end > contact else -1
    order = np.arange(contact + step, end + step, step)
    needed = 4 if acceleration is not None else 5
    if order.size < needed:
        return None
    core_from = min(int(_CORE_FROM * order.size), order.size - needed)
    core_to = max(int(_CORE_TO * order.size), core_from + needed)
    near, far = core_from, core_to
    while True:
        flight = _fit(track, order[near:far], acceleration)
        wider = _grow_far(track, flight, order, far)
        if wider == far:
            break
        far = wider
    near = _grow_near(track, flight, order, near)
    return _fit(track, order[near:far], acceleration)


def _grow_far(track: Track, flight: Flight, order: Indices, far: int) -> int:
    """Take in the next block away from the contact while it lies on the parabola."""
    block = order[far : far + max(2, (far * 15) // 100)]
    if block.size == 0:
        return far
    z = _deviation(track, flight, block)
    # a block off the parabola has a mean that its own noise does not explain
    limit = _FAR_LIMIT * max(1.0, 2.0 / np.sqrt(block.size))
    return far + block.size if abs(float(np.median(z))) < limit else far


def _grow_near(track: Track, flight: Flight, order: Indices, near: int) -> int:
    """Take in samples towards the contact until one deviates; keep a margin to that one."""
    if near == 0:
        return 0
    z = np.abs(_deviation(track, flight, order[:near]))
    off = np.flatnonzero(z > _NEAR_LIMIT)
    # an isolated outlier is the regression's business; contact is two in a row or the very end
    contact = [i for i in off if i == 0 or z[i - 1] > _NEAR_LIMIT]
    return min(int(contact[-1]) + 1 + _MARGIN, near) if contact else 0


def _deviation(track: Track, flight: Flight, index: Indices) -> Array:
    tau = track.time[index] - flight.reference
    design = _design(tau, flight.acceleration)
    spread = np.hypot(flight.height.sigma, flight.height.prediction_std(design))
    spread = np.maximum(spread, 1e-9 * np.ptp(track.height))
    return np.asarray((track.height[index] - flight.heights(track.time[index])) / spread)


def _fit(track: Track, index: Indices, acceleration: float | None) -> Flight:
    index = np.sort(index)
    time = track.time[index]
    reference = float(time.mean())
    tau = time - reference
    design = _design(tau, acceleration)
    known = 0.0 if acceleration is None else -0.5 * acceleration * tau**2
    height = robust_regression(design, track.height[index] - known, floor=track.floor)
    along = robust_regression(
        np.stack([np.ones_like(tau), tau], axis=1), track.along[index], floor=track.floor
    )
    return Flight(int(index[0]), int(index[-1]), reference, height, along, acceleration)


def _design(tau: Array, acceleration: float | None) -> Array:
    columns = [np.ones_like(tau), tau]
    if acceleration is None:
        columns.append(-0.5 * tau**2)
    return np.stack(columns, axis=1)


def _height(c: Array, tau: Array | float, acceleration: float | None) -> Array:
    a = c[2] if acceleration is None else acceleration
    return np.asarray(c[0] + c[1] * tau - 0.5 * a * tau**2)


def _bounce(track: Track, turning: int, before: Flight, after: Flight) -> Bounce:
    guess = float(track.time[turning])
    size = before.height.coefficients.size
    ends = _resolved_contact(track, before, after)

    def numbers(c: Array) -> Array:
        return _contact(c[:size], c[size:], before, after, guess, ends)

    c = np.concatenate([before.height.coefficients, after.height.coefficients])
    covariance = np.zeros((c.size, c.size))
    covariance[:size, :size] = before.height.covariance
    covariance[size:, size:] = after.height.covariance
    time, approach, rebound, ratio = propagate(numbers, c, covariance)
    return Bounce(
        time, approach, rebound, ratio, _slope(before), _slope(after), turning, before, after
    )


def _slope(flight: Flight) -> Measured:
    return Measured(
        float(flight.along.coefficients[1]), float(np.sqrt(flight.along.covariance[1, 1]))
    )


def _resolved_contact(track: Track, before: Flight, after: Flight) -> tuple[float, float] | None:
    """First and last instant of the contact, if the track has enough samples within it."""
    first, last = before.last + _MARGIN, after.first - _MARGIN
    if last - first - 1 < _RESOLVED:
        return None
    return float(track.time[first]), float(track.time[last])


def _contact(
    cb: Array,
    ca: Array,
    before: Flight,
    after: Flight,
    guess: float,
    ends: tuple[float, float] | None,
) -> Array:
    """Instant in which the two parabolas meet near `guess`, and the speeds at the contact.

    With a contact that the track resolves, the approach is read at its start and the rebound at
    its end; else both where the parabolas meet.
    """
    time = guess
    for _ in range(8):
        tb, ta = time - before.reference, time - after.reference
        gap = float(_height(cb, tb, before.acceleration) - _height(ca, ta, after.acceleration))
        rate = _rate(cb, tb, before.acceleration) - _rate(ca, ta, after.acceleration)
        if rate == 0.0:
            break
        time -= gap / rate
    start, end = (time, time) if ends is None else (min(ends[0], time), max(ends[1], time))
    down = -_rate(cb, start - before.reference, before.acceleration)
    up = _rate(ca, end - after.reference, after.acceleration)
    return np.array([time, down, up, up / down if down != 0.0 else np.nan])


def _rate(c: Array, tau: float, acceleration: float | None) -> float:
    a = c[2] if acceleration is None else acceleration
    return float(c[1] - a * tau)
