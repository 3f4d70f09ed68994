"""Rigid-body fit of markers: their mean shape, and the pose in every frame (Kabsch).

The fit of a shape b_i to markers p_i minimises sum |p_i - o - R b_i|² over origin o and rotation R
(W. Kabsch, Acta Cryst. A32 (1976) 922; scipy's `Rotation.align_vectors` solves it). The error of a
pose in units of the error of a marker follows from where the seen markers sit.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ...core.arrays import Array, Integers, Mask
from ...core.errors import InputError
from ..rules import RULES
from ..shared.regression import FIT_ROUNDS
from .file import Markers


@dataclass(frozen=True)
class Poses:
    """The body in the frames in which three or more of its markers were seen.

    - `frame`: (k,) numbers of the frames.
    - `time`: (k,) [s].
    - `origin`: (k, 3) place of the mean shape's centroid [m].
    - `turn`: (k, 3, 3) rotations from the mean shape to the frame.
    - `whiten`: (k, 6, 6) factor that turns the error (of origin [m], rotation [rad]) into six
      independent ones of a marker's own size.
    - `shape`: (m, 3) mean shape about its centroid [m].
    - `spread`: root mean square distance of the markers from the mean shape over all frames [m].
    - `dropped`: number of marker positions left out because they do not fit the body.
    """

    frame: Integers
    time: Array
    origin: Array
    turn: Array
    whiten: Array
    shape: Array
    spread: float
    dropped: int

    @property
    def collinear(self) -> bool:
        """Whether the markers lie on one line, so that the roll about it is not seen."""
        return _is_line(self.shape)

    @property
    def extent(self) -> float:
        """Largest distance of a marker from the centroid [m]."""
        return float(np.linalg.norm(self.shape, axis=1).max())


def kabsch(shape: Array, points: Array) -> tuple[Array, Array]:
    """Return origin (3,) and rotation (3, 3) that bring a shape (m, 3) onto points (m, 3)."""
    middle, target = shape.mean(axis=0), points.mean(axis=0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # the roll of collinear markers is free
        rotation, _ = Rotation.align_vectors(points - target, shape - middle)
    turn = rotation.as_matrix()
    return target - turn @ middle, turn


def rigid_poses(markers: Markers) -> Poses:
    """Return mean shape and poses; refuse fewer than three markers, or seen in too few frames."""
    points = markers.position
    seen: Mask = np.asarray(np.isfinite(points).all(axis=2))
    if points.shape[1] < 3:
        raise InputError(
            f"{points.shape[1]} markers", source=markers.source, allowed="three or more on the body"
        )
    shape = _mean_shape(points, seen, markers.source)
    seen, dropped = _without_misfits(shape, points, seen)
    frames = np.flatnonzero(seen.sum(axis=1) >= 3)
    if frames.size < 10:
        raise InputError(
            f"three markers are seen in only {frames.size} frames", source=markers.source,
            allowed="10 or more",
        )  # fmt: skip
    line = _is_line(shape)
    turns: list[Array] = []
    origins, factors, misfits = [], [], []
    for k in frames:
        body, found = shape[seen[k]], points[k, seen[k]]
        origin, turn = kabsch(body, found)
        if line and turns:
            turn = _carried(turns[-1], turn, np.asarray(np.linalg.svd(shape)[2][0]))
        origins.append(origin)
        turns.append(turn)
        factors.append(_whiten(body @ turn.T))
        misfits.append(np.sqrt(np.mean(np.sum((found - origin - body @ turn.T) ** 2, axis=1))))
    return Poses(
        frames, markers.time[frames], np.array(origins), np.array(turns), np.array(factors),
        shape, float(np.sqrt(np.mean(np.square(misfits)))), dropped,
    )  # fmt: skip


def _mean_shape(points: Array, seen: Mask, source: str) -> Array:
    """Generalised Procrustes: the shape that fits all frames best, markers missing or not."""
    whole = np.flatnonzero(seen.all(axis=1))
    if whole.size == 0:
        never = "; ".join(f"marker {i + 1} never" for i in np.flatnonzero(~seen.any(axis=0)))
        raise InputError(
            f"no frame shows all {points.shape[1]} markers{f' ({never})' if never else ''}",
            source=source, allowed="one frame or more, or fewer with the option markers",
        )  # fmt: skip
    # the frame nearest the median of all mutual distances: the first one may hold a mix-up
    distance = np.linalg.norm(points[whole][:, :, None] - points[whole][:, None], axis=3)
    nearest = np.argmin(np.abs(distance - np.median(distance, axis=0)).sum(axis=(1, 2)))
    shape = points[whole[nearest]] - points[whole[nearest]].mean(axis=0)
    usable = np.flatnonzero(seen.sum(axis=1) >= 3)
    for _ in range(FIT_ROUNDS):
        back = np.full((usable.size, *shape.shape), np.nan)
        for row, k in enumerate(usable):
            origin, turn = kabsch(shape[seen[k]], points[k, seen[k]])
            back[row, seen[k]] = (points[k, seen[k]] - origin) @ turn
        # the median keeps a marker that was mixed up out of the shape
        new = np.nanmedian(back, axis=0)
        new -= new.mean(axis=0)
        moved = float(np.abs(new - shape).max())
        shape = new
        if moved < 1e-7:
            break
    return np.asarray(shape)


def _without_misfits(shape: Array, points: Array, seen: Mask) -> tuple[Mask, int]:
    """Take out markers that do not fit the body; with three of them the whole frame goes."""
    off = np.zeros(seen.shape)
    usable = np.flatnonzero(seen.sum(axis=1) >= 3)
    for k in usable:
        off[k, seen[k]] = _distances(shape[seen[k]], points[k, seen[k]])
    rms = np.sqrt((off[usable] ** 2).sum(axis=1) / seen[usable].sum(axis=1))
    limit = RULES.foreign * max(float(np.median(rms)) if rms.size else 0.0, 1e-9)
    kept, dropped = seen.copy(), 0
    for k in np.flatnonzero(off.max(axis=1) > limit):
        while kept[k].sum() >= 3 and _distances(shape[kept[k]], points[k, kept[k]]).max() > limit:
            kept[k, _worst(shape, points[k], kept[k])] = False
            dropped += 1
        if kept[k].sum() < 3:
            dropped += int(kept[k].sum())
            kept[k] = False
    return kept, dropped


def _worst(shape: Array, points: Array, kept: Mask) -> int:
    """Return the marker without which the others fit best."""
    index = np.flatnonzero(kept)
    if index.size == 3:
        return int(index[0])
    left = [
        float(np.sum(_distances(shape[rest], points[rest]) ** 2))
        for rest in (index[index != i] for i in index)
    ]
    return int(index[int(np.argmin(left))])


def _distances(shape: Array, points: Array) -> Array:
    origin, turn = kabsch(shape, points)
    return np.asarray(np.linalg.norm(points - origin - shape @ turn.T, axis=1))


def _whiten(arms: Array) -> Array:
    """Return L.T with L L.T = J.T J, J the motion of the markers (m, 3) by origin and rotation."""
    jacobian = np.concatenate([np.tile(np.eye(3), (len(arms), 1)), -cross_matrices(arms)], axis=1)
    information = jacobian.T @ jacobian
    information[3:, 3:] += 1e-9 * np.trace(information[3:, 3:]) * np.eye(3)
    return np.asarray(np.linalg.cholesky(information).T)


def cross_matrices(vectors: Array) -> Array:
    """Return the matrices [v]x with [v]x u = v x u, stacked: (k, 3) to (3 k, 3)."""
    x, y, z = vectors.T
    zero = np.zeros_like(x)
    rows = [[zero, -z, y], [z, zero, -x], [-y, x, zero]]
    return np.asarray(np.moveaxis(np.array(rows), 2, 0).reshape(-1, 3))


def _is_line(shape: Array) -> bool:
    extents = np.linalg.svd(shape, compute_uv=False)
    return bool(extents[1] < RULES.collinear * extents[0])


def _carried(before: Array, turn: Array, axis: Array) -> Array:
    """Return the rotation with the line of `turn` that rolls least from `before`."""
    old, new = before @ axis, turn @ axis
    if float(old @ new) < 0.0:
        return turn  # more than a quarter turn between frames: nothing to carry over
    normal = np.cross(old, new)
    size = float(np.linalg.norm(normal))
    angle = np.arctan2(size, float(old @ new))
    step = Rotation.from_rotvec(normal * (angle / size if size > 0.0 else 0.0))
    return np.asarray(step.as_matrix() @ before)
