"""How much of a ringing that follows a pulse the pulse itself shows.

A plate that was struck rings after the blow; a sensor rings while the force lasts as well. A pulse
of the form a sin^p with a fading swing of the ringing's frequency on it tells which: what it shows
at that frequency is taken off, where it is no chance, and moves its peak and its ends.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from ....core.arrays import Array
from ...rules import RULES
from ...shared.regression import correlation_factor, unit_covariance


class RingingWithin(NamedTuple):
    """A ringing within a pulse: what to take off the record (n,), and what stays unknown of it.

    `part` is the root mean square of it in the peak, `unsure` that of what stays unknown.
    """

    swing: Array
    part: float
    unsure: float


def ringing_within(
    time: Array, clear: Array, ends: tuple[float, float], peak: float, ringing: float
) -> RingingWithin:
    """Return the ringing within a pulse that begins and ends at `ends` [s].

    Of a record (n,) with its level before the pulse taken off, the pulse upwards. `ringing` is the
    largest half-wave of the other sign beside it, in the peak. Where it swings as slowly as the
    pulse, or the samples are few, all of it stays unknown.
    """
    long = ends[1] - ends[0]
    inside = (time > ends[0]) & (time < ends[1])
    late = (time >= ends[1]) & (time < ends[1] + RULES.beside * long)
    if inside.sum() < 2 * RULES.fewest or late.sum() < 2 * RULES.fewest:
        return _unknown(clear, ringing)
    turn, fades = _swing((time[late] - ends[1]) / long, clear[late] / peak)
    if turn <= math.pi:
        return _unknown(clear, ringing)
    u, seen = (time[inside] - ends[0]) / long, clear[inside] / peak
    swings = np.exp(-fades * u)[:, None] * np.stack([np.cos(turn * u), np.sin(turn * u)], axis=1)

    def left(c: Array) -> Array:
        # the flanks may be as unlike as a loss makes them: the time runs unevenly
        form = c[0] * np.sin(math.pi * u ** c[2]) ** c[1]
        return np.asarray(form + swings @ c[3:] - seen)

    fit = least_squares(
        left, (1.0, 1.2, 1.0, 0.0, 0.0),
        bounds=((0.0, 0.5, 0.5, -1.0, -1.0), (2.0, 4.0, 2.0, 1.0, 1.0)), x_scale="jac",
        max_nfev=60,
    )  # fmt: skip
    spread = float(fit.fun @ fit.fun) / (u.size - 5) * correlation_factor(fit.fun)
    usual = float(np.mean(np.sum(swings**2, axis=1))) / 2.0
    found = usual * float(fit.x[3:] @ fit.x[3:])
    chance = usual * spread * float(np.diag(unit_covariance(fit.jac))[3:].sum())
    if found < RULES.no_chance * chance:
        return _unknown(clear, min(math.sqrt(max(found, chance)), ringing))
    on = time > ends[0]
    u = (time[on] - ends[0]) / long
    swing = np.zeros_like(clear)
    swing[on] = (
        peak * np.exp(-fades * u) * (fit.x[3] * np.cos(turn * u) + fit.x[4] * np.sin(turn * u))
    )
    # what rings while it is pushed is pushed farther, by the square of the pulse's pace in its own
    more = (math.pi / turn) ** 2
    unsure = math.hypot(math.sqrt(chance + 0.25 * found), more)
    return RingingWithin(swing, math.sqrt(found), unsure)


def _unknown(clear: Array, part: float) -> RingingWithin:
    return RingingWithin(np.zeros_like(clear), part, part)


def _swing(t: Array, seen: Array) -> tuple[float, float]:
    """Return angular frequency and decay of a ringing, over the unit of `t`."""
    even = np.linspace(t[0], t[-1], t.size)
    part = np.interp(even, t, seen)
    size = 4 * part.size  # between its own frequencies as well
    found = np.abs(np.fft.rfft((part - part.mean()) * np.hanning(part.size), size))
    turns = np.fft.rfftfreq(size, float(even[1] - even[0]))
    first = 2.0 * math.pi * float(turns[1 + int(np.argmax(found[1:]))])

    def left(c: Array) -> Array:
        shown = c[2] * np.cos(c[0] * t) + c[3] * np.sin(c[0] * t)
        return np.asarray(np.exp(-c[1] * t) * shown + c[4] - seen)

    fit = least_squares(
        left, (first, 0.5, 0.0, float(np.ptp(seen)) / 2.0, 0.0),
        bounds=((0.5 * first, 0.0, -2.0, -2.0, -1.0), (2.0 * first, 5.0, 2.0, 2.0, 1.0)),
        x_scale="jac", max_nfev=60,
    )  # fmt: skip
    return float(fit.x[0]), float(fit.x[1])
