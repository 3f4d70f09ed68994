"""Figures of a report as SVG whose colours follow the page: light, dark, print."""

from __future__ import annotations

import html
import io
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter, NullLocator

from ...core.observables import OBSERVABLES
from ..correction import Correction
from .series import STATED, WITH, WITHOUT, Against, SeriesPoint

# limit: distance of two simulations of one number in a figure [axis]: a marker's half
_DRAWN_APART = 0.012

COLOURS = {"#010101": "ink", "#020202": "faint", "#030303": "without", "#040404": "verdict"}
"""Colours that are drawn, and the variable of the page's style that takes their place."""
_INK, _FAINT, _WITHOUT, _VERDICT = COLOURS


class _Series(NamedTuple):
    """How one of the simulations is drawn: line, own marker or the striker's, and to which side."""

    line: str
    marker: str
    side: float


_SERIES = {
    _FAINT: _Series(":", ".", 0.0),
    _WITHOUT: _Series("--", "", -1.0),
    _VERDICT: _Series("-", "", 1.0),
}
"""By their colours, in the order of `_simulated`."""
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
"""A striker's marker, in the order of the strikers."""
_STYLE = {
    "svg.fonttype": "none", "svg.hashsalt": "dentscope", "font.size": 9.0, "axes.labelsize": 9.0,
    "text.color": _INK, "axes.labelcolor": _INK, "axes.edgecolor": _FAINT, "xtick.color": _INK,
    "ytick.color": _INK, "grid.color": _FAINT, "grid.alpha": 0.25, "axes.linewidth": 0.8,
}  # fmt: skip


def comparison(
    points: Sequence[SeriesPoint], against: Against, strikers: Sequence[str], *, key: str
) -> str:
    """Return measured beside the simulations, and the differences below, for one observable.

    Parameters
    ----------
    points
        Numbers of one observable.
    against
        What the axis shows.
    strikers
        All strikers of the report, for their markers.
    key
        Begins the ids of the figure's elements; no other figure of the page has it.
    """
    row = OBSERVABLES[points[0].observable]
    with matplotlib.rc_context(_STYLE):
        figure = Figure(figsize=(4.6, 4.5), layout="constrained")
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(1.35, 1.0))
        x = np.array([p.x[against.key] for p in points])
        positive = np.array([[p.measured, p.as_stated, p.best_without] for p in points])
        _axis(upper, "y", positive, log=row.log)
        _axis(upper, "x", x, log=against.key in ("speed_m_s", "load_N"))
        if not np.ptp(x):  # else the axis is as wide as what stands apart beside the one place
            upper.set_xlim(*(x[0] + 0.5 * side * (abs(x[0]) or 1.0) for side in (-1.0, 1.0)))
        shift = _sideways(x, log=upper.get_xscale() == "log")
        for n, p in enumerate(points):
            marker = MARKERS[strikers.index(p.striker) % len(MARKERS)]
            _draw_point(upper, lower, p, marker, float(x[n]), shift, gid=f"{key}-{n}")
        for line in _lines(points, against):
            xs = [p.x[against.key] for p in line]
            for (colour, look), values in zip(
                _SERIES.items(), np.transpose([_simulated(p) for p in line]), strict=True
            ):
                if np.isfinite(values).all():
                    upper.plot(xs, values, color=colour, lw=1.1, ls=look.line, zorder=1)
        lower.axhline(0.0, color=_INK, lw=0.8)
        unit = "%" if row.log else row.unit
        shown = "" if unit == "-" else f" [{unit}]"
        upper.set_ylabel(row.axis)
        lower.set_ylabel(f"measured off\nsimulated{shown}")
        lower.set_xlabel(against.label)
        lower.yaxis.set_major_locator(MaxNLocator(5))
        for axis in (upper, lower):
            axis.grid(visible=True)
            axis.spines[["top", "right"]].set_visible(False)
        titles = {f"{key}-{n}": _told(p, against) for n, p in enumerate(points)}
        return svg(figure, f"{row.label} against {against.label}", key=key, titles=titles)


def _draw_point(
    upper: Axes, lower: Axes, p: SeriesPoint, marker: str, x: float, shift: float, *, gid: str
) -> None:
    fill = _INK if p.weight else "none"
    bars = [[p.measured - p.low], [p.high - p.measured]]
    look: dict[str, Any] = {"marker": marker, "ms": 5.0, "ls": "none", "mew": 1.0}
    upper.errorbar(x, p.measured, yerr=bars, fmt="none", ecolor=_INK, elinewidth=1.0, zorder=3)
    (dot,) = upper.plot(x, p.measured, **look, color=_INK, mfc=fill, zorder=4)
    dot.set_gid(gid)
    for value, (colour, series) in zip(_simulated(p), _SERIES.items(), strict=True):
        if not math.isfinite(value):
            continue
        side = series.side
        look |= {"marker": series.marker or marker}
        aside = x * shift**side if upper.get_xscale() == "log" else x + side * (shift - 1.0)
        upper.plot(x, value, **look, color=colour, mfc="none", zorder=2)
        scale = 100.0 / value if OBSERVABLES[p.observable].log and value else 1.0
        off = [scale * (one - value) for one in (p.low, p.measured, p.high)]
        lower.errorbar(
            aside, off[1], yerr=[[off[1] - off[0]], [off[2] - off[1]]], fmt="none",
            ecolor=colour, elinewidth=1.0,
        )  # fmt: skip
        lower.plot(aside, off[1], **look, color=colour, mfc=colour if p.weight else "none")


def _simulated(p: SeriesPoint) -> tuple[float, float, float]:
    """As stated, at best without anything missing, and with the verdict."""
    return p.as_stated, p.best_without, p.with_verdict


def _sideways(x: np.ndarray, *, log: bool) -> float:
    """By how much the fitted simulations stand apart: a factor, or 1 plus a length."""
    if log:
        return float((x.max() / x.min()) ** _DRAWN_APART) if np.ptp(x) else 1.01
    return 1.0 + _DRAWN_APART * float(np.ptp(x) or abs(x[0]) or 1.0)


def _axis(axis: Axes, which: str, values: np.ndarray, *, log: bool) -> None:
    """Scale one axis by what it shows: a logarithm from a ratio of five on, ticks that fit."""
    given = values[np.isfinite(values)]
    ratio = given.max() / given.min() if given.min() > 0.0 else 0.0
    chosen = axis.xaxis if which == "x" else axis.yaxis
    if log and ratio > 5.0:
        (axis.set_xscale if which == "x" else axis.set_yscale)("log")
        subs = (1.0, 2.0, 5.0) if ratio < 300.0 else (1.0,)
        chosen.set_major_locator(LogLocator(subs=subs, numticks=9))
        chosen.set_minor_locator(NullLocator())
    else:
        chosen.set_major_locator(MaxNLocator(5))
    chosen.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    chosen.set_minor_formatter(NullFormatter())


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
    texts = [
        f"{p.striker}, {against.label.split(' [')[0]} {p.x[against.key]:.3g}",
        f"measured {p.measured:.4g} ± {(p.high - p.low) / 2.0:.2g}{unit}, {p.trials} trials",
        f"{STATED} {p.as_stated:.4g}{unit}",
        f"{WITHOUT} {p.best_without:.4g}{unit}",
    ]
    if math.isfinite(p.with_verdict):
        texts.append(f"{WITH} {p.with_verdict:.4g}{unit}")
    if not p.weight:
        texts.append("given no weight")
    return "; ".join(texts)


def correction(found: Iterable[Correction], *, key: str) -> str:
    """Return the factor on loading and recovery over the depth, with the 90 % band."""
    found = list(found)
    with matplotlib.rc_context(_STYLE):
        figure = Figure(figsize=(4.6 * len(found), 3.0), layout="constrained")
        axes = figure.subplots(1, len(found), squeeze=False)[0]
        for axis, c in zip(axes, found, strict=True):
            axis.fill_between(c.depth_over_R, c.low, c.high, color=_VERDICT, alpha=0.25, lw=0)
            axis.plot(c.depth_over_R, c.factor, color=_VERDICT)
            axis.axhline(1.0, color=_INK, lw=0.8)
            _axis(axis, "x", np.asarray(c.depth_over_R), log=True)
            what = "loading force" if c.phase == "loading" else "elastic recovery"
            axis.set_ylabel(f"factor on the {what} [-]")
            axis.set_xlabel("depth over radius [-]")
            axis.grid(visible=True)
        return svg(figure, "factor on the force law over the depth", key=key)


def svg(figure: Figure, label: str, *, key: str, titles: dict[str, str] | None = None) -> str:
    """Return a figure as an SVG element with the page's colours and fonts.

    Parameters
    ----------
    figure
        What is drawn in the colours of `COLOURS`.
    label
        What a reader hears who does not see it.
    key
        Begins every id.
    titles
        Texts shown over elements, by their gid.
    """
    buffer = io.StringIO()
    figure.set_facecolor("none")
    for axis in figure.axes:
        axis.set_facecolor("none")
    FigureCanvasSVG(figure).print_svg(buffer, metadata={"Date": None, "Creator": None})
    text = buffer.getvalue()
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    for gid, told in (titles or {}).items():
        text = text.replace(
            f'<g id="{gid}">',
            f'<g id="{gid}" class="point"><title>{html.escape(told)}</title>',
        )
    text = re.sub(rf'(id="|url\(#|href="#)(?!{re.escape(key)}-)', rf"\1{key}-", text)
    for colour, name in COLOURS.items():
        text = text.replace(colour, f"var(--{name})")
    # the page's own font and width
    text = re.sub(r"font-family: [^;\"]*;?", "", text)
    text = re.sub(r"<style.*?</style>", "", text, count=1, flags=re.DOTALL)
    head, rest = text.split(">", 1)
    head = re.sub(r' (?:width|height)="[^"]*"', "", head)
    return f'{head} role="img" aria-label="{html.escape(label)}">{rest}'
