"""Figures of the impact commands; PNG files, drawn without a screen."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ..core.observables import OBSERVABLES
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


def draw_histories(traces: Sequence[tuple[str, Trace]], path: Path) -> None:
    """Motion of the contact point and force against time (figures 4.4-4.8)."""
    made, axes = figure(2, 3, size=(13.0, 7.0))
    for axis, (name, label, factor, number) in zip(axes.flat, HISTORY_PANELS, strict=True):
        for law, trace in traces:
            axis.plot(1e3 * trace.column("time_s"), factor * trace.column(name), label=law)
        axis.set(xlabel="time [ms]", ylabel=label, title=f"as Fig. {number}" if number else "")
        axis.grid(alpha=0.3)
    axes[0, 0].legend(fontsize=7)
    save(made, path)


def draw_sweep(
    speeds: Sequence[float], curves: Sequence[tuple[str, Sequence[Any]]], path: Path
) -> None:
    """Residual depth, restitution and spin against approach speed (figures 4.9-4.11)."""
    made, axes = figure(1, 3, size=(13.0, 4.2))
    panels = (OBSERVABLES[k] for k in ("permanent_depth_m", "restitution", "rebound_spin_rad_s"))
    for axis, shown in zip(axes[0], panels, strict=True):
        for law, impacts in curves:
            values = [shown.scale * getattr(i, shown.simulated) for i in impacts]
            axis.plot(speeds, values, label=law)
        axis.set(xlabel="approach speed [m/s]", ylabel=shown.axis)
        axis.grid(alpha=0.3)
    axes[0, 0].legend(fontsize=7)
    save(made, path)


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
    save(made, path)


def save(made: Figure, path: Path) -> None:
    """Write a figure, its folder made if need be."""
    path.parent.mkdir(parents=True, exist_ok=True)
    made.savefig(path, dpi=130)
