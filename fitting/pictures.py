"""Pictures of a fit: errors over the depth, errors over the pairs, and the curves themselves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..core.output import figure, write_figure
from .prediction import Prediction
from .table import ResidualTable, Table


def _colour(ratio: float) -> Any:
    import matplotlib as mpl

    return mpl.colormaps["coolwarm"](0.5 + 0.5 * float(np.clip(np.log10(ratio), -1.0, 1.0)))


def draw_errors(p: Prediction, table: Table, turns: ResidualTable, path: Path) -> Path:
    """Draw law minus finite elements over the depth, a panel a quantity, a line a combination."""
    made, axes = figure(2, 3, size=(13, 7.5))
    F, a = p.force / table.force, p.radius / table.radius
    panels = (
        ("error of F [%]", 100.0 * (F - 1.0), 10.0),
        ("error of a [%]", 100.0 * (a - 1.0), 10.0),
        ("error of H [%]", 100.0 * (F / a**2 - 1.0), 15.0),
        (r"error of $\delta_s^*$", p.share - table.share, 0.15),
    )
    shown = (table.w >= 0.3) & table.edge_seen
    for axis, (title, error, most) in zip(axes.flat, panels, strict=False):
        for number, pair in enumerate(table.pairs):
            m = shown & (table.case == number)
            axis.semilogx(table.w[m], error[m], color=_colour(pair.Sy_ratio), lw=0.9)
        axis.set(xlabel=r"$\delta/\delta_c$", title=title, ylim=(-most, most))
    sphere = p.sphere - turns.sphere_part * turns.total
    for axis, title, error in (
        (axes[1, 1], r"error of residual depth $/\Delta_m$", p.total - turns.total),
        (axes[1, 2], r"error of the sphere's residual depth $/\Delta_m$", sphere),
    ):
        colours = [_colour(turns.pairs[k].Sy_ratio) for k in turns.case]
        axis.scatter(turns.w, error, c=colours, s=14, edgecolor="grey", linewidth=0.3)
        axis.set(xscale="log", xlabel=r"$\delta_m/\delta_c$", title=title, ylim=(-0.1, 0.1))
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    made.suptitle(
        "combinations predicted by fits that did not see them; blue: weak sphere, red: weak flat"
    )
    return write_figure(made, path, dpi=110)


def draw_maps(p: Prediction, table: Table, path: Path) -> Path:
    """Draw the mean error of each combination over Sy* and E'/Sy_min."""
    made, axes = figure(1, 3, size=(13, 4.2))
    seen = (table.w >= 1.0) & table.edge_seen
    ratio = np.array([q.Sy_ratio for q in table.pairs])
    modulus = np.array([q.E_reduced / q.Sy_min for q in table.pairs])
    panels = (
        ("mean error of F [%]", 100.0 * np.abs(p.force / table.force - 1.0), seen),
        ("mean error of a [%]", 100.0 * np.abs(p.radius / table.radius - 1.0), seen),
        (r"mean error of $\delta_s^*$", np.abs(p.share - table.share), table.w >= 1.0),
    )
    for axis, (title, error, rows) in zip(axes.flat, panels, strict=True):
        means = [
            float(error[rows & (table.case == k)].mean())
            if np.any(rows & (table.case == k))
            else np.nan
            for k in range(len(table.pairs))
        ]
        dots = axis.scatter(ratio, modulus, c=means, cmap="viridis", s=40, vmin=0.0)
        axis.set(xscale="log", yscale="log", xlabel=r"$S_y^*$", ylabel=r"$E'/S_{y,min}$")
        axis.set_title(title)
        axis.grid(alpha=0.3)
        made.colorbar(dots, ax=axis)
    return write_figure(made, path, dpi=110)


def draw_curves(p: Prediction, table: Table, path: Path) -> Path:
    """Draw mean pressure and share of nine combinations over Sy*, law and finite elements."""
    made, axes = figure(1, 2, size=(12, 5))
    order = np.argsort([q.Sy_ratio for q in table.pairs])
    picked = order[np.unique(np.linspace(0, len(order) - 1, 9).astype(int))]
    modulus = np.array([q.E_reduced / q.Sy_min for q in table.pairs])
    ours = p.force / (np.pi * p.radius**2) * modulus[table.case]
    for number in picked:
        m = (table.case == number) & table.edge_seen
        pair = table.pairs[number]
        label = f"Sy* {pair.Sy_ratio:.2g}, E'/Sy {modulus[number]:.0f}"
        for axis, law, found in zip(
            axes.flat, (ours, p.share), (table.hardness, table.share), strict=True
        ):
            line = axis.semilogx(table.w[m], law[m], lw=1.3, label=label)[0]
            axis.semilogx(table.w[m], found[m], ".", ms=4, color=line.get_color())
    axes[0, 0].set(xlabel=r"$\delta/\delta_c$", title=r"mean pressure $H/S_{y,min}$")
    axes[0, 1].set(xlabel=r"$\delta/\delta_c$", title=r"$\delta_s^*$")
    axes[0, 1].legend(fontsize=7)
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    made.suptitle("lines: law; dots: finite elements")
    return write_figure(made, path, dpi=110)
