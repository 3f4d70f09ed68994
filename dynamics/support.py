"""How the flat gives way: on a spring, as a half-space, as a plate or rod that waves run along."""

from __future__ import annotations

import math

from scipy.integrate import quad
from scipy.optimize import brentq

from ..core.errors import InputError
from ..core.material import Material
from .scene import Support


def plate_support(material: Material, *, thickness: float) -> Support:
    """Zener's infinite plate: its surface moves at F / (8 sqrt(rho h D)) under a force F.

    Valid while no reflection has come back from an edge, for a contact small against the
    thickness.

    C. Zener, Phys. Rev. 59 (1941) 669-673.
    """
    _check(material)
    if not thickness > 0.0:
        raise InputError(f"{thickness:g}", key="thickness_m", allowed="a number above 0")
    bending = material.E * thickness**3 / (12.0 * (1.0 - material.nu**2))
    return Support(plate_mobility=1.0 / (8.0 * math.sqrt(material.density * thickness * bending)))


def rod_support(material: Material, *, radius: float) -> Support:
    """A rod without end, struck on its end: that moves at F / (rho c A), c = sqrt(E/rho).

    Valid while nothing has come back from the far end, for a contact small against the rod.

    W. Goldsmith, Impact (1960), chapter IV (longitudinal impact of spheres on rods).
    """
    _check(material)
    area = math.pi * radius**2
    return Support(plate_mobility=1.0 / (math.sqrt(material.E * material.density) * area))


def half_space_radiation(material: Material) -> float:
    """Kappa [m s/N]: a force F(t) on a half-space radiates the power kappa F'(t)^2.

    From the imaginary part of Lamb's solution at the loaded point for wavelengths long against
    the contact: kappa = J(nu) / (2 pi G c_s).

    G. F. Miller and H. Pursey, Proc. R. Soc. A 233 (1955) 55-69 (shares of the waves).
    S. C. Hunter, J. Mech. Phys. Solids 5 (1957) 162-171 (loss of an elastic impact).
    """
    _check(material)
    body, rayleigh = radiated_shares(material.nu)
    G = material.E / (2.0 * (1.0 + material.nu))
    return (body + rayleigh) / (2.0 * math.pi * G * math.sqrt(G / material.density))


def radiated_shares(nu: float) -> tuple[float, float]:
    """Return J of the body waves and of the Rayleigh wave; their sum is J(nu)."""
    g2 = (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu))
    g = math.sqrt(g2)

    def both(x: float) -> float:
        a, b = math.sqrt(max(g2 - x * x, 0.0)), math.sqrt(1.0 - x * x)
        return a * x / ((2.0 * x * x - 1.0) ** 2 + 4.0 * x * x * a * b)

    def shear(x: float) -> float:
        p, b = math.sqrt(max(x * x - g2, 0.0)), math.sqrt(max(1.0 - x * x, 0.0))
        A, B = (2.0 * x * x - 1.0) ** 2, 4.0 * x * x * p * b
        return p * x * B / (A * A + B * B)

    def secular(x: float) -> float:
        return (2.0 * x * x - 1.0) ** 2 - 4.0 * x * x * math.sqrt((x * x - g2) * (x * x - 1.0))

    root = brentq(secular, 1.0 + 1e-9, 2.0, xtol=1e-14)
    step = 1e-6
    slope = (secular(root + step) - secular(root - step)) / (2.0 * step)
    rayleigh = math.pi * math.sqrt(root * root - g2) * root / abs(slope)
    return quad(both, 0.0, g)[0] + quad(shear, g, 1.0)[0], rayleigh


def _check(material: Material) -> None:
    if material.rigid or not math.isfinite(material.density):
        raise InputError("waves need a deformable flat with a density", key="target.density_kg_m3")
