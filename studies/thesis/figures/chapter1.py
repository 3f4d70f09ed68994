"""Figures 1.2 and 1.3: the published hardness laws."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ....campaigns import CaseRecord
from ....core.arrays import Array
from ....models.published import hardness
from ...plot import Entry, Picture, finish, sheet

_PLACES = (0.1, 0.3, 0.5)  # a/R at which a law's deviation is told
_PLASTIC = 110.0  # w from which a contact counts as fully plastic (2.3.2)


def pictures(records: Sequence[CaseRecord]) -> list[Entry]:
    """The figures; `records` are the stored finite-element cases, possibly none."""
    return [
        _hardness(
            "1.2",
            "indentation",
            hardness.INDENTATION,
            records,
            lambda r: r > 1.7,
            "The thesis says that its own points here are not perfectly plastic; ours are.",
        ),
        _hardness(
            "1.3",
            "flattening",
            hardness.FLATTENING,
            records,
            lambda r: r < 0.6,
            "The text calls 1.15 the improved fit. The thesis's points are adjusted for the "
            "radius of curvature, it does not say how; ours are not.",
        ),
    ]


def _hardness(
    number: str,
    regime: str,
    published: dict[str, Callable[[Any], Array]],
    records: Sequence[CaseRecord],
    belongs: Callable[[float], bool],
    said: str,
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
        told = ", ".join(
            f"{name} {value:.1%} ({', '.join(_along(published[name], radius, pressure))})"
            for name, value in deviations.items()
        )
        places = ", ".join(f"{place:g}" for place in _PLACES)
        note = (
            f"Mean deviation from {len(radius)} of our points of full plasticity, in brackets at "
            f"a/R = {places}: {told}; the nearest is {best}."
        )
    axis.set_ylim(1.0, 3.6)
    finish(axis, x="contact radius a/R", y="mean pressure p/Sy")
    note += f" {said}"
    return Picture(number, f"Hardness laws, {regime}", made, note)


def _along(law: Callable[[Any], Array], radius: Array, pressure: Array) -> list[str]:
    """Mean deviation of a law from the points near each of `_PLACES`."""
    off = law(radius) / pressure - 1.0
    near = (np.abs(radius - place) < 0.03 for place in _PLACES)
    return [f"{np.mean(off[here]):+.1%}" for here in near if np.any(here)]


def _plastic(
    records: Sequence[CaseRecord], belongs: Callable[[float], bool]
) -> tuple[Array, Array]:
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
