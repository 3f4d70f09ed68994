"""What a track says of the contacts in it."""

from __future__ import annotations

from dataclasses import dataclass

from ...core.arrays import Array
from ..measured import Measured
from .flights import Piece
from .scale import Scale
from .view import Stage, View


@dataclass(frozen=True)
class Bounce:
    """One contact: velocities just before and after, in the track's unit of length per second."""

    time: Measured
    approach: Measured
    """Downward speed of the point at the contact."""
    rebound: Measured
    restitution: Measured
    height: Measured
    """At which the flights meet, above the stage's floor."""
    turning: int
    """Index of the lowest sample."""
    before: Piece
    after: Piece

    @property
    def near(self) -> tuple[int, int]:
        """Last sample of the flight before, and first one of the flight after the contact."""
        before, after = self.before.index, self.after.index
        return int(before[before < self.turning][-1]), int(after[after > self.turning][0])


@dataclass(frozen=True)
class Bounced:
    """The contacts of a track in the order of time, and what its flights share.

    Ranges and the likeliest shared unknowns; the acceleration at rest that the track itself shows,
    nan if it shows none [unit/s²]; the size of the unit.
    """

    bounces: tuple[Bounce, ...]
    stage: Stage
    view: View
    fall: Measured
    scale: Scale
    notes: tuple[str, ...]

    def heights(self, piece: Piece, time: Array) -> Array:
        """Return the heights of a flight as the camera sees them, (n,) [unit]."""
        return self.stage.seen(self.view, piece.launch, piece.reference, time)

    def row(self, k: int) -> dict[str, Measured]:
        """Return the columns of trials.csv that contact `k` tells: ratios alone without a scale."""
        bounce, row = self.bounces[k], {"restitution": self.bounces[k].restitution}
        if self.scale.known:
            row["impact_speed_m_s"] = bounce.approach.times(self.scale.metres)
            row["rebound_speed_m_s"] = bounce.rebound.times(self.scale.metres)
        return row

    def part(self, k: int) -> slice:
        """Return the samples from the contact before `k` to the one after it."""
        low = self.bounces[k - 1].turning if k > 0 else 0
        return slice(low, self.bounces[k + 1].turning if k + 1 < len(self.bounces) else None)

    def trace(self, k: int, time: Array, height: Array) -> dict[str, Array]:
        """Return time [s] and height [m] of these samples from contact `k`; {} without a scale."""
        if not self.scale.known:
            return {}
        bounce, part = self.bounces[k], self.part(k)
        touch = self.stage.floor + bounce.height.value
        return {
            "time_s": time[part] - bounce.time.value,
            "tip_height_m": (height[part] - touch) * self.scale.metres.value,
        }
