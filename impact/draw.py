"""Figures of the impact commands; PNG files, drawn without a screen."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from .chapter3 import Bench, Curve
from .inverse import alpha_curve
from .reference import Trace
from .scene import Striker

HISTORY_PANELS = (
    ("tip_height_m", "tip height [um]", 1e6, "4.4"),
    ("slip_m", "tangential displacement [um]", 1e6, "4.5"),
    ("normal_velocity_m_s", "normal velocity [m/s]", 1.0, "4.6"),
    ("sliding_velocity_m_s", "tangential velocity [m/s]", 1.0, "4.7"),
    ("spin_rad_s", "spin [rad/s]", 1.0, "4.8"),
    ("normal_force_N", "normal force [kN]", 1e-3, ""),
)


def figure(rows: int, columns: int, *, size: tuple[float, float]) -> tuple[Figure, Any]:
    """Return an off-screen figure and its axes."""
    made = Figure(figsize=size, layout="constrained")
    FigureCanvasAgg(made)
    return made, made.subplots(rows, columns, squeeze=False)


def draw_chapter3(found: Bench, curves: Sequence[Curve], path: Path) -> None:
    """Restitution and residual depth against drop height (figures 3.11 and 3.12)."""
    made, axes = figure(1, 2, size=(11.0, 4.6))
    panels = (("restitution", "restitution", 1.0), ("residual_depth", "residual depth [um]", 1e6))
    styles = dict(zip(sorted({c.mass for c in curves}), ("-", "--", ":", "-."), strict=False))
    names = list(dict.fromkeys(c.law.name for c in curves))
    for axis, (key, label, factor) in zip(axes[0], panels, strict=True):
        for curve in curves:
            y = [
                i.restitution if key == "restitution" else i.residual_flat_m for i in curve.impacts
            ]
            axis.plot(
                curve.heights, factor * np.array(y), styles[curve.mass],
                color=f"C{names.index(curve.law.name)}",
                label=f"{curve.law.name}, {curve.mass:g} kg",
            )  # fmt: skip
        for row in found.measured:
            if row["observable"] == key:
                axis.plot(row["drop_height_m"], factor * row["value"], "kx", ms=9, mew=2)
        axis.set(xlabel="drop height [m]", ylabel=label, ylim=(0.0, None))
        axis.grid(alpha=0.3)
    axes[0, 1].legend(fontsize=7, ncols=2, title="crosses: measured", title_fontsize=7)
    _save(made, path)


def draw_histories(traces: Sequence[tuple[str, Trace]], path: Path) -> None:
    """Motion of the contact point and force against time (figures 4.4-4.8)."""
    made, axes = figure(2, 3, size=(13.0, 7.0))
    for axis, (name, label, factor, number) in zip(axes.flat, HISTORY_PANELS, strict=True):
        for law, trace in traces:
            axis.plot(1e3 * trace.column("time_s"), factor * trace.column(name), label=law)
        axis.set(xlabel="time [ms]", ylabel=label, title=f"as Fig. {number}" if number else "")
        axis.grid(alpha=0.3)
    axes[0, 0].legend(fontsize=7)
    _save(made, path)


def draw_sweep(
    speeds: Sequence[float], curves: Sequence[tuple[str, Sequence[Any]]], path: Path
) -> None:
    """Residual depth, restitution and spin against approach speed (figures 4.9-4.11)."""
    made, axes = figure(1, 3, size=(13.0, 4.2))
    panels = (
        ("residual_flat_m", "residual depth of the flat [um]", 1e6),
        ("restitution", "restitution", 1.0),
        ("rebound_spin_rad_s", "rebound spin [rad/s]", 1.0),
    )
    for axis, (name, label, factor) in zip(axes[0], panels, strict=True):
        for law, impacts in curves:
            axis.plot(speeds, [factor * getattr(i, name) for i in impacts], label=law)
        axis.set(xlabel="approach speed [m/s]", ylabel=label)
        axis.grid(alpha=0.3)
    axes[0, 0].legend(fontsize=7)
    _save(made, path)


def draw_alpha(striker: Striker, frictions: Sequence[float], path: Path) -> None:
    """Sliding per normal travel over the angle (figure 5.3); above zero the tip sticks."""
    made, axes = figure(1, 1, size=(6.5, 4.6))
    angles = np.radians(np.linspace(0.2, 89.8, 400))
    for mu in frictions:
        values = alpha_curve(striker, angles, mu=mu)
        jam = np.abs(np.diff(values, append=values[-1])) > 5.0
        axes[0, 0].plot(np.degrees(angles), np.where(jam, np.nan, values), label=f"friction {mu:g}")
    axes[0, 0].axhline(0.0, color="k", lw=0.8)
    axes[0, 0].set(
        xlabel="angle [degrees]", ylabel="alpha = A/B (below 0: sliding)", ylim=(-1.5, 1.5)
    )
    axes[0, 0].legend(fontsize=8)
    axes[0, 0].grid(alpha=0.3)
    _save(made, path)


def _save(made: Figure, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    made.savefig(path, dpi=130)
