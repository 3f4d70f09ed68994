"""Held-out conditions and the free correction, where both follow from a known formula."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.correction import correct, widened
from dentscope.discrepancy.heldout import groups_of, held_out, missed
from dentscope.discrepancy.inference.linear import Linear
from dentscope.discrepancy.unknowns.lawerror import FREE, LawError, Spread
from dentscope.dynamics.strength import NODES
from scipy.stats import norm


def test_whole_strikers_speeds_and_angles_are_left_out(toy) -> None:
    c = toy.condition
    given = replace(
        toy.problem([0.0] * 4),
        conditions=(c(1.0, "a"), c(2.0, "a"), c(1.0, "b"), c(2.0, "b", math.radians(60.0))),
    )
    groups = {tuple(np.flatnonzero(mask).tolist()) for mask in groups_of(given)}
    assert groups == {(0, 1), (2, 3), (0, 2), (1, 3), (0, 1, 2), (3,)}


def test_where_nothing_varies_single_conditions_are_left_out(toy) -> None:
    given = toy.problem([0.0] * 3, speeds=[1.0, 1.001, 1.002])
    assert [np.flatnonzero(m).tolist() for m in groups_of(given)] == [[0], [1], [2]]
    # ln v/0.15 = 0, 0.3 and 1.2
    given = toy.problem([0.0] * 3, speeds=[1.0, 1.05, 1.2])
    assert [np.flatnonzero(m).tolist() for m in groups_of(given)] == [[0, 1], [2]]


def test_cells_that_share_nothing_are_missed_by_their_residual(toy) -> None:
    given = toy.problem([3.0, -4.0])
    found = held_out(given, toy.fit_of([3.0, -4.0]))
    assert found.rms == pytest.approx(math.sqrt((9.0 + 16.0) / 2.0))
    assert found.log_density == pytest.approx(np.mean(norm.logpdf([3.0, -4.0])))
    assert found.trials == 2


def test_what_cells_share_is_learnt_from_those_that_were_kept(toy) -> None:
    """An unknown of variance 9 in two cells of unit noise: 9/10 of one foretells the other."""
    J = [[3.0], [3.0]]
    found = held_out(toy.problem([5.0, 7.0], derivative=J), toy.fit_of([5.0, 7.0], J=J))
    miss = np.array([5.0 - 0.9 * 7.0, 7.0 - 0.9 * 5.0])
    assert found.rms == pytest.approx(math.sqrt(np.mean(miss**2)), rel=1e-12)
    density = norm.logpdf(miss, scale=math.sqrt(1.0 + 9.0 - 0.9 * 9.0))
    assert found.log_density == pytest.approx(np.mean(density), rel=1e-12)


def test_a_mechanism_foretells_what_it_was_not_shown(toy) -> None:
    data = [20.0, 40.0]
    effect = toy.Effect("a", (40.0, 80.0))
    with_it, without = (held_out(toy.problem(data), toy.fit_of(data, *e)) for e in ((effect,), ()))
    assert with_it.rms < 1.0
    assert without.rms == pytest.approx(math.sqrt((400.0 + 1600.0) / 2.0))


def test_sizes_count_by_how_well_they_explain_what_was_kept(toy) -> None:
    """Near the end of its range the sizes that come into question lie to one side."""
    data, effect = [0.8, 1.6], toy.Effect("a", (40.0, 80.0))
    # shown one cell, the size is known to 1/80 or 1/40 of its range: 2 standard errors at the most
    assert held_out(toy.problem(data), toy.fit_of(data, effect)).rms < 1.5


def test_some_cells_foretell_the_others() -> None:
    rng = np.random.default_rng(5)
    linear = Linear(np.eye(4), rng.normal(size=(4, 2)), rng.normal(size=(4, 3)))
    r, out = rng.normal(size=(3, 4)), np.array([False, True, False, True])
    kept = linear.total[np.ix_(~out, ~out)]
    precision = np.linalg.inv(linear.total)
    g = r @ precision
    foretold = r[:, ~out] @ np.linalg.solve(kept, linear.total[np.ix_(~out, out)])
    whole = np.sum(r * g, axis=1)
    miss, squares, log_density = missed(whole, g[:, out], precision[np.ix_(out, out)])
    assert miss == pytest.approx(r[:, out] - foretold)
    assert squares == pytest.approx(
        np.einsum("ki,ij,kj->k", r[:, ~out], np.linalg.inv(kept), r[:, ~out])
    )
    # of all less of the others
    both = linear.log_likelihood(r)
    others = -0.5 * (squares + np.linalg.slogdet(2.0 * math.pi * kept)[1])
    assert log_density == pytest.approx(both - others)


KNOWN = 0.02
KINDS = ("force", "recovery", "recovery exponent", "crater", "radius")
NONE = dict.fromkeys(KINDS, np.zeros(NODES))
ERROR = LawError(
    np.ones((1, NODES)), np.zeros((0, NODES)), np.zeros((0, NODES)),
    {"ball": Spread(NONE, NONE | {"force": np.full(NODES, KNOWN)}, np.array([-5.0]))},
)  # fmt: skip


def corrected(toy, data, noise):
    J = [[KNOWN]]
    given = toy.problem(data, derivative=J, error=ERROR)
    base = replace(toy.fit_of(data, J=J), linear=Linear(noise**2 * np.eye(1), np.array(J)))
    simulator = SimpleNamespace(
        problem=replace(given), observe=lambda *_: {"peak_depth_m": np.array([[1e-4]])}
    )
    object.__setattr__(simulator.problem, "scenes", lambda z: [SimpleNamespace(pair=PAIR)])
    return correct(simulator, base)


PAIR = SimpleNamespace(R=0.01)


def test_a_force_off_by_a_fifth_is_a_factor_of_that_size(toy) -> None:
    (loading,) = corrected(toy, [math.log(1.2)], 1e-3)
    assert loading.phase == "loading"
    # a prior of 16 % hardly holds back what is measured to a thousandth
    held = FREE["force"] ** 2 / (FREE["force"] ** 2 + 1e-6)
    assert loading.factor == pytest.approx(1.2**held, rel=1e-9)
    assert loading.depth_over_R[[0, -1]] == pytest.approx([0.3 * 1e-2, 1e-2])


def test_the_band_is_that_of_the_measurement(toy) -> None:
    (loading,) = corrected(toy, [0.0], 0.05)
    spread = (FREE["force"] ** -2 + 0.05**-2) ** -0.5
    beyond = norm.ppf(0.95)
    assert np.log(loading.high) == pytest.approx(beyond * spread, rel=1e-9)
    assert np.log(loading.low) == pytest.approx(-beyond * spread, rel=1e-9)


def test_only_the_laws_error_is_set_free(toy) -> None:
    J = [[0.5, KNOWN]]
    given = toy.problem([0.0], derivative=J, error=ERROR)
    wide = widened(given, toy.fit_of([0.0], J=J))
    assert wide.scaled == pytest.approx(np.array([[0.5, FREE["force"]]]))
