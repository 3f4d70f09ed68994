"""High-speed video to approach and rebound speed of a falling rod or ball.

As chapter 3 of the thesis does it, with sub-pixel positions and uncertainties: the critical frame
is the one with the fewest dark pixels, the threshold lies between the two grey levels of that
frame, the tip is followed through all frames, the lean is checked on both sides of the contact,
and the speeds come from robust fits of free flight. Time is the camera's, not the container's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from ....core.errors import InputError
from ..clip import Clip
from ..edge_fit import Ball, RodPose, RodShape, fit_ball, fit_rod
from ..flight import Bounce, Track, bounces, scale_from_fall
from ..measured import Array, Measured, Trial
from ..silhouette import ball_by_light, body_mask, rod_guess

SHAPES = ("rod", "sphere")
BACKGROUNDS = ("none", "median")
BRIGHTNESS = ("bright", "dark")
GRAVITY = 9.81

_LEAN_FRAMES = 20
_LEAN_LIMIT = math.radians(5.0)
_SHAPE_FRAMES = 15
_MOSTLY = 0.8
"""Part of the frames in which the edge of the ball must be found, else its light is used."""

_POSITION_FLOOR = 1e-3
"""No position in a picture is believed better than this [pixel]."""


@dataclass(frozen=True)
class Optics:
    """How the picture becomes metres and seconds.

    Parameters
    ----------
    rate
        The camera's own frames per second [1/s].
    scale
        Size of a pixel [m], or None.
    size
        Diameter of the striker [m], from which the scale follows, or None.
    gravity
        [m/s²]; gives the scale when neither of the others is known and the fall is long enough.
    """

    rate: float
    scale: Measured | None = None
    size: Measured | None = None
    gravity: float = GRAVITY


@dataclass(frozen=True)
class VideoReduction:
    """A tracked clip and the contacts in it.

    Parameters
    ----------
    frame
        (n,) numbers of the frames in which the striker was found.
    column, row
        (n,) tip of the rod on its axis, or centre of the ball [pixel].
    row_std
        (n,) standard deviation of `row` by the fit, nan for a ball [pixel].
    lean
        (n,) lean of the rod to the right [rad], 0 for a ball.
    critical_frame, threshold, levels
        Frame with the fewest dark pixels, grey level between body and background, both levels.
    half_width
        Half the width of the rod, or radius of the ball [pixel].
    scale, scale_from
        Size of a pixel [m] and where it came from; a scale of nan leaves only ratios.
    bounces
        Contacts in pixels and seconds.
    """

    frame: npt.NDArray[np.int64]
    column: Array
    row: Array
    row_std: Array
    lean: Array
    shape: str
    critical_frame: int
    threshold: float
    levels: tuple[float, float]
    half_width: Measured
    tip_radius: float
    scale: Measured
    scale_from: str
    rate: float
    gravity: float
    bounces: tuple[Bounce, ...]
    notes: tuple[str, ...]
    source: str

    @property
    def time(self) -> Array:
        """Time of each tracked frame, (n,) [s]."""
        return self.frame / self.rate

    def trials(self) -> tuple[Trial, ...]:
        """Return a row of trials.csv for each contact."""
        return tuple(self._trial(b, k) for k, b in enumerate(self.bounces, start=1))

    def _trial(self, bounce: Bounce, number: int) -> Trial:
        row = {"restitution": bounce.restitution}
        if math.isfinite(self.scale.value):
            row["impact_speed_m_s"] = bounce.approach.times(self.scale)
            row["rebound_speed_m_s"] = bounce.rebound.times(self.scale)
        if self.shape == "rod":
            lean = self._lean_before(bounce)
            row["angle_deg"] = Measured(
                90.0 - math.degrees(abs(lean.value)), math.degrees(lean.std)
            )
        label = f"bounce{number}" if len(self.bounces) > 1 else ""
        return Trial(row, self.notes, trace=self._trace(bounce, number), label=label)

    def _lean_before(self, bounce: Bounce) -> Measured:
        near = self.frame <= self.frame[bounce.before.last]
        last = self.lean[near][-_LEAN_FRAMES:]
        return Measured(float(np.median(last)), float(np.std(last) / max(len(last) - 1, 1) ** 0.5))

    def _trace(self, bounce: Bounce, number: int) -> dict[str, Array]:
        if not math.isfinite(self.scale.value):
            return {}
        low = 0 if number == 1 else self.bounces[number - 2].turning
        high = self.frame.size if number == len(self.bounces) else self.bounces[number].turning
        part = slice(low, high)
        touch = float(bounce.before.heights(np.array([bounce.time.value]))[0])
        trace = {
            "time_s": self.time[part] - bounce.time.value,
            "tip_height_m": (-self.row[part] - touch) * self.scale.value,
            "tip_x_m": (self.column[part] - self.column[bounce.turning]) * self.scale.value,
        }
        if self.shape == "rod":
            trace["angle_rad"] = 0.5 * np.pi - np.abs(self.lean[part])
        return trace


def reduce_video(
    clip: Clip,
    optics: Optics,
    *,
    shape: str = "rod",
    striker_is: str = "bright",
    background: str = "none",
) -> VideoReduction:
    """Track the striker through a clip and return its contacts.

    Parameters
    ----------
    clip
        Frames with gravity downwards.
    optics
        Frame rate, and one way to the size of a pixel.
    shape
        `"rod"` (enters from above, straight sides, round tip) or `"sphere"` (wholly in view).
    striker_is
        `"bright"` on a dark ground, or `"dark"` on a bright one.
    background
        `"none"`, or `"median"` to subtract the median of all frames: for a striker that moves
        over a ground of its own brightness.

    Raises
    ------
    InputError
        No striker, no contact or too few frames of flight in the clip.
    """
    frames = _signal(clip, striker_is, background)
    levels = _levels(frames, clip.source)
    dark_pixels = np.array([np.count_nonzero(f <= 0.5 * sum(levels)) for f in frames])
    critical = int(np.argmin(dark_pixels))
    if shape == "rod":
        levels = _levels(frames[critical : critical + 1], clip.source)
        track, rod = _track_rod(frames, critical, levels, clip.source)
        half = Measured(rod.half_width, 0.02)
        tip_radius = rod.tip_radius
    else:
        track = _track_ball(frames, levels, clip.source)
        radii = track["radius"]
        half = Measured(float(np.median(radii)), float(np.std(radii) / math.sqrt(radii.size)))
        half = Measured(half.value, max(half.std, 0.01 * half.value))
        tip_radius = half.value
    fresh = np.isin(track["frame"], clip.repeats, invert=True)
    track = {name: values[fresh] for name, values in track.items() if name != "radius"}
    notes = _timing_notes(clip, optics.rate)
    found, scale, origin = _contacts(track, half, optics, clip.source)
    result = VideoReduction(
        **track, shape=shape, critical_frame=critical, threshold=0.5 * sum(levels), levels=levels,
        half_width=half, tip_radius=tip_radius, scale=scale, scale_from=origin, rate=optics.rate,
        gravity=optics.gravity, bounces=tuple(found), notes=(), source=clip.source,
    )  # fmt: skip
    return replace(result, notes=(*notes, *_flight_notes(result, optics)))


def _signal(clip: Clip, striker_is: str, background: str) -> npt.NDArray[np.uint8]:
    frames = clip.frames
    if background == "median":
        ground = np.median(frames[:: max(1, len(frames) // 60)], axis=0).astype(np.int16)
        sign = 1 if striker_is == "bright" else -1
        moved = np.empty_like(frames)
        for number, frame in enumerate(frames):
            moved[number] = np.clip(sign * (frame.astype(np.int16) - ground), 0, 255)
        return moved
    return frames if striker_is == "bright" else 255 - frames


def _levels(frames: npt.NDArray[np.uint8], source: str) -> tuple[float, float]:
    """Return the grey levels of ground and striker: medians on both sides of Otsu's threshold."""
    from skimage.filters import threshold_otsu

    sample = frames[:: max(1, len(frames) // 40)].ravel()
    if sample.min() == sample.max():
        raise InputError(
            "every pixel has the same grey", source=source, allowed="a clip of an impact"
        )
    threshold = threshold_otsu(sample)
    dark, bright = sample[sample <= threshold], sample[sample > threshold]
    return float(np.median(dark)), float(np.median(bright))


def _track_rod(
    frames: npt.NDArray[np.uint8], critical: int, levels: tuple[float, float], source: str
) -> tuple[dict[str, Any], RodShape]:
    shape = _rod_shape(frames, critical, levels)
    if shape is None:
        raise InputError(
            "no round-ended rod that enters from above is seen near the critical frame "
            f"{critical}", source=source,
            allowed="a rod from the upper edge to its tip (see --down, --striker-is, --crop)",
        )  # fmt: skip
    poses: list[tuple[int, RodPose]] = []
    for number, frame in enumerate(frames):
        grey = frame.astype(np.float64)
        start = rod_guess(body_mask(grey, 0.5 * sum(levels)))
        if start is None:
            continue
        pose = fit_rod(grey, shape, start[1], levels=levels)
        if pose is not None:
            poses.append((number, pose))
    if len(poses) < 10:
        raise InputError(
            f"the tip is found in only {len(poses)} frames", source=source, allowed="10 or more"
        )
    return {
        "frame": np.array([n for n, _ in poses]),
        "column": np.array([p.x for _, p in poses]),
        "row": np.array([p.y for _, p in poses]),
        "row_std": np.array([math.sqrt(max(p.covariance[1, 1], 0.0)) for _, p in poses]),
        "lean": np.array([p.lean for _, p in poses]),
    }, shape


def _rod_shape(
    frames: npt.NDArray[np.uint8], critical: int, levels: tuple[float, float]
) -> RodShape | None:
    """Median shape from frames around the critical one, in which most of the rod is seen."""
    reach = max(len(frames) // 8, _SHAPE_FRAMES)
    first, last = max(critical - reach, 0), min(critical + reach, len(frames) - 1)
    chosen = np.unique(np.linspace(first, last, 2 * _SHAPE_FRAMES).astype(int))
    found = []
    for number in chosen:
        grey = frames[number].astype(np.float64)
        start = rod_guess(body_mask(grey, 0.5 * sum(levels)))
        if start is None:
            continue
        pose = fit_rod(grey, start[0], start[1], levels=levels, free="shape")
        if pose is not None:
            found.append((pose.shape.half_width, pose.shape.curvature, pose.shape.blur))
    if len(found) < 3:
        return None
    return RodShape(*(float(v) for v in np.median(np.array(found), axis=0)))


def _track_ball(
    frames: npt.NDArray[np.uint8], levels: tuple[float, float], source: str
) -> dict[str, Any]:
    seen = [(n, ball_by_light(f.astype(np.float64), levels=levels)) for n, f in enumerate(frames)]
    light = [(n, b) for n, b in seen if b is not None]
    if light:
        # other things that move are not of the ball's size
        usual = float(np.median([b.radius for _, b in light]))
        light = [(n, b) for n, b in light if 0.7 < b.radius / usual < 1.4]
    if len(light) < 10:
        raise InputError(
            f"the ball is found in only {len(light)} frames", source=source,
            allowed="10 or more (see --striker-is, --background, --crop, --channel)",
        )  # fmt: skip
    edges = [(n, _ball_edge(frames[n].astype(np.float64), b, levels[0])) for n, b in light]
    sharp = [(n, b) for n, b in edges if b is not None]
    # one kind of position for the whole clip: the two differ by a constant under uneven light
    found = sharp if len(sharp) > _MOSTLY * len(light) else light
    return {
        "frame": np.array([n for n, _ in found]),
        "column": np.array([b.x for _, b in found]),
        "row": np.array([b.y for _, b in found]),
        "row_std": np.array([b.row_std for _, b in found]),
        "lean": np.zeros(len(found)),
        "radius": np.array([b.radius for _, b in found]),
    }


def _ball_edge(grey: Array, ball: Ball, dark: float) -> Ball | None:
    return fit_ball(grey, (ball.x, ball.y, ball.radius), levels=(dark, ball.bright))


def _contacts(
    track: dict[str, Array], half: Measured, optics: Optics, source: str
) -> tuple[list[Bounce], Measured, str]:
    path = Track(
        track["frame"] / optics.rate, -track["row"], track["column"], floor=_POSITION_FLOOR
    )
    scale, origin = _known_scale(half, optics)
    known = optics.gravity / scale.value if math.isfinite(scale.value) else None
    found = bounces(path, acceleration=known)
    if not found:
        raise InputError(
            "no contact with flight before and after it", source=source,
            allowed="a clip that shows the striker fall, touch and rise",
        )  # fmt: skip
    if known is None:
        scale, origin = scale_from_fall(found, optics.gravity)
        if not math.isfinite(scale.value):
            # over so short a fall gravity is nothing: a free acceleration would only add noise
            found = bounces(path, acceleration=0.0)
    return found, scale, origin


def _known_scale(half: Measured, optics: Optics) -> tuple[Measured, str]:
    if optics.scale is not None:
        return optics.scale, "as given"
    if optics.size is not None:
        return optics.size.over(half.scaled(2.0)), "the striker's diameter"
    return Measured(math.nan, math.nan), ""


def _timing_notes(clip: Clip, rate: float) -> list[str]:
    notes = []
    if math.isfinite(clip.container_rate) and abs(clip.container_rate / rate - 1.0) > 0.01:
        notes.append(
            f"the container plays at {clip.container_rate:.6g} frames/s; {rate:g} was used"
        )
    if clip.uneven:
        notes.append(f"{clip.uneven} gaps between the container's time stamps are uneven")
    if clip.repeats.size:
        notes.append(
            f"{clip.repeats.size} of {len(clip.frames)} frames repeat the one before and are left "
            "out: the camera's own rate is lower"
        )
    return notes


def _flight_notes(result: VideoReduction, optics: Optics) -> list[str]:
    notes = []
    if not math.isfinite(result.scale.value):
        notes.append("no length scale: ratios only (give the size of a pixel or the diameter)")
    else:
        part = result.scale.std / result.scale.value
        notes.append(
            f"pixel {result.scale.value * 1e6:.4g} um ± {100 * part:.2g} % from {result.scale_from}"
        )
    for number, bounce in enumerate(result.bounces, start=1):
        gap = result.frame[bounce.after.first] - result.frame[bounce.before.last] - 1
        used = [int(f.height.used.sum()) for f in (bounce.before, bounce.after)]
        notes.append(
            f"contact {number}: {gap} frames left out, contact shorter than "
            f"{(gap + 1) / result.rate * 1e3:.3g} ms; flights of {used[0]} and {used[1]} frames"
        )
    if result.shape == "rod":
        notes.extend(_lean_notes(result))
    return notes


def _lean_notes(result: VideoReduction) -> list[str]:
    turning = result.bounces[0].turning
    sides = {
        "before": result.lean[max(turning - 2 * _LEAN_FRAMES, 0) : turning][:_LEAN_FRAMES],
        "after": result.lean[turning + _LEAN_FRAMES : turning + 2 * _LEAN_FRAMES],
    }
    notes = []
    for name, lean in sides.items():
        if lean.size == 0:
            continue
        angle, std = float(np.median(lean)), float(np.std(lean))
        verdict = "" if abs(angle) <= _LEAN_LIMIT else ": not upright"
        notes.append(
            f"axis {name} contact {90 - math.degrees(angle):.2f} ± {math.degrees(std):.2f} deg"
            f"{verdict}"
        )
    return notes
