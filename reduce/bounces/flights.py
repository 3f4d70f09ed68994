"""Flights in a track, each over as many samples as one motion describes.

A flight grows from its contact outwards. It begins behind the samples that the contact has moved
and ends where its residuals show structure: a hand, a frame that was dropped without a word, a
tracker that begins anew.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array, Indices
from ..measured import Measured
from ..rules import RULES
from ..shared.regression import Regression, robust_regression
from .track import Track
from .view import Launch, Stage, View


@dataclass(frozen=True, eq=False)
class Piece:
    """Samples of one flight, (n,) in order of time, and its motion.

    `launch` holds at the time `reference` [s]; `sigma` is the standard deviation of a sample
    [unit].
    """

    index: Indices
    reference: float
    launch: Launch
    sigma: float

    @property
    def first(self) -> int:
        """First sample."""
        return int(self.index[0])

    @property
    def last(self) -> int:
        """Last sample."""
        return int(self.index[-1])

    def straight(self, time: Array, fall: float) -> bool:
        """Whether an acceleration [unit/s²] hardly changes its speed, and so says nothing of it."""
        return abs(fall) * self.duration(time) < RULES.straight * abs(self.launch.speed)

    def duration(self, time: Array) -> float:
        """Return how long its samples, of a track with these times, span [s]."""
        return float(time[self.last] - time[self.first])


def side(
    track: Track, contact: int, end: int, stage: Stage, view: View | None, *, off: int = 0
) -> Piece | None:
    """Return the flight next to sample `contact`, towards sample `end`; None where there is none.

    Without a view it is a parabola of its own. `off` samples next to the turning point belong to
    the contact.
    """
    step = 1 if end > contact else -1
    order = np.arange(contact + step, end + step, step)
    if off and order.size - off >= RULES.flight_samples:
        order = order[off:]
    if order.size < RULES.flight_samples:
        return None
    size = min(RULES.flight_core, order.size)
    tried = [
        _grown(track, order, near, size, stage, view) for near in _clean_starts(track, order, size)
    ]
    # begun within a contact it does not reach far, and one that took in what is none is crooked
    best, _ = min(tried, key=lambda found: found[1])
    if view is not None and best.straight(track.time, view.fall):
        best = _off_the_contact(track, best, step, stage, view)
    return best if best.index.size >= RULES.flight_samples else None


def _off_the_contact(track: Track, piece: Piece, step: int, stage: Stage, view: View) -> Piece:
    """Leave out the samples next to a contact that lie, in their mean, off the flight of the rest.

    Where a contact sets in, no single sample is off by more than its noise.
    """
    for _ in range(RULES.trim_rounds):
        size = max(RULES.flight_samples, piece.index.size // 8)
        if piece.index.size < 4 * size:
            break
        index = piece.index[::step]
        near, rest = np.sort(index[:size]), np.sort(index[size:])
        fit = _fitted(track, rest, stage, view)
        time = track.time[near]
        off = float(np.mean(track.height[near] - fit.heights(time)))
        design = stage.launch_slopes(view, fit.launch, fit.reference, time)
        predicted = float(fit.regression.prediction_std(design).mean())
        if abs(off) < RULES.no_chance * np.hypot(fit.sigma / np.sqrt(size), predicted):
            break
        piece = Piece(rest[fit.regression.used], fit.reference, fit.launch, fit.regression.sigma)
    return piece


def _grown(
    track: Track, order: Indices, near: int, size: int, stage: Stage, view: View | None
) -> tuple[Piece, float]:
    """Let a flight grow from `size` samples, `near` samples away from its contact.

    Returns it, and the error of the speed that it tells at the turning point [unit/s].
    """
    used = order[near : near + size]
    far = near + size
    while True:
        fit = _fitted(track, used, stage, view)
        more, reached = _next_blocks(track, fit, order, far, used.size)
        if more.size == 0:
            break
        used, far = np.concatenate([used, more]), reached
    used = np.sort(np.concatenate([_nearer(track, fit, order[:near]), used]))
    fit = _fitted(track, used, stage, view)
    kept = used[fit.regression.used]
    piece = Piece(kept, fit.reference, fit.launch, fit.regression.sigma)
    return piece, fit.speed_error(float(track.time[order[0]]), track.time[kept])


def _clean_starts(track: Track, order: Indices, size: int) -> list[int]:
    """Return after how many samples from a turning point the contact may be over, up to three."""
    offsets, spreads = [], []
    offset = 0
    # farther out lie rest and other flights, which may be quieter
    while offset + size <= order.size and offset <= RULES.flight_reach * size:
        fit = _parabola(track, order[offset : offset + size])
        upward = fit.coefficients[2] > RULES.no_chance * np.sqrt(fit.covariance[2, 2])
        spreads.append(np.inf if upward else fit.sigma)
        offsets.append(offset)
        offset += max(1, offset // 2)
    limit = 1.5 * max(min(spreads, default=np.inf), track.noise)
    clean = [o for o, s in zip(offsets, spreads, strict=True) if s <= limit]
    clean = clean or [0]
    return sorted({clean[0], clean[len(clean) // 2], clean[-1]})


def _parabola(track: Track, index: Indices) -> Regression:
    tau = track.time[index] - track.time[index].mean()
    return robust_regression(_powers(tau), track.height[index], floor=track.floor)


@dataclass(frozen=True)
class _Fit:
    """One flight fitted by itself: as a parabola, or as a launch in the view that all share."""

    stage: Stage
    view: View | None
    reference: float
    launch: Launch
    regression: Regression
    sigma: float

    def heights(self, time: Array) -> Array:
        if self.view is None:
            return np.asarray(_powers(time - self.reference) @ self.regression.coefficients)
        return self.stage.seen(self.view, self.launch, self.reference, time)

    def deviations(self, track: Track, index: Indices) -> Array:
        """Return how far samples lie off, in units of the spread that is expected."""
        time = track.time[index]
        if self.view is None:
            design = _powers(time - self.reference)
        else:
            design = self.stage.launch_slopes(self.view, self.launch, self.reference, time)
        predicted = self.regression.prediction_std(design) * self.sigma / self.regression.sigma
        spread = np.maximum(np.hypot(self.sigma, predicted), 1e-9 * self.stage.reach)
        return np.asarray((track.height[index] - self.heights(time)) / spread)

    def speed_error(self, contact: float, time: Array) -> float:
        """Return the error of the speed at a contact by a flight seen at some times [unit/s]."""
        late = contact - self.reference
        row = np.array([0.0, 1.0, 2.0 * late] if self.view is None else [0.0, 1.0])
        fall = 2.0 * self.regression.coefficients[2] if self.view is None else self.view.fall
        bridged = RULES.uneven_fall * abs(fall) * float(np.abs(time - contact).min())
        variance = float(row @ self.regression.covariance @ row)
        told = time.size >= RULES.flight_samples
        return float(np.hypot(np.sqrt(variance), bridged)) if told else np.inf


def _powers(tau: Array) -> Array:
    return np.stack([np.ones_like(tau), tau, tau**2], axis=1)


def _fitted(track: Track, index: Indices, stage: Stage, view: View | None) -> _Fit:
    time = track.time[index]
    reference = float(time.mean())
    tau = time - reference
    tiny = max(track.floor, 1e-9 * stage.reach)
    if view is None:
        fit = robust_regression(_powers(tau), track.height[index], floor=tiny)
        launch = Launch(float(fit.coefficients[0] - stage.floor), float(fit.coefficients[1]))
    else:
        slope, middle = np.polyfit(tau, track.height[index] + 0.5 * view.fall * tau**2, 1)
        launch = Launch(float(middle) - stage.floor, float(slope))
        for _ in range(2):
            left = track.height[index] - stage.seen(view, launch, reference, time)
            design = stage.launch_slopes(view, launch, reference, time)
            fit = robust_regression(design, left, floor=tiny)
            launch = Launch(*(float(v) for v in np.add(launch, fit.coefficients)))
    # a flight that has taken in what is none would take in more
    sigma = min(fit.sigma, RULES.flight_noise * track.noise)
    return _Fit(stage, view, reference, launch, fit, sigma)


def own_fall(track: Track, piece: Piece) -> Measured:
    """Return the downward acceleration of a flight by itself, as a parabola [unit/s²]."""
    fit = _parabola(track, piece.index)
    return Measured(-2.0 * float(fit.coefficients[2]), 2.0 * float(np.sqrt(fit.covariance[2, 2])))


def _next_blocks(
    track: Track, fit: _Fit, order: Indices, far: int, size: int
) -> tuple[Indices, int]:
    """Return the next samples away from the contact that lie on the flight, and how far they go."""
    width = max(3, int(RULES.flight_block * size))
    for skipped in range(RULES.stray_blocks + 1):
        start = far + skipped * width
        block = order[start : start + width]
        if block.size == 0 or block.size < min(3, order.size - far):
            break
        z = fit.deviations(track, block)
        # a block off the flight has a middle that its own noise does not explain
        middle, on_it = abs(float(np.median(z))), np.mean(np.abs(z) < RULES.no_chance)
        if middle < RULES.flight_far and on_it >= RULES.mostly:
            return block, start + block.size
    return order[:0], far


def _nearer(track: Track, fit: _Fit, rest: Indices) -> Indices:
    """Return the samples towards the contact that lie on the flight, up to the first ones off."""
    if rest.size == 0:
        return rest
    z = np.abs(fit.deviations(track, rest))
    off = np.flatnonzero(z > RULES.no_chance)
    # an isolated stray is the regression's business; contact is two in a row or the very end
    contact = [i for i in off if i == 0 or z[i - 1] > RULES.no_chance]
    first = int(contact[-1]) + 1 if contact else 0
    return rest[first:]
