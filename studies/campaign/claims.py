"""Claims of chapter 2 on one case of Table 2.1 over Sy*, each a function of its sweep.

A function gives whether the claim holds and the number that says so; none where the data is not
there. The tolerances that give words like "near" and "constant" a meaning stand in the claim.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...core.arrays import Array
from .sweep import Sweep

Finding = tuple[bool, str]
"""Whether a claim holds, and the number that says so."""

FEWEST = 3
"""Points that a stretch of Sy* needs before anything is said of it."""


def _spread(values: Array) -> float:
    """Largest departure from the middle of a stretch, over its mean."""
    return float((values.max() - values.min()) / 2.0 / values.mean())


def _constant(
    name: str, low: float, high: float, *, within: float
) -> Callable[[Sweep], Finding | None]:
    def test(sweep: Sweep) -> Finding | None:
        k = sweep.between(low, high)
        if len(k) < FEWEST or sweep.at(low) is None:
            return None
        spread = _spread(getattr(sweep, name)[k])
        return spread <= within, f"±{spread:.1%} over {len(k)} values of Sy*"

    return test


def _share_at_start(sweep: Sweep) -> Finding | None:
    k = sweep.at(0.1)
    return None if k is None else (abs(sweep.share[k] - 0.9) <= 0.05, f"{sweep.share[k]:.3f}")


def _falls(
    low: float, high: float, *, fewest: int, faster: bool
) -> Callable[[Sweep], Finding | None]:
    def test(sweep: Sweep) -> Finding | None:
        k = sweep.between(low, high)
        if len(k) < fewest or (faster and sweep.at(high) is None):
            return None
        slope = np.diff(sweep.share[k]) / np.diff(sweep.ratio[k])
        bends = -np.diff(slope) if faster else np.diff(slope)
        holds = bool(np.all(slope < 0.0) and np.all(bends > 0.0))
        return holds, f"slope {slope[0]:.2f} to {slope[-1]:.2f}"

    return test


def _falls_at_one(sweep: Sweep) -> Finding | None:
    k = sweep.between(0.9, 1.2)
    if len(k) < 4 or sweep.at(1.0) is None:
        return None
    slope = np.diff(sweep.share[k]) / np.diff(np.log(sweep.ratio[k]))
    steepest = int(np.argmin(slope))
    a, b = sweep.ratio[k][steepest], sweep.ratio[k][steepest + 1]
    return a <= 1.0 + 1e-6 and b >= 1.0 - 1e-6, f"steepest from {a:g} to {b:g}"


def _half_at_one(sweep: Sweep) -> Finding | None:
    k = sweep.at(1.0)
    pair = None if k is None else sweep.records[k].case.pair
    if k is None or pair is None or pair.sphere != pair.flat:
        return None  # only identical bodies must begin with one half
    first = sweep.records[k].curve
    start = float(first["sphere"][0] / (first["sphere"][0] + first["flat"][0]))
    return abs(start - 0.5) < 0.01, f"{start:.3f} before yield, {sweep.share[k]:.3f} at 0.04"


def _inner_extreme(sweep: Sweep, values: Array, low: float, high: float) -> tuple[float, float]:
    """Place and value of the largest of `values` between two ratios, by a parabola through three.

    Returns nan as place where the largest lies at an end of the stretch.
    """
    k = sweep.between(low, high)
    if len(k) < 5:
        return np.nan, np.nan
    x, y = np.log(sweep.ratio[k]), values[k]
    best = int(np.argmax(y))
    if best in (0, len(k) - 1):
        return np.inf, float(y[best])
    curve = np.polyfit(x[best - 1 : best + 2] - x[best], y[best - 1 : best + 2], 2)
    return float(np.exp(x[best] - curve[1] / (2.0 * curve[0]))), float(y[best])


def _radius_dips(sweep: Sweep) -> Finding | None:
    place, depth = _inner_extreme(sweep, -sweep.radius, 0.6, 1.7)
    if np.isnan(place):
        return None
    if np.isinf(place):
        return False, "no minimum inside 0.6 to 1.7"
    deep = float(-depth / sweep.radius[sweep.between(0.1, 0.6)].mean() - 1.0)
    return abs(place - 1.07) <= 0.05, f"minimum at {place:.3f}, {deep:+.1%} from the plateau"


def _radius_ends_higher(sweep: Sweep) -> Finding | None:
    a, b = sweep.at(1.7), sweep.at(0.1)
    if a is None or b is None:
        return None
    more = float(sweep.radius[a] / sweep.radius[b] - 1.0)
    return more > 0.0, f"{more:+.1%}"


def _pressure_jumps(sweep: Sweep) -> Finding | None:
    k = sweep.between(0.6, 1.7)
    if len(k) < 6 or sweep.at(0.95) is None or sweep.at(1.05) is None:
        return None
    rise = np.diff(sweep.pressure[k]) / np.diff(np.log(sweep.ratio[k]))
    middle = sweep.between(0.94, 1.06)
    steep = np.diff(sweep.pressure[middle]) / np.diff(np.log(sweep.ratio[middle]))
    part = float(np.ptp(sweep.pressure[middle]) / np.ptp(sweep.pressure[k]))
    return float(steep.max()) >= float(rise.max()) - 1e-12, f"{part:.0%} of the whole rise"


def _pressure_peaks(sweep: Sweep) -> Finding | None:
    place, top = _inner_extreme(sweep, sweep.pressure, 1.0, 2.5)
    if np.isnan(place) or not 2 <= sweep.number <= 4:
        return None
    if np.isinf(place):
        return False, "no maximum inside 1.0 to 2.5"
    over = float(top / sweep.pressure[sweep.between(1.7, 10.0)].mean() - 1.0)
    return abs(place - 1.4) <= 0.1, f"maximum at {place:.2f}, {over:+.1%} above the plateau"


def _no_peak_in_case_1(sweep: Sweep) -> Finding | None:
    place, top = _inner_extreme(sweep, sweep.pressure, 1.0, 2.5)
    if np.isnan(place) or sweep.number != 1:
        return None
    over = float(top / sweep.pressure[sweep.between(1.7, 10.0)].mean() - 1.0)
    where = "" if np.isinf(place) else f" at {place:.2f}"
    return over < 0.005, f"largest{where}, {over:+.1%} above the plateau"


def _force_changes_at_one(sweep: Sweep) -> Finding | None:
    k = sweep.between(0.6, 1.7)
    if len(k) < 6 or sweep.at(1.0) is None:
        return None
    place, _ = _inner_extreme(sweep, -sweep.force, 0.6, 1.7)
    if np.isinf(place):
        return False, "no minimum inside 0.6 to 1.7"
    return abs(place - 1.0) <= 0.05, f"minimum at {place:.3f}"


def _indentation_beyond_1_7(sweep: Sweep) -> Finding | None:
    k = [i for i in sweep.between(1.7, 10.0) if sweep.records[i].unloadings]
    if not k:
        return None
    parts = []
    for i in k:
        last = sweep.records[i].unloadings[-1]
        parts.append(last.residual_sphere / (last.residual_sphere + last.residual_flat))
    most = float(np.max(np.abs(parts)))
    return most < 0.01, f"sphere's part of the residual depth at most {most:.2g}"


CLAIMS: tuple[tuple[str, str, Callable[[Sweep], Finding | None]], ...] = (
    ("2.2.2", "delta_s* starts near 0.9 (within 0.05) at Sy* = 0.1", _share_at_start),
    (
        "2.2.2",
        "delta_s* is constant (within ±2 %) up to Sy* = 0.6",
        _constant("share", 0.1, 0.6, within=0.02),
    ),
    (
        "2.2.2",
        "delta_s* decreases from Sy* = 0.6 to 1, faster and faster",
        _falls(0.6, 1.0, fewest=4, faster=True),
    ),
    ("2.2.2", "delta_s* changes most rapidly at Sy* = 1", _falls_at_one),
    (
        "2.2.2",
        "(not in the text) identical bodies share equally before yield (0.5 within 0.01)",
        _half_at_one,
    ),
    (
        "2.2.2",
        "delta_s* decreases from Sy* = 1 to 1.7, slower and slower",
        _falls(1.0, 1.7, fewest=5, faster=False),
    ),
    (
        "2.2.2",
        "delta_s* is nearly constant (within ±10 % of itself) beyond 1.7",
        _constant("share", 1.7, 10.0, within=0.10),
    ),
    (
        "2.2.3",
        "a is constant (within ±1 %) up to Sy* = 0.6",
        _constant("radius", 0.1, 0.6, within=0.01),
    ),
    ("2.2.3", "a has its dip near Sy* = 1.07 (within 0.05)", _radius_dips),
    ("2.2.3", "a at Sy* = 1.7 is larger than in the flattening phase", _radius_ends_higher),
    (
        "2.2.3",
        "a is constant (within ±1 %) beyond Sy* = 1.7",
        _constant("radius", 1.7, 10.0, within=0.01),
    ),
    (
        "2.2.4",
        "the mean pressure is nearly constant (within ±2 %) from Sy* = 0.1 to 0.94",
        _constant("pressure", 0.1, 0.94, within=0.02),
    ),
    (
        "2.2.4",
        "the mean pressure rises most steeply between Sy* = 0.94 and 1.06",
        _pressure_jumps,
    ),
    (
        "2.2.4",
        "cases 2 to 4: the mean pressure has a maximum near Sy* = 1.4 (within 0.1)",
        _pressure_peaks,
    ),
    ("2.2.4", "case 1: the mean pressure has no maximum (above 0.5 %)", _no_peak_in_case_1),
    (
        "2.2.4",
        "the mean pressure is constant (within ±2 %) beyond Sy* = 1.7",
        _constant("pressure", 1.7, 10.0, within=0.02),
    ),
    (
        "2.2.5",
        "F follows the pattern of a, with its transition at Sy* = 1 (minimum within 0.05)",
        _force_changes_at_one,
    ),
    (
        "1.2",
        "beyond Sy* = 1.7 the contact is one of indentation (the sphere keeps below 1 %)",
        _indentation_beyond_1_7,
    ),
)
"""Section, claim and test, in the order of the text."""
