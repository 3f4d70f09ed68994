"""The smallest effect that a set would have shown: nearest to doing nothing, in the rig's range."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.estimates import limits_of
from dentscope.discrepancy.inference.grid import Axis, Grid
from dentscope.discrepancy.mechanisms.base import Parameter


@pytest.mark.parametrize(
    ("low", "high", "scale", "neutral", "effect", "value"),
    [
        (-8.0, 8.0, "linear", 0.0, lambda x: x, 2.9),
        (1e-3, 1e1, "log", 0.0, lambda x: 10.0 * x, 0.29),
        (1e5, 1e9, "log", math.inf, lambda x: 1e8 / x, 1e8 / 2.9),
    ],
)
def test_limit_is_the_value_nearest_to_doing_nothing(low, high, scale, neutral, effect, value):
    own = Parameter("p", "-", low, high, scale, neutral, "", nodes=5)
    grid = Grid((Axis("m", own),))
    found = limits_of(
        SimpleNamespace(
            base=SimpleNamespace(linear=SimpleNamespace(white=lambda e: e)),
            screened=[
                SimpleNamespace(
                    mechanism=SimpleNamespace(name="m", parameters=(None,)), grid=grid,
                    effect=effect(own.value(grid.places()[:, 0]))[:, None],
                )
            ],
        ),
    )  # fmt: skip
    step = (own.value(1.0 / len(grid.fine[0])) / low) if scale == "log" else 1.0
    assert abs(found["m"]) == pytest.approx(value, rel=max(step - 1.0, 0.4))
    assert np.abs(effect(found["m"])) > math.sqrt(8.0)
