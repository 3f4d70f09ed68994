"""A table of stress over strain, or of the load and the extension of a specimen."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..pictures import drawn_if_refused
from ..reduced import Reduced
from ..shared.units import LENGTH, UNITS
from .file import Columns
from .options import TableOptions
from .picture import draw_tension
from .series import no_number
from .tension import reduce_tension

_AREA_UNITS = {
    f"{unit}{square}": size**2 for unit, size in LENGTH.items() for square in ("2", "^2", "²")
} | {f"sq {unit}": size**2 for unit, size in LENGTH.items()}


def reduce(path: Path, table: Columns, options: TableOptions) -> Reduced:
    """Return the flow curve of a tension or compression test."""
    at, value = table.find(options.time, key="time"), table.find(options.value, key="value")
    parts, unit = _strain_unit(table, at, options), _stress_unit(table, value, options)
    with np.errstate(over="ignore"):  # what is too large is refused as that
        strain, stress = table.values[:, at] * parts, table.values[:, value] * unit
    with drawn_if_refused(strain, stress, axes=("strain", "stress")):
        found = reduce_tension(
            strain, stress, strain_is=options.strain_is, E=options.E_Pa, source=str(path)
        )
    notes = found.notes
    if options.E_Pa is None and table.unit(at) in LENGTH:
        notes += ("a travel of the machine's head holds its give: state E_Pa if it is one",)
    pair = np.isfinite(table.values[:, [at, value]])
    if (holes := np.flatnonzero(pair.sum(axis=1) == 1)).size:
        marks = {table.cells[int(k)][value if pair[k, 0] else at] for k in holes}
        notes += (f"{no_number(holes.size, sorted(marks))}: their rows are left out",)
    return Reduced(
        source=path, values=found.values, trials=(), notes=notes,
        draw=lambda to: draw_tension(found, to), flow=(options.body, found.flow),
    )  # fmt: skip


def _stress_unit(table: Columns, column: int, options: TableOptions) -> float:
    """Return the stress that one of a column's unit is worth [Pa].

    A column of loads is divided by the specimen's area: as given, or from the header's line `Area`
    or `Diameter`.
    """
    given = options.value_unit
    force = UNITS["force"].get(table.unit(column) if given == "file" else given)
    if force is None:
        return table.factor(column, "stress", given=given, key="value_unit")
    area = 1e-6 * (options.area_mm2 or 0.0) or _said(table, "area", _AREA_UNITS)
    area = area or 0.25 * math.pi * _said(table, "diameter", LENGTH) ** 2
    if not area > 0.0:
        raise InputError(
            f"column {table.names[column]!r} holds a load, and the file names no area",
            source=table.source, key="area_mm2", allowed="the specimen's cross-section",
        )  # fmt: skip
    return force / area


def _said(table: Columns, word: str, units: Mapping[str, float]) -> float:
    """The quantity that a header's line begins with a word [SI]; 0 without one."""
    number, unit = table.heading.quantity(word) or (0.0, "")
    return number * units.get(unit, 0.0)


def _strain_unit(table: Columns, column: int, options: TableOptions) -> float:
    """Return the strain that one of a column's unit is worth.

    A column of extensions is divided by the gauge length: as given in mm, or from the header's line
    `Gauge length` or `Gage length`.
    """
    unit = table.unit(column)
    if unit == "%":
        return 0.01
    if unit not in LENGTH:
        return 1.0
    said = (_said(table, word, LENGTH) for word in ("gauge length", "gage length"))
    length = 1e-3 * (options.gauge_length_mm or 0.0) or next(filter(None, said), 0.0)
    if not length > 0.0:
        raise InputError(
            f"column {table.names[column]!r} holds an extension, and the file names no gauge "
            "length", source=table.source, key="gauge_length_mm", allowed="the extensometer's",
        )  # fmt: skip
    return LENGTH[unit] / length
