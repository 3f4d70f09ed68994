"""The bright body in a frame: its pixels, and a first guess of where it is."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import binary_dilation

from ...core.arrays import Array, Mask
from ..rules import RULES
from .edge_fit import BallEdge, RodShape


def body_mask(frame: Array, level: float) -> Mask:
    """Return the largest connected region above `level`, (rows, columns); it may be empty."""
    from skimage.measure import label

    regions = label(frame > level, connectivity=1)
    sizes = np.bincount(regions.ravel())
    if sizes.size < 2:
        return np.zeros(frame.shape, dtype=np.bool_)
    sizes[0] = 0
    return np.asarray(regions == int(np.argmax(sizes)))


def rod_guess(mask: Mask) -> tuple[RodShape, tuple[float, float, float]] | None:
    """Return shape and pose (column, row, lean) of a rod that enters from above, to the pixel.

    None where too little of it is in the picture.
    """
    rows = np.flatnonzero(mask.sum(axis=1) >= 3)
    if rows.size < 8 or rows[0] > 1:
        return None
    bottom = int(rows[-1])
    upper = rows[: max(5, rows.size // 2)]
    columns = np.arange(mask.shape[1])
    widths = mask[upper].sum(axis=1)
    half = float(np.median(widths)) / 2.0
    slope, middle = np.polyfit(upper.astype(float), (mask[upper] * columns).sum(axis=1) / widths, 1)
    x = float(middle + slope * bottom)
    ends = mask.shape[0] - 1 - np.argmax(mask[::-1], axis=0)
    off = columns - x
    inside = mask.any(axis=0) & (np.abs(off) < 0.9 * half)
    if inside.sum() < 5 or half < 3.0 or bottom >= mask.shape[0] - 2:
        return None
    cap = np.polyfit(off[inside], ends[inside] - bottom, 2)
    curvature = float(np.clip(-2.0 * cap[0], 1e-4 / half, 1.0 / half))
    return RodShape(half, curvature, 1.0), (x, bottom + 0.5, float(np.arctan(-slope)))


def ball_by_light(frame: Array, *, levels: tuple[float, float]) -> BallEdge | None:
    """Return the centroid of the light of the brightest body, which no blur moves.

    In grey values (rows, columns), the ball bright; `levels` are those of background and ball. Its
    radius is that of a disc of equal light. None where nothing is bright, or the body touches the
    edge of the frame.
    """
    mask = body_mask(frame, 0.5 * (levels[0] + levels[1]))
    # other things that move pull the level of the clip; the ball has its own
    bright = float(np.median(frame[mask])) if mask.any() else levels[1]
    if bright > RULES.own_level * levels[1] - (RULES.own_level - 1.0) * levels[0]:
        mask = body_mask(frame, 0.5 * (levels[0] + bright))
    else:
        bright = levels[1]
    if mask.sum() < 12 or mask[0].any() or mask[-1].any() or mask[:, [0, -1]].any():
        return None
    around = binary_dilation(mask, iterations=4)
    ring = binary_dilation(around, iterations=3) & ~around
    dark = float(np.median(frame[ring])) if ring.any() else levels[0]
    light = (frame[around] - dark) / max(bright - dark, 1e-9)
    total = float(light.sum())
    if total <= 0.0:
        return None
    rows, columns = np.nonzero(around)
    return BallEdge(
        float(light @ columns) / total, float(light @ rows) / total, float(np.sqrt(total / np.pi)),
        bright,
    )  # fmt: skip
