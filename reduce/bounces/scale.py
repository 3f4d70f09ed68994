"""The size of a track's unit of length, by gravity and by what was stated, and a flat that drifts.

Gravity and the body's own diameter (or a stated size) are independent scales. Where they disagree
the result lies between them and its error holds both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array
from ..gates import Refused
from ..measured import Measured
from ..rules import RULES


@dataclass(frozen=True)
class Scale:
    """Size of the unit [m], nan if it is not known; where it came from; remarks."""

    metres: Measured
    origin: str
    notes: tuple[str, ...] = ()
    off: float = 0.0
    """By which the fall asks for another unit than what is stated, in it; 0 within its error."""

    @property
    def known(self) -> bool:
        """Whether speeds in metres per second can be told."""
        return math.isfinite(self.metres.value)


def scale_of(fall: Measured, gravity: float, stated: Measured | None) -> Scale:
    """Return the size of the unit by the fall and by what was stated [m], if it was.

    `fall` is the acceleration at rest that the track shows [unit/s²], nan if it shows none,
    `gravity` what it should be [m/s²].
    """
    by_fall = None
    if fall.value > 0.0 and fall.std < RULES.fall_known * fall.value:
        by_fall = Measured(gravity / fall.value, gravity * fall.std / fall.value**2)
    if stated is None:
        if by_fall is None:
            return Scale(Measured(math.nan, math.nan), "nothing")
        return Scale(by_fall, "gravity")
    if by_fall is None:
        return Scale(stated, "as stated")
    both = math.hypot(by_fall.std, stated.std)
    apart = abs(by_fall.value - stated.value)
    if apart <= RULES.by_chance * both:
        if stated.std == 0.0:
            return Scale(stated, "as stated")
        w = np.array([by_fall.std, stated.std]) ** -2.0
        mean = float(w @ [by_fall.value, stated.value] / w.sum())
        std = float(w.sum() ** -0.5) * max(apart / both, 1.0)
        return Scale(Measured(mean, std), "gravity and what is stated")
    middle = stated.value if stated.std == 0.0 else 0.5 * (by_fall.value + stated.value)
    std = max(abs(v - middle) for v in (by_fall.value, stated.value))
    off = by_fall.value / stated.value - 1.0
    note = (
        f"the stated unit {stated} m and that of the fall, {by_fall} m, differ by "
        f"{100.0 * off:+.2g} %: check unit, rate, plane of the scale; the error of the speeds "
        "holds both"
    )
    metres = Measured(middle, math.hypot(std, both))
    return Scale(metres, "what is stated, against gravity", (note,), off)


def check_scale(scale: Scale, *, source: str) -> None:
    """Refuse a track whose unit or rate contradicts gravity, with the values that would fit.

    Drag and buoyancy make less.
    """
    if abs(1.0 / (1.0 + scale.off) - 1.0) > RULES.fall_off:
        ratio = 1.0 + scale.off
        raise Refused(
            f"it falls with {1.0 / ratio:.3g} times gravity", source=source,
            allowed=f"a fall: the unit or the stated size times {ratio:.4g} would fit, or the "
            f"rate times {math.sqrt(ratio):.4g}, or another gravity_m_s2",
        )  # fmt: skip


def floor_drift(contacts: Sequence[tuple[Measured, Measured]], fall: float) -> Measured:
    """Return how fast the flat itself moves up through the picture [unit/s].

    The heights of the contacts, times [s] and heights [unit], show it where there are two or more:
    a camera that is not level while the body drifts aside, or a body that comes nearer. `fall` is
    its acceleration [unit/s²].
    """
    if len(contacts) < 2:
        return Measured(0.0, 0.0)
    beliefs, means, variances = _drifts(contacts, fall)
    weight = np.exp(beliefs - beliefs.max())
    weight /= weight.sum()
    mean = float(weight @ means)
    variance = float(weight @ (variances + (means - mean) ** 2))
    return Measured(mean, math.sqrt(max(variance, 0.0)))


def frames_lost(
    contacts: Sequence[tuple[Measured, Measured]], rises: Sequence[float], fall: float
) -> Array:
    """Return how likely a frame is missing in each contact, (n,); 0 where the heights tell nothing.

    Contacts with time [s] and height [unit]; `rises` is by how much a missing frame lifts the point
    where the flights of each meet [unit], `fall` the acceleration [unit/s²].
    """
    if len(contacts) < 2:
        return np.zeros(len(contacts))
    seen = [_belief(contacts, fall)]
    for k, rise in enumerate(rises):
        time, height = contacts[k]
        lower = Measured(height.value - rise, height.std)
        moved = [*contacts[:k], (time, lower), *contacts[k + 1 :]]
        seen.append(_belief(moved, fall) + math.log(RULES.missing_frame))
    share = np.exp(np.array(seen) - max(seen))
    share /= share.sum()
    return np.where(share[1:] > RULES.missing_told, share[1:], 0.0)


def _belief(contacts: Sequence[tuple[Measured, Measured]], fall: float) -> float:
    return float(np.logaddexp.reduce(_drifts(contacts, fall)[0]))


def _drifts(
    contacts: Sequence[tuple[Measured, Measured]], fall: float
) -> tuple[Array, Array, Array]:
    """Return, for each width of the prior, its log evidence, and mean and variance of the drift."""
    time = np.array([t.value for t, _ in contacts])
    height = np.array([h.value for _, h in contacts])
    error = np.array([h.std for _, h in contacts])
    late = time - time.mean()
    rest = height - np.average(height, weights=error**-2.0)
    found = []
    for width in RULES.drift_widths:
        std = width * abs(fall)
        covariance = np.diag(error**2) + np.outer(late, late) * std**2
        size = np.linalg.slogdet(covariance)[1]
        gain = std**2 * late @ np.linalg.inv(covariance)
        belief = -0.5 * (size + rest @ np.linalg.solve(covariance, rest))
        found.append((belief, gain @ rest, std**2 * (1.0 - gain @ late)))
    beliefs, means, variances = np.array(found).T
    return beliefs, means, variances
