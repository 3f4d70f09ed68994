"""The thesis's equations exactly as printed, where the print is wrong, to show that it is.

No law of the contract uses them. Units and signs are the print's own: several results have no
physical unit at all. Each function names the corrected one; docs/thesis/errata.md has the
demonstrations.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from ...core.arrays import Array
from ...core.material import Pair
from ...models.kernel import common_parameters


def critical_area_1_18(E: float, S: float, R: float, C: float) -> float:
    """A_c = pi^3 (C S R/(2 E')), a length; corrected: the bracket squared."""
    return float(math.pi**3 * C * S * R / (2.0 * E))


def critical_force_1_19(E: float, S: float, R: float, C: float) -> float:
    """F_c = (4/3)(R/E')^2 (C pi S/2), in m^4/N; corrected: the last bracket cubed."""
    return float(4.0 / 3.0 * (R / E) ** 2 * (0.5 * C * math.pi * S))


def hertz_2_4(E: float, R: float, depth: float) -> float:
    """F = (4/3) R E' Delta^1.5, in N m^0.5; corrected: sqrt(R) (`base.hertz_force`)."""
    return float(4.0 / 3.0 * R * E * depth**1.5)


def share_2_14(D: float, q: float, ratio: float) -> float:
    """delta_s* between Sy* = 1 and 1.53 with the phase 1.035; corrected: 1.035 pi."""
    first = math.sin(45.63 * D**1.75 + 0.094 * math.pi * ratio**4.01)
    return float(-22.49 * q**-0.7 * first * math.sin(1.546 * ratio**-9.22 + 1.035))


def radius_2_21(updated: float, slope: float, n: float, B: float, chi: float) -> float:
    """A = R'(pi C S/2E')[delta_n (delta_n/1.9)^B] chi; corrected: the root of the bracket."""
    return float(updated * slope * n * (n / 1.9) ** B * chi)


def chi_2_29(n: float, ratio: float) -> float:
    """chi_21 with Sy* times C_chi21; corrected: Sy* to the power C_chi21."""
    power = ratio * -0.091 * math.exp(-0.008 * n)
    return float(0.4 + 0.55 * n**0.022 + 0.283 / math.sqrt(n) * power)


def chi_2_32(n: float, ratio: float) -> float:
    """chi_22 with Sy* times C_chi22, n above 409; corrected: Sy* to the power C_chi22."""
    beyond = n - 408.0
    exponent = -0.0091 * math.log(beyond) ** 3.53
    return float(1.024 - 0.004 * beyond**0.3814 + (0.013 + 2.2e-5 * beyond) * ratio * exponent)


def slip_line_2_36(x: npt.ArrayLike) -> Array:
    """H_i with -(1 - acos(a/R)); corrected: -(1 + acos(a/R)) as in 1.13 (`hardness.slip_line`)."""
    x = np.asarray(x, float)
    arc = (1.0 - np.arccos(x)) * (1.0 - x * x) ** 1.5
    bracket = x**3 / 3.0 - arc - x + 0.5 * math.pi + 1.0
    return np.asarray(4.0 / (3.0 * math.sqrt(3.0)) / x**2 * bracket)


def jackson_green_4_10(w: npt.ArrayLike, C: float, hardness: float = 2.84) -> Array:
    """F/F_c with misplaced brackets; corrected: `jackson_green`."""
    w = np.asarray(w, float)
    first = np.exp(-0.25 * w) * w ** (5.0 / 12.0) * w**1.5
    return np.asarray(first + 4.0 * hardness / C * (1.0 - np.exp(-0.04 * w ** (5.0 / 9.0)) * w))


def radius_4_11(pair: Pair, depth: float) -> float:
    """A = sqrt(R delta_y (delta/1.9 delta_c)^B); corrected: delta in place of delta_y."""
    par = common_parameters(pair)
    onset = (math.pi * par.C * par.S / (2.0 * par.E)) ** 2 * par.R
    B = 0.14 * math.exp(23.0 * par.S / par.E)
    return float(math.sqrt(par.R * onset * (depth / (1.9 * onset)) ** B))


def unloading_4_19(x: float, w: float) -> float:
    """F/F_m = x^1.5 w^-0.0331 with x from 0 to 1; corrected: x^(1.5 w^-0.0331)."""
    return float(x**1.5 * w**-0.0331)


def area_ratio_4_26(Q: float) -> float:
    """a'/a with ln(Q^2); corrected: (ln Q)^2 (`ye_komvopoulos`)."""
    return 0.05 * math.log(Q**2) - 0.57 * math.log(Q) + 2.41


def stress_4_28(nu: float) -> float:
    """F(nu) with (1 - nu), before the square; corrected: (1 + nu) (`brake.stress_factor`)."""
    z = np.linspace(1e-6, 3.0, 300_001)
    return float(np.max(np.abs(-(1.0 - nu) * (1.0 - z * np.arctan(1.0 / z)) + 1.5 / (1.0 + z * z))))


def hardness_4_30(sphere: float, flat: float) -> float:
    """H = (2/H_s + 2/H_f)^-1; corrected: (1/H_s + 1/H_f)^-1 (`brake.effective_hardness`)."""
    return 1.0 / (2.0 / sphere + 2.0 / flat)


def alpha_5_12(
    *, mass: float, inertia: float, length: float, R: float, theta: float, mu: float
) -> float:
    """Ratio alpha with mu on the whole denominator; corrected: `dynamics.inverse`."""
    c, s = math.cos(theta), math.sin(theta)
    above = (1.0 / mass + (length * s + R) ** 2 / (4.0 * inertia)) * mu
    above -= length * c * (0.5 * length * s + R) / (2.0 * inertia)
    below = 1.0 / mass + (length * c) ** 2 / (4.0 * inertia)
    below -= (0.5 * length * s + R) / (2.0 * inertia)
    return above / (below * mu)


def ghaednia_force(pair: Pair, depth: npt.ArrayLike) -> Array:
    """The force of 2.13-2.43 read to the letter, shape (...); its unit depends on the branch.

    delta_s* of 2.13 up to Sy* = 1, 2.14 and 2.15 beyond; R' with delta_s* itself (2.18); no roots
    (2.21, 2.28), factors in place of exponents (2.29, 2.32), 2.36 with its minus sign, R' in place
    of its root (2.39, 2.40) and a plastic force without the yield strength (2.41). delta_c is not
    printed; it is taken as in the corrected reading. Where a power has no real value: nan.
    """
    from ...models.published.ghaednia import share_of_sphere

    par = common_parameters(pair)
    ratio, q = pair.Sy_ratio, float(par.E / par.S)
    slope = math.pi * par.C * par.S / (2.0 * par.E)
    weak = pair.weaker.plane_strain_modulus
    B = 0.14 * math.exp(23.0 * par.S / par.E)
    weight = math.atan(300.0 * math.log(ratio - 0.06)) / math.pi + 0.5 if ratio > 0.06 else 0.0
    out = []
    for d in np.asarray(depth, float).ravel():
        D = d / pair.R
        middle = 1.0 < ratio <= 1.53
        share = share_2_14(D, q, ratio) if middle else share_of_sphere(D, q, ratio, 1.0)
        updated = pair.R * (1.0 + share - D * share)
        delta = (share if ratio <= 1.07 else 1.0 - share) * d
        n = delta / (slope**2 * updated)
        if delta <= 0.0 or n < 1.9 or (408.0 < n < 409.0):
            out.append(math.nan)
            continue
        if n <= 3.7:
            a = math.sqrt(updated * delta)
        else:
            a = radius_2_21(updated, slope, n, B, _chi(n, ratio))
        x = a / pair.R
        H = 2.84 - 0.92 * (1.0 - math.cos(math.pi * x))
        if weight > 0.0:
            H += weight * (float(slip_line_2_36(x)) - H) if 0.0 < x <= 1.0 else math.nan
        elastic = 4.0 / 3.0 * updated * weak * delta**1.5
        if ratio <= 1.07:
            we, wp = math.exp(-1.6 * (n - 1.9) ** 0.16), 0.95 - math.exp(-0.58 * n**0.3)
        else:
            we, wp = math.exp(-1.7 * (n - 1.9) ** 0.26), 1.0 - math.exp(-0.465 * n**0.45)
        out.append(we * elastic + wp * math.pi * a * a * H)
    return np.array(out).reshape(np.shape(depth))


def _chi(n: float, ratio: float) -> float:
    if ratio > 1.07:
        return chi_2_29(n, ratio) if n <= 408.0 else chi_2_32(n, ratio)
    if n <= 408.0:
        return float(0.4 + 0.55 * n**0.022 + 0.283 / math.sqrt(n) * ratio**6)
    beyond = n - 408.0
    return float(1.024 - 0.004 * beyond**0.3814 + (0.013 + 2.2e-5 * beyond) * ratio**6)
