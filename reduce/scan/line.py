"""A line profile across a crater: depth and width below the undisturbed line."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array, Mask
from ...core.errors import InputError
from ..measured import UNITY, Measured, Trial
from ..rules import RULES
from ..shared.regression import robust_regression, robust_std
from .file import LineScan
from .noise import autocovariance, variance
from .walls import Section, opening

# limit: points of the smaller fit on a line at least [-]
_LINE_POINTS = 12


@dataclass(frozen=True)
class Groove:
    """A measured profile; lengths in metres.

    Parameters
    ----------
    depth, width
        Below the undisturbed line, and between the walls at its level (nan if one is cut).
    line
        The levelled profile, `s` from the deepest point.
    clear
        Points that it was levelled on.
    """

    depth: Measured
    width: Measured
    line: Section
    clear: Mask
    notes: tuple[str, ...]
    source: str

    def trials(self) -> tuple[Trial, ...]:
        """Return the observables of trials.csv and the profile."""
        profile = {"x_m": self.line.s - self.line.s[0], "z_m": self.line.z}
        return (Trial({"permanent_depth_m": self.depth}, self.notes, profile=profile),)


def reduce_line(scan: LineScan, *, height_scale: Measured = UNITY) -> Groove:
    """Measure the deepest crater or groove of a profile.

    Raises
    ------
    InputError
        Nothing stands out of the roughness, or no undisturbed line is left.
    """
    seen = np.isfinite(scan.z)
    x = np.linspace(scan.x[0], scan.x[-1], scan.x.size)
    z = np.interp(x, scan.x[seen], scan.z[seen])
    step = float(x[1] - x[0])
    z, crater, clear = _levelled(x, z, scan.source)
    half = 0.5 * float(crater.sum()) * step
    covariance = autocovariance(
        z[:, None],
        clear[:, None],
        np.array([min(int(2 * RULES.bottom_large * half / step) + 1, x.size // 2), 0]),
    )
    start = int(np.argmin(np.where(crater, z, np.inf)))
    low, at, weights = _bottom(x, z, start, RULES.bottom_large * half, scan.source)
    other, _, inner = _bottom(x, z, start, RULES.bottom_small * half, scan.source)
    level = np.stack([np.ones_like(x), x], axis=1)
    drawn = np.zeros_like(x)
    drawn[clear] = level[clear] @ np.linalg.solve(level[clear].T @ level[clear], [1.0, at])
    noise = variance((weights - drawn)[:, None], covariance)
    model = max((low - other) ** 2 - variance((weights - inner)[:, None], covariance), 0.0)
    depth = Measured(-low, math.sqrt(noise + model))
    line = Section(x - at, z)
    lags = covariance[covariance.shape[0] // 2 :, 0]
    notes = [*scan.notes, "one line: the depth is the crater's only if it runs through the deepest "
             "point"]  # fmt: skip
    if not seen.all():
        notes.append(f"{100 * (1 - seen.mean()):.2g} % not seen")
    return Groove(
        depth.times(height_scale), opening(line, depth.value, lags), line, clear, tuple(notes),
        scan.source,
    )  # fmt: skip


def _levelled(x: Array, z: Array, source: str) -> tuple[Array, Mask, Mask]:
    design = np.stack([np.ones_like(x), x - x.mean()], axis=1)
    clear, crater = np.ones(x.size, dtype=np.bool_), np.zeros(x.size, dtype=np.bool_)
    for _ in range(8):
        level = robust_regression(design[clear], z[clear]).coefficients
        off = z - design @ level
        noise = robust_std(off[clear])
        bottom = int(np.argmin(off))
        if not -off[bottom] > 5.0 * max(noise, 1e-15):
            raise InputError(
                f"no crater: the lowest point lies {-off[bottom]:.3g} m under the line, whose "
                f"roughness is {noise:.3g} m", source=source,
                allowed="a crater deeper than five times that",
            )  # fmt: skip
        under = off < -max(-0.03 * off[bottom], min(2.0 * noise, -0.2 * off[bottom]))
        ends = np.flatnonzero(~under)
        left = ends[ends < bottom].max(initial=-1) + 1
        right = ends[ends > bottom].min(initial=x.size)
        found = np.zeros_like(crater)
        found[left:right] = True
        gap = int(0.5 * RULES.clearance * (right - left))
        clear = np.ones_like(crater)
        clear[max(left - gap, 0) : right + gap] = False
        if clear.sum() < max(_LINE_POINTS, 0.05 * x.size):
            raise InputError(
                "the crater leaves no undisturbed line to level on", source=source,
                allowed="a profile some 4 crater widths long",
            )  # fmt: skip
        if np.array_equal(found, crater):
            break
        crater = found
    return off, crater, clear


def _bottom(
    x: Array, z: Array, start: int, reach: float, source: str
) -> tuple[float, float, Array]:
    """Return height and place of the minimum of a quartic, and the weights of the points."""
    middle = float(x[start])
    for _ in range(8):
        near = np.abs(x - middle) <= reach
        if near.sum() < _LINE_POINTS:
            raise InputError(
                f"{int(near.sum())} points on the floor of the crater", source=source,
                allowed=f"{_LINE_POINTS} or more: a finer profile",
            )  # fmt: skip
        u = (x[near] - middle) / reach
        solver = np.linalg.pinv(np.vander(u, 5, increasing=True))
        fine = np.linspace(-0.6, 0.6, 601)
        at = float(fine[int(np.argmin(np.vander(fine, 5, increasing=True) @ solver @ z[near]))])
        if abs(at) < 0.02:
            break
        middle += at * reach
    weights = np.zeros_like(z)
    weights[near] = at ** np.arange(5) @ solver
    return float(weights @ z), middle + at * reach, weights
