"""The misprinted equations of the thesis, each with numbers computed here."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...core.material import Material, Pair
from ...dynamics.inverse import alpha
from ...dynamics.scene import Striker
from ...models import LAWS, critical_depth, critical_force, yield_constant
from ...models.kernel import common_parameters
from ...models.published import hardness
from ...models.published.brake import stress_factor
from ...models.published.ghaednia import indentation_weight, share_of_sphere
from . import as_printed

STEEL = Material(E=200e9, nu=0.3, Sy=503e6)
ROD = Striker(mass=0.4607, tip_radius=0.0088, length=0.3048, radius=0.0088)


@dataclass(frozen=True, slots=True)
class Erratum:
    """One misprint or contradiction.

    Parameters
    ----------
    where
        Equation numbers, or the place of a contradiction.
    printed, meant
        What stands there, and what is used here.
    show
        Returns the demonstration, one sentence with computed numbers.
    """

    where: str
    printed: str
    meant: str
    show: Callable[[], str]


def _pair(ratio: float) -> Pair:
    """Case 1 of table 2.1 at the strength ratio `ratio`."""
    s, f = (200e6, 200e6 / ratio) if ratio < 1.0 else (200e6 * ratio, 200e6)
    return Pair(Material(E=200e9, nu=0.3, Sy=s), Material(E=200e9, nu=0.3, Sy=f), 1e-3)


def _constant() -> str:
    exact = 1.0 / stress_factor(0.3)
    nus = np.linspace(0.0, 0.499, 40)
    truth = np.array([1.0 / stress_factor(float(nu)) for nu in nus])
    rms = [
        math.sqrt(float(np.mean((1.295 * np.exp(k * nus) / truth - 1.0) ** 2)))
        for k in (0.73, 0.736)
    ]
    return (
        f"Hertz's axis stresses give C(0.3) = {exact:.4f}; over nu from 0 to 0.5 the rms error is "
        f"{rms[0]:.2%} with 0.73 and {rms[1]:.2%} with 0.736, which also stands in 3.2 and 4.9."
    )


def _critical_area() -> str:
    pair = Pair(STEEL, Material(E=200e9, nu=0.3, Sy=5e9), 1e-3)
    C = yield_constant(0.3)
    args = (pair.E_reduced, pair.Sy_min, pair.R, C)
    area = math.pi * pair.R * critical_depth(pair)
    return (
        f"Printed, it has the unit of a length ({as_printed.critical_area_1_18(*args):.3g} m for a "
        f"steel ball of 1 mm); the square is pi R delta_c = {area:.3g} m^2 exactly."
    )


def _critical_force() -> str:
    pair = Pair(STEEL, Material(E=200e9, nu=0.3, Sy=5e9), 1e-3)
    hertz = float(LAWS["hertz"].loading(pair, critical_depth(pair)))
    printed = as_printed.critical_force_1_19(
        pair.E_reduced, pair.Sy_min, pair.R, yield_constant(0.3)
    )
    return (
        f"Printed, the number is {printed:.3g} with the unit m^4/N; the cube gives "
        f"{critical_force(pair):.4g} N, and Hertz at delta_c {hertz:.4g} N."
    )


def _hertz() -> str:
    pair = _pair(1.0)
    ratio = as_printed.hertz_2_4(pair.E_reduced, pair.R, 1e-7)
    ratio /= float(LAWS["hertz"].loading(pair, 1e-7))
    return (
        f"Printed, it is {ratio:.4f} times Hertz's force for R = 1 mm, which is sqrt(R) in metres: "
        "the unit gives it away."
    )


def _share() -> str:
    q = _pair(2.0).E_reduced / 200e6
    printed = [as_printed.share_2_14(0.04, q, s) for s in (1.1, 1.2, 1.4, 1.53)]
    meant = [share_of_sphere(0.04, q, s, 1.0) for s in (1.1, 1.2, 1.4, 1.53)]
    beyond = share_of_sphere(0.04, q, 1.5301, 1.0)
    show = ", ".join
    return (
        "Shares of the sphere at Sy* = 1.1, 1.2, 1.4, 1.53 (case 1, Delta/R = 0.04): printed "
        f"{show(f'{v:.3f}' for v in printed)}, all negative; with 1.035 pi "
        f"{show(f'{v:.3f}' for v in meant)}, and 2.15 goes on with {beyond:.3f}."
    )


def _updated_radius() -> str:
    pair = _pair(10.0)
    D = 0.04
    share = share_of_sphere(D, pair.E_reduced / 200e6, 10.0, 1.0)
    flattening = share_of_sphere(D, pair.E_reduced / 200e6, 0.1, 1.0)
    wrong = 1.0 + flattening - D * flattening
    right = 1.0 + (1.0 - flattening) - D * (1.0 - flattening)
    a = [math.sqrt(r * flattening * D) for r in (wrong, right)]
    return (
        f"2.18 expands the exact result of 2.6 for a small share, as in indentation ({share:.3f}). "
        f"In flattening the sphere's own share is {flattening:.2f}: with it R'/R = {wrong:.2f} and "
        f"the truncated radius a/R = {a[0]:.3f}, with the other body's {right:.2f} and {a[1]:.3f}; "
        f"sqrt(R Delta) is {math.sqrt(D):.3f}."
    )


def _radius() -> str:
    pair = _pair(0.1)
    par = common_parameters(pair)
    slope = math.sqrt(critical_depth(pair) / pair.R)
    n = 0.92 * 0.04 * pair.R / critical_depth(pair)
    B = 0.14 * math.exp(23.0 * par.S / par.E)
    printed = as_printed.radius_2_21(pair.R, slope, n, B, 1.0) / pair.R
    root = slope * math.sqrt(n * (n / 1.9) ** B)
    return (
        f"Case 1 at Sy* = 0.1, Delta/R = 0.04 (delta_n = {n:.0f}): printed a/R = {printed:.0f}, "
        f"with the root {root:.3f}."
    )


def _exponents() -> str:
    n = 2000.0
    return (
        f"chi at Sy* = 10: printed product {as_printed.chi_2_29(20.0, 10.0):.3f} at delta_n = 20 "
        f"and {as_printed.chi_2_32(n, 10.0):.2f} at 2000, a negative radius; with an exponent "
        f"{0.4 + 0.55 * 20**0.022 + 0.283 / math.sqrt(20) * 10 ** (-0.091 * math.exp(-0.16)):.3f} "
        f"and {_chi_high(n, 10.0):.3f}, and at Sy* = 1 the two branches meet."
    )


def _chi_high(n: float, ratio: float) -> float:
    beyond = n - 408.0
    power = ratio ** (-0.0091 * math.log(beyond) ** 3.53)
    return float(1.024 - 0.004 * beyond**0.3814 + (0.013 + 2.2e-5 * beyond) * power)


def _slip_line() -> str:
    x = np.array([0.1, 0.3])
    wrong, right = as_printed.slip_line_2_36(x), hardness.slip_line(x)
    return (
        f"At a/R = 0.1 and 0.3 the print gives {wrong[0]:.0f} and {wrong[1]:.1f} S and diverges as "
        f"a/R goes to 0; with the sign of 1.13 it is {right[0]:.3f} and {right[1]:.3f} S, and "
        f"Prandtl's {(2 + math.pi) / math.sqrt(3):.4f} S at 0."
    )


def _force() -> str:
    pair = _pair(0.05)
    d = 0.01 * pair.R
    printed = float(as_printed.ghaednia_force(pair, d))
    meant = float(LAWS["ghaednia"].loading(pair, d))
    return (
        f"All of 2.13-2.43 read to the letter give {printed:.3g}, without a unit, at Delta/R = "
        f"0.01 (case 1, Sy* = 0.05, R = 1 mm); the corrected reading gives {meant:.4g} N."
    )


def _jackson_green() -> str:
    printed = as_printed.jackson_green_4_10([1.9, 10.0, 100.0], yield_constant(0.3))
    pair = Pair(STEEL, Material(E=200e9, nu=0.3, Sy=5e9), 1.0)
    w = np.array([1.9000001, 10.0, 100.0])
    meant = LAWS["jackson-green"].loading(pair, w * critical_depth(pair)) / critical_force(pair)
    show = ", ".join
    return (
        f"F/F_c at w = 1.9, 10, 100: printed {show(f'{v:.1f}' for v in printed)}; corrected "
        f"{show(f'{v:.2f}' for v in meant)}."
    )


def _jackson_green_radius() -> str:
    pair = Pair(STEEL, Material(E=200e9, nu=0.3, Sy=5e9), 1.0)
    d = 100.0 * critical_depth(pair)
    ratio = float(LAWS["jackson-green"].contact_radius(pair, d)) / as_printed.radius_4_11(pair, d)
    return (
        f"At w = 100 the printed radius is {ratio:.1f} times too small, the root of delta/delta_y."
    )


def _unloading() -> str:
    low, high = (as_printed.unloading_4_19(1.0, w) - 1.0 for w in (10.0, 110.0))
    return (
        f"At the start of unloading the printed force differs from the peak force by {low:.1%} at "
        f"w = 10 and {high:.1%} at 110; as an exponent it begins at the peak."
    )


def _area_ratio() -> str:
    meant = [0.05 * math.log(Q) ** 2 - 0.57 * math.log(Q) + 2.41 for Q in (1.78, 400.0)]
    printed = [as_printed.area_ratio_4_26(Q) for Q in (1.78, 400.0)]
    return (
        f"a'/a at Q = 1.78 and 400 must be near 2 (elastic) and 0.71 (4.27): ln(Q^2) gives "
        f"{printed[0]:.2f} and {printed[1]:.2f}, (ln Q)^2 {meant[0]:.2f} and {meant[1]:.2f}."
    )


def _pressure_logarithm() -> str:
    Q = 1.78
    elastic = 4.0 * math.sqrt(2.0) / (3.0 * math.pi) * Q
    natural, decimal = 0.7 * math.log(Q) + 0.66, 0.7 * math.log10(Q) + 0.66
    return (
        f"At Q = 1.78 the elastic pressure is {elastic:.3f} S; 4.25 gives {natural:.3f} with ln "
        f"({natural / elastic - 1:+.1%}) and {decimal:.3f} with log10 "
        f"({decimal / elastic - 1:+.0%})."
    )


def _yield_stress() -> str:
    printed, exact = as_printed.stress_4_28(0.3), stress_factor(0.3)
    return (
        f"1/F(0.3) is {1 / printed:.3f} printed and {1 / exact:.4f} with 1 + nu, as C = "
        f"{yield_constant(0.3):.4f}; the printed onset is {(printed / exact) ** 2:.1f} times too "
        "shallow."
    )


def _pair_hardness() -> str:
    printed = as_printed.hardness_4_30(327.0, 105.0)
    return (
        f"A rigid sphere must leave H_f; the print gives H_f/2. For the chapter's pair it is "
        f"{printed:.1f} kgf/mm^2 = {printed * 9.80665:.0f} MPa = "
        f"{printed * 9.80665 / 305:.2f} S of the flat, below any plastic hardness; corrected "
        f"{2 * printed:.1f} kgf/mm^2."
    )


def _brake_residual() -> str:
    return (
        "Printed, the fraction has the unit m^0.5 and the depth on both sides; with sqrt(R) and "
        "delta_m it is 1 - F_m over Hertz's force at delta_m, without unit and 0 for Hertz."
    )


def _alpha() -> str:
    lines = []
    for degrees, mu in ((20, 0.20), (45, 0.13), (70, 0.10)):
        theta = math.radians(degrees)
        printed = as_printed.alpha_5_12(
            mass=ROD.mass, inertia=ROD.inertia, length=ROD.length, R=ROD.tip_radius,
            theta=theta, mu=mu,
        )  # fmt: skip
        lines.append(f"{degrees} deg {printed:+.2f} / {alpha(ROD, theta, mu=mu):+.3f}")
    return "alpha printed / corrected: " + "; ".join(lines) + "; tables 5.2-5.4 imply the latter."


def _restitution() -> str:
    return (
        "The text below it defines R by the impulses of restitution and compression, P_r/P_c, and "
        "e is positive only with a minus sign; for a central impact E^2 = e R then holds."
    )


def _natural() -> str:
    weights = [indentation_weight(s) for s in (1.0, 1.06, 1.12)]
    show = ", ".join(f"{w:.3f}" for w in weights)
    return (
        f"With ln the weight of indentation at Sy* = 1.00, 1.06 and 1.12 is {show}: the step that "
        "the text puts there. Below Sy* = 0.06 the logarithm has no real value; flattening is "
        "meant."
    )


def _undefined() -> str:
    return (
        "Below a/R = L D the power has no real value; hardness.olsson_larsson gives "
        f"{float(hardness.olsson_larsson(0.05, LD=0.1)):g} S there, and "
        f"{float(hardness.olsson_larsson(0.5, LD=0.1)):.3f} S at a/R = 0.5 with L D = 0.1."
    )


MISPRINTS: tuple[Erratum, ...] = (
    Erratum("1.1", "R = P_fn/P_in, e = v_fn/v_in", "R = P_r/P_c, e = -v_fn/v_in", _restitution),
    Erratum("1.12", "L and D without a definition", "their product is given", _undefined),
    Erratum("1.17", "C = 1.295 exp(0.73 nu)", "0.736", _constant),
    Erratum("1.18", "A_c = pi^3 (C S R/2E')", "the bracket squared", _critical_area),
    Erratum("1.19", "F_c = (4/3)(R/E')^2 (C pi S/2)", "the last bracket cubed", _critical_force),
    Erratum("2.4, 2.10, 2.39, 2.40", "R, R' in Hertz's force", "their roots", _hertz),
    Erratum("2.14", "sin[1.546 Sy*^-9.22 + 1.035]", "1.035 pi", _share),
    Erratum(
        "2.7, 2.18",
        "R'/R with delta_s* for every Sy*",
        "the stronger body's share",
        _updated_radius,
    ),
    Erratum("2.21, 2.24, 2.28, 2.31", "delta_n (delta_n/1.9)^B", "its root", _radius),
    Erratum("2.29, 2.32", "Sy* times C_chi", "Sy* to the power C_chi", _exponents),
    Erratum("2.33, 2.34", "log", "the natural logarithm", _natural),
    Erratum("2.36", "-(1 - acos(a/R))", "-(1 + acos(a/R)), as 1.13", _slip_line),
    Erratum("2.37-2.41", "F_p = pi a^2 H", "times the yield strength", _force),
    Erratum("4.10", "misplaced brackets", "as 1.20", _jackson_green),
    Erratum("4.11", "a = sqrt(R delta_y ...)", "delta", _jackson_green_radius),
    Erratum("4.19", "F_m x^1.5 w^-0.0331", "F_m x^(1.5 w^-0.0331)", _unloading),
    Erratum("4.25", "log", "the natural logarithm", _pressure_logarithm),
    Erratum("4.26, 4.27", "log Q^2; large deformation from 21", "(ln Q)^2; from 400", _area_ratio),
    Erratum("4.28", "(1 - nu), z/r", "(1 + nu), z/a", _yield_stress),
    Erratum("4.30", "(2/H_s + 2/H_f)^-1", "(1/H_s + 1/H_f)^-1", _pair_hardness),
    Erratum(
        "4.31",
        "F_m/((4/3 E)(delta_m - delta)^1.5)",
        "F_m/((4/3) E' sqrt(R) delta_m^1.5)",
        _brake_residual,
    ),
    Erratum(
        "4.6, 4.7, 4.32, 5.5-5.13",
        "i and j, lengths, places of mu",
        "docs/impact-method.md",
        _alpha,
    ),
)
"""Misprinted equations, in their order."""
