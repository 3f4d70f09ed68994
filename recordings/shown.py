"""A recording set in a notebook: its first rows as a table, its observables as a picture."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ..core.observables import OBSERVABLES
from ..core.tables import html_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .recording_set import RecordingSet

_ROWS = 12


def table_of(found: RecordingSet) -> str:
    """Return the conditions and observables of the first trials as HTML."""
    head = ("trial", "striker", "approach speed [m/s]", "angle [deg]", *found.observed)
    rows = [
        (
            found.trials.trial[k], found.trials.striker[k], f"{found.approach.normal[k]:.4g}",
            f"{found.trials.angle_deg[k]:.4g}",
            *(_cell(float(found.values(name)[k])) for name in found.observed),
        )
        for k in range(min(len(found.trials), _ROWS))
    ]  # fmt: skip
    return html_table(head, rows, title=f"{found.name}: {len(found.trials)} trials")


def _cell(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.4g}"


def picture_of(found: RecordingSet) -> Figure:
    """Return each observable over the speed, or over the angle where that is what varies."""
    from matplotlib.figure import Figure

    names = found.observed
    columns = max(min(len(names), 3), 1)
    rows = max(math.ceil(len(names) / columns), 1)
    figure = Figure(figsize=(4.2 * columns, 3.4 * rows), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False)
    for spare in axes.flat[len(names) :]:
        spare.remove()
    speed, angle = found.approach.normal, found.trials.angle_deg
    whole = np.hypot(speed, found.approach.tangential)
    by_angle = np.ptp(whole) < 0.02 * np.max(whole) and np.ptp(angle) > 0.0
    x, label = (angle, "angle [deg]") if by_angle else (speed, "approach speed [m/s]")
    for axis, name in zip(axes.flat, names, strict=False):
        for striker in dict.fromkeys(found.trials.striker):
            mine = np.array([one == striker for one in found.trials.striker])
            axis.errorbar(x[mine], found.values(name)[mine], found.std(name)[mine], fmt="o", ms=4,
                          label=striker)  # fmt: skip
        axis.set(xlabel=label, ylabel=OBSERVABLES[name].axis)
        axis.grid(alpha=0.3)
    if names:
        axes.flat[0].legend(fontsize=8)
    figure.suptitle(found.name, fontsize=10)
    return figure
