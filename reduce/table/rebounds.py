"""A table of rebound heights beside drop heights."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError, InputErrors
from ..bounces.fall import Ball, Fall
from ..measured import Measured, Trial
from ..reduced import Reduced
from ..rules import RULES
from ..shared.units import LENGTH, quantity_of
from .file import Columns
from .options import TableOptions
from .picture import draw_trials
from .sheet.kinds import MEAN, SUMMARY, is_spread, kind_of
from .sheet.words import APPROACHES, REBOUND_HEIGHT, bare


def reduce(path: Path, table: Columns, options: TableOptions) -> Reduced:
    """Return a trial for each rebound height beside a drop height that is not below it.

    The drop heights stand in a column that is named so, or given; rebounds of the repeats in all
    columns of lengths after it. With drag a ball lands slower than it was dropped.
    """
    value = options.value if "value" in options.model_fields_set else ""
    heights, metres = _heights(table, value, options.value_unit)
    error, ball = options.value_std * metres, options.ball
    trials: list[Trial] = []
    for row, (drop, *rebounds) in enumerate(heights, start=1):
        if not np.isfinite(drop):
            continue
        speed = _fall(ball, drop).speed(float(drop))
        approach = Measured(speed, 0.5 * speed * error / drop)
        for k, height in enumerate(rebounds, start=1):
            if np.isfinite(height):
                up = _fall(ball, height).speed(float(height), 1.0)
                ratio = Measured(up, 0.5 * up * error / height).over(approach)
                seen = {"impact_speed_m_s": approach, "restitution": ratio}
                trials.append(Trial(seen, label=f"drop{row}-{k}"))
    if not trials:
        raise InputError("no rebound height", source=table.source, allowed="heights above 0")
    speeds = np.array([t.observables["impact_speed_m_s"].value for t in trials])
    ratios = np.array([t.observables["restitution"].value for t in trials])
    values = {}
    for speed in np.unique(speeds):
        same = ratios[speeds == speed]
        spread = float(np.std(same, ddof=1) / math.sqrt(same.size)) if same.size > 1 else math.nan
        values[f"restitution_at_{speed:.4g}_m_s"] = Measured(float(same.mean()), spread)
    return Reduced(
        source=path, values=values, trials=tuple(trials),
        notes=(f"{len(trials)} rebounds", *options.left_out),
        draw=lambda to: draw_trials(("impact speed [m/s]", speeds), ("restitution", ratios), to),
    )  # fmt: skip


def _fall(ball: Ball, height: float) -> Fall:
    """Return the flight over a height [m], its drag taken at a typical speed."""
    return ball.fall(RULES.drag_speed * math.sqrt(2.0 * ball.gravity * height))


def _heights(table: Columns, value: str, unit: str) -> tuple[Array, float]:
    """Return drop and rebound heights, (rows, 1 + repeats) [m], and their unit [m]."""
    kinds = [getattr(kind_of(name), "name", "") for name in table.names]
    if not value and APPROACHES[0] not in kinds:
        raise InputError(
            "no column is named as a drop height", source=table.source, key="value",
            allowed="its name or number; the rebound heights follow it",
        )  # fmt: skip
    first = table.find(value, key="value") if value else kinds.index(APPROACHES[0])
    metres = table.factor(first, "length", given=unit, key="value_unit")
    said = [table.unit(k) if unit == "file" else "" for k in range(len(table.names))]
    columns = [first] + [
        k for k, name in enumerate(table.names[first + 1 :], start=first + 1)
        if quantity_of(said[k]) in ("", "length") and kinds[k] in ("", REBOUND_HEIGHT)
        and not (is_spread(name) or MEAN.search(bare(name)))
    ]  # fmt: skip
    titles = [k for k in range(first) if kinds[k] != "person"]  # whom Max may be
    sums = [any(SUMMARY.fullmatch(bare(row[k])) for k in titles) for row in table.cells]
    heights = table.values[:, columns] * [LENGTH.get(said[k], metres) for k in columns]
    heights[sums] = np.nan
    if heights.shape[1] < 2:
        raise InputError(
            "no column after the drop heights", source=table.source, key="value",
            allowed="rebound heights in the columns that follow",
        )  # fmt: skip
    wrong = tuple(
        InputError(
            f"{h[k]:g} m after a drop of {h[0]:g} m", source=table.source,
            key=f"row {row + 1} of the numbers, column {columns[k] + 1}",
            allowed="a rebound above 0 and below the drop",
        )
        for row, h in enumerate(heights)
        for k in range(1, h.size)
        if np.isfinite(h[k]) and not 0.0 < h[k] < h[0]
    )  # fmt: skip
    if wrong:
        raise InputErrors(wrong)
    return heights, metres
