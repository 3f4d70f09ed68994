"""The striker followed through the frames of a clip: the tip of a rod, or the centre of a ball."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ..images.clip import Clip
from ..images.edge_fit import BallEdge, RodPose, RodShape, fit_ball, fit_rod
from ..images.picture_file import Frame
from ..images.silhouette import ball_by_light, body_mask, rod_guess
from ..rules import RULES


def track_rod(
    frames: Frame, critical: int, levels: tuple[float, float], source: str
) -> tuple[dict[str, Any], RodShape]:
    """Return the tip of a rod in each frame, as named arrays (n,), and the shape of the rod.

    Refuses a clip without a rod near the critical frame, or with its tip in too few frames.
    """
    shape = _rod_shape(frames, critical, levels)
    if shape is None:
        raise InputError(
            "no round-ended rod that enters from above is seen near the critical frame "
            f"{critical}", source=source,
            allowed="a rod from the upper edge to its tip (see --down, --striker-is, --crop)",
        )  # fmt: skip
    poses: list[tuple[int, RodPose]] = []
    for number, grey, (_, near) in _guessed(frames, range(len(frames)), levels):
        pose = fit_rod(grey, shape, near, levels=levels)
        if pose is not None:
            poses.append((number, pose))
    poses = _without_reflection(frames, poses, shape, levels)
    if len(poses) < 10:
        raise InputError(
            f"the tip is found in only {len(poses)} frames", source=source, allowed="10 or more"
        )
    return _places(poses) | {"lean": np.array([p.lean for _, p in poses])}, shape


def _places(found: Sequence[tuple[int, RodPose | BallEdge]]) -> dict[str, Any]:
    return {
        "frame": np.array([n for n, _ in found]),
        "column": np.array([p.x for _, p in found]),
        "row": np.array([p.y for _, p in found]),
    }


def _guessed(
    frames: Frame, numbers: Iterable[int], levels: tuple[float, float]
) -> Iterator[tuple[int, Array, tuple[RodShape, tuple[float, float, float]]]]:
    """Yield number, grey values, and shape and pose to the pixel, of frames that show a rod."""
    for number in numbers:
        grey = frames[number].astype(np.float64)
        start = rod_guess(body_mask(grey, 0.5 * sum(levels)))
        if start is not None:
            yield number, grey, start


def _without_reflection(
    frames: Frame, poses: list[tuple[int, RodPose]], shape: RodShape, levels: tuple[float, float]
) -> list[tuple[int, RodPose]]:
    """Fit the tip anew, with its reflection, where it is so near to the flat that both overlap."""
    rows = np.array([p.y for _, p in poses])
    lowest = float(rows.max(initial=0.0))
    low, high = (lowest - n * shape.blur for n in (RULES.mirror_reach, RULES.mirror_least))
    both = np.flatnonzero((rows > low) & (rows < high))
    found = []
    for k in both[:: max(1, len(both) // RULES.mirror_frames)]:
        number, pose = poses[k]
        start = replace(shape, mirror=0.1, flat=lowest)
        there = fit_rod(
            frames[number].astype(np.float64), start, (pose.x, pose.y, pose.lean), levels=levels,
            free="mirror",
        )  # fmt: skip
        if there is not None:
            found.append((there.shape.mirror, there.shape.flat))
    if len(found) < 5:
        return poses
    mirror, flat = (float(v) for v in np.median(np.array(found), axis=0))
    if mirror < RULES.dull:
        return poses
    shape = replace(shape, mirror=mirror, flat=flat)
    again = []
    for number, pose in poses:
        if pose.y > low:
            pose = fit_rod(
                frames[number].astype(np.float64), shape, (pose.x, min(pose.y, flat), pose.lean),
                levels=levels,
            ) or pose  # fmt: skip
        again.append((number, pose))
    return again


def _rod_shape(frames: Frame, critical: int, levels: tuple[float, float]) -> RodShape | None:
    """Median shape from frames around the critical one, in which most of the rod is seen."""
    reach = max(len(frames) // 8, RULES.shape_frames)
    first, last = max(critical - reach, 0), min(critical + reach, len(frames) - 1)
    chosen = np.unique(np.linspace(first, last, 2 * RULES.shape_frames).astype(int))
    found = []
    for _, grey, start in _guessed(frames, chosen, levels):
        pose = fit_rod(grey, *start, levels=levels, free="shape")
        if pose is not None:
            found.append((pose.shape.half_width, pose.shape.curvature, pose.shape.blur))
    if len(found) < 3:
        return None
    return RodShape(*(float(v) for v in np.median(np.array(found), axis=0)))


def track_ball(frames: Frame, levels: tuple[float, float], source: str) -> dict[str, Any]:
    """Return centre and radius of a ball in each frame, as named arrays (n,); refuse few."""
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
    found = sharp if len(sharp) > RULES.mostly_found * len(light) else light
    radii = np.array([b.radius for _, b in found])
    return _places(found) | {"lean": np.zeros(len(found)), "radius": radii}


def _ball_edge(grey: Array, ball: BallEdge, dark: float) -> BallEdge | None:
    return fit_ball(grey, (ball.x, ball.y, ball.radius), levels=(dark, ball.bright))


def striker_bright(clip: Clip, striker_is: str, background: str) -> Frame:
    """Return frames in which the striker is bright on a dark ground, (n, rows, columns)."""
    frames = clip.frames
    if background == "median":
        ground = np.median(frames[:: max(1, len(frames) // 60)], axis=0).astype(np.int16)
        sign = 1 if striker_is == "bright" else -1
        moved = np.empty_like(frames)
        for number, frame in enumerate(frames):
            moved[number] = np.clip(sign * (frame.astype(np.int16) - ground), 0, 255)
        return moved
    return frames if striker_is == "bright" else 255 - frames


def grey_levels(frames: Frame, source: str) -> tuple[float, float]:
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
