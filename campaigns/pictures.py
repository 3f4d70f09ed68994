"""Pictures of a campaign: force, contact radius, share and hardness of every case."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..core.material import Pair
from ..core.output import write_figure
from ..fem import critical_depth
from .records import CaseRecord


def draw_campaign(records: list[CaseRecord], folder: Path) -> list[Path]:
    """Draw all completed cases into `folder`; return the files."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 8), layout="constrained")
    axes = figure.subplots(2, 2)
    colours = mpl.colormaps["coolwarm"]
    for record in records:
        pair = record.case.pair
        c = record.curve
        w = c["delta"] / (critical_depth(pair) * pair.R)
        ratio = np.clip(np.log10(pair.Sy_ratio), -1.0, 1.0) if np.isfinite(pair.Sy_ratio) else 0.0
        style = {"color": colours(0.5 + 0.5 * ratio), "lw": 1.0}
        axes[0, 0].loglog(w, c["force"] / _critical_force(pair), **style)
        axes[0, 1].plot(c["delta"] / pair.R, c["radius"] / pair.R, **style)
        axes[1, 0].semilogx(w, c["sphere"] / (c["sphere"] + c["flat"]), **style)
        if np.isfinite(pair.Sy_min):
            axes[1, 1].semilogx(w, c["hardness"] / pair.Sy_min, **style)
    for axis, (x, y) in zip(
        axes.flat,
        (
            (r"$\delta/\delta_c$", r"$F/F_c$"),
            (r"$\Delta/R$", r"$a/R$"),
            (r"$\delta/\delta_c$", r"sphere's share $\delta_s^*$"),
            (r"$\delta/\delta_c$", r"$H/S_{y,min}$"),
        ),
        strict=True,
    ):
        axis.set_xlabel(x)
        axis.set_ylabel(y)
        axis.grid(alpha=0.3)
    figure.suptitle("blue: weak sphere (flattening), red: weak flat (indentation)")
    return [write_figure(figure, folder / "curves.png", dpi=120)]


def _critical_force(pair: Pair) -> float:
    depth = critical_depth(pair) * pair.R
    return float(4.0 / 3.0 * pair.E_reduced * np.sqrt(pair.R) * depth**1.5)
