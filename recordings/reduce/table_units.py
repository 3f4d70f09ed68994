"""Units that the columns of a table may be in."""

from __future__ import annotations

import math

from ...core.errors import InputError
from .table_file import Columns

STANDARD_GRAVITY = 9.80665
POUND_FORCE = 4.4482216152605
"""Both exact by definition (NIST SP 811)."""

LENGTH = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "nm": 1e-9, "in": 0.0254}
TIME = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "min": 60.0}
UNITS: dict[str, dict[str, float]] = {
    "time": TIME,
    "length": LENGTH,
    "force": {"N": 1.0, "kN": 1e3, "mN": 1e-3, "lbf": POUND_FORCE, "kgf": STANDARD_GRAVITY},
    "acceleration": {
        "m/s2": 1.0, "m/s^2": 1.0, "m/s²": 1.0, "g": STANDARD_GRAVITY, "kg": 1e3 * STANDARD_GRAVITY,
    },
    "speed": {"m/s": 1.0, "mm/s": 1e-3, "cm/s": 1e-2, "km/h": 1.0 / 3.6},
    "angle": {"deg": 1.0, "°": 1.0, "rad": math.degrees(1.0)},
    "spin": {"rad/s": 1.0, "deg/s": math.radians(1.0), "rpm": math.pi / 30.0, "1/s": math.tau},
    "temperature": {"K": 1.0},
    "number": {"": 1.0, "-": 1.0, "%": 1e-2},
}  # fmt: skip
"""Quantity, and its units in those of the recording set (kg among accelerations: 1000 g)."""


def factor(
    table: Columns, place: int, quantity: str, *, given: str, key: str, default: str | None
) -> tuple[float, str]:
    """Return what the numbers of a column are multiplied by, and the unit they are in.

    Parameters
    ----------
    table, place
        The column.
    quantity
        One of `UNITS`.
    given
        Unit by the user, or `"file"` for what the column's name says.
    key
        Option that gives the unit.
    default
        Unit where neither says one; None asks for it.

    Raises
    ------
    InputError
        The unit is not known.
    """
    units = UNITS[quantity]
    if given != "file":
        if given not in units:
            raise InputError(repr(given), key=key, allowed=", ".join(units))
        return units[given], given
    said = table.unit(place)
    if said in units:
        return units[said], said
    if default is None:
        raise InputError(
            f"column {table.names[place] or place + 1!r} does not name its unit",
            source=table.source, key=key, allowed=", ".join(units),
        )  # fmt: skip
    return units[default], default
