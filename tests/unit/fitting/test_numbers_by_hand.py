"""Tuned numbers of the fits where they act, in cases that are worked out by hand."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.core import InputError, Material, Pair
from dentscope.fitting import correct as correcting
from dentscope.fitting import fit as form_fit
from dentscope.fitting import hardening
from dentscope.fitting import prediction as predicting
from dentscope.fitting.calibrate import Misses, _scaled, calibrate, within
from dentscope.fitting.case_table import pair_table
from dentscope.fitting.correct import REACHES, _Rows, _spread_out
from dentscope.fitting.hardening import _case, _solved
from dentscope.fitting.ripple import _smoothed
from dentscope.fitting.table import _loading
from dentscope.models import LAWS, critical_depth
from dentscope.models.closed_form import Coefficients
from dentscope.models.correction import CHANNELS
from dentscope.models.uncertainty import FEATURES, Calibration, Uncertainty
from scipy.stats import t as student

HARD = Material(E=2e11, nu=0.3, Sy=2e9)
STEEL = Material(E=2e11, nu=0.3, Sy=4e8)
PAIR = Pair(HARD, STEEL, 1.0)


def test_a_deviation_holds_what_students_t_with_seven_degrees_holds() -> None:
    """Of the errors 0.001 to 0.1: shares of a spread s and of 2 s add up to those of t."""
    size = np.arange(1.0, 101.0) / 1000.0
    features = np.ones((100, 1)) * np.eye(1, len(FEATURES))[0]
    weights = _scaled(np.eye(1, len(FEATURES))[0] * math.log(0.03), features, size)
    s = 1000.0 * math.exp(weights[0])
    shares = student(7)
    wanted = sum(2.0 * shares.cdf(k * math.sqrt(7.0 / 5.0)) - 1.0 for k in (1.0, 2.0))
    assert min(s, 100.0) + min(2.0 * s, 100.0) == pytest.approx(100.0 * wanted, abs=2.5)


def test_no_error_is_taken_for_smaller_than_the_elements_noise() -> None:
    """A law's own spread of nothing: an error of 0.2 % is one deviation."""
    weights = np.full((len(Uncertainty._fields), len(FEATURES)), 0.0)
    weights[:, 0] = -50.0
    features = np.eye(1, len(FEATURES))
    found = {
        name: Misses(np.repeat(features, 2, axis=0), np.array([0.0019, 0.0021]))
        for name in Uncertainty._fields
    }
    assert within(Calibration(weights), found)["force"] == (0.5, 1.0)


def test_an_error_vanishes_before_yield_as_a_power_from_a_half_to_four() -> None:
    """Errors that grow with the feature `yield`, as steeply as they like."""
    rng = np.random.default_rng(1)
    x = np.zeros((400, len(FEATURES)))
    x[:, 0] = 1.0
    x[:, 1] = rng.uniform(-1.0, 0.0, 400)

    def power(steep):
        off = 0.05 * np.exp(steep * x[:, 1]) * rng.standard_normal(400)
        found = {name: Misses(x, off) for name in Uncertainty._fields}
        return calibrate(found).weights[0, 1]

    assert power(-3.0) == pytest.approx(0.5)
    assert power(12.0) == pytest.approx(4.0)


def test_a_feature_without_a_say_is_held_at_nothing() -> None:
    """With a penalty of 0.02 for its square, over eight; a tenth of that is what noise asks for."""
    rng = np.random.default_rng(2)
    x = np.zeros((20, len(FEATURES)))
    x[:, 0], x[:, 2] = 1.0, rng.standard_normal(20)
    off = 0.05 * np.exp(0.5 * x[:, 2]) * rng.standard_normal(20)
    found = {name: Misses(x, off) for name in Uncertainty._fields}
    held = calibrate(found).weights[0, 2]
    # the same by hand: the penalised mean of the loss, at its least over one weight and the level
    from scipy.optimize import minimize

    def loss(w):
        spread = np.hypot(np.exp(w[0] + w[1] * x[:, 2]), 0.002)
        size = np.maximum(np.abs(off), 1e-6)
        whole = np.mean(np.log(spread) + 2.5 * np.log1p((size / spread) ** 2 / 4.0))
        return whole + 0.02 * w[1] ** 2 / len(FEATURES)

    assert held == pytest.approx(minimize(loss, [-3.0, 0.0]).x[1], abs=0.02)


def test_a_bump_stands_for_six_and_a_half_pairs() -> None:
    groups = np.random.default_rng(0).standard_normal((65, len(REACHES)))
    assert len(_spread_out(groups)) == 10
    assert len(_spread_out(groups[:6])) == 1


@pytest.fixture
def rows(monkeypatch):
    def of(back=1.0, **off):
        n = 4
        ones, none = np.ones(n), np.zeros(n, dtype=int)
        table = SimpleNamespace(
            force=ones, radius=ones, share=0.5 * ones, edge_seen=ones > 0, case=none
        )
        turns = SimpleNamespace(
            exponent=1.4 * ones, total=0.5 * ones, sphere_part=0.2 * ones, case=none,
            D=np.geomspace(1e-3, 1e-2, n),
        )  # fmt: skip
        values = {"force": ones, "radius": ones, "share": 0.5 * ones, "total": 0.5 * ones,
                  "sphere": 0.1 * ones, "exponent": 1.4 * ones} | off  # fmt: skip
        seen = SimpleNamespace(**values)
        monkeypatch.setattr(correcting, "moved", lambda numbers, shifts: None)
        monkeypatch.setattr(correcting, "predict_by", lambda *given: seen)
        monkeypatch.setattr(predicting, "given_back", lambda p, u: np.full(n, back))
        return _Rows(None, table, turns, np.full(n, 0.003), np.full(n, 0.003))

    return of


def test_a_misfit_of_one_is_three_thousandths_of_share_and_what_the_others_have(rows) -> None:
    ones = np.ones(4)
    loading, unloading = rows(
        share=0.503 * ones, total=(0.5 + 4e-4 + 3e-3) * ones, sphere=(0.1 + 4e-3) * ones,
        exponent=1.415 * ones, back=math.exp(0.008),
    ).misfit(None)  # fmt: skip
    assert loading[2] == pytest.approx(ones)
    # of half the depth: 0.0004 + 0.006 of what is left
    assert unloading == pytest.approx(np.ones((4, 4)))


def test_a_misfit_beyond_four_counts_linearly(rows) -> None:
    # 16 (sqrt(1 + x^2/16) - 1) for each of four rows
    for x in (0.1, 4.0, 400.0):
        cost = rows(share=(0.5 + 0.003 * x) * np.ones(4)).cost(None)
        assert cost == pytest.approx(64.0 * (math.sqrt(1.0 + x * x / 16.0) - 1.0), rel=1e-6)


class Parabola:
    """Misfits whose squares are least at given shifts of one case, with a normal matrix of h."""

    def __init__(self, at, h=1.0):
        self.at, self.h, self.asked = at, h, []

    def cost(self, shifts):
        self.asked.append(float(shifts[0, 0]))
        return 0.5 * self.h * float(np.sum((shifts - self.at) ** 2)) + 1.0

    def normal(self, shifts):
        k = shifts.shape[1]
        return self.h * np.eye(k)[None], self.h * (shifts - self.at)


def test_a_shift_costs_twice_its_square_over_two_and_moves_by_one_and_a_half_at_a_time() -> None:
    """Least where h (x - a) + 2 x is nought: x = h a/(h + 2)."""
    rows = Parabola(np.full((1, len(CHANNELS)), 3.0), h=2.0)
    found = correcting._descend(rows, np.ones((1, 1)))
    assert found == pytest.approx(np.full((1, len(CHANNELS)), 1.5), rel=1e-2)
    far = Parabola(np.full((1, len(CHANNELS)), 100.0), h=100.0)
    correcting._descend(far, np.ones((1, 1)))
    assert far.asked[1] == pytest.approx(1.5)


def test_a_regression_ends_when_a_step_brings_two_thousandths() -> None:
    class Slow(Parabola):
        def __init__(self, part):
            super().__init__(np.full((1, len(CHANNELS)), 1e9))
            self.part = part

        def cost(self, shifts):
            value = math.exp(-self.part * float(shifts[0, 0]) / 1.5) * 1e9
            self.asked.append(value)
            return value

    def steps(part):
        rows = Slow(part)
        correcting._descend(rows, np.ones((1, 1)))
        return len(rows.asked) - 1

    assert steps(0.0019) == 1
    # 25 steps at the most
    assert steps(0.05) == 25


def test_every_fourth_depth_of_a_fit_and_every_third_of_a_path_is_looked_at(monkeypatch) -> None:
    kept = []
    n = 21
    table = SimpleNamespace(
        D=np.ones(n), case=np.zeros(n, dtype=int), bodies=None, pairs=(PAIR,),
        rows=lambda m: kept.append(int(np.sum(m))),
    )  # fmt: skip
    monkeypatch.setattr(correcting, "compact_numbers", lambda *a: None)
    monkeypatch.setattr(correcting, "coordinates", lambda *a: np.zeros((1, len(REACHES))))
    monkeypatch.setattr(correcting, "_descend", lambda rows, basis: np.zeros((1, len(CHANNELS))))
    correcting.correct(np.zeros(len(Coefficients._fields)), table, None, np.zeros((2, n)))
    assert kept == [6]


def record(radius, *, depth=None, turns=()):
    n = len(radius)
    onset = critical_depth(PAIR)
    delta = onset * np.geomspace(2.0, 50.0, n) if depth is None else depth
    a = np.asarray(radius)
    curve = {"delta": delta, "radius": a, "radius_last_node": 0.9 * a, "force": delta,
             "sphere": 0.1 * delta, "flat": 0.9 * delta}  # fmt: skip
    unloadings = [
        SimpleNamespace(
            depth=d, residual_sphere=0.0, residual_flat=0.5 * d,
            curve={"radius": np.array([a[0]]), "delta": d * np.linspace(1.0, 0.5, 9),
                   "force": np.linspace(1.0, 0.0, 9)},
        )
        for d in turns
    ]  # fmt: skip
    return SimpleNamespace(
        case=SimpleNamespace(pair=PAIR, name="a"), curve=curve, unloadings=unloadings
    )


def test_a_path_of_64_points_looks_at_every_third_depth_to_half_a_radius() -> None:
    found = _case(LAWS["fitted"], record([0.1] * 9 + [0.49, 0.51]))
    # ten depths lie within; the last of them and every third before
    assert len(found.depth) == 4
    assert len(found.path.D) == 64


def test_what_stays_is_judged_from_five_critical_depths_on() -> None:
    onset = critical_depth(PAIR)
    found = _case(LAWS["fitted"], record([0.1] * 9, turns=(4.9 * onset, 5.1 * onset)))
    assert np.exp(found.turn) == pytest.approx([5.1 * onset])


def test_the_form_is_fitted_to_contacts_of_more_than_half_a_radius() -> None:
    table = _loading([record([0.1, 0.54, 0.56])])
    assert len(table.D) == 2


def test_weights_of_hardening_are_held_by_300_against_squares_of_a_hundredth() -> None:
    """One feature of ones in m rows: m x/(m + 300 * 0.01^2)."""
    found = _solved(np.ones((2, 1)), np.full(2, 0.5))
    assert found == pytest.approx([0.5 * 2.0 / (2.0 + 0.03)])


def test_eight_folds_are_left_out_in_turn(monkeypatch) -> None:
    asked = []

    monkeypatch.setattr(hardening, "_case", lambda fitted, record: record)
    monkeypatch.setattr(hardening, "_regress", lambda cases: asked.append(len(cases)))
    monkeypatch.setattr(hardening, "_off", lambda *a: {})
    with pytest.raises(KeyError):
        hardening.fit_hardening(None, list(range(16)))
    assert asked == [14] * 8


def test_a_curve_is_smoothed_over_a_factor_of_e_to_both_sides_from_six_depths_on() -> None:
    def moved(x):
        n = len(x)
        table = SimpleNamespace(
            D=np.exp(x), case=np.zeros(n, dtype=int), edge_seen=np.ones(n, dtype=bool),
            pairs=(PAIR,),
        )  # fmt: skip
        value = np.zeros(n)
        value[n // 2] = 1.0
        return _smoothed(table, value)

    # the jag in the middle of seven depths within a factor of e leaves part of itself
    near = moved(np.linspace(-0.9, 0.9, 7))
    assert 0.0 < near[3] < 0.9
    # of those farther apart too few lie near
    assert moved(np.linspace(-2.0, 2.0, 7))[3] == 1.0
    assert moved(np.linspace(-0.5, 0.5, 5))[2] == 1.0
    assert moved(np.linspace(-0.5, 0.5, 6))[3] < 1.0


def test_a_law_of_a_solve_needs_three_unloadings() -> None:
    curve = SimpleNamespace(
        delta=np.array([1e-3]), force=np.array([1.0]), radius=np.array([1.0]),
        sphere=np.array([0.5]), flat=np.array([0.5]),
    )  # fmt: skip
    solution = SimpleNamespace(
        problem=SimpleNamespace(pair=PAIR), loading=curve, unloadings=[], snapshots=[],
    )  # fmt: skip
    with pytest.raises(InputError, match="3 or more"):
        pair_table(solution, None)


def test_a_residual_of_one_of_the_form_is_a_hundredth_of_force_radius_and_shares(monkeypatch):
    one = np.ones(1)
    table = SimpleNamespace(edge_seen=one > 0.0, force=one, radius=one, share=0.5 * one)
    turns = SimpleNamespace(exponent=1.5 * one, total=0.5 * one, sphere_part=0.4 * one)
    seen = SimpleNamespace(
        force=np.exp([0.01]), radius=np.exp([0.02]), share=0.53 * one, total=0.54 * one,
        sphere=0.25 * one, exponent=1.53 * one,
    )  # fmt: skip
    monkeypatch.setattr(form_fit, "predict", lambda *_: seen)
    monkeypatch.setattr(predicting, "given_back", lambda *_: np.exp([0.02]))
    misfit = form_fit._misfit_of(table, turns, (0.0, 0.0))
    assert misfit(np.zeros(1)) == pytest.approx([1.0, 2.0, 3.0, 4.0, 5.0, 1.0, 1.0])
