"""How good a solved case is, in a few numbers that are stored with it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..core.arrays import Array
from .rules import RULES


@dataclass(frozen=True)
class Quality:
    """Balances, smoothness and reach of one loading curve; nan where there are too few depths.

    - `energy_defect`: largest |work - stored - dissipated|/work.
    - `force_step`, `radius_step`, `share_step`: largest step of F, a and delta_s*, over the local
      value: the difference, between two neighbouring depths, of the departures from a smooth curve
      (a local cubic in log Delta over seven depths), scaled so that a single step reads its height;
      an alternating ripple reads up to 1.7 times its own.
    - `depth_reached`: largest Delta/R.
    - `radius_reached`: largest a/R.
    """

    energy_defect: float
    force_step: float
    radius_step: float
    share_step: float
    depth_reached: float
    radius_reached: float

    @property
    def largest_step(self) -> float:
        """The largest of the three steps."""
        return float(np.nanmax([0.0, self.force_step, self.radius_step, self.share_step]))


def quality_of(curve: Mapping[str, Array], R: float) -> Quality:
    """Judge the curve of a sphere of radius R [m]: `campaigns.schema.CURVE`, shape (n,) [SI]."""
    depth = curve["delta"]
    if len(depth) == 0:
        return Quality(math.nan, math.nan, math.nan, math.nan, 0.0, 0.0)
    force_step, radius_step, share_step = (largest_step(depth, v) for v in _judged(curve))
    return Quality(
        energy_defect=float(np.nanmax(np.abs(curve["energy_defect"]))),
        force_step=force_step,
        radius_step=radius_step,
        share_step=share_step,
        depth_reached=float(depth[-1] / R),
        radius_reached=float(np.nanmax(curve["radius"]) / R),
    )


def steps_not_in(
    curve: Mapping[str, Array], finer: Mapping[str, Array]
) -> tuple[float, float, float]:
    """Largest steps of F, a and delta_s* that a finer solve of the same case does not show.

    They are the steps of the ratio of the two curves, at the depths of the first within those of
    the second: what both show cancels.
    """
    depth = curve["delta"]
    within = depth <= finer["delta"][-1] * (1.0 + 1e-9)
    x, y = np.log(depth[within]), np.log(finer["delta"])
    out = []
    for values, other in zip(_judged(curve), _judged(finer), strict=True):
        there = np.exp(np.interp(x, y, np.log(other)))
        out.append(largest_step(depth[within], values[within] / there))
    return out[0], out[1], out[2]


def _judged(curve: Mapping[str, Array]) -> tuple[Array, Array, Array]:
    share = curve["sphere"] / (curve["sphere"] + curve["flat"])
    return curve["force"], curve["radius"], share


def largest_step(depth: Array, values: Array) -> float:
    """Largest step of positive values along a curve, over the local value.

    `depth`, `values`: shape (n,), both positive.

    Examples
    --------
    >>> depth = np.geomspace(1e-5, 0.1, 48)
    >>> bool(largest_step(depth, depth**1.2) < 1e-9)
    True
    >>> round(largest_step(depth, depth**1.2 * np.where(depth > 1e-3, 1.02, 1.0)), 3)
    0.02
    """
    if len(depth) < RULES.smooth_window + 1 or not (
        np.all(values > 0.0) and np.all(np.isfinite(values))
    ):
        return math.nan
    x, y = np.log(depth), np.log(values)
    departure = np.empty_like(y)
    for i in range(len(x)):
        start = min(max(i - RULES.smooth_window // 2, 0), len(x) - RULES.smooth_window)
        near = slice(start, start + RULES.smooth_window)
        at = (x[near] - x[i]) / (x[near][-1] - x[near][0])
        departure[i] = y[i] - np.polyfit(at, y[near], 3)[-1]
    return float(np.abs(np.diff(departure)).max()) / RULES.step_seen
