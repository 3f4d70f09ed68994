"""The demonstration on chapter 5 as lines and as a picture."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ...core.observables import OBSERVABLES
from ...core.output import write_figure
from .demonstration import Demonstration, Row
from .later_touch import Later
from .uncertain import RANGES

_FAR = 2.0  # deviations from which a value counts as unexplained
_COLOURS = ("#8a94a3", "#2b6cb0", "#2f855a", "#c05621", "#6b46c1")


def table(found: Demonstration, *, most: int = 12) -> list[str]:
    """Return the demonstration as lines: values with bands, ranking, what remains, what follows."""
    m = found.measured
    out = ["Drawn, nothing fitted:"]
    out += [f"  {name}: {r.low:g} to {r.high:g} ({r.source})" for name, r in RANGES.items()]
    unfinished, struck = found.unfinished
    draws = len(found.shown[0].predicted)
    out += ["", f"{draws} draws, 5 to 95 %; {unfinished} of {struck} impacts did not end"]
    out += [f"  [{i}] {row.name}" for i, row in enumerate(found.shown)]
    out.append(f"{'':38s}{'measured':>15s}" + "".join(
        f"{f'[{i}]':>16s}" for i in range(len(found.shown))
    ))  # fmt: skip
    for k, name in enumerate(m.names):
        o = OBSERVABLES[name]
        for j, angle in enumerate(m.angles):
            cells = [_cell(name, r.band()[0][j, k], r.band()[1][j, k]) for r in found.shown]
            at = f"{_number(name, m.value[j, k])} +- {_number(name, m.std[j, k])}"
            out.append(f"{f'{o.axis}, {angle:.0f} deg':38s}{at:>15s}" + "".join(
                f"{cell:>16s}" for cell in cells
            ))  # fmt: skip
    few = len(found.ranked[0].predicted)
    out += ["", f"Ranked, {len(found.ranked)} explanations of up to three mechanisms, {few} draws:"]
    out.append("  misfit  farthest off")
    for row in found.ranked[:most]:
        out.append(f"  {row.misfit:6.0f}  {_farthest(found, row):42s} {row.name}")
    out += _places(found.ranked, most)
    for row in dict.fromkeys((found.shown[-1], found.shown[min(3, len(found.shown) - 1)])):
        out += ["", f"What {row.name} does not explain:", *_unexplained(found, row)]
    out += ["", f"A later contact, after {found.shown[3].name}:"]
    out += [
        f"  {angle:.0f} deg: {_later(of)}" for angle, of in zip(m.angles, found.later, strict=True)
    ]
    return out


def _number(name: str, value: float) -> str:
    o = OBSERVABLES[name]
    return f"{o.scale * value:.0f}" if o.unit == "um" else f"{o.scale * value:.2f}"


def _cell(name: str, low: float, high: float) -> str:
    return f"{_number(name, low)} to {_number(name, high)}"


def _farthest(found: Demonstration, row: Row) -> str:
    m = found.measured
    j, k = np.unravel_index(int(np.argmax(np.abs(row.z))), row.z.shape)
    return f"{OBSERVABLES[m.names[k]].label}, {m.angles[j]:.0f} deg ({row.z[j, k]:+.1f} sd)"


def _places(ranked: Sequence[Row], most: int) -> list[str]:
    """Return the best of each size and the baseline, where they lie behind what was listed."""
    out = []
    for size, name in enumerate(("baseline", "best single", "best pair", "best triple")):
        of = [
            (i, r) for i, r in enumerate(ranked)
            if (0 if r.name == "baseline" else r.name.count("+") + 1) == size
        ]  # fmt: skip
        if of:
            i, row = of[0]
            out.append(f"  {name}: {row.name}, misfit {row.misfit:.0f}, place {i + 1}")
    return out


def _unexplained(found: Demonstration, row: Row) -> list[str]:
    m, (low, high) = found.measured, row.band()
    out = []
    for k, name in enumerate(m.names):
        for j, angle in enumerate(m.angles):
            if abs(row.z[j, k]) > _FAR:
                out.append(
                    f"  {OBSERVABLES[name].axis} at {angle:.0f} deg: "
                    f"{_number(name, m.value[j, k])} measured, "
                    f"{_cell(name, low[j, k], high[j, k])} predicted"
                )
    return out or ["  nothing beyond two standard deviations"]


def _later(of: Sequence[Later | None]) -> str:
    back = [x for x in of if x is not None]
    if not back:
        return "the tip does not come back within 2 s"
    time, away, speed = (
        _span([getattr(x, key) * scale for x in back])
        for key, scale in (("time", 1e3), ("distance", 1e3), ("speed", 1.0))
    )
    other = [1e3 * x.other_first for x in back if np.isfinite(x.other_first)]
    first = f"the other end strikes after {_span(other)} ms, " if other else ""
    text = f"{first}the tip is back after {time} ms, {away} mm along the flat, at {speed} m/s; "
    both = [x.second for x in back if x.overlaps]
    text += f"its mark runs into the first in {len(both)} of {len(of)} draws"
    if both:
        depth, excess = (
            _span([1e6 * getattr(x, key) for x in both])
            for key in ("residual_flat_m", "scar_excess_m")
        )
        text += f", both together {depth} um deep and {excess} um longer than wide"
    return text


def _span(values: Sequence[float]) -> str:
    low, high = np.percentile(values, [5.0, 95.0])
    return f"{low:.3g} to {high:.3g}"


def draw(found: Demonstration, path: Path) -> None:
    """Draw measured values and the bands of the shown explanations over the angle."""
    m = found.measured
    figure = Figure(figsize=(10.0, 7.0), layout="constrained")
    panels = figure.subplots(2, 2).ravel()
    for k, (name, axis) in enumerate(zip(m.names, panels, strict=True)):
        o = OBSERVABLES[name]
        for i, row in enumerate(found.shown):
            low, high = row.band()
            x = m.angles + 2.0 * (i + 1)
            axis.bar(
                x, o.scale * (high[:, k] - low[:, k]), 1.6, o.scale * low[:, k],
                color=_COLOURS[i], edgecolor=_COLOURS[i], lw=2, label=row.name,
            )  # fmt: skip
            middle = o.scale * np.nanmedian(row.predicted[:, :, k], axis=0)
            axis.hlines(middle, x - 0.8, x + 0.8, color="black", lw=0.8)
        axis.errorbar(
            m.angles, o.scale * m.value[:, k], o.scale * m.std[:, k], fmt="ks", capsize=3, ms=5,
            label="measured (thesis), one standard deviation",
        )  # fmt: skip
        axis.set_title(o.axis, fontsize=10)
        axis.set_xticks(m.angles, [f"{a:.0f}" for a in m.angles])
        axis.axhline(0.0, color="#cccccc", lw=0.8, zorder=0)
    for axis in panels[2:]:
        axis.set_xlabel("angle between rod and flat [deg]", fontsize=9)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize=8)
    figure.suptitle("Chapter 5: 5 to 95 % of the draws, nothing fitted", fontsize=11)
    write_figure(figure, path, dpi=figure.dpi)
