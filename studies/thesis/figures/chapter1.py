"""Figures 1.1-1.4: the two ways to press, and the published hardness laws."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ....campaigns import CaseRecord
from ....models.published import hardness
from ...plot import Entry, Floats, Picture, finish, sheet
from . import sketches

_PLASTIC = 110.0  # w from which a contact counts as fully plastic (2.3.2)


def pictures(records: Sequence[CaseRecord]) -> list[Entry]:
    """The figures; `records` are the stored finite-element cases, possibly none."""
    return [
        *sketches.chapter_1(),
        _hardness("1.2", "indentation", hardness.INDENTATION, records, lambda r: r > 1.7),
        _hardness("1.3", "flattening", hardness.FLATTENING, records, lambda r: r < 0.6),
    ]


def _hardness(
    number: str,
    regime: str,
    published: dict[str, Callable[[Any], Floats]],
    records: Sequence[CaseRecord],
    belongs: Callable[[float], bool],
) -> Picture:
    made, (axis,) = sheet()
    x = np.linspace(1e-3, 0.6, 300)
    for name, function in published.items():
        axis.plot(x, function(x), label=name)
    axis.plot(x, hardness.olsson_larsson(x, LD=0.02), ":", color="0.5",
              label="Olsson and Larsson (1.12), L D = 0.02 chosen")  # fmt: skip
    radius, pressure = _plastic(records, belongs)
    note = "No finite-element campaign was found to draw beside them."
    if len(radius):
        axis.plot(radius, pressure, "k.", ms=4, label="our finite elements, w > 110")
        deviations = {
            name: float(np.mean(np.abs(function(radius) / pressure - 1.0)))
            for name, function in published.items()
        }
        best = min(deviations, key=lambda name: deviations[name])
        told = ", ".join(f"{name} {value:.1%}" for name, value in deviations.items())
        note = f"Mean deviation from {len(radius)} of our points: {told}; the nearest is {best}."
    axis.set_ylim(1.0, 3.6)
    finish(axis, x="contact radius a/R", y="mean pressure p/Sy")
    note += " 1.12 cannot be judged: the thesis does not define its L and D."
    return Picture(number, f"Hardness laws, {regime}", made, note)


def _plastic(
    records: Sequence[CaseRecord], belongs: Callable[[float], bool]
) -> tuple[Floats, Floats]:
    from ....models import critical_depth

    xs, ys = [], []
    for record in records:
        pair = record.case.pair
        if not belongs(pair.Sy_ratio):
            continue
        keep = record.curve["delta"] > _PLASTIC * critical_depth(pair)
        xs.append(record.curve["radius"][keep] / pair.R)
        ys.append(record.curve["hardness"][keep] / pair.Sy_min)
    return (np.concatenate(xs), np.concatenate(ys)) if xs else (np.zeros(0), np.zeros(0))
