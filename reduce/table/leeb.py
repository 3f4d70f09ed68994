"""A table of Leeb numbers: a thousand times the restitution of the device's ball."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ...core.errors import InputError, InputErrors
from ..measured import Measured, Trial
from ..reduced import Reduced
from .file import Columns
from .options import TableOptions
from .picture import draw_trials

_LEEB_SPEED = 2.05
"""Approach of the body of a device D [m/s] (ISO 16859-1)."""


def reduce(path: Path, table: Columns, options: TableOptions) -> Reduced:
    """Return a trial for each number, from 0 to 1000, of a column and of all after it."""
    value = options.value if len(table.names) > 1 else "1"
    first, speed = table.find(value, key="value"), options.approach_speed_m_s
    approach = Measured(speed or _LEEB_SPEED, 0.0)
    trials, wrong = [], []
    for row, numbers in enumerate(table.values[:, first:], start=1):
        for k, number in enumerate(numbers[np.isfinite(numbers)], start=1):
            if not 0.0 < number < 1000.0:
                wrong.append(InputError(
                    f"{number:g}", source=table.source, key=f"row {row} of the numbers",
                    allowed="a Leeb number between 0 and 1000",
                ))  # fmt: skip
            ratio = Measured(float(number) / 1e3, options.value_std / 1e3)
            seen = {"impact_speed_m_s": approach, "restitution": ratio}
            trials.append(Trial(seen, label=f"{row}-{k}"))
    if wrong:
        raise InputErrors(tuple(wrong))
    if not trials:
        raise InputError("no Leeb number", source=table.source, allowed="numbers of 0 to 1000")
    ratios = np.array([t.observables["restitution"].value for t in trials])
    spread = float(np.std(ratios, ddof=1)) if ratios.size > 1 else math.nan
    mean = Measured(float(ratios.mean()), spread / math.sqrt(ratios.size))
    number = np.arange(1.0, ratios.size + 1)
    return Reduced(
        source=path, values={"restitution": mean}, trials=tuple(trials),
        notes=() if speed else (f"approach {_LEEB_SPEED} m/s, as of device D",),
        draw=lambda to: draw_trials(("number", number), ("restitution", ratios), to),
    )  # fmt: skip
