"""Tuned numbers of the laws where they act, in cases that are worked out by hand."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.core import Material, Pair
from dentscope.core.flow import Flow, swift, tabulated
from dentscope.models import LAWS, critical_depth, hardening
from dentscope.models.anchored import _grid
from dentscope.models.choose import demand, objection
from dentscope.models.closed_form import PairNumbers, still_flat_at
from dentscope.models.correction import CHANNELS, moved
from dentscope.models.table import LoadingCurve, PairTable, Turns
from dentscope.models.uncertainty import LEAST, METAL, RECOVERY_EXPONENT, WITH_CURVE, deviation

HARD = Material(E=2e11, nu=0.3, Sy=2e9)
STEEL = Material(E=2e11, nu=0.3, Sy=4e8)
PAIR = Pair(HARD, STEEL, 1e-3)


@pytest.mark.parametrize(
    ("ratio", "regime"),
    [(0.59, "flattening"), (0.61, "both bodies"), (1.69, "both bodies"), (1.71, "indentation")],
)
def test_one_body_yields_below_three_fifths_and_beyond_seventeen_tenths(ratio, regime) -> None:
    sphere = Material(E=2e11, nu=0.3, Sy=ratio * 4e8)
    pair = Pair(sphere, STEEL, 1e-3)
    assert demand(pair, 5.0 * critical_depth(pair)).regime == regime


@pytest.mark.parametrize(("w", "said"), [(1.89, ""), (1.91, "elastic only")])
def test_hertz_may_be_used_to_nearly_twice_the_critical_depth(w, said) -> None:
    assert objection(LAWS["hertz"], demand(PAIR, w * critical_depth(PAIR))) == said


def test_one_regime_takes_over_from_the_other_no_more_sharply_than_the_twentieth_power() -> None:
    """Of p, p/sqrt(1 + p^2/400) counts."""

    def part(p, small):
        return float(still_flat_at(small, SimpleNamespace(p=p, a_t=1.0)))

    # (1 + x^(2 s))^(-1/s) is 2^(-1/s) at x = 1
    for p in (1.0, 20.0, 1e6):
        sharp = p / math.sqrt(1.0 + p * p / 400.0)
        assert part(p, 1.0) == pytest.approx(2.0 ** (-1.0 / sharp), rel=1e-9)


def test_a_shift_bends_towards_four_of_its_units() -> None:
    """c is a factor of unit 0.03: a shift of x moves ln c by 0.03 x/sqrt(1 + x^2/16)."""
    ones = PairNumbers(*(np.ones(1) for _ in PairNumbers._fields))
    for x in (1.0, 4.0, 100.0):
        shifts = np.zeros((1, len(CHANNELS)))
        shifts[0, list(CHANNELS).index("c")] = x
        found = math.log(float(moved(ones, shifts).c[0]))
        assert found == pytest.approx(0.03 * x / math.sqrt(1.0 + x * x / 16.0))


def test_the_strain_that_stands_for_all_is_a_fifth_of_a_over_r_beyond_yield() -> None:
    found = hardening.representative_strain(np.array([0.1, 0.3]), 0.2)
    assert found == pytest.approx([0.0, 0.2 * 0.1])


def test_strains_fall_from_three_times_that_one_with_the_power_seventeen_tenths() -> None:
    """Of p^n over strains 3 x^1.7, x even in (0, 1): 3^n/(1 + 1.7 n); the force has it far out."""
    assert hardening.mean_over_strains(0.3) == pytest.approx(3.0**0.3 / 1.51)
    flows = SimpleNamespace(n=np.array([0.3]))
    far = SimpleNamespace(
        at=SimpleNamespace(phi=np.array([0.5])), sphere=flows, flat=flows, y=np.array([1e12])
    )
    assert hardening._fuller(far) == pytest.approx([1.51 / 3.0**0.3])


def power_law(n=0.2):
    p = np.concatenate([[0.0], np.geomspace(1e-10, 20.0, 4000)])
    return tabulated(p, 1e8 * np.maximum(p, 1e-10) ** n)


def test_a_table_of_means_reaches_from_1e_minus_8_to_5_in_400_rows_of_60_strains() -> None:
    x, under = hardening._under(power_law())
    assert np.exp(x[[0, -1]]) == pytest.approx([1e-8, 5.0])
    assert len(x) == 400
    # the middle of the first of 60 shares, 1/120, is the smallest strain
    k = 300
    smallest = 3.0 * math.exp(x[k]) * (1.0 / 120.0) ** 1.7
    exact = np.mean([(3.0 * ((j + 0.5) / 60.0) ** 1.7) ** 0.2 for j in range(60)])
    assert under.S[k] / (1e8 * math.exp(x[k]) ** 0.2) == pytest.approx(exact, rel=1e-4)
    assert smallest < math.exp(x[k])


def test_a_bend_is_the_change_of_the_exponent_over_a_factor_of_e_to_both_sides() -> None:
    """Ln S = a x + b x^2/2: the exponent grows by b for each unit of x, by 2 b over two."""
    x = np.linspace(-20.0, 3.0, 3000)
    p = np.concatenate([[0.0], np.exp(x)])
    stress = np.exp(np.concatenate([[x[0]], x]) * 0.3 + 0.5 * 0.01 * np.append(x[0], x) ** 2)
    at, under = hardening._under(tabulated(p, 1e8 * stress))
    k = int(np.argmin(np.abs(at + 5.0)))
    assert under.bend[k] == pytest.approx(0.02, rel=0.05)


def test_a_path_begins_at_a_hundredth_of_the_critical_depth_and_ends_at_three_fifths() -> None:
    D = hardening.equivalent(LAWS["fitted"], PAIR, points=5).D
    assert D[0] == pytest.approx(0.01 * critical_depth(PAIR) / 1e-3)
    assert D[-1] == pytest.approx(0.6)
    grid = np.exp(_grid(PAIR, 0.6))
    assert (grid[0], grid[-1]) == pytest.approx((D[0], D[-1]))
    assert len(grid) == 240


def test_part_and_radius_of_a_flow_are_found_in_14_rounds_of_3() -> None:
    asked = []
    law = LAWS["fitted"]

    class Counting:
        def numbers(self, bodies):
            asked.append(1)
            return law.numbers(bodies)

    hardening.equivalent(Counting(), PAIR, points=5)
    # two ends first, and the weakest metal last
    assert len(asked) == 3 * (14 + 2) + 1


def test_between_data_a_correction_fades_over_three_tenths_of_a_coordinate() -> None:
    flowing = Material(E=2e11, nu=0.3, Sy=4e8, flow=Flow(swift(Sy=4e8, K=9e8, n=0.2)))
    e = hardening.equivalent(LAWS["fitted"], Pair(HARD, flowing, 1e-3), points=9)
    sphere, flat = hardening.coordinates_of(e)
    low = np.minimum(sphere, flat).min(axis=0) - 1.0
    high = np.maximum(sphere, flat).max(axis=0) + 1.0
    inside = hardening.features_of(e, low, high)
    # 21 monomials of five coordinates up to the second degree
    assert inside.shape[1] == 2 * (21 + 6) + 5
    # all points of the flat 0.3 below the least radius: exp(-1/2) of the constant's feature
    low[0] = flat[-1, 0] + 0.3
    outside = hardening.features_of(e, low, np.maximum(high, low))
    flat_constant = 27
    assert outside[-1, flat_constant] / inside[-1, flat_constant] == pytest.approx(math.exp(-0.5))


def table(*turns, first=0.1):
    onset = critical_depth(PAIR) / PAIR.R
    D = np.geomspace(first * onset, 100.0 * onset, 40)
    F, a = 4.0 / 3.0 * D**1.5, np.sqrt(D)
    none = np.zeros_like(D)
    curve = LoadingCurve(D, F, a, 0.5 + none, none, none, none)
    columns = [np.array(x, dtype=float) for x in zip(*turns, strict=True)] or [np.zeros(0)] * 4
    return PairTable(PAIR, curve, Turns(*columns))


def test_a_solve_counts_from_four_fifths_of_the_critical_depth_after_seven_of_hertz() -> None:
    onset = critical_depth(PAIR) / PAIR.R
    x, _, _ = table()._loading()
    w = np.exp(x) / onset
    assert w[:7] == pytest.approx([0.02, 0.05, 0.1, 0.2, 0.4, 0.5, 0.6])
    own = np.geomspace(0.1, 100.0, 40)
    assert w[7] == pytest.approx(own[own >= 0.8][0])


def test_no_law_is_known_to_better_than_a_thousandth() -> None:
    features = np.array([[1.0, 0.0]])
    assert deviation(features, np.array([-50.0, 0.0]), least=LEAST) == pytest.approx([1e-3])


def test_a_flow_curve_takes_half_of_a_metals_error_in_force_radius_and_crater() -> None:
    for name in ("force", "radius", "crater"):
        assert METAL[name] == 2.0 * WITH_CURVE[name]
    assert METAL["recovery exponent"] == WITH_CURVE["recovery exponent"]


def test_an_exponent_off_by_its_deviation_moves_what_is_given_back_by_eight_thousandths() -> None:
    """Work of a power N is F h/(1 + N), of 1.5 here."""
    assert math.log((1.0 + 1.5 + RECOVERY_EXPONENT) / 2.5) == pytest.approx(0.008, abs=1e-4)
