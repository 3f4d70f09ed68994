"""Panels of a figure as SVG whose colours follow the page: light, dark, print.

Written straight: a plotting library took a third of an ordinary diagnosis for ten small figures.
"""

from __future__ import annotations

import html
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from ...core.arrays import Array

_DASHES = {"-": "", ":": "1.1 1.8", "--": "4.1 1.8"}
SHAPES = {
    ".": "m-1.3 0a1.3 1.3 0 1 0 2.6 0a1.3 1.3 0 1 0-2.6 0z",
    "o": "m-2.5 0a2.5 2.5 0 1 0 5 0a2.5 2.5 0 1 0-5 0z",
    "s": "m-2.4-2.4h4.8v4.8h-4.8z",
    "^": "m0-3l2.8 5h-5.6z",
    "D": "m0-3.3l3.3 3.3l-3.3 3.3l-3.3-3.3z",
    "v": "m0 3l2.8-5h-5.6z",
    "P": "m-1-3h2v2h2v2h-2v2h-2v-2h-2v-2h2z",
    "X": "m0-1.4l1.4-1.4l1.4 1.4l-1.4 1.4l1.4 1.4l-1.4 1.4l-1.4-1.4l-1.4 1.4l-1.4-1.4l1.4-1.4"
    "l-1.4-1.4l1.4-1.4z",
    "*": "m0-3.4l.8 2.3h2.4l-1.9 1.5l.7 2.4l-2-1.4l-2 1.4l.7-2.4l-1.9-1.5h2.4z",
}
"""Outlines of markers about their place: a point, then those of strikers, in their order."""
# limit: of text: its size, a letter's width, from line to line [pt]
_FONT, _LETTER, _LINE = 9.0, 5.2, 11.0


@dataclass(frozen=True)
class PlotAxis:
    """One axis of a panel: its ends, in the unit of what it shows, and where they lie [pt]."""

    low: float
    high: float
    start: float
    end: float
    log: bool = False

    @classmethod
    def over(
        cls, values: npt.ArrayLike, start: float, end: float, *, log: bool = False
    ) -> PlotAxis:
        """Return the axis that holds all values and a margin; `log`: by their ratio, from 5 on."""
        given = np.ravel(values)[np.isfinite(np.ravel(values))]
        low, high = float(given.min()), float(given.max())
        if log and low > 0.0 and high > 5.0 * low:
            margin = (high / low) ** 0.05
            return cls(low / margin, high * margin, start, end, log=True)
        margin = 0.05 * ((high - low) or abs(low) or 1.0)
        return cls(low - margin, high + margin, start, end)

    def at(self, value: npt.ArrayLike) -> Array:
        """Return where values lie [pt], shape (...)."""
        ends = np.array([self.low, self.high])
        value, ends = (np.log(value), np.log(ends)) if self.log else (np.asarray(value), ends)
        share = (value - ends[0]) / np.ptp(ends)
        return np.asarray(self.start + share * (self.end - self.start), float)

    def ticks(self) -> dict[str, float]:
        """Return where round values stand [pt] by their texts; 1, 2, 5 of a logarithm's decades."""
        if self.log:
            decades = range(math.floor(math.log10(self.low)), math.ceil(math.log10(self.high)) + 1)
            digits = (1.0, 2.0, 5.0) if self.high < 300.0 * self.low else (1.0,)
            found = [s * 10.0**k for k in decades for s in digits]
        else:
            least = (self.high - self.low) / 5.0
            power = 10.0 ** math.floor(math.log10(least))
            step = next(s * power for s in (1.0, 2.0, 2.5, 5.0, 10.0) if s * power > 0.999 * least)
            whole = range(math.ceil(self.low / step), math.floor(self.high / step) + 1)
            found = [k * step for k in whole]
        shown = [tick for tick in found if self.low <= tick <= self.high]
        texts = (f"{round(tick, 12):g}".replace("-", "\N{MINUS SIGN}") for tick in shown)
        return dict(zip(texts, self.at(shown).tolist(), strict=True))


def room(upward: Iterable[PlotAxis], lines: int) -> float:
    """Width that ticks and labels of upward axes take on their left [pt]."""
    return _LETTER * max(len(text) for y in upward for text in y.ticks()) + _LINE * lines + 9.0


@dataclass
class Plot:
    """A pair of axes and what is drawn between them, back to front."""

    x: PlotAxis
    y: PlotAxis
    parts: list[str] = field(default_factory=list)

    def frame(self, across: str, up: Sequence[str], left: float) -> None:
        """Draw axes, grid and labels: lines of the upward one from `left` [pt] of it on."""
        x0, x1, y0, y1 = self.x.start, self.x.end, self.y.start, self.y.end
        tops, sides = self.x.ticks(), self.y.ticks()
        grid = [f"M{px:.1f} {y0:g}V{y1:g}" for px in tops.values()]
        grid += [f"M{x0:g} {py:.1f}H{x1:g}" for py in sides.values()]
        self._path("".join(grid), "faint", 0.8, "opacity:.25")
        self._path(f"M{x0:g} {y1:g}V{y0:g}H{x1:g}", "faint", 0.8)
        for text, py in sides.items():
            self._text(x0 - 4.0, py + 3.2, text, 'text-anchor="end"')
        for k, line in enumerate(up):
            x, y = x0 - left + _LINE * (k + 0.9), 0.5 * (y0 + y1)
            self._text(x, y, line, f'text-anchor="middle" transform="rotate(-90 {x:.1f} {y:.1f})"')
        if across:
            for text, px in (*tops.items(), (across, 0.5 * (x0 + x1))):
                self._text(px, y0 + (24.0 if text == across else 12.0), text)

    def line(self, xs: npt.ArrayLike, ys: npt.ArrayLike, colour: str, look: str = "-") -> None:
        """Draw a line through points, all finite."""
        dashes = f"stroke-dasharray:{_DASHES[look]}" if _DASHES[look] else ""
        self._path(f"M{self._through(xs, ys)}", colour, 1.1, dashes)

    def text(self, x: float, text: str, line: int = 1) -> None:
        """Write below the axis across."""
        self._text(float(self.x.at(x)), self.y.start + 12.0 * line, text)

    def level(self, value: float) -> None:
        """Draw a value across the panel."""
        self._path(f"M{self.x.start:g} {self.y.at(value):.1f}H{self.x.end:g}", "ink", 0.8)

    def band(self, xs: Array, low: Array, high: Array, colour: str) -> None:
        """Fill what lies between two curves."""
        edge = self._through(np.append(xs, xs[::-1]), np.append(low, high[::-1]))
        self.parts.append(f'<path d="M{edge}z" style="fill:var(--{colour});opacity:.25"/>')

    def bar(self, x: float, low: float, high: float, colour: str) -> None:
        """Draw an error bar."""
        self._path(f"M{self.x.at(x):.1f} {self.y.at(low):.1f}V{self.y.at(high):.1f}", colour, 1.0)

    def marker(
        self, x: float, y: float, shape: str, colour: str, *, full: bool = False, told: str = "",
        key: str = "",
    ) -> None:  # fmt: skip
        """Draw a marker of `SHAPES`; `told` is shown over it, `key` its id."""
        fill = f"var(--{colour})" if full else "none"
        drawn = (
            f'<path d="M{self.x.at(x):.1f} {self.y.at(y):.1f}{SHAPES[shape]}" '
            f'pointer-events="all" style="fill:{fill};stroke:var(--{colour})"/>'
        )
        title = f'<g id="{key}" class="point"><title>{html.escape(told)}</title>'
        self.parts.append(f"{title}{drawn}</g>" if told else drawn)

    def _through(self, xs: npt.ArrayLike, ys: npt.ArrayLike) -> str:
        places = zip(self.x.at(xs), self.y.at(ys), strict=True)
        return "L".join(f"{px:.1f} {py:.1f}" for px, py in places)

    def _path(self, d: str, colour: str, width: float, more: str = "") -> None:
        style = f"fill:none;stroke:var(--{colour});stroke-width:{width};{more}"
        self.parts.append(f'<path d="{d}" style="{style}"/>')

    def _text(self, x: float, y: float, text: str, more: str = 'text-anchor="middle"') -> None:
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" {more}>{html.escape(text)}</text>')


def figure(panels: Iterable[Plot], label: str, *, width: float, height: float) -> str:
    """Return panels as one SVG element; `label` is what a reader hears who does not see it."""
    inside = "".join(part for panel in panels for part in panel.parts)
    return (
        f'<svg viewBox="0 0 {width:g} {height:g}" role="img" aria-label="{html.escape(label)}" '
        f'font-size="{_FONT:g}" style="fill:var(--ink)">{inside}</svg>'
    )
