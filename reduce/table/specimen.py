"""Load and extension of a specimen as stress and strain: area and gauge length."""

from __future__ import annotations

import math

from ...core.errors import InputError
from ..units import LENGTH, UNITS
from .file import Columns

_AREA_UNITS = {
    f"{unit}{square}": size**2 for unit, size in LENGTH.items() for square in ("2", "^2", "²")
} | {f"sq {unit}": size**2 for unit, size in LENGTH.items()}


def stress_unit(table: Columns, column: int, *, given: str, area_mm2: float | None) -> float:
    """Return the stress that one of a column's unit is worth [Pa].

    A column of loads is divided by the specimen's area: as given, or from the header's line
    `Area` or `Diameter`.

    Raises
    ------
    InputError
        The unit is none of stress or force, or no area is known.
    """
    said = table.unit(column) if given == "file" else given
    force = UNITS["force"].get(said)
    if force is None:
        return table.factor(column, "stress", given=given, key="value_unit")
    area = None if area_mm2 is None else 1e-6 * area_mm2
    for word, units in (("area", _AREA_UNITS), ("diameter", LENGTH)):
        found = table.heading.quantity(word)
        if area is None and found is not None and found[1] in units:
            size = found[0] * units[found[1]]
            area = size if word == "area" else 0.25 * math.pi * found[0] ** 2 * units[found[1]] ** 2
    if area is None or not area > 0.0:
        raise InputError(
            f"column {table.names[column]!r} holds a load, and the file names no area",
            source=table.source, key="area_mm2", allowed="the specimen's cross-section",
        )  # fmt: skip
    return force / area


def strain_unit(table: Columns, column: int, *, given: float | None) -> float:
    """Return the strain that one of a column's unit is worth.

    A column of extensions is divided by the gauge length: as given in mm, or from the header's line
    `Gauge length` or `Gage length`.

    Raises
    ------
    InputError
        A length without a gauge length.
    """
    unit = table.unit(column)
    if unit == "%":
        return 0.01
    if unit not in LENGTH:
        return 1.0
    length = None if given is None else 1e-3 * given
    for word in ("gauge length", "gage length"):
        found = table.heading.quantity(word)
        if length is None and found is not None and found[1] in LENGTH:
            length = found[0] * LENGTH[found[1]]
    if length is None or not length > 0.0:
        raise InputError(
            f"column {table.names[column]!r} holds an extension, and the file names no gauge "
            "length", source=table.source, key="gauge_length_mm", allowed="the extensometer's",
        )  # fmt: skip
    return LENGTH[unit] / length
