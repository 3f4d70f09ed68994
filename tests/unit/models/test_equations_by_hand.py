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
from dentscope.models.published import ghaednia, hardness
from dentscope.models.published.brake import brake_2015, effective_hardness, stress_factor
from dentscope.models.published.brake import yield_depth as brake_yield_depth
from dentscope.models.published.ceb import yield_depth
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


HUNDRED_NEWTON = Pair(Material(E=91e9, nu=0.3), Material(E=math.nan, nu=math.nan, rigid=True), R)
STEEL_ON_ALUMINIUM = Pair(Material(E=200e9, nu=0.3), ALUMINIUM, R)
HERTZ, LATER = LAWS["hertz"], LAWS["jackson-green-2007"]
ETSION, KOMVOPOULOS = LAWS["kogut-etsion"], LAWS["kogut-komvopoulos"]


def ball_on_a_flat():
    """A ball that loses energy on a massive flat: e = P_r/P_c, and E^2 = e R."""
    impact = chapter5.strike(
        scene_of(
            KOMVOPOULOS, sphere=FLAT.sphere, flat=FLAT.flat, gravity=0.0,
            striker=chapter5.Striker(mass=0.03, tip_radius=R), approach=Approach(2.0),
        )
    )  # fmt: skip
    e, kinetic = impact.restitution, impact.kinetic_restitution
    # recovered (2/5) F (d_m - d_r) with 1 - 0.764696 of the depth left to recover (4.22)
    return [(kinetic, e, 1e-6), (impact.energetic_restitution**2, e * kinetic, 1e-6),
            (impact.residual_m / impact.peak_depth_m, 0.764696)]  # fmt: skip


def share_of_two_bodies():
    n = np.zeros(1)
    curve = Curve(
        delta=np.array([4e-5]), force=n, radius=n, radius_last_node=n, sphere=np.array([3e-5]),
        flat=np.array([1e-5]), hardness=n, force_defect=n, energy_defect=n, dissipated=n,
    )  # fmt: skip
    return [(curve.sphere_share[0], 0.75)]


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


def recovery():
    """Half way back: 0.5^1.5 = 0.353553 of the peak force."""
    rest = float(sum(LATER.residual(STEEL, 2e-5)))
    half = LATER.unloading(STEEL, 0.5 * (rest + 2e-5), 2e-5)
    return [(hertz_recovery(1000.0, 7.5e-6, 1e-5, 5e-6), 353.5534),
            (half / LATER.loading(STEEL, 2e-5), 0.3535534)]  # fmt: skip


def left(law, pair, w):
    peak = w * critical_depth(pair)
    return float(sum(LAWS[law].residual(pair, peak))) / peak


ONSET = 4.799906e-7  # of Kogut and Etsion, by hand


def etsion_recovery():
    """0.5^(1.5 40^-0.0331) = 0.398434 half way back."""
    peak = 40.0 * ONSET
    rest = float(sum(ETSION.residual(STEEL, peak)))
    half = ETSION.unloading(STEEL, 0.5 * (rest + peak), peak)
    return [(half / ETSION.loading(STEEL, peak), 0.3984340)]


def kogut_and_komvopoulos():
    """At 40 um p/Sy = 2.689462 and a'/a = 1.167580; at 1 um of an elastic pair Hertz's force."""
    square, strain = truncated(HERTZ.parameters(FLAT), 4e-5)
    elastic = Pair(FLAT.sphere, Material(E=200e9, nu=0.3, Sy=3e9), R)
    return [
        (strain, 0.04476615),
        (KOMVOPOULOS.loading(FLAT, 4e-5), math.pi * square * 300e6 * 2.303450),
        # (4 sqrt 2/(3 pi)) (E'/Sy)(d/r') Sy pi r'^2/2 with r'^2 = 2 R d - d^2
        (KOMVOPOULOS.loading(elastic, 1e-6), 14.65164),
    ]


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


def kinematics():
    """C lies (L/2) cos 45 beside T and (L/2) sin 45 + R above; T starts at rest along the flat."""
    c, s = chapter5.thesis_rod().arm(math.radians(45.0))
    return [(c, 0.1077631), (s, 0.1165631),
            (oblique().column("normal_velocity_m_s")[0], -2.18),
            (1.0 + oblique().column("sliding_velocity_m_s")[0], 1.0)]  # fmt: skip


def equations_of_motion():
    """P_y = (1 + e) v 0.2013 kg and P_x = 0.13 P_y (data audit, 45 degrees)."""
    impact = oblique().impact
    P = impact.normal_impulse_Ns
    return [(P, (1.0 + impact.restitution) * 2.18 * 0.2013, 1e-3),
            (abs(impact.tangential_impulse_Ns), 0.13 * P, 1e-6)]  # fmt: skip


def tip(angle=45.0):
    return mobility(chapter5.thesis_rod(), math.radians(angle))


def trials():
    """Rows of the thesis with the durations of the data audit [s] and (1 + e) v/B [N s]."""
    return zip(
        chapter5.thesis_rows()[1], (4.11e-3, 1.38e-3, 0.146e-3), (0.285, 0.656, 1.343), strict=True
    )


WORKED = {
    "1.1": ball_on_a_flat,
    "1.4-1.5": lambda: [(HUNDRED_NEWTON.E_reduced, 100e9),
                        (HERTZ.loading(HUNDRED_NEWTON, 3.831547e-6), 100.0),
                        (HERTZ.contact_radius(HUNDRED_NEWTON, 3.831547e-6), A_100)],
    # p_0 = 3 P/(2 pi a^2) = 1.24614 GPa; the mean is 2/3 of it
    "1.6": lambda: [(HERTZ.hardness(HUNDRED_NEWTON, 3.831547e-6), 2.0 / 3.0 * 1.246141e9)],
    "1.7 | 2.17": lambda: [(STEEL_ON_ALUMINIUM.E_reduced, 57.870370e9)],
    "1.9": lambda: [(hardness.kogut_komvopoulos(400.0), 2.889284)],
    "1.10": lambda: [(hardness.yu_blanchard(0.3), 3.114655)],
    "1.11": lambda: [(hardness.alcala(0.3), 2.4785)],
    "1.12": lambda: [(hardness.olsson_larsson(0.5, LD=0.1), 2.603358)],
    "1.13": lambda: [(hardness.slip_line(0.3), 2.674000)],
    "1.14": lambda: [(hardness.jackson_green(0.3), 2.417221)],
    "1.15": lambda: [(hardness.jackson_green_2007(0.3), 2.460762)],
    "1.16 | 3.1-3.2 | 4.9": lambda: [(critical_depth(STEEL), 4.796109e-7)],
    "1.17": lambda: [(yield_constant(0.3), 1.614961)],
    "1.18": lambda: [(math.pi * R * critical_depth(STEEL), 1.506742e-8)],
    "1.19": lambda: [(critical_force(STEEL), 4.866659)],
    # w = 50: a = 0.624866 mm, F = 984.456 N
    "1.20-1.21 | 4.10-4.11": lambda: [(LATER.contact_radius(STEEL, 2.398054e-5), 6.248663e-4),
                                      (LATER.loading(STEEL, 2.398054e-5), 984.4558)],
    "1.22": lambda: [(growth_exponent(300e6, STEEL.E_reduced), 0.1490724)],
    "2.1": lambda: [(STEEL.Sy_ratio, 1.0 / 3.0)],
    "2.2": share_of_two_bodies,
    # E' (1 - nu^2)/E = 57.8704/219.7802 for the steel sphere on aluminium
    "2.3": lambda: [(STEEL_ON_ALUMINIUM.elastic_share, 0.263310)],
    # sqrt(2 R d - d^2) = 4.35890 mm at 1 mm
    "2.5": lambda: [(math.sqrt(truncated(HERTZ.parameters(STEEL), 1e-3)[0]), 4.358899e-3)],
    "2.13-2.16": lambda: [(ghaednia.share_of_sphere(D, case_1(r).E_reduced / 200e6, r, 1.07), share)
                          for r, D, share, *_ in CHAPTER_2],
    # delta_n holds the share of the weak body and R' (2.7, 2.11-2.12, 2.18, 2.19, 2.26)
    "2.7 | 2.11-2.12 | 2.18 | 2.19 | 2.26": lambda: [
        (ghaednia.updated_jackson_green(case_1(r), D * 1e-3)[1], n)
        for r, D, _, n, *_ in CHAPTER_2],
    "2.21-2.25 | 2.28-2.33": lambda: [(LAWS["ghaednia"].contact_radius(case_1(r), D * 1e-3), a)
                                      for r, D, _, _, a, *_ in CHAPTER_2],
    # half way at Sy* = 1.06; (atan(300 ln 1.04) + pi/2)/pi = 0.973012 at 1.10
    "2.34": lambda: [(ghaednia.indentation_weight(1.06), 0.5),
                     (ghaednia.indentation_weight(1.10), 0.973012)],
    "2.35": lambda: [(of_radius, flattening) for *_, a, flattening, _, _ in CHAPTER_2
                     for of_radius in (ghaednia.model_hardness(0.0, a / 1e-3),
                                       hardness.jackson_green_2007(a / 1e-3))],
    "2.36": lambda: [(of_radius, indentation) for *_, a, _, indentation, _ in CHAPTER_2
                     for of_radius in (ghaednia.model_hardness(1.0, a / 1e-3),
                                       hardness.slip_line(a / 1e-3))],
    "2.10 | 2.37-2.43": lambda: [(LAWS["ghaednia"].loading(case_1(r), D * 1e-3), F)
                                 for r, D, *_, F in CHAPTER_2],
    "3.3-3.4 | 2.4 | 4.8": lambda: [(hertz_force(HERTZ.parameters(STEEL), 1e-7), 0.4633374)],
    "3.5-3.6 | 4.13-4.14": recovery,
    "3.7": lambda: [(left("ghaednia", STEEL, 50.0), 0.7890269)],
    "4.1-4.5": kinematics,
    "4.6-4.7": equations_of_motion,
    "4.12": lambda: [(left("jackson-green", STEEL, 50.0), 0.6904083)],
    "4.15-4.17": lambda: [(yield_depth(common_parameters(STEEL)), ONSET),
                          (ETSION.loading(STEEL, 3.0 * ONSET), 24.01494),
                          (ETSION.loading(STEEL, 40.0 * ONSET), 719.9068)],
    # (1 - 40^-0.28)(1 - 40^-0.69)
    "4.18": lambda: [(sum(ETSION.residual(STEEL, 40.0 * ONSET)) / (40.0 * ONSET), 0.5935001)],
    "4.19": etsion_recovery,
    "4.20-4.21": kogut_and_komvopoulos,
    "4.22": lambda: [(sum(KOMVOPOULOS.residual(FLAT, 1e-4)) / 1e-4, 0.7646962)],
    # Q = (E'/Sy) delta/r' = 25.9663 at 100 um
    "4.23": lambda: [(FLAT.E_reduced / 300e6 * truncated(HERTZ.parameters(FLAT), 1e-4)[1],
                      25.96634)],
    # Q = 2.59, 8.19, 25.97 and 183.15, worked along 4.25-4.27 with natural logarithms
    "4.24-4.27": lambda: [(LAWS["ye-komvopoulos"].loading(FLAT, depth), F) for depth, F in (
        (1e-6, 13.06843), (1e-5, 280.4688), (1e-4, 5017.744), (4e-3, 219343.0))],
    # from Hertz's stresses on the axis
    "4.28": lambda: [*((1.0 / stress_factor(nu), worst, 5e-5) for nu, worst in (
                         (0.25, 1.5543), (0.4, 1.7385))),
                     (1.0 / stress_factor(0.3), 1.612797),
                     (brake_yield_depth(common_parameters(FLAT)), 4.783263e-7)],
    # 50 um: 1983.70 N without hardening at 630 MPa, 3095.64 N with n = 2.2 at 1 GPa
    "4.29": lambda: [(brake_2015().loading(FLAT, 5e-5), 1983.701),
                     (brake_2015(meyer=2.2, hardness=1e9).loading(FLAT, 5e-5), 3095.636)],
    # 2.8/(1/300 + 1/900) MPa = 630 MPa
    "4.30": lambda: [(effective_hardness(common_parameters(FLAT)), 630e6)],
    # 1 - 1983.70/5180.27 at 50 um
    "4.31": lambda: [(sum(LAWS["brake-2015"].residual(FLAT, 5e-5)) / 5e-5, 0.6170661)],
    "4.32 | 5.13": lambda: [(oblique().impact.friction_impulse_ratio, 0.13, 1e-6)],
    # m = 0.4607 kg, I = 3.56670e-3 kg m^2, c = 0.107763 m, s = 0.116563 m
    "5.1-5.4": lambda: [(tip().xx, 1.0 / 0.4607 + 0.1165631**2 / 3.566698e-3),
                        (tip().xy, -0.1077631 * 0.1165631 / 3.566698e-3),
                        (tip().yy, 1.0 / 0.4607 + 0.1077631**2 / 3.566698e-3)],
    # effective masses of the tip of the data audit
    "5.5, 5.7-5.8": lambda: [(1.0 / tip(angle).normal(mu), mass, 4e-4) for angle, mu, mass in (
        (20, 0.20, 0.1346), (45, 0.13, 0.2013), (70, 0.10, 0.3690))],
    # v_Tx = (mu M_xx + M_xy) P_y
    "5.6": lambda: [(tip().tangential(0.13), 0.13 * tip().xx + tip().xy),
                    (tip().stick_friction, 0.589, 1e-3)],
    "5.9-5.10 | 5.11": lambda: [(row.inferred.duration, T, 5e-3) for row, T, _ in trials()],
    "5.12": lambda: [
        (alpha(chapter5.thesis_rod(), math.radians(angle), mu=mu), value, 2e-4)
        for angle, mu, value in ((20, 0.20, -0.2427), (45, 0.13, -0.5523), (70, 0.10, -0.5005))],
    "5.14": lambda: [(infer(chapter5.thesis_rod(), row.measured).mean_force, P / T, 1e-2)
                     for row, T, P in trials()],
}  # fmt: skip
BY_HAND = {one: worked for equations, worked in WORKED.items() for one in equations.split(" | ")}


@pytest.mark.parametrize("equation", BY_HAND)
def test_equation(equation):
    rows = BY_HAND[equation]()
    assert rows
    for value, expected, *rel in rows:
        assert float(value) == pytest.approx(expected, rel=rel[0] if rel else 1e-5)


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
