"""The heights of a body against time, and where its path turns."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.ndimage import median_filter
from scipy.signal import find_peaks

from ...core.arrays import Array, Indices
from ..rules import RULES
from ..shared.regression import robust_std


@dataclass(frozen=True)
class Track:
    """Heights of a point against time; the unit of length is the caller's.

    - `time`: (n,), increasing [s].
    - `height`: (n,), upwards [unit].
    - `floor`: smallest error of a position that is believed [unit].
    - `trend`: error of a position that grows from one end of a flight to the other, as uneven light
      makes one of the place of an edge [unit].
    - `near`, `unsure`: height above the flat below which a position is less sure, as where a body
      and its reflection run together, and by how much it then may drift over a flight [unit].
    """

    time: Array
    height: Array
    floor: float = 0.0
    trend: float = 0.0
    near: float = 0.0
    unsure: float = 0.0

    def drift(self, path: float) -> float:
        """Return the error of a position that grows over a flight of so long a path [unit]."""
        more = self.unsure * max(1.0 - path / self.near, 0.0) if self.near else 0.0
        return self.trend + more

    @cached_property
    def step(self) -> float:
        """Usual time between two samples [s]."""
        return float(np.median(np.diff(self.time)))

    @cached_property
    def noise(self) -> float:
        """Spread of a sample by third differences, which a flight passes through [unit]."""
        return max(robust_std(np.diff(self.height, 3)) / math.sqrt(20.0), self.floor)


def on_the_body(track: Track) -> Indices:
    """Return the samples that one moving body can have, (m,): strays of a tracker are left out.

    Steps faster than any body of this track cut it into parts; short ones between two cuts are
    something else that the tracker held for the body.
    """
    speed = np.abs(np.diff(track.height)) / np.diff(track.time)
    noise = robust_std(np.diff(track.height, 2)) / np.sqrt(6.0) / track.step
    limit = RULES.impossible * float(np.quantile(speed, 0.9)) + 6.0 * noise
    kept = np.arange(track.time.size)
    for _ in range(4):
        time, height = track.time[kept], track.height[kept]
        cuts = np.flatnonzero(np.abs(np.diff(height)) > limit * np.diff(time)) + 1
        parts = np.split(np.arange(kept.size), cuts)
        good = [p for p in parts if p.size >= RULES.fewest]
        if len(good) == len(parts) or not good:
            break
        kept = kept[np.concatenate(good)]
    return kept


def turning_points(track: Track) -> list[int]:
    """Return the indices of the lowest samples of every contact.

    A free flight has no minimum of height, so each clear minimum is a contact.
    """
    smooth = median_filter(track.height, 3, mode="nearest")
    # of a hundred thousand samples of normal noise five turn by so much, behind the filter
    prominence = max(0.01 * float(np.ptp(smooth)), 5.0 * track.noise)
    if prominence <= 0.0:
        return []
    peaks, _ = find_peaks(-smooth, prominence=prominence)
    # the filter widens a sharp minimum: go back to the lowest sample itself
    found = []
    for peak in peaks:
        low, high = max(peak - 1, 0), min(peak + 2, smooth.size)
        found.append(low + int(np.argmin(track.height[low:high])))
    return found
