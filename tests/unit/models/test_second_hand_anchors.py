"""Laws verified second hand: the forms that the texts and codes read give, worked out here.

Each is written as its source writes it, in other variables than the law's own: the contact radius
instead of the depth (Thornton and Ning in PyGran), dimensional powers (Kogut and Etsion in
SCHC-framework), the pressure over 2.84 S (Jackson and Green in a code of rough contact).
"""

import math

import pytest
from dentscope.core import Material, Pair
from dentscope.models import LAWS, law_named
from dentscope.models.base import Standing
from dentscope.models.published.brizmer import stick_over_slip

E, NU, S, R = 200e9, 0.3, 503e6, 1e-3
RIGID = Material(E=math.nan, nu=math.nan, rigid=True)
PAIR = Pair(Material(E=E, nu=NU, Sy=S), RIGID, R)
E_RED = E / (1.0 - NU**2)
SLOPE = math.pi * (0.454 + 0.41 * NU) * 2.8 * S / (2.0 * E_RED)  # pi K H/(2 E')


def force(name, depth):
    return float(LAWS[name].loading(PAIR, depth))


def left(name, peak):
    return float(sum(LAWS[name].residual(PAIR, peak)))


@pytest.mark.parametrize("w", [3.0, 12.0, 90.0])
def test_jackson_green_as_a_code_of_rough_contact_writes_it(w):
    """F_c {exp(-0.25 w^(5/12)) w^1.5 + 4/C 2.84 [1 - exp(-0.82 x^-0.7)] ...}, x = a/R."""
    C = 1.295 * math.exp(0.736 * NU)
    depth = w * (math.pi * C * S / (2.0 * E_RED)) ** 2 * R
    F_c = 4.0 / 3.0 * (R / E_RED) ** 2 * (0.5 * C * math.pi * S) ** 3
    B = 0.14 * math.exp(23.0 * S / E_RED)
    x = math.sqrt(depth / R) * (w / 1.9) ** (B / 2.0)
    hardness = 2.84 * (1.0 - math.exp(-0.82 * x**-0.7))
    expected = math.exp(-0.25 * w ** (5.0 / 12.0)) * w**1.5
    expected += 4.0 / C * hardness * (1.0 - math.exp(-0.04 * w ** (5.0 / 9.0))) * w
    assert force("jackson-green", depth) == pytest.approx(F_c * expected, rel=1e-9)
    hardness = 2.84 - 0.92 * (1.0 - math.cos(math.pi * x))  # 28 of the paper of 2019
    later = math.exp(-0.25 * w ** (5.0 / 12.0)) * w**1.5
    later += 4.0 / C * hardness * (1.0 - math.exp(-(w ** (5.0 / 9.0)) / 25.0)) * w
    assert force("jackson-green-2007", depth) == pytest.approx(F_c * later, rel=1e-9)


def test_jackson_greens_recovery_as_public_code_writes_it():
    """R_r = (3 F_m/(4 E'))^2/(d_m - d_r)^3 and F = (4/3) E' sqrt(R_r) (d - d_r)^1.5."""
    law, peak = LAWS["jackson-green"], 2e-5
    rest, F_m = left("jackson-green", peak), force("jackson-green", peak)
    R_r = 1.0 / (peak - rest) ** 3 * (3.0 * F_m / (4.0 * E_RED)) ** 2
    depth = 0.4 * rest + 0.6 * peak
    expected = 4.0 / 3.0 * E_RED * math.sqrt(R_r) * (depth - rest) ** 1.5
    assert float(law.unloading(PAIR, depth, peak)) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    ("w", "factor", "strain", "radius", "depth_power"),
    [(3.0, 1.37, 0.15, 0.575, 1.425), (40.0, 1.87, 0.474, 0.737, 1.263)],
)
def test_kogut_etsion_force_in_dimensional_powers(w, factor, strain, radius, depth_power):
    """1.37 (pi K H/2E')^0.15 E' R^0.575 d^1.425, and 1.87, 0.474, 0.737, 1.263, to their digits."""
    depth = w * SLOPE**2 * R
    expected = factor * SLOPE**strain * E_RED * R**radius * depth**depth_power
    assert force("kogut-etsion", depth) == pytest.approx(expected, rel=4e-3)


def test_kogut_etsion_area_in_dimensional_powers():
    """0.94 pi R^0.854 (pi K H/2E')^-0.292 d^1.146 between w = 6 and 110."""
    depth = 40.0 * SLOPE**2 * R
    area = 0.94 * math.pi * R**0.854 * SLOPE**-0.292 * depth**1.146
    a = float(LAWS["kogut-etsion"].contact_radius(PAIR, depth))
    assert math.pi * a**2 == pytest.approx(area, rel=1e-9)


@pytest.mark.parametrize(("name", "pressure"), [("thornton", 1.6), ("thornton-ning", 2.84)])
def test_thornton_and_ning_in_the_contact_radius(name, pressure):
    """F = F_y + pi p_y (a^2 - a_y^2), R_p = 4 E' a^3/(3 F_m), d_p = a^2 (1/R - 1/R_p)."""
    p, peak = pressure * S, 3e-5
    a_y = math.pi * p * R / (2.0 * E_RED)
    a = math.sqrt(R * peak)
    F_m = 4.0 / 3.0 * E_RED * a_y**3 / R + math.pi * p * (a**2 - a_y**2)
    assert force(name, peak) == pytest.approx(F_m, rel=1e-12)
    R_p = 4.0 / 3.0 * E_RED * a**3 / F_m
    assert left(name, peak) == pytest.approx(a**2 * (1.0 / R - 1.0 / R_p), rel=1e-9)


@pytest.mark.parametrize("w", [1.7, 9.0, 40.0, 53.9, 80.0])
def test_zhao_maietta_chang_as_a_function_for_rough_surfaces_writes_it(w):
    """The integrands of ZMC for one asperity, elastic-plastic and plastic; k is the caller's."""
    H, k = 2.8 * S, 0.4
    w_1 = (0.75 * math.pi * k * H / E_RED) ** 2 * R
    w_2 = 54.0 * w_1
    depth = w * w_1
    if depth < w_2:
        pressure = 1.0 - (1.0 - k) * (math.log(w_2) - math.log(depth)) / math.log(w_2 / w_1)
        x = (depth - w_1) / (w_2 - w_1)
        expected = math.pi * R * H * depth * pressure * (1.0 - 2.0 * x**3 + 3.0 * x**2)
    else:
        expected = 2.0 * math.pi * R * H * depth
    assert force("zhao-maietta-chang", depth) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("w", [0.5, 1.5, 20.0, 109.0])
def test_brizmers_stick_as_a_code_for_granular_particles_writes_it(w):
    """L_c w^1.5 (1 - exp(1/(1 - w^beta))) with L_c from pi^3/6 C^3 Y (R (1 - nu^2) Y/E)^2."""
    C = 1.234 + 1.256 * NU
    depth_ratio = 6.82 * NU - 7.83 * (NU * NU + 0.0586)
    load_ratio = 8.88 * NU - 10.13 * (NU * NU + 0.089)
    strain = S * (1.0 - NU**2) / E
    w_c = depth_ratio * (0.5 * math.pi * C * strain) ** 2 * R
    L_c = load_ratio * math.pi**3 / 6.0 * C**3 * S * (R * strain) ** 2
    fade = math.exp(1.0 / (1.0 - w ** (0.174 + 0.08 * NU))) if w > 1.0 else 0.0
    expected = L_c * w**1.5 * (1.0 - fade)
    assert force("brizmer-stick", w * w_c) == pytest.approx(expected, rel=1e-9)


def test_stick_and_slip_are_one_where_nothing_wants_to_slide():
    """An incompressible half-space has no tangential motion under normal pressure."""
    assert stick_over_slip(0.5) == pytest.approx((1.0, 1.0), abs=0.01)


def test_kogut_etsion_continued_leaves_the_other_at_110_only():
    onset = SLOPE**2 * R
    below, above = 100.0 * onset, 500.0 * onset
    assert force("kogut-etsion-continued", below) == force("kogut-etsion", below)
    hertz = 4.0 / 3.0 * E_RED * math.sqrt(R) * onset**1.5
    expected = 1.40 * 500.0**1.263 * hertz
    assert force("kogut-etsion-continued", above) == pytest.approx(expected, rel=1e-9)


def test_a_joined_law_stands_no_better_than_its_weaker_half():
    assert LAWS["jackson-green"].standing is Standing.SECOND_HAND
    assert law_named("jackson-green+thornton").standing is Standing.SECOND_HAND
    assert law_named("jackson-green+stronge").standing is Standing.OUR_READING


def test_no_standing_is_told_as_more_than_it_is():
    for law in LAWS.values():
        found_elsewhere = law.standing >= Standing.SECOND_HAND
        assert law.standing.told.startswith("verified") == found_elsewhere
        if law.standing <= Standing.THESIS:
            assert "only" in law.standing.told
