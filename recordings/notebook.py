"""A recording set in a notebook: its first rows as a table, its observables as a picture."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.arrays import Array
from ..core.observables import OBSERVABLES
from ..core.tables import html_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .recording_set import RecordingSet

# limit: trials that a notebook shows [-]: a screen
_ROWS_SHOWN = 12


def table_of(found: RecordingSet) -> str:
    """Return the conditions and observables of the first trials as HTML."""
    columns = {
        "approach speed [m/s]": found.approach.normal, "load [N]": found.trials.load_N,
        "angle [deg]": found.trials.angle_deg,
    }  # fmt: skip
    columns = {name: x for name, x in columns.items() if not np.isnan(x).all()}
    head = ("trial", "striker", *columns, *found.observed)
    rows = [
        (
            found.trials.trial[k], found.trials.striker[k],
            *(_cell(float(x[k])) for x in columns.values()),
            *(_cell(float(found.values(name)[k])) for name in found.observed),
        )
        for k in range(min(len(found.trials), _ROWS_SHOWN))
    ]  # fmt: skip
    return html_table(head, rows, title=f"{found.name}: {len(found.trials)} trials")


def _cell(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.4g}"


class _Panel(NamedTuple):
    """One observable of the impacts or of the presses, over what was varied."""

    observable: str
    of: RecordingSet
    x: Array
    label: str


def _panels(found: RecordingSet) -> list[_Panel]:
    parts = []
    impacts, presses = found.impacts, found.presses
    if len(impacts.trials):
        speed, angle = impacts.approach.normal, impacts.trials.angle_deg
        whole = np.hypot(speed, impacts.approach.tangential)
        by_angle = np.ptp(whole) < 0.02 * np.max(whole) and np.ptp(angle) > 0.0
        x, label = (angle, "angle [deg]") if by_angle else (speed, "approach speed [m/s]")
        parts += [_Panel(name, impacts, x, label) for name in impacts.observed]
    load = presses.trials.load_N
    parts += [_Panel(name, presses, load, "load of a press [N]") for name in presses.observed]
    return parts


def picture_of(found: RecordingSet) -> Figure:
    """Return each observable over the speed, or over the angle where that is what varies.

    Those of quasi-static presses stand behind, over the load.
    """
    from ..core.output import panels

    shown = _panels(found)
    figure, axes = panels(len(shown))
    for axis, panel in zip(axes, shown, strict=True):
        scale = OBSERVABLES[panel.observable].scale
        y, std = (scale * f(panel.observable) for f in (panel.of.values, panel.of.std))
        strikers = panel.of.trials.striker
        for striker in dict.fromkeys(strikers):
            mine = np.array([one == striker for one in strikers])
            axis.errorbar(panel.x[mine], y[mine], std[mine], fmt="o", ms=4, label=striker)
        axis.set(xlabel=panel.label, ylabel=OBSERVABLES[panel.observable].axis)
        axis.grid(alpha=0.3)
    if axes:
        axes[0].legend(fontsize=8)
    figure.suptitle(found.name, fontsize=10)
    return figure
