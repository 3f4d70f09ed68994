"""Pictures of a campaign: force, contact radius, share and hardness of every case."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..core.material import Pair
from ..core.output import figure, write_figure
from .records import CaseRecord

# limit: pairs that a picture names one by one [-]: colours that an eye parts
_PAIRS_NAMED = 6

_APPROACH = r"approach over that at first yield $\delta/\delta_c$"


def draw_campaign(records: list[CaseRecord], folder: Path) -> list[Path]:
    """Draw all completed cases into `folder`; return the files."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LinearSegmentedColormap, LogNorm

    made, axes = figure(2, 2, size=(10, 8))
    many = len(records) > _PAIRS_NAMED
    # dark in its middle: equal strengths stand out from the white page
    hues = LinearSegmentedColormap.from_list("", ["deepskyblue", "blue", "black", "red", "orange"])
    shades = ScalarMappable(LogNorm(0.1, 10.0, clip=True), hues)
    for record in records:
        pair = record.case.pair
        c = record.curve
        w = c["delta"] / (pair.first_yield * pair.R)
        ratio = pair.Sy_ratio if np.isfinite(pair.Sy_ratio) else 1.0
        style = {"color": shades.to_rgba(np.array(ratio)), "lw": 1.0 if many else 1.8}
        name = None if many else _told(pair)
        axes[0, 0].loglog(w, c["force"] / _critical_force(pair), label=name, **style)
        axes[0, 1].plot(c["delta"] / pair.R, c["radius"] / pair.R, **style)
        axes[1, 0].semilogx(w, c["sphere"] / (c["sphere"] + c["flat"]), **style)
        if np.isfinite(pair.Sy_min):
            axes[1, 1].semilogx(w, c["hardness"] / pair.Sy_min, **style)
    for axis, (x, y) in zip(
        axes.flat,
        (
            (_APPROACH, "force over that at first yield"),
            (r"approach over radius $\Delta/R$", "contact radius over radius $a/R$"),
            (_APPROACH, r"sphere's share of the approach $\delta_s^*$"),
            (_APPROACH, "mean pressure over the weaker strength"),
        ),
        strict=True,
    ):
        axis.set(xlabel=x, ylabel=y)
        axis.grid(alpha=0.3)
    bar = made.colorbar(shades, ax=axes, shrink=0.6, ticks=[0.1, 1.0, 10.0])
    bar.ax.set_yticklabels(["0.1\nsphere weaker:\nit flattens", "1", "10\nflat weaker:\nit dents"])
    bar.set_label("strength of the sphere over that of the flat, $S_y^*$")
    if not many:
        axes[0, 0].legend(title="strength of sphere on flat", fontsize=8, title_fontsize=8)
    pairs = "1 pair" if len(records) == 1 else f"{len(records)} pairs"
    coarse = any(record.case.accuracy.level == "smoke" for record in records)
    remark = "; level smoke: coarse, with steps in the curves" if coarse else ""
    made.suptitle(f"{pairs} of a sphere and a flat, pressed together{remark}")
    return [write_figure(made, folder / "curves.png", dpi=120)]


def _told(pair: Pair) -> str:
    """Both strengths in words."""
    bodies = (pair.sphere, pair.flat)
    return " on ".join(
        "rigid" if b.rigid else f"{b.Sy / 1e6:.0f} MPa" if np.isfinite(b.Sy) else "elastic"
        for b in bodies
    )


def _critical_force(pair: Pair) -> float:
    depth = pair.first_yield * pair.R
    return float(4.0 / 3.0 * pair.E_reduced * np.sqrt(pair.R) * depth**1.5)
