"""The pictures of tables: a pulse with its ends, heights with flights, a flow curve, trials."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...core.arrays import Array
from ...core.inputs.flow_curve import PROOF_STRAIN
from ...core.output import figure
from ..pictures import save

if TYPE_CHECKING:
    from ..bounces.contacts import Bounced
    from ..bounces.track import Track
    from .pulse import Pulse
    from .tension import TensionReduction


def draw_pulse(pulse: Pulse, unit: str, path: Path) -> None:
    """Draw the record, and the pulse with its ends and its peak."""
    made, axes = figure(1, 2, size=(11.0, 4.5))
    ends = 1e3 * pulse.start.value, 1e3 * pulse.end.value
    axes[0, 0].plot(1e3 * pulse.time, pulse.value, lw=0.7)
    axes[0, 0].axvspan(*ends, color="C1", alpha=0.3)
    axes[0, 0].set(xlabel="time [ms]", ylabel=f"record less {pulse.baseline:.3g} [{unit}]")
    near = np.abs(pulse.time - 5e-4 * sum(ends)) < max(pulse.duration.value, 1e-12)
    axes[0, 1].plot(1e3 * pulse.time[near], pulse.value[near], "k.-", ms=3, lw=0.6)
    for end in ends:
        axes[0, 1].axvline(end, color="C3", lw=1.0)
    axes[0, 1].axhline(pulse.peak.value, color="C0", lw=0.8, ls=":")
    axes[0, 1].set(xlabel="time [ms]", title=f"peak {pulse.peak} {unit}, {pulse.duration} s")
    save(made, path)


def draw_heights(track: Track, found: Bounced, path: Path) -> None:
    """Draw the heights with the fitted flights, and what is left of them."""
    made, axes = figure(2, 1, size=(11.0, 7.0))
    axes[0, 0].plot(track.time, track.height, "k.", ms=3)
    for k, bounce in enumerate(found.bounces):
        for piece in (bounce.before, bounce.after):
            time = track.time[piece.index]
            ends = (*time[[0, -1]], bounce.time.value)
            span = np.linspace(min(ends), max(ends), 160)
            axes[0, 0].plot(span, found.heights(piece, span), f"C{k % 8}", lw=1.2)
            rest = track.height[piece.index] - found.heights(piece, time)
            axes[1, 0].plot(time, rest, ".", color=f"C{k % 8}", ms=3)
        axes[0, 0].annotate(
            f"e = {bounce.restitution}", (bounce.time.value, float(track.height[bounce.turning])),
            (0, 8), textcoords="offset points", fontsize=8, rotation=90, va="bottom", ha="center",
        )  # fmt: skip
    axes[0, 0].set(ylabel="height [unit of the table]")
    axes[1, 0].set(xlabel="time [s]", ylabel="residuals of the flights [same unit]")
    save(made, path)


def draw_tension(found: TensionReduction, path: Path) -> None:
    """Draw the curve with its elastic line, and the rows of the flow curve."""
    made, axes = figure(1, 2, size=(11.0, 4.5))
    axes[0, 0].plot(found.strain, 1e-6 * found.stress, "k-", lw=0.8)
    top = float(found.flow.stress[0]) / found.modulus.value
    axes[0, 0].plot([0.0, top], [0.0, 1e-6 * found.modulus.value * top], "C3", lw=1.2)
    axes[0, 0].set(xlabel="true strain", ylabel="true stress [MPa]",
                   title=f"E = {found.modulus.scaled(1e-9)} GPa")  # fmt: skip
    axes[0, 1].plot(found.flow.strain, 1e-6 * found.flow.stress, "o-", ms=3)
    axes[0, 1].axvline(PROOF_STRAIN, color="0.6", lw=0.8)
    axes[0, 1].set(xlabel="plastic strain", ylabel="true stress [MPa]",
                   title=f"0.2 %: {1e-6 * found.flow.strength:.4g} MPa")  # fmt: skip
    save(made, path)


def draw_trials(x: tuple[str, Array], y: tuple[str, Array], path: Path) -> None:
    """Draw one column of trials over another, (n,) each with its name."""
    made, axes = figure(1, 1, size=(7.0, 5.0))
    axes[0, 0].plot(x[1], y[1], "o", ms=4)
    shown, all_of_them = int(np.isfinite(x[1] * y[1]).sum()), x[1].size
    title = f"{all_of_them} trials" if shown == all_of_them else f"{shown} of {all_of_them} trials"
    axes[0, 0].set(xlabel=x[0], ylabel=y[0], title=title)
    save(made, path)
