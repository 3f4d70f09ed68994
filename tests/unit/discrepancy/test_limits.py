"""The smallest effect that a set would have shown: nearest to doing nothing, in the rig's range."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.choice.odds import PRIORS
from dentscope.discrepancy.estimates import limits_of
from dentscope.discrepancy.inference.grid import Axis, Grid
from dentscope.discrepancy.inference.linear import Linear
from dentscope.discrepancy.report.sentences import limit_rows
from dentscope.discrepancy.rules import RULES
from dentscope.dynamics.mechanisms.base import Parameter

# Standard errors that one alternative has to win to be named, and three nats for its parameter.
PRIOR = math.log(PRIORS["baseline"] / PRIORS["mechanisms"])
NEEDED = math.sqrt(2.0 * (PRIOR / RULES.temper + 3.0))


@pytest.mark.parametrize(
    ("low", "high", "scale", "neutral", "effect", "value"),
    [
        (-8.0, 8.0, "linear", 0.0, lambda x: x, NEEDED),
        (1e-3, 1e1, "log", 0.0, lambda x: 10.0 * x, NEEDED / 10.0),
        (1e5, 1e9, "log", math.inf, lambda x: 1e8 / x, 1e8 / NEEDED),
    ],
)
def test_limit_is_the_value_nearest_to_doing_nothing(low, high, scale, neutral, effect, value):
    own = Parameter("p", "-", low, high, scale, neutral, "", nodes=5)
    grid = Grid((Axis("m", own),))
    found = limits_of(
        SimpleNamespace(
            base=SimpleNamespace(linear=Linear(np.eye(1), np.zeros((1, 0)))),
            problem=SimpleNamespace(n_nuisances=0, conditions=(), by_density={}),
            screened=[
                SimpleNamespace(
                    mechanism=SimpleNamespace(name="m", parameters=(None,)), grid=grid,
                    effect=effect(own.value(grid.places()[:, 0]))[:, None],
                )
            ],
        ),
    )  # fmt: skip
    n = len(grid.fine[0])
    step = (high / low) ** (1.0 / n) - 1.0 if scale == "log" else (high - low) / n / value
    assert abs(found["m"]) == pytest.approx(value, rel=step)
    assert np.abs(effect(found["m"])) > NEEDED


def test_a_limit_is_told_with_its_unit():
    mechanism = SimpleNamespace(name="m", parameters=(Parameter("p_m", "m", 0, 1, "log", 0, ""),))
    ranking = SimpleNamespace(screened=[SimpleNamespace(mechanism=mechanism)])
    told = SimpleNamespace(limits={"m": 1.5e-7}, titles={"m": "it yields"}, ranking=ranking)
    assert limit_rows(told) == (("it yields", "p", "150 nm"),)
