"""A table of heights against time: speeds before and after each contact."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ..bounces.contacts import told_bounces
from ..bounces.track import Track
from ..measured import Measured, Trial, labelled, labels
from ..pictures import drawn_if_refused
from ..reduced import Reduced
from .file import Columns
from .options import TableOptions
from .picture import draw_heights
from .series import series_of


def reduce(path: Path, table: Columns, options: TableOptions) -> Reduced:
    """Fit the flights of a track and read the speeds at its contacts."""
    series = series_of(table, options)
    time, column = series.time, series.column
    said = table.unit(column) if options.value_unit == "file" else options.value_unit
    metres = None  # then the fall tells the size of the unit
    if said != "px":
        metres = table.factor(column, "length", given=options.value_unit, key="value_unit")
    height = series.value if options.upwards == "up" else -series.value
    track = Track(time, height, floor=options.value_std)
    with drawn_if_refused(time, series.value, axes=("time [s]", "height")):
        found = told_bounces(
            track, options.ball, metres=None if metres is None else Measured(metres, 0.0),
            contact=Measured(lasts, 0.0) if (lasts := options.contact_time_s) else None,
            source=str(path),
            allowed="heights of a body that falls, touches and rises (see --upwards, --first-s)",
        )  # fmt: skip
    trials = tuple(
        Trial(found.row(k), trace=found.trace(k, time, height), label=label)
        for k, label in enumerate(labels(len(found.bounces)))
    )
    values = labelled((trial.label, trial.observables) for trial in trials)
    if metres is None and found.scale.known:
        values["unit_m"] = found.scale.metres
    if metres is not None and math.isfinite(found.fall.value):
        values["fall_acceleration_m_s2"] = found.fall.scaled(metres)
    return Reduced(
        source=path, values=values, trials=trials,
        notes=found.notes + series.notes + series.missed_notes(": they are left out"),
        draw=lambda to: draw_heights(track, found, to),
        noise={"frame_rate_hz": float(1.0 / np.median(np.diff(time)))},
    )  # fmt: skip
