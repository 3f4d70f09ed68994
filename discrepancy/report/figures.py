"""Figures of a report: measured beside the simulations, and how far they lie apart."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ...core.arrays import Array
from ...core.observables import OBSERVABLES
from ...core.tables import counted
from ..correction import Correction
from ..findings import After
from .series import STATED, WITH, WITHOUT, Against, SeriesPoint
from .svg import SHAPES, Plot, PlotAxis, figure, room

# limit: distance of two simulations of one number in a figure [axis]: a marker's half
_DRAWN_APART = 0.012

# limit: explanations of a path [-]: a screen
_PATHS = 5


class _Series(NamedTuple):
    """How one of the simulations is drawn: line, own marker or the striker's, and to which side."""

    line: str
    marker: str
    side: float


_SERIES = {
    "faint": _Series(":", ".", 0.0),
    "without": _Series("--", "", -1.0),
    "verdict": _Series("-", "", 1.0),
}
"""By the page's colours, in the order of `_simulated`."""
MARKERS = tuple(SHAPES)[1:]
"""A striker's marker, in the order of the strikers."""
# limit: of a figure [pt]: its size, and where its panels end
_WIDTH, _HEIGHT, _RIGHT, _TOP, _SPLIT, _BOTTOM = 331.0, 324.0, 325.0, 6.0, (170.0, 180.0), 294.0


def comparison(
    points: Sequence[SeriesPoint], against: Against, strikers: Sequence[str], *, key: str
) -> str:
    """Return measured beside the simulations, and the differences below, for one observable.

    `against`: what the axis shows; `strikers`: all of the report, for their markers; `key`: begins
    the ids of the figure's elements, and no other's of the page.
    """
    row = OBSERVABLES[points[0].observable]
    upper, lower, left = _plots(points, against)
    unit = "%" if row.log else row.unit
    shown = "" if unit == "-" else f" [{unit}]"
    upper.frame("", [row.axis], left)
    lower.frame(against.label, ["measured off", f"simulated{shown}"], left)
    lower.level(0.0)
    for line in _lines(points, against):
        xs = [p.x[against.key] for p in line]
        for (colour, look), values in zip(
            _SERIES.items(), np.transpose([_simulated(p) for p in line]), strict=True
        ):
            if np.isfinite(values).all():
                upper.line(xs, values, colour, look.line)
    for n, p in enumerate(points):
        x, shape = p.x[against.key], MARKERS[strikers.index(p.striker) % len(MARKERS)]
        for value, (colour, series) in zip(_simulated(p), _SERIES.items(), strict=True):
            if not math.isfinite(value):
                continue
            own = series.marker or shape
            upper.marker(x, value, own, colour)
            low, off, high = _off(p, value)
            aside = _aside(lower.x, x, series.side)
            lower.bar(aside, low, high, colour)
            lower.marker(aside, off, own, colour, full=p.weight)
        upper.bar(x, p.low, p.high, "ink")
        told = _told(p, against)
        upper.marker(x, p.measured, shape, "ink", full=p.weight, told=told, key=f"{key}-{n}")
    label = f"{row.label} against {against.label}"
    return figure((upper, lower), label, width=_WIDTH, height=_HEIGHT)


def _plots(points: Sequence[SeriesPoint], against: Against) -> tuple[Plot, Plot, float]:
    """Return both plots, empty, and the width of what stands on their left [pt]."""
    x = np.array([p.x[against.key] for p in points])
    values = [(p.low, p.high, *_simulated(p)) for p in points]
    apart = [_off(p, value) for p in points for value in _simulated(p)]
    up = PlotAxis.over(values, _SPLIT[0], _TOP, log=OBSERVABLES[points[0].observable].log)
    down = PlotAxis.over([0.0, *np.ravel(apart)], _BOTTOM, _SPLIT[1])
    left = room((up, down), 2)
    # an axis with one place on it is wide, else as wide as what stands apart beside that
    wide = x if np.ptp(x) else x[0] + 0.45 * np.array([-1.0, 1.0]) * (abs(x[0]) or 1.0)
    log = bool(np.ptp(x)) and against.key in ("speed_m_s", "load_N")
    across = PlotAxis.over(wide, left, _RIGHT, log=log)
    return Plot(across, up), Plot(across, down), left


def _off(p: SeriesPoint, value: float) -> Array:
    """How far the measured number and the ends of its bar, (low, it, high), lie off a simulated."""
    scale = 100.0 / value if OBSERVABLES[p.observable].log and value else 1.0
    return scale * (np.array([p.low, p.measured, p.high]) - value)


def _aside(scale: PlotAxis, x: float, side: float) -> float:
    """Where a fitted simulation stands beside its place."""
    if scale.log:
        return float(x * (scale.high / scale.low) ** (side * _DRAWN_APART))
    return x + side * _DRAWN_APART * (scale.high - scale.low)


def _simulated(p: SeriesPoint) -> tuple[float, float, float]:
    """As stated, at best without anything missing, and with the verdict."""
    return p.as_stated, p.best_without, p.with_verdict


def _lines(points: Sequence[SeriesPoint], against: Against) -> Iterator[list[SeriesPoint]]:
    """Return the simulated points that differ in nothing but what the axis shows, in its order."""
    groups: dict[tuple[object, ...], list[SeriesPoint]] = {}
    for p in points:
        rest = tuple(f"{x:.3g}" for k, x in p.x.items() if k != against.key)
        groups.setdefault((p.striker, rest), []).append(p)
    for group in groups.values():
        group.sort(key=lambda p: p.x[against.key])
        if len({p.x[against.key] for p in group}) == len(group) > 1:
            yield group


def _told(p: SeriesPoint, against: Against) -> str:
    unit = "" if p.unit == "-" else f" {p.unit}"
    measured = f"measured {p.measured:.4g} ± {(p.high - p.low) / 2.0:.2g}{unit}"
    texts = [
        f"{p.striker}, {against.label.split(' [')[0]} {p.x[against.key]:.3g}",
        f"{measured}, {counted(p.trials, 'trial')}",
        f"{STATED} {p.as_stated:.4g}{unit}",
        f"{WITHOUT} {p.best_without:.4g}{unit}",
    ]
    if math.isfinite(p.with_verdict):
        texts.append(f"{WITH} {p.with_verdict:.4g}{unit}")
    if not p.weight:
        texts.append("given no weight")
    return "; ".join(texts)


def correction(found: Iterable[Correction]) -> str:
    """Return the factor on loading and recovery over the depth, with the 90 % band."""
    panels, begin = [], 0.0
    for c in found:
        y = PlotAxis.over([*c.low, *c.high, 1.0], 186.0, _TOP)
        left = room([y], 1)
        x = PlotAxis.over(c.depth_over_R, begin + left, begin + _RIGHT, log=True)
        panels.append(Plot(x, y))
        what = "loading force" if c.phase == "loading" else "elastic recovery"
        panels[-1].frame("depth over radius [-]", [f"factor on the {what} [-]"], left)
        panels[-1].band(c.depth_over_R, c.low, c.high, "verdict")
        panels[-1].line(c.depth_over_R, c.factor, "verdict")
        panels[-1].level(1.0)
        begin += _WIDTH
    return figure(panels, "factor on the force law over the depth", width=begin, height=216.0)


def paths_of(history: Sequence[After]) -> list[str]:
    """Return the explanations whose path is drawn: those that were ever the most probable."""
    most: dict[str, float] = {}
    for one in history:
        for name, p in one.probabilities.items():
            most[name] = max(most.get(name, 0.0), p)
    return sorted(most, key=lambda name: -most[name])[:_PATHS]


def path(history: Sequence[After]) -> str:
    """Return the probability of each explanation of `paths_of` after each session."""
    y = PlotAxis(0.0, 1.0, 186.0, _TOP)
    left = room([y], 1)
    places = np.arange(1.0, len(history) + 1.0)
    panel = Plot(PlotAxis(0.7, len(history) + 0.3, left, _RIGHT), y)
    panel.frame("", ["probability [-]"], left)
    names = paths_of(history)
    last = max(names, key=lambda name: history[-1].probabilities.get(name, 0.0))
    for marker, name in zip(MARKERS, names, strict=False):
        p = [one.probabilities.get(name, 0.0) for one in history]
        colour = "verdict" if name == last else "ink"
        panel.line(places, p, colour, "-" if name == last else "--")
        for k, value in enumerate(p):
            panel.marker(float(places[k]), value, marker, colour, full=name == last)
    for place, one in zip(places.tolist(), history, strict=True):
        panel.text(place, f"after session {one.batch:g}")
        panel.text(place, counted(one.trials, "trial"), line=2)
    label = "probability of each explanation after each session"
    return figure([panel], label, width=_WIDTH, height=216.0)
