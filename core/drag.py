"""Drag of a smooth sphere, and of a rod, in a still fluid.

The sphere's curve runs from creeping flow to beyond the drag crisis.

The functions are plain scalar arithmetic: Python calls them as they are, and so does code that
numba compiles (njit).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba.extending import register_jitable

HIGHEST_REYNOLDS = 3.38e5
"""Beyond it roughness and the fluid's own turbulence decide when the drag collapses."""

DRAG_COEFFICIENT_STD = 0.04
"""Relative standard deviation of the curve: correlations and measurements of smooth spheres in
steady flow scatter by about as much around it (Brown and Lawler 2003)."""

_GAS_CONSTANT_OF_AIR = 287.053
_SUTHERLAND_FACTOR, _SUTHERLAND_TEMPERATURE = 1.458e-6, 110.4


class Fluid(NamedTuple):
    """What surrounds a body: density [kg/m³] and dynamic viscosity [Pa s]."""

    density: float
    viscosity: float


def air(temperature: float = 293.15, pressure: float = 101325.0) -> Fluid:
    """Return dry air, an ideal gas, valid from 200 to 1000 K near atmospheric pressure.

    `temperature`: [K]; `pressure`: [Pa].

    U.S. Standard Atmosphere 1976, Eq. 42 (density) and Eq. 51 (viscosity by Sutherland's law).

    Examples
    --------
    >>> fluid = air(288.15)
    >>> f"{fluid.density:.4f} {fluid.viscosity:.4e}"
    '1.2250 1.7894e-05'
    """
    return Fluid(
        pressure / (_GAS_CONSTANT_OF_AIR * temperature),
        _SUTHERLAND_FACTOR * temperature**1.5 / (temperature + _SUTHERLAND_TEMPERATURE),
    )


@register_jitable  # type: ignore[untyped-decorator]
def drag_coefficient(reynolds: float) -> float:
    """Return the standard drag curve of a sphere, C_D(Re), Re > 0.

    The pieces meet within 1.5 %. A smooth sphere in steady motion is taken for granted; above
    `HIGHEST_REYNOLDS` the drag crisis of a very smooth sphere in a quiet stream follows, with a
    jump at Re = 4e5.

    `reynolds`: speed times diameter over kinematic viscosity.

    R. Clift, J. R. Grace, M. E. Weber, Bubbles, Drops, and Particles (1978), Table 5.2.

    Examples
    --------
    >>> round(drag_coefficient(1e4), 3)
    0.405
    """
    w: float = math.log10(reynolds)
    if reynolds <= 0.01:
        return 24.0 / reynolds + 3.0 / 16.0
    if reynolds <= 20.0:
        return float(24.0 / reynolds * (1.0 + 0.1315 * reynolds ** (0.82 - 0.05 * w)))
    if reynolds <= 260.0:
        return float(24.0 / reynolds * (1.0 + 0.1935 * reynolds**0.6305))
    if reynolds <= 1.5e3:
        return float(10.0 ** (1.6435 - 1.1242 * w + 0.1558 * w**2))
    if reynolds <= 1.2e4:
        return float(10.0 ** (-2.4571 + 2.5558 * w - 0.9295 * w**2 + 0.1049 * w**3))
    if reynolds <= 4.4e4:
        return float(10.0 ** (-1.9181 + 0.6370 * w - 0.0636 * w**2))
    if reynolds <= HIGHEST_REYNOLDS:
        return float(10.0 ** (-4.3390 + 1.5809 * w - 0.1546 * w**2))
    if reynolds <= 4e5:
        return 29.78 - 5.3 * w
    if reynolds <= 1e6:
        return 0.1 * w - 0.49
    return 0.19 - 8e4 / reynolds


@register_jitable  # type: ignore[untyped-decorator]
def drag_force(speed: float, diameter: float, density: float, viscosity: float) -> float:
    """Return the drag of a sphere in steady motion, F = C_D π d² ρ v²/8, with the sign of `speed`.

    `speed`: of the sphere relative to the fluid [m/s]; `diameter`: of the sphere [m]; `density`,
    `viscosity`: of the fluid [kg/m³, Pa s].
    """
    rate = abs(speed) * diameter * density / viscosity
    if rate < 1e-12:
        return 3.0 * math.pi * viscosity * diameter * speed
    area = 0.25 * math.pi * diameter**2
    return float(0.5 * drag_coefficient(rate) * area * density * speed * abs(speed))


_SLENDERNESS = (1.0, 2.0, 5.0, 10.0, 40.0)
_ACROSS = (0.63, 0.68, 0.74, 0.82, 0.98)
_ENDLESS = 1.20
_SLENDERNESS_ALONG, _ALONG = (1.0, 2.0, 4.0, 7.0), (0.91, 0.85, 0.87, 0.99)


@register_jitable  # type: ignore[untyped-decorator]
def _between(x: float, places: tuple[float, ...], values: tuple[float, ...]) -> float:
    """Interpolate in the logarithm of x; beyond the table its ends."""
    if x <= places[0]:
        return values[0]
    for i in range(1, len(places)):
        if x < places[i]:
            share = math.log(x / places[i - 1]) / math.log(places[i] / places[i - 1])
            return values[i - 1] + share * (values[i] - values[i - 1])
    return values[-1]


@register_jitable  # type: ignore[untyped-decorator]
def rod_drag_across(reynolds: float, slenderness: float) -> float:
    """Return C_D of a cylinder across the stream, referred to length times diameter, 1 < Re < 2e5.

    The curve of an endless cylinder, 1 + 10 Re^(-2/3), times the share that a finite one keeps.

    `reynolds`: speed times diameter over kinematic viscosity; `slenderness`: length over diameter.

    F. M. White, Viscous Fluid Flow (1991), the fit to the cylinder's curve; C. Matthews,
    Aeronautical Engineer's Data Book (2002), p. 95, for the finite length at Re near 1e5.

    Examples
    --------
    >>> round(rod_drag_across(1e4, 10.0), 3)
    0.698
    """
    endless = 1.0 + 10.0 * max(reynolds, 1.0) ** (-2.0 / 3.0)
    return float(endless * _between(slenderness, _SLENDERNESS, _ACROSS) / _ENDLESS)


@register_jitable  # type: ignore[untyped-decorator]
def rod_drag_along(slenderness: float) -> float:
    """Return C_D of a blunt cylinder along the stream, referred to its cross-section, Re > 1e3.

    Round ends have less: an upper bound for a rod with round tips.

    C. Matthews, Aeronautical Engineer's Data Book (2002), p. 95.

    Examples
    --------
    >>> rod_drag_along(4.0)
    0.87
    """
    return float(_between(slenderness, _SLENDERNESS_ALONG, _ALONG))
