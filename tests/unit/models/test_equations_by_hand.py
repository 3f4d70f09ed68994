"""The equations of docs/theory.md: each listed once, and each function against a value by hand."""

import importlib
import math
import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from dentscope.core import Material, Pair
from dentscope.dynamics import traced
from dentscope.dynamics.inverse import alpha, infer, mobility
from dentscope.dynamics.scene import Approach, Friction, scene_of
from dentscope.fem import Curve
from dentscope.models import LAWS, critical_depth, critical_force, yield_constant
from dentscope.models.kernel import common_parameters, hertz_force, hertz_recovery
from dentscope.models.published import hardness
from dentscope.models.published.brake import brake_2015, effective_hardness, stress_factor
from dentscope.models.published.brake import yield_depth as brake_yield_depth
from dentscope.models.published.ceb import yield_depth
from dentscope.models.published.ghaednia import (
    indentation_weight,
    model_hardness,
    share_of_sphere,
    updated_jackson_green,
)
from dentscope.models.published.jackson_green import growth_exponent
from dentscope.models.published.kogut_komvopoulos import truncated
from dentscope.studies.thesis import chapter5

THEORY = Path(__file__).parents[3] / "docs" / "theory.md"
R = 0.01
SOFT = Material(E=200e9, nu=0.3, Sy=300e6)
STEEL = Pair(SOFT, Material(E=200e9, nu=0.3, Sy=900e6), R)
FLAT = Pair(Material(E=200e9, nu=0.3, Sy=900e6), SOFT, R)
ALUMINIUM = Material(E=70e9, nu=0.33)
A_100 = 1.957434e-4  # Hertz's radius of 100 N on E' = 100 GPa [m]


BY_HAND = {}


def of(*equations):
    """Put what works equations by hand into their list."""
    return lambda worked: BY_HAND.update(dict.fromkeys(equations, worked)) or worked


def close(value, expected, rel=1e-5):
    assert float(value) == pytest.approx(expected, rel=rel)


def hundred_newton():
    return Pair(Material(E=91e9, nu=0.3), Material(E=math.nan, nu=math.nan, rigid=True), R)


@of("1.1")
def equation_1_1():
    """A ball that loses energy on a massive flat: e = P_r/P_c, and E^2 = e R."""
    impact = chapter5.strike(
        scene_of(
            LAWS["kogut-komvopoulos"], sphere=FLAT.sphere, flat=FLAT.flat,
            striker=chapter5.Striker(mass=0.03, tip_radius=R), approach=Approach(2.0), gravity=0.0,
        )
    )  # fmt: skip
    close(impact.kinetic_restitution, impact.restitution, 1e-6)
    close(impact.energetic_restitution**2, impact.restitution * impact.kinetic_restitution, 1e-6)
    # recovered (2/5) F (d_m - d_r) with 1 - 0.764696 of the depth left to recover (4.22)
    close(impact.residual_m / impact.peak_depth_m, 0.764696)


@of("1.4-1.5")
def hertz():
    pair = hundred_newton()
    close(pair.E_reduced, 100e9)
    close(LAWS["hertz"].loading(pair, 3.831547e-6), 100.0)
    close(LAWS["hertz"].contact_radius(pair, 3.831547e-6), A_100)


@of("1.7", "2.17")
def reduced_modulus():
    close(Pair(Material(E=200e9, nu=0.3), ALUMINIUM, R).E_reduced, 57.870370e9)


@of("1.16", "3.1-3.2", "4.9")
def critical_values():
    close(critical_depth(STEEL), 4.796109e-7)


@of("1.20-1.21", "4.10-4.11")
def jackson_and_green():
    """w = 50: a = 0.624866 mm, F = 984.456 N."""
    depth = 2.398054e-5
    close(LAWS["jackson-green-2007"].contact_radius(STEEL, depth), 6.248663e-4)
    close(LAWS["jackson-green-2007"].loading(STEEL, depth), 984.4558)


@of("2.2")
def equation_2_2():
    n = np.zeros(1)
    curve = Curve(
        delta=np.array([4e-5]), force=n, radius=n, radius_last_node=n, sphere=np.array([3e-5]),
        flat=np.array([1e-5]), hardness=n, force_defect=n, energy_defect=n, dissipated=n,
    )  # fmt: skip
    close(curve.sphere_share[0], 0.75)


@of("2.4", "3.3-3.4", "4.8")
def hertz_of_depth():
    close(hertz_force(LAWS["hertz"].parameters(STEEL), 1e-7), 0.4633374)


# case 1 of table 2.1, worked along the corrected 2.13-2.43; delta_n on both sides of 408:
# Sy*, Delta/R, share, delta_n, a [m], H_f, H_i, F [N]
CHAPTER_2 = (
    (0.1, 0.04, 0.920381, 1604.477, 3.139337e-4, 2.427674, 2.65735, 153.7968),
    (0.1, 0.0025, 0.7838293, 75.62293, 6.417865e-5, 2.821363, 2.916077, 7.224298),
    (10.0, 0.04, 0.02633674, 1782.044, 3.164859e-4, 2.421506, 2.654272, 167.0537),
    (10.0, 0.0025, 0.08205763, 99.51324, 6.880636e-5, 2.81859, 2.912067, 8.569643),
    (1.2, 0.04, 0.07376901, 1623.144, 3.166707e-4, 2.421058, 2.654049, 167.1266),
)


def case_1(ratio):
    s, f = (200e6, 200e6 / ratio) if ratio < 1.0 else (200e6 * ratio, 200e6)
    return Pair(Material(E=200e9, nu=0.3, Sy=s), Material(E=200e9, nu=0.3, Sy=f), 1e-3)


@of("2.13-2.16")
def shares():
    for ratio, D, share, *_ in CHAPTER_2:
        close(share_of_sphere(D, case_1(ratio).E_reduced / 200e6, ratio, 1.07), share)


@of("2.7", "2.11-2.12", "2.18", "2.19", "2.26")
def depth_of_the_weak_body():
    """delta_n holds the share of the weak body and R' (2.7, 2.11-2.12, 2.18, 2.19, 2.26)."""
    for ratio, D, _, n, *_ in CHAPTER_2:
        close(updated_jackson_green(case_1(ratio), D * 1e-3)[1], n)


@of("2.21-2.25", "2.28-2.33")
def contact_radius():
    for ratio, D, _, _, a, *_ in CHAPTER_2:
        close(LAWS["ghaednia"].contact_radius(case_1(ratio), D * 1e-3), a)


@of("2.34")
def equation_2_34():
    """Half way at Sy* = 1.06; (atan(300 ln 1.04) + pi/2)/pi = 0.973012 at 1.10."""
    close(indentation_weight(1.06), 0.5)
    close(indentation_weight(1.10), 0.973012)


@of("2.35")
def equation_2_35():
    for _, _, _, _, a, flattening, *_ in CHAPTER_2:
        close(model_hardness(0.0, a / 1e-3), flattening)
        close(hardness.jackson_green_2007(a / 1e-3), flattening)


@of("2.36")
def equation_2_36():
    for _, _, _, _, a, _, indentation, _ in CHAPTER_2:
        close(model_hardness(1.0, a / 1e-3), indentation)
        close(hardness.slip_line(a / 1e-3), indentation)


@of("2.10", "2.37-2.43")
def model_force():
    for ratio, D, *_, F in CHAPTER_2:
        close(LAWS["ghaednia"].loading(case_1(ratio), D * 1e-3), F)


@of("3.5-3.6", "4.13-4.14")
def recovery():
    """Half way back: 0.5^1.5 = 0.353553 of the peak force."""
    close(hertz_recovery(1000.0, 7.5e-6, 1e-5, 5e-6), 353.5534)
    rest = float(sum(LAWS["jackson-green-2007"].residual(STEEL, 2e-5)))
    half = LAWS["jackson-green-2007"].unloading(STEEL, 0.5 * (rest + 2e-5), 2e-5)
    close(half / LAWS["jackson-green-2007"].loading(STEEL, 2e-5), 0.3535534)


def left(law, pair, w):
    peak = w * critical_depth(pair)
    return float(sum(LAWS[law].residual(pair, peak))) / peak


@of("4.15-4.17")
def kogut_and_etsion():
    """delta_c = 0.479991 um; 24.0149 N at w = 3, 719.907 N at w = 40."""
    onset = yield_depth(common_parameters(STEEL))
    close(onset, 4.799906e-7)
    close(LAWS["kogut-etsion"].loading(STEEL, 3.0 * onset), 24.01494)
    close(LAWS["kogut-etsion"].loading(STEEL, 40.0 * onset), 719.9068)


@of("4.18")
def etsion_residual():
    """(1 - 40^-0.28)(1 - 40^-0.69)."""
    peak = 40.0 * 4.799906e-7
    close(sum(LAWS["kogut-etsion"].residual(STEEL, peak)) / peak, 0.5935001)


@of("4.19")
def etsion_recovery():
    """0.5^(1.5 40^-0.0331) = 0.398434 half way back."""
    law, peak = LAWS["kogut-etsion"], 40.0 * 4.799906e-7
    rest = float(sum(law.residual(STEEL, peak)))
    half = law.unloading(STEEL, 0.5 * (rest + peak), peak) / law.loading(STEEL, peak)
    close(half, 0.3984340)


@of("4.20-4.21")
def kogut_and_komvopoulos():
    """At 40 um p/Sy = 2.689462 and a'/a = 1.167580; at 1 um of an elastic pair Hertz's force."""
    depth = 4e-5
    square, strain = truncated(LAWS["hertz"].parameters(FLAT), depth)
    close(strain, 0.04476615)
    close(LAWS["kogut-komvopoulos"].loading(FLAT, depth), math.pi * square * 300e6 * 2.303450)
    elastic = Pair(FLAT.sphere, Material(E=200e9, nu=0.3, Sy=3e9), R)
    # (4 sqrt 2/(3 pi)) (E'/Sy)(d/r') Sy pi r'^2/2 with r'^2 = 2 R d - d^2
    close(LAWS["kogut-komvopoulos"].loading(elastic, 1e-6), 14.65164)


@of("4.23")
def equation_4_23():
    """Q = (E'/Sy) delta/r' = 25.9663 at 100 um."""
    _, strain = truncated(LAWS["hertz"].parameters(FLAT), 1e-4)
    close(FLAT.E_reduced / 300e6 * strain, 25.96634)


@of("4.24-4.27")
def ye_and_komvopoulos():
    """Q = 2.59, 8.19, 25.97 and 183.15, worked along 4.25-4.27 with natural logarithms."""
    for depth, F in ((1e-6, 13.06843), (1e-5, 280.4688), (1e-4, 5017.744), (4e-3, 219343.0)):
        close(LAWS["ye-komvopoulos"].loading(FLAT, depth), F)


@of("4.28")
def equation_4_28():
    close(1.0 / stress_factor(0.3), 1.612797)
    close(brake_yield_depth(common_parameters(FLAT)), 4.783263e-7)


@of("4.29")
def equation_4_29():
    """50 um: 1983.70 N without hardening at 630 MPa, 3095.64 N with n = 2.2 at 1 GPa."""
    close(brake_2015().loading(FLAT, 5e-5), 1983.701)
    close(brake_2015(meyer=2.2, hardness=1e9).loading(FLAT, 5e-5), 3095.636)


@cache
def oblique():
    rod = Material(E=200e9, nu=0.3, Sy=760e6)
    flat = Material(E=200e9, nu=0.3, Sy=305e6)
    return traced(
        scene_of(
            LAWS["ghaednia"], sphere=rod, flat=flat, striker=chapter5.thesis_rod(),
            approach=Approach(2.18, math.radians(45.0)), friction=Friction(0.13), gravity=0.0,
        ),
        points=50,
    )  # fmt: skip


@of("4.1-4.5")
def kinematics():
    """C lies (L/2) cos 45 beside T and (L/2) sin 45 + R above; T starts at rest along the flat."""
    c, s = chapter5.thesis_rod().arm(math.radians(45.0))
    close(c, 0.1077631)
    close(s, 0.1165631)
    close(oblique().column("normal_velocity_m_s")[0], -2.18)
    close(1.0 + oblique().column("sliding_velocity_m_s")[0], 1.0)


@of("4.6-4.7")
def equations_of_motion():
    """P_y = (1 + e) v 0.2013 kg and P_x = 0.13 P_y (data audit, 45 degrees)."""
    impact = oblique().impact
    close(impact.normal_impulse_Ns, (1.0 + impact.restitution) * 2.18 * 0.2013, 1e-3)
    close(abs(impact.tangential_impulse_Ns), 0.13 * impact.normal_impulse_Ns, 1e-6)


@of("4.32", "5.13")
def friction_from_velocities():
    close(oblique().impact.friction_impulse_ratio, 0.13, 1e-6)


@of("5.1-5.4")
def velocities_from_impulses():
    """m = 0.4607 kg, I = 3.56670e-3 kg m^2, c = 0.107763 m, s = 0.116563 m."""
    found = mobility(chapter5.thesis_rod(), math.radians(45.0))
    close(found.xx, 1.0 / 0.4607 + 0.1165631**2 / 3.566698e-3)
    close(found.xy, -0.1077631 * 0.1165631 / 3.566698e-3)
    close(found.yy, 1.0 / 0.4607 + 0.1077631**2 / 3.566698e-3)


@of("5.5, 5.7-5.8")
def mobility_while_sliding():
    """Effective masses of the tip of the data audit."""
    for angle, mu, mass in ((20, 0.20, 0.1346), (45, 0.13, 0.2013), (70, 0.10, 0.3690)):
        close(1.0 / mobility(chapter5.thesis_rod(), math.radians(angle)).normal(mu), mass, 4e-4)


@of("5.6")
def ratio_while_sliding():
    """v_Tx = (mu M_xx + M_xy) P_y."""
    found = mobility(chapter5.thesis_rod(), math.radians(45.0))
    close(found.tangential(0.13), 0.13 * found.xx + found.xy)
    close(found.stick_friction, 0.589, 1e-3)


@of("5.9-5.10", "5.11")
def durations():
    """4.11, 1.38 and 0.146 ms (data audit)."""
    for row, T in zip(chapter5.thesis_rows()[1], (4.11, 1.38, 0.146), strict=True):
        close(row.inferred.duration * 1e3, T, 5e-3)


@of("5.12")
def equation_5_12():
    for angle, mu, value in ((20, 0.20, -0.2427), (45, 0.13, -0.5523), (70, 0.10, -0.5005)):
        close(alpha(chapter5.thesis_rod(), math.radians(angle), mu=mu), value, 2e-4)


@of("5.14")
def equation_5_14():
    """(1 + e) v/B = 0.285, 0.656 and 1.343 N s over the durations."""
    rod, rows = chapter5.thesis_rows()
    for row, P, T in zip(rows, (0.285, 0.656, 1.343), (4.11e-3, 1.38e-3, 0.146e-3), strict=True):
        close(infer(rod, row.measured).mean_force, P / T, 1e-2)


BY_HAND |= {
    # p_0 = 3 P/(2 pi a^2) = 1.24614 GPa; the mean is 2/3 of it
    "1.6": lambda: close(
        LAWS["hertz"].hardness(hundred_newton(), 3.831547e-6), 2.0 / 3.0 * 1.246141e9
    ),
    "1.9": lambda: close(hardness.kogut_komvopoulos(400.0), 2.889284),
    "1.10": lambda: close(hardness.yu_blanchard(0.3), 3.114655),
    "1.11": lambda: close(hardness.alcala(0.3), 2.4785),
    "1.12": lambda: close(hardness.olsson_larsson(0.5, LD=0.1), 2.603358),
    "1.13": lambda: close(hardness.slip_line(0.3), 2.674000),
    "1.14": lambda: close(hardness.jackson_green(0.3), 2.417221),
    "1.15": lambda: close(hardness.jackson_green_2007(0.3), 2.460762),
    "1.17": lambda: close(yield_constant(0.3), 1.614961),
    "1.18": lambda: close(math.pi * R * critical_depth(STEEL), 1.506742e-8),
    "1.19": lambda: close(critical_force(STEEL), 4.866659),
    "1.22": lambda: close(growth_exponent(300e6, STEEL.E_reduced), 0.1490724),
    "2.1": lambda: close(STEEL.Sy_ratio, 1.0 / 3.0),
    # E' (1 - nu^2)/E = 57.8704/219.7802 for the steel sphere on aluminium
    "2.3": lambda: close(Pair(Material(E=200e9, nu=0.3), ALUMINIUM, R).elastic_share, 0.263310),
    # sqrt(2 R d - d^2) = 4.35890 mm at 1 mm
    "2.5": lambda: close(
        math.sqrt(truncated(LAWS["hertz"].parameters(STEEL), 1e-3)[0]), 4.358899e-3
    ),
    "3.7": lambda: close(left("ghaednia", STEEL, 50.0), 0.7890269),
    "4.12": lambda: close(left("jackson-green", STEEL, 50.0), 0.6904083),
    "4.22": lambda: close(sum(LAWS["kogut-komvopoulos"].residual(FLAT, 1e-4)) / 1e-4, 0.7646962),
    # 2.8/(1/300 + 1/900) MPa = 630 MPa
    "4.30": lambda: close(effective_hardness(common_parameters(FLAT)), 630e6),
    # 1 - 1983.70/5180.27 at 50 um
    "4.31": lambda: close(sum(LAWS["brake-2015"].residual(FLAT, 5e-5)) / 5e-5, 0.6170661),
}


@pytest.mark.parametrize("equation", BY_HAND)
def test_equation(equation):
    BY_HAND[equation]()


def test_every_equation_with_a_function_is_worked_by_hand():
    rows = re.findall(r"^\| (\d\.[^|]+) \| [^|]+ \| (.+) \|$", THEORY.read_text("utf-8"), re.M)
    with_function = {
        re.sub(r" \(.*?\)", "", equation).strip()
        for equation, function in rows
        if not function.startswith("no function")
    }
    assert with_function == set(BY_HAND)


# equations of each chapter, counted in the thesis
COUNT = {1: 22, 2: 43, 3: 7, 4: 32, 5: 14}
ROW = re.compile(r"^\| ([^|]+) \| ([^|]+) \| (.+) \|$", re.MULTILINE)
NUMBER = re.compile(r"(\d)\.(\d+)(?:-\1\.(\d+))?")


def rows():
    # the chapters' tables; what follows them speaks of laws and where they serve
    tables, _, _ = THEORY.read_text("utf-8").partition("## Which law to use when")
    return [m.groups() for m in ROW.finditer(tables)]


def numbers(text):
    for chapter, first, last in NUMBER.findall(text):
        yield from ((int(chapter), n) for n in range(int(first), int(last or first) + 1))


def listed():
    # the bracket only says which of them are corrected
    return [n for equation, _, _ in rows() for n in numbers(re.sub(r"\(.*?\)", "", equation))]


def test_every_equation_is_listed_once():
    expected = [(chapter, n) for chapter, count in COUNT.items() for n in range(1, count + 1)]
    assert sorted(listed()) == expected


def names():
    text = THEORY.read_text("utf-8")
    return sorted(set(re.findall(r"`((?:core|models|fem|dynamics)\.[\w.]+)`", text)))


@pytest.mark.parametrize("name", names())
def test_every_named_function_exists(name):
    parts = name.split(".")
    for cut in range(len(parts), 0, -1):
        try:
            thing = importlib.import_module(".".join(["dentscope", *parts[:cut]]))
        except ModuleNotFoundError:
            continue
        for part in parts[cut:]:
            fields = getattr(thing, "__dataclass_fields__", {})
            thing = fields[part] if part in fields else getattr(thing, part)
        return
    pytest.fail(f"{name} is nowhere")


def test_every_row_has_a_function_or_says_why_not():
    for equation, _, function in rows():
        if NUMBER.search(equation):
            assert "`" in function or function.startswith("no function: ")


def test_every_corrected_equation_has_an_erratum():
    errata = (THEORY.parent / "thesis" / "errata.md").read_text("utf-8")
    known = set(numbers(" ".join(re.findall(r"\*\*(.*?)\*\*", errata))))
    for equation, _, _ in rows():
        if "corrected)" in equation:
            assert known & set(numbers(equation)), equation
