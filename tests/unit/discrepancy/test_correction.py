"""The free correction, where one cell is the logarithm of the force itself."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.correction import correct, widened
from dentscope.discrepancy.inference.linear import Linear
from dentscope.discrepancy.unknowns.lawerror import FREE, LawError, Spread
from dentscope.dynamics.strength import NODES
from scipy.stats import norm

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
