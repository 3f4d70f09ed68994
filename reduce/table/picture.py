"""The pictures of tables: a pulse with its ends, heights with flights, times, trials."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...core.inputs.flow_curve import PROOF_STRAIN
from ...core.output import figure
from ..pictures import save

if TYPE_CHECKING:
    from ..bounces.times import BounceTimes
    from .force import PulseReduction
    from .height import HeightReduction
    from .tension import TensionReduction
    from .trials import TrialsReduction


def draw_pulse(found: PulseReduction, path: Path) -> None:
    """Draw the record, the pulse with its ends, and the flanks in the power 2/3."""
    pulse = found.pulse
    made, axes = figure(1, 3, size=(14.0, 4.5))
    axes[0, 0].plot(1e3 * pulse.time, pulse.value, lw=0.7)
    axes[0, 0].axvspan(1e3 * pulse.start.value, 1e3 * pulse.end.value, color="C1", alpha=0.3)
    axes[0, 0].set(xlabel="time [ms]", ylabel=f"record less {pulse.baseline:.3g} [{found.unit}]")
    span = max(pulse.duration.value, 1e-12)
    near = np.abs(pulse.time - 0.5 * (pulse.start.value + pulse.end.value)) < span
    for axis, power in ((axes[0, 1], 1.0), (axes[0, 2], 2.0 / 3.0)):
        y = np.maximum(pulse.value[near], 0.0) ** power if power != 1.0 else pulse.value[near]
        axis.plot(1e3 * pulse.time[near], y, "k.-", ms=3, lw=0.6)
        for end in (pulse.start, pulse.end):
            axis.axvline(1e3 * end.value, color="C3", lw=1.0)
        axis.axhline(0.0, color="0.5", lw=0.5)
        axis.set(xlabel="time [ms]")
    axes[0, 1].axhline(pulse.peak.value, color="C0", lw=0.8, ls=":")
    axes[0, 1].set(ylabel=f"pulse [{found.unit}]", title=f"peak {pulse.peak} {found.unit}")
    axes[0, 2].set(ylabel="its power 2/3: straight flanks if elastic", title=f"{pulse.duration} s")
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    save(made, path)


def draw_heights(found: HeightReduction, path: Path) -> None:
    """Draw the heights with the fitted flights, and what is left of them."""
    made, axes = figure(2, 1, size=(11.0, 7.0))
    track = found.track
    axes[0, 0].plot(track.time, track.height, "k.", ms=3)
    bounced = found.found
    for k, bounce in enumerate(bounced.bounces):
        for piece in (bounce.before, bounce.after):
            time = track.time[piece.index]
            ends = (*time[[0, -1]], bounce.time.value)
            span = np.linspace(min(ends), max(ends), 160)
            axes[0, 0].plot(span, bounced.heights(piece, span), f"C{k % 8}", lw=1.2)
            rest = track.height[piece.index] - bounced.heights(piece, time)
            axes[1, 0].plot(time, rest, ".", color=f"C{k % 8}", ms=3)
        axes[0, 0].annotate(
            f"e = {bounce.restitution}", (bounce.time.value, float(track.height[bounce.turning])),
            (0, 8), textcoords="offset points", fontsize=8, rotation=90, va="bottom", ha="center",
        )  # fmt: skip
    axes[0, 0].set(ylabel="height [unit of the table]")
    axes[1, 0].set(xlabel="time [s]", ylabel="residuals of the flights [same unit]")
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    save(made, path)


def draw_times(found: BounceTimes, path: Path) -> None:
    """Draw intervals and restitution of timed bounces."""
    from ..bounces.picture import draw_intervals, draw_restitution

    made, axes = figure(1, 2, size=(11.0, 4.5))
    draw_intervals(axes[0, 0], found)
    draw_restitution(axes[0, 1], found)
    save(made, path)


def draw_tension(found: TensionReduction, path: Path) -> None:
    """Draw the curve with its elastic line, and the rows of the flow curve."""
    made, axes = figure(1, 2, size=(11.0, 4.5))
    axes[0, 0].plot(found.strain, 1e-6 * found.stress, "k-", lw=0.8)
    top = float(found.flow.stress[0]) / found.modulus.value
    axes[0, 0].plot([0.0, top], [0.0, 1e-6 * found.modulus.value * top], "C3", lw=1.2)
    axes[0, 0].set(
        xlabel="true strain",
        ylabel="true stress [MPa]",
        title=f"E = {found.modulus.scaled(1e-9)} GPa",
    )
    axes[0, 1].plot(found.flow.strain, 1e-6 * found.flow.stress, "o-", ms=3)
    axes[0, 1].axvline(PROOF_STRAIN, color="0.6", lw=0.8)
    axes[0, 1].set(xlabel="plastic strain", ylabel="true stress [MPa]",
                   title=f"0.2 %: {1e-6 * found.flow.strength:.4g} MPa")  # fmt: skip
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    save(made, path)


def draw_trials(found: TrialsReduction, path: Path) -> None:
    """Draw the first measured column over the approach."""
    made, axes = figure(1, 1, size=(7.0, 5.0))
    axes[0, 0].plot(found.x[1], found.y[1], "o", ms=4)
    shown, all_of_them = int(np.isfinite(found.x[1] * found.y[1]).sum()), len(found.trials)
    title = f"{all_of_them} trials" if shown == all_of_them else f"{shown} of {all_of_them} trials"
    axes[0, 0].set(xlabel=found.x[0], ylabel=found.y[0], title=title)
    if found.x[0] == "number":
        axes[0, 0].xaxis.get_major_locator().set_params(integer=True)
    axes[0, 0].grid(alpha=0.3)
    save(made, path)
