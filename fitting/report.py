"""What a reviewer wants to see of a fit: the errors as a picture, by quantity and depth."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .fit import Fit
from .table import Table


def draw_fit(fit: Fit, table: Table, folder: Path) -> Path:
    """Draw law against finite elements, a panel a quantity, into `folder`."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib.figure import Figure

    folder.mkdir(parents=True, exist_ok=True)
    figure = Figure(figsize=(12, 4), layout="constrained")
    axes = figure.subplots(1, 3)
    colours = mpl.colormaps["coolwarm"]
    law = fit.law
    for number, pair in enumerate(table.pairs):
        m = table.case == number
        depth = table.D[m] * pair.R
        colour = colours(0.5 + 0.5 * float(np.clip(np.log10(pair.Sy_ratio), -1.0, 1.0)))
        force = law.loading(pair, depth) / (pair.E_reduced * pair.R**2)
        radius = law.contact_radius(pair, depth) / pair.R
        axes[0].semilogx(table.w[m], 100.0 * (force / table.force[m] - 1.0), color=colour)
        axes[1].semilogx(table.w[m], 100.0 * (radius / table.radius[m] - 1.0), color=colour)
        axes[2].semilogx(table.w[m], law.share(pair, depth) - table.share[m], color=colour)
    for axis, title in zip(
        axes, ("error of F [%]", "error of a [%]", r"error of $\delta_s^*$"), strict=True
    ):
        axis.set_xlabel(r"$\delta/\delta_c$")
        axis.set_title(title)
        axis.grid(alpha=0.3)
    path = folder / "errors.png"
    figure.savefig(path, dpi=120)
    return path
