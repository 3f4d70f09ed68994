"""Units that raw files may be in, each with its size in that of a recording set."""

from __future__ import annotations

import math
from collections.abc import Iterable

from ...core.errors import InputError

# limit: largest number of a column or a scan [its unit]; no record in any unit: a damaged file
LARGEST_NUMBER = 1e20

STANDARD_GRAVITY = 9.80665
POUND_FORCE = 4.4482216152605
"""Both exact by definition (NIST SP 811)."""

LENGTH = {
    "m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "μm": 1e-6, "nm": 1e-9, "pm": 1e-12,
    "Å": 1e-10, "in": 0.0254, "ft": 0.3048, "mil": 2.54e-5,
}  # fmt: skip
"""With both signs for micro."""
TIME = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6, "ns": 1e-9, "min": 60.0}
HERTZ = {"Hz": 1.0, "kHz": 1e3, "MHz": 1e6}
UNITS: dict[str, dict[str, float]] = {
    "time": TIME,
    "length": LENGTH,
    "force": {
        "N": 1.0, "kN": 1e3, "MN": 1e6, "mN": 1e-3, "uN": 1e-6, "µN": 1e-6, "μN": 1e-6,
        "daN": 10.0, "lbf": POUND_FORCE, "kgf": STANDARD_GRAVITY, "gf": 1e-3 * STANDARD_GRAVITY,
    },
    "acceleration": {
        "m/s2": 1.0, "m/s^2": 1.0, "m/s²": 1.0, "g": STANDARD_GRAVITY, "kg": 1e3 * STANDARD_GRAVITY,
        "mg": 1e-3 * STANDARD_GRAVITY, "cm/s2": 1e-2, "cm/s²": 1e-2, "cm/s^2": 1e-2, "mm/s2": 1e-3,
        "mm/s²": 1e-3, "mm/s^2": 1e-3,
    },
    "speed": {"m/s": 1.0, "mm/s": 1e-3, "cm/s": 1e-2, "km/h": 1.0 / 3.6, "ft/s": 0.3048},
    "angle": {"deg": 1.0, "°": 1.0, "rad": math.degrees(1.0)},
    "spin": {"rad/s": 1.0, "deg/s": math.radians(1.0), "rpm": math.pi / 30.0, "1/s": math.tau},
    "stress": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/mm2": 1e6, "psi": 6894.757293,
               "ksi": 6894757.293},
    "energy": {"J": 1.0, "mJ": 1e-3, "kJ": 1e3},
    "stiffness": {"N/m": 1.0, "N/mm": 1e3, "mN/nm": 1e6, "N/um": 1e6, "N/µm": 1e6, "kN/mm": 1e6},
    "temperature": {"K": 1.0, "°C": 1.0, "C": 1.0, "degC": 1.0, "°F": 5.0 / 9.0, "degF": 5.0 / 9.0},
    "mass": {"kg": 1.0, "g": 1e-3, "mg": 1e-6},
    "number": {"": 1.0, "-": 1.0, "%": 1e-2},
}  # fmt: skip
"""Quantity, and its units in those of the recording set (kg among accelerations: 1000 g)."""

ZERO = {"°C": 273.15, "C": 273.15, "degC": 273.15, "°F": 459.67, "degF": 459.67}
"""How far above 0 K a scale begins, in its degrees."""


def quantity_of(unit: str) -> str:
    """Return the quantity that a unit is one of; empty where it is not known.

    Examples
    --------
    >>> quantity_of("mm"), quantity_of("mm/s"), quantity_of("ticks")
    ('length', 'speed', '')
    """
    return next((quantity for quantity, known in UNITS.items() if unit and unit in known), "")


def metres(unit: str, *, source: str, allowed: Iterable[str]) -> float:
    """Return the size of a unit of length [m]; refuse none, or one that such a file is not in.

    `unit` is as the file or the user says it, empty if neither does.
    """
    if unit in LENGTH and unit in allowed:
        return LENGTH[unit]
    said = f"unit of length {unit!r}" if unit else "the file does not say its unit of length"
    raise InputError(said, source=source, key="unit", allowed=", ".join(allowed))
