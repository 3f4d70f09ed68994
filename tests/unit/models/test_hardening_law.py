"""The law for metals with a flow curve: its limits, and the similarity solution of power laws."""

import math

import numpy as np
import pytest
from dentscope.campaigns.cases.plateau import ASTM_1016, ASTM_1055, measured
from dentscope.core import Material, Pair
from dentscope.core.flow import Flow, swift, voce
from dentscope.models import LAWS, critical_depth

STEEL = Material(E=200e9, nu=0.3, Sy=503e6)
SOFT = Material(E=71.7e9, nu=0.33, Sy=300e6)
RIGID = Material(E=math.nan, nu=math.nan, rigid=True)
HARDENING, FITTED = LAWS["hardening"], LAWS["fitted"]


def power_law(body, n):
    return body.with_(flow=Flow(swift(Sy=body.Sy, K=body.Sy * (body.E / body.Sy) ** n, n=n)))


@pytest.mark.parametrize("pair", [Pair(STEEL, SOFT, 1e-3), Pair(SOFT, STEEL, 1e-3)])
def test_without_a_flow_curve_it_is_the_fitted_law(pair):
    d = np.geomspace(1e-5, 0.1, 40) * pair.R
    assert HARDENING.loading(pair, d) == pytest.approx(FITTED.loading(pair, d), rel=3e-3)
    assert HARDENING.contact_radius(pair, d) == pytest.approx(
        FITTED.contact_radius(pair, d), rel=3e-3
    )
    assert HARDENING.share(pair, d) == pytest.approx(FITTED.share(pair, d), abs=1e-3)
    deep = d[d > 1e-3 * pair.R]
    left = sum(HARDENING.residual(pair, deep))
    assert left == pytest.approx(sum(FITTED.residual(pair, deep)), rel=2e-3)


@pytest.mark.filterwarnings("ignore::dentscope.models.base.DomainWarning")
@pytest.mark.parametrize("n", [0.1, 0.2, 0.4])
def test_a_power_law_flat_follows_its_similarity_solution(n):
    """Storakers, Biwa and Larsson (1997): a^2 = 2 c^2 R Delta, F = 3 pi a^2 K (a/(6 R))^n."""
    E, first, start = 200e9, 1.8e-5 * 200e9, 2e-4
    K = first / start**n
    flat = Material(E=E, nu=0.3, Sy=first, flow=Flow(swift(Sy=first, K=K, n=n)))
    pair = Pair(RIGID, flat, 1.0)
    d = np.geomspace(3e-4, 1.5e-3, 5)
    a = np.sqrt(2.0 * 1.43 * math.exp(-0.97 * n) * d)
    assert HARDENING.contact_radius(pair, d) == pytest.approx(a, rel=0.04)
    load = 3.0 * math.pi * a**2 * K * (a / 6.0) ** n
    assert HARDENING.loading(pair, d) == pytest.approx(load, rel=0.06)


def test_equal_bodies_share_the_approach_however_they_harden():
    body = power_law(STEEL, 0.3)
    pair = Pair(body, body, 1e-3)
    assert HARDENING.share(pair, [1e-6, 1e-5]) == pytest.approx([0.5, 0.5], abs=0.01)


def test_two_bodies_that_harden_agree_with_calculix():
    """CalculiX 2.20 (CAX4), both bodies n = 0.2, F in N: docs/verification.md, independent code."""
    body = power_law(STEEL, 0.2)
    pair = Pair(body, body, 1e-3)
    depth = np.array([1.361e-3, 7.893e-3, 1.901e-2, 4.578e-2])
    force, share = [6.205, 63.11, 188.0, 509.0], [0.4978, 0.5090, 0.5318, 0.5862]
    found = HARDENING.loading(pair, depth * pair.R)
    assert found == pytest.approx(force, rel=0.03)
    assert HARDENING.share(pair, depth * pair.R) == pytest.approx(share, abs=0.03)


def test_the_body_that_hardens_leaves_flow_to_the_other():
    """A weaker sphere that hardens takes less of the approach than one that does not."""
    weak = STEEL.with_(Sy=400e6)
    plain, hard = Pair(weak, STEEL, 1e-3), Pair(power_law(weak, 0.4), STEEL, 1e-3)
    d = np.array([1e-5, 5e-5])
    assert np.all(HARDENING.share(hard, d) < HARDENING.share(plain, d) - 0.1)
    assert np.all(HARDENING.loading(hard, d) > 1.1 * HARDENING.loading(plain, d))


def test_a_flow_stress_that_levels_off_ends_as_perfectly_plastic_at_that_stress():
    body = SOFT.with_(flow=Flow(voce(Sy=SOFT.Sy, Q=150e6, b=2000.0)))
    deep = 0.05 * 1e-3
    ended = FITTED.loading(Pair(STEEL, SOFT.with_(Sy=450e6), 1e-3), deep)
    assert HARDENING.loading(Pair(STEEL, body, 1e-3), deep) == pytest.approx(ended, rel=0.02)


BALL = Material(E=210e9, nu=0.29, Sy=2e9)


def on_steel(rows, E=203e9):
    curve = measured(rows)
    return Pair(BALL, Material(E=E, nu=0.29, Sy=curve.strength, flow=Flow(curve)), 1e-3)


@pytest.mark.parametrize("flat_E", [70e9, 206e9])
@pytest.mark.parametrize(
    "rows",
    [
        ((0.0, 300.0), (0.02, 300.0), (0.04, 400.0), (0.2, 500.0)),
        ((0.0, 300.0), (0.04, 300.0), (0.05, 600.0), (1.0, 600.0)),
        ((0.0, 320.0), (0.004, 300.0), (0.03, 300.0), (0.2, 480.0)),
    ],
    ids=["plateau", "step", "upper yield"],
)
def test_a_plateau_never_takes_the_force_below_that_of_its_stress(rows, flat_E):
    pair = on_steel(rows, flat_E)
    lowest = min(stress for _, stress in rows) * 1e6
    plain = Pair(BALL, pair.flat.with_(flow=None, Sy=lowest), 1e-3)
    d = np.geomspace(1e-5, 0.17, 300) * pair.R
    # a table stands for the law: its error where a curve bends sharply
    assert np.all(HARDENING.loading(pair, d) > (1.0 - 3e-4) * FITTED.loading(plain, d))


def test_a_constant_curve_is_perfect_plasticity():
    flat = Material(E=206e9, nu=0.3, Sy=3e8, flow=Flow(measured(((0.0, 300.0), (1.0, 300.0)))))
    pair, plain = Pair(BALL, flat, 1e-3), Pair(BALL, flat.with_(flow=None), 1e-3)
    d = np.geomspace(1e-6, 0.17, 300) * pair.R
    for answer in (HARDENING.loading, HARDENING.contact_radius):
        assert answer(pair, d) == pytest.approx(answer(plain, d), rel=1e-12)


# CalculiX 2.20, axisymmetric, finite strain, elastic ball of 1 mm on a flat of the measured curve;
# a convergence study puts these forces 0.5 to 1 % low
CALCULIX = {
    "1016": (ASTM_1016, [1.04131e-3, 2.43456e-3, 4.73042e-3, 1.00602e-2, 1.61437e-2, 2.4e-2],
             [3.92148, 11.7716, 27.5078, 69.4494, 121.488, 197.085]),
    "1055": (ASTM_1055, [1.04131e-3, 2.43456e-3, 4.73042e-3, 7.59093e-3, 1.13663e-2],
             [4.40038, 14.2408, 34.868, 65.008, 109.496]),
}  # fmt: skip


@pytest.mark.parametrize("steel", CALCULIX)
def test_steels_with_a_plateau_or_a_knee_agree_with_calculix(steel):
    rows, depth, force = CALCULIX[steel]
    pair = on_steel(rows)
    d = np.array(depth) * pair.R
    off = HARDENING.loading(pair, d) / (1.0075 * np.array(force)) - 1.0
    assert np.mean(np.abs(off)) < 0.02
    assert np.max(np.abs(off)) < 0.04
    assert np.mean(np.abs(off) < 2.0 * HARDENING.uncertainty(pair, d).force) > 0.9


def test_a_curve_that_bends_is_less_sure():
    bent = on_steel(((0.0, 300.0), (0.02, 300.0), (0.04, 400.0), (0.2, 500.0)))
    weak = on_steel(((0.0, 300.0), (0.2, 310.0), (1.0, 350.0)))
    d = 3e-3 * bent.R
    assert HARDENING.uncertainty(bent, d).force > 1.5 * HARDENING.uncertainty(weak, d).force


def test_it_states_its_error_which_vanishes_before_yield_and_grows_with_hardening():
    plain, hard = Pair(SOFT, STEEL, 1e-3), Pair(power_law(SOFT, 0.3), STEEL, 1e-3)
    depth = np.array([0.3 * critical_depth(hard), 2e-5])
    sure = HARDENING.uncertainty(hard, depth)
    assert sure.force[0] < 2e-3 < 5e-3 < sure.force[1] < 0.05
    assert sure.force[1] > 2.0 * HARDENING.uncertainty(plain, depth).force[1]
    assert HARDENING.uncertainty(plain, depth).force == pytest.approx(
        FITTED.uncertainty(plain, depth).force, rel=0.05
    )


@pytest.mark.filterwarnings("ignore::dentscope.models.base.DomainWarning")
def test_far_from_the_data_no_curve_falls_or_leaves_its_bounds():
    random = np.random.default_rng(7)
    for _ in range(40):
        E, Sy = 10.0 ** random.uniform(10.0, 12.0, 2), 10.0 ** random.uniform(6.5, 9.5, 2)
        bodies = [
            power_law(Material(E=e, nu=nu, Sy=s), n)
            for e, nu, s, n in zip(
                E, random.uniform(0.0, 0.49, 2), np.minimum(Sy, E / 50.0),
                random.uniform(0.01, 0.9, 2), strict=True,
            )
        ]  # fmt: skip
        pair = Pair(*bodies, 1e-3)
        d = np.geomspace(1e-8, 0.3, 120) * pair.R
        force, share = HARDENING.loading(pair, d), HARDENING.share(pair, d)
        assert np.all(np.diff(force) >= 0.0)
        assert np.all((share >= 0.0) & (share <= 1.0))
        left = sum(HARDENING.residual(pair, d))
        assert np.all((left >= 0.0) & (left < d))
        for peak in d[60::15]:
            down = np.linspace(float(sum(HARDENING.residual(pair, peak))), peak, 60)
            back = np.trapezoid(HARDENING.unloading(pair, down, peak), down)
            up = np.linspace(0.0, peak, 400)
            assert back <= np.trapezoid(HARDENING.loading(pair, up), up) * (1.0 + 1e-3)
