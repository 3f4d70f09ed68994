"""A table of the instants at which a ball touches the flat."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..bounces.picture import draw_times
from ..bounces.times import reduce_bounce_times
from ..reduced import Reduced
from .file import Columns
from .options import TableOptions
from .series import counts


def reduce(path: Path, table: Columns, options: TableOptions) -> Reduced:
    """Return the bounces behind a column of three or more instants that increase."""
    column = table.find(options.time, key="time")
    # 1, 2, 3 ... numbers the contacts, and their times stand beside it
    if "time" not in options.model_fields_set and counts(table.values[:, column]):
        column = min(column + 1, len(table.names) - 1)
    unit = table.factor(column, "time", given=options.time_unit, key="time_unit", default="s")
    times = table.values[:, column] * unit
    times = times[np.isfinite(times)]
    times = times[options.keeps(times)]
    if times.size < 3:
        raise InputError(
            f"{times.size} instants", source=str(path), key="time", allowed="three or more"
        )
    if (np.diff(times) <= 0.0).any():
        raise InputError(
            "the instants do not increase", source=str(path), key="time",
            allowed="the column of the times, not of the intervals",
        )  # fmt: skip
    std = None if options.time_std_s is None else np.full(times.size, options.time_std_s)
    found = reduce_bounce_times(times, options, std=std, source=str(path))
    return Reduced(
        source=path, values=found.values(), trials=found.trials(), notes=found.notes,
        draw=lambda to: draw_times(found, to),
    )  # fmt: skip
