"""What one press shows: the zero of contact, the depth that stays, the stiffness of unloading."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import least_squares

from ...core.arrays import Array
from ..measured import Measured
from ..rules import RULES
from ..shared.flank import meets_zero
from ..shared.regression import unit_covariance
from .cycles import Cycle, virgin

_STIFFNESS_FROM, _STIFFNESS_TO = (0.5, 0.7), 0.98
"""Loads between which the slope of unloading is read, in the largest [-] (ISO 14577-1, A.4)."""


def contact_zero(load: Array, depth: Array, cycle: Cycle, noise: float) -> Measured:
    """Return the depth at which the load of the loading meets zero [m].

    Of the rows that load further than all before, from the noise or the preload on.
    """
    rows = virgin(load, cycle.turn + 1)
    low = RULES.pulse_over_noise * noise
    seen = bool((load[rows] < low).any())
    rows = rows[load[rows] >= low]
    found = _zero(load[rows] / cycle.peak, depth[rows], RULES.press_powers)
    # below a preload nothing tells how the contact began
    return found if seen else found.widened(RULES.preload_part * (depth[rows[0]] - found.value))


def left_depth(load: Array, depth: Array, cycle: Cycle, noise: float) -> Measured:
    """Return the depth at which the load of the unloading meets zero [m]."""
    rows = cycle.unloading
    rows = rows[load[rows] >= max(RULES.pulse_over_noise * noise, float(load[rows[-1]]))]
    if rows.size < 2:
        return Measured(math.nan, math.nan)
    return _zero(load[rows] / cycle.peak, depth[rows], RULES.press_powers)


def _zero(part: Array, depth: Array, powers: tuple[float, ...]) -> Measured:
    """Where a load meets zero, by its lowest part that tells it; a longer one's answer is error.

    A blunt tip and a rough face make the beginning another power than what follows.
    """
    least = float(part.min())
    found: list[Measured] = []
    for reach in RULES.zero_reach:
        use = part <= max(reach, RULES.zero_span * least)
        order = np.flatnonzero(use)[np.argsort(part[use])]
        bins = np.array_split(order, min(RULES.press_bins, max(order.size // 2, 1)))
        if len(bins) < RULES.fewest:
            continue
        x, y = (np.array([float(np.mean(v[b])) for b in bins]) for v in (depth, part))
        if np.ptp(x) > 0.0 and y[-1] > y[0]:
            found.append(meets_zero(x, y, -1, powers))
        if len(found) == 2:
            return found[0].widened(0.5 * (found[1].value - found[0].value))
    first = int(np.argmin(part))
    span = abs(float(depth[part >= 0.5 * part.max()].mean() - depth[first]))
    return found[0] if found else Measured(float(depth[first]), least * span + 1e-12)


def stiffness(load: Array, depth: Array, cycle: Cycle) -> Measured:
    """Return the slope of the unloading where it begins [N/m].

    Of P = B (h - h0)^m over the upper half (Oliver and Pharr, eq. 8; ISO 14577-1, A.4); its error
    holds the difference to the upper third's.
    """
    whole, upper = (_slope(load, depth, cycle, low) for low in _STIFFNESS_FROM)
    return whole if math.isnan(upper.value) else whole.widened(0.5 * (upper.value - whole.value))


def _slope(load: Array, depth: Array, cycle: Cycle, low: float) -> Measured:
    rows = cycle.unloading
    part = rows[(load[rows] <= _STIFFNESS_TO * cycle.peak) & (load[rows] >= low * cycle.peak)]
    if part.size < RULES.fewest:
        return Measured(math.nan, math.nan)
    x, y = depth[part], load[part] / cycle.peak
    line = np.polyfit(y, x, 1)
    top, span = float(np.polyval(line, 1.0)), float(abs(line[0]))
    if not span > 0.0 or not line[0] > 0.0:
        return Measured(math.nan, math.nan)
    s = (x - top) / span  # 0 where unloading begins, -1 where its tangent meets zero

    def rest(c: Array) -> Array:  # force at 0, slope at 0, power
        return np.asarray(c[0] * np.maximum(1.0 + c[1] * s / (c[0] * c[2]), 1e-9) ** c[2] - y)

    fit = least_squares(
        rest, (1.0, 1.0, 1.3), bounds=((0.5, 0.2, 1.0), (2.0, 5.0, 3.0)), max_nfev=100
    )
    sigma = math.sqrt(float(fit.fun @ fit.fun) / max(part.size - 3, 1))
    std = sigma * math.sqrt(max(float(unit_covariance(fit.jac)[1, 1]), 0.0))
    return Measured(float(fit.x[1]), std).scaled(cycle.peak / span)
