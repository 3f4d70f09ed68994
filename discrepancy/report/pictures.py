"""Figures of a report."""

from __future__ import annotations

import base64
import html
import io

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter

from ...core.observables import OBSERVABLES
from ..findings import Verdict
from ..inference.fit import Fit

_BASE, _BEST = "#8a94a3", "#2b6cb0"


def figure_misfit(v: Verdict) -> Figure:
    """Recording over simulation against speed, before and after, a panel for each observable."""
    cells = v.problem.cells
    names = list(dict.fromkeys(cells.observable))
    columns = min(len(names), 2)
    lines = -(-len(names) // columns)
    figure = Figure(figsize=(4.6 * columns, 2.7 * lines), layout="constrained")
    axes = np.atleast_1d(figure.subplots(lines, columns, squeeze=False)).ravel()
    shown: list[tuple[str, Fit, str]] = [("baseline", v.ranking.base, _BASE)]
    if v.mechanisms:
        shown.append((" + ".join(v.mechanisms), v.best, _BEST))
    for axis, name in zip(axes, names, strict=False):
        here = np.array([o == name for o in cells.observable])
        speed = np.array([v.problem.conditions[k].speed for k in cells.condition[here]])
        for place, (label, fitted, colour) in enumerate(shown):
            miss = _prior_miss(fitted)[here]
            log = bool(cells.is_log[here][0])
            value = 100.0 * np.expm1(miss) if log else miss
            bar = cells.std[here] * (100.0 if log else 1.0)
            axis.errorbar(
                speed * 1.03**place, value, yerr=bar, fmt="o", ms=4, lw=1, color=colour,
                label=label,
            )  # fmt: skip
        axis.axhline(0.0, color="#444", lw=0.8)
        axis.set_xscale("log")
        axis.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
        axis.xaxis.set_minor_formatter(NullFormatter())
        ticks = sorted({float(f"{x:.2g}") for x in speed})
        axis.set_xticks(ticks if len(ticks) < 7 else ticks[:: len(ticks) // 5])
        axis.set_title(OBSERVABLES[name].label, fontsize=10)
        axis.set_xlabel("approach speed [m/s]", fontsize=9)
        axis.set_ylabel("recording off simulation" + (" [%]" if log else ""), fontsize=9)
        axis.tick_params(labelsize=8)
    for axis in axes[len(names) :]:
        axis.set_visible(False)
    axes[0].legend(fontsize=8)
    return figure


def _prior_miss(fitted: Fit) -> np.ndarray:
    """Recording minus prediction, with what the law's known error does not explain."""
    return np.asarray(fitted.residual - fitted.linear.J @ fitted.z)


def figure_correction(v: Verdict) -> Figure:
    """Factor on loading and recovery over the depth, with the 90 % band."""
    figure = Figure(figsize=(4.6 * len(v.corrections), 3.0), layout="constrained")
    axes = figure.subplots(1, len(v.corrections), squeeze=False)[0]
    for axis, c in zip(axes, v.corrections, strict=True):
        axis.fill_between(c.depth_over_R, c.low, c.high, color=_BEST, alpha=0.25, lw=0)
        axis.plot(c.depth_over_R, c.factor, color=_BEST)
        axis.axhline(1.0, color="#444", lw=0.8)
        axis.set_xscale("log")
        what = "loading force" if c.phase == "loading" else "elastic recovery"
        axis.set_title(f"factor on the {what}", fontsize=10)
        axis.set_xlabel("depth / R", fontsize=9)
        axis.tick_params(labelsize=8)
    return figure


def image(figure: Figure, alt: str) -> str:
    """Return a figure as an element of a page, with the picture inside."""
    buffer = io.BytesIO()
    FigureCanvasAgg(figure).print_png(buffer, metadata={"Software": None})
    data = base64.b64encode(buffer.getvalue()).decode("ascii")
    return f'<p><img alt="{html.escape(alt)}" src="data:image/png;base64,{data}"></p>'
