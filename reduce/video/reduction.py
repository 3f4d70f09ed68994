"""High-speed video to approach and rebound speed of a falling rod or ball.

As chapter 3 of the thesis does it, with sub-pixel positions and uncertainties: the critical frame
is the one with the fewest dark pixels, the threshold lies between the two grey levels of that
frame, the tip is followed through all frames, the lean is checked on both sides of the contact,
and the speeds come from robust fits of free flight. Time is the camera's, not the container's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import Array, Integers
from ..bounces.contacts import Bounce, Bounced, told_bounces
from ..bounces.fall import UNKNOWN, Ball
from ..bounces.track import Track
from ..images.clip import Clip
from ..measured import Measured, Trial, labels
from ..rules import RULES
from .tracking import grey_levels, striker_bright, track_ball, track_rod


@dataclass(frozen=True)
class Optics:
    """How the picture becomes metres and seconds.

    - `rate`: the camera's own frames per second [1/s].
    - `scale`: size of a pixel [m], or None.
    - `size`: diameter of the striker [m], from which the scale follows, or None.
    - `ball`: gravity, which gives the scale where the fall is long enough, and drag as far as
      known.
    - `line_time`: from one row of the picture to the next, of a shutter that rolls down [s].
    - `stamps`: (n,) times of the frames where they are not evenly spaced (a phone's) [s].
    """

    rate: float
    ball: Ball = UNKNOWN
    scale: Measured | None = None
    size: Measured | None = None
    line_time: float = 0.0
    stamps: Array | None = None

    def time(self, frame: Integers, row: Array) -> Array:
        """Return when a row of a frame was exposed, (n,) [s]."""
        begun = frame / self.rate if self.stamps is None else self.stamps[frame]
        return np.asarray(begun + self.line_time * row)


@dataclass(frozen=True)
class VideoReduction:
    """A tracked clip and the contacts in it.

    - `frame`: (n,) numbers of the frames in which the striker was found.
    - `column`, `row`: (n,) tip of the rod on its axis, or centre of the ball [pixel].
    - `lean`: (n,) lean of the rod to the right [rad], 0 for a ball.
    - `half_width`: half the width of the rod, or radius of the ball [pixel].
    - `found`: contacts in pixels and seconds, and the size of a pixel [m]; nan leaves only ratios.
    """

    frame: Integers
    column: Array
    row: Array
    lean: Array
    shape: str
    half_width: Measured
    tip_radius: float
    optics: Optics
    found: Bounced
    notes: tuple[str, ...]

    @property
    def time(self) -> Array:
        """Time of each tracked frame, (n,) [s]."""
        return self.optics.time(self.frame, self.row)

    @property
    def bounces(self) -> tuple[Bounce, ...]:
        """The contacts."""
        return self.found.bounces

    @property
    def scale(self) -> Measured:
        """Size of a pixel [m]."""
        return self.found.scale.metres

    def trials(self) -> tuple[Trial, ...]:
        """Return a row of trials.csv for each contact."""
        return tuple(self._trial(k, label) for k, label in enumerate(labels(len(self.bounces))))

    def _trial(self, k: int, label: str) -> Trial:
        bounce, part = self.bounces[k], self.found.part(k)
        row, trace = self.found.row(k), self.found.trace(k, self.time, -self.row)
        if trace:
            aside = self.column[part] - self.column[bounce.turning]
            trace["tip_x_m"] = aside * self.scale.value
        if self.shape == "rod":
            lean = self._lean_before(bounce)
            row["angle_deg"] = Measured(
                90.0 - math.degrees(abs(lean.value)), math.degrees(lean.std)
            )
            if trace:
                trace["angle_rad"] = 0.5 * np.pi - np.abs(self.lean[part])
        return Trial(row, trace=trace, label=label)

    def _lean_before(self, bounce: Bounce) -> Measured:
        near = self.frame <= self.frame[bounce.near[0]]
        last = self.lean[near][-RULES.lean_frames :]
        return Measured(float(np.median(last)), float(np.std(last) / max(len(last) - 1, 1) ** 0.5))


def reduce_video(
    clip: Clip, optics: Optics, *, shape: str = "rod", striker_is: str = "bright",
    background: str = "none",
) -> VideoReduction:  # fmt: skip
    """Track the striker through a clip with gravity downwards and return its contacts.

    A rod enters from above, with straight sides and a round tip; a sphere is wholly in view.
    `background="median"` subtracts the median of all frames: for a striker that moves over a ground
    of its own brightness.
    """
    frames = striker_bright(clip, striker_is, background)
    levels = grey_levels(frames, clip.source)
    dark_pixels = np.array([np.count_nonzero(f <= 0.5 * sum(levels)) for f in frames])
    critical = int(np.argmin(dark_pixels))
    if shape == "rod":
        levels = grey_levels(frames[critical : critical + 1], clip.source)
        track, rod = track_rod(frames, critical, levels, clip.source)
        half = Measured(rod.half_width, 0.02)
        tip_radius, near = rod.tip_radius, RULES.mirror_reach * rod.blur
    else:
        track = track_ball(frames, levels, clip.source)
        radii = track["radius"]
        half = Measured(float(np.median(radii)), float(np.std(radii) / math.sqrt(radii.size)))
        half = Measured(half.value, max(half.std, 0.01 * half.value))
        tip_radius, near = half.value, 0.0
    fresh = np.isin(track["frame"], clip.repeats, invert=True)
    track = {name: values[fresh] for name, values in track.items() if name != "radius"}
    optics, notes = _timed(clip, optics)
    result = VideoReduction(
        **track, shape=shape, half_width=half, tip_radius=tip_radius, optics=optics,
        found=_contacts(track, half, near, optics, clip.source), notes=(),
    )  # fmt: skip
    return replace(result, notes=(*notes, *result.found.notes, *_flight_notes(result)))


def _contacts(
    track: dict[str, Array], half: Measured, near: float, optics: Optics, source: str
) -> Bounced:
    time = optics.time(track["frame"].astype(np.int64), track["row"])
    stated = optics.scale
    if stated is None and optics.size is not None:
        stated = optics.size.over(half.scaled(2.0))
    path = Track(
        time, -track["row"], floor=RULES.position_floor, trend=RULES.position_trend, near=near,
        unsure=RULES.mirror_move,
    )  # fmt: skip
    return told_bounces(
        path, optics.ball, metres=stated, source=source,
        allowed="a clip that shows the striker fall, touch and rise",
    )  # fmt: skip


def _timed(clip: Clip, optics: Optics) -> tuple[Optics, list[str]]:
    """Take the container's time stamps where it was written as it was filmed, and unevenly."""
    notes, rate = [], optics.rate
    if abs(clip.container_rate / rate - 1.0) > RULES.same_rate:  # not so for nan, of pictures
        notes.append(
            f"the container plays at {clip.container_rate:.6g} frames/s; {rate:g} was used"
        )
    elif clip.uneven and clip.stamps is not None:
        optics = replace(optics, stamps=clip.stamps - clip.stamps[0])
        notes.append(
            f"{clip.uneven} gaps between the container's time stamps are uneven: they tell the time"
        )
    if clip.repeats.size:
        notes.append(
            f"{clip.repeats.size} of {len(clip.frames)} frames repeat the one before and are left "
            "out: the camera's own rate is lower"
        )
    return optics, notes


def _flight_notes(result: VideoReduction) -> list[str]:
    notes = []
    if not math.isfinite(result.scale.value):
        notes.append("no length scale: ratios only (give the size of a pixel or the diameter)")
    else:
        part, origin = result.scale.std / result.scale.value, result.found.scale.origin
        size = result.scale.value * 1e6
        notes.append(f"pixel {size:.4g} um ± {100 * part:.2g} % from {origin}")
    for number, bounce in enumerate(result.bounces, start=1):
        last, first = bounce.near
        gap = result.frame[first] - result.frame[last] - 1
        used = [p.index.size for p in (bounce.before, bounce.after)]
        notes.append(
            f"contact {number}: {gap} frames left out, contact shorter than "
            f"{(gap + 1) / result.optics.rate * 1e3:.3g} ms; flights of {used[0]} and {used[1]} "
            "frames"
        )
    if result.shape == "rod":
        notes.extend(_lean_notes(result))
    return notes


def _lean_notes(result: VideoReduction) -> list[str]:
    turning, count = result.bounces[0].turning, RULES.lean_frames
    sides = {
        "before": result.lean[max(turning - 2 * count, 0) : turning][:count],
        "after": result.lean[turning + count : turning + 2 * count],
    }
    return [
        f"axis {name} contact {90 - math.degrees(np.median(lean)):.2f} ± "
        f"{math.degrees(np.std(lean)):.2f} deg"
        for name, lean in sides.items() if lean.size
    ]  # fmt: skip
