"""The rough layer against its own limits: no energy made, Greenwood's closure, neutral ends."""

import numpy as np
import pytest
from dentscope.core.material import Material, Pair
from dentscope.dynamics.mechanisms.roughness import Layer
from dentscope.dynamics.strength import strength_table
from dentscope.models import law_named

PAIR = Pair(Material(E=208e9, nu=0.3, Sy=2e9), Material(E=69e9, nu=0.33, Sy=280e6), 1e-3)
TABLE = strength_table(law_named("fitted"), PAIR)
FORCE = np.exp(TABLE.stated.force)


def layer(sigma=1e-6, start=0.1, kept=0.5):
    return Layer.of(TABLE, sigma, start, kept)


@pytest.mark.parametrize("start", [0.01, 0.3, 3.0])
def test_at_one_force_the_layer_adds_its_closure(start):
    """To what interpolation between nodes 40 % apart allows."""
    sigma = 1e-6
    rough = layer(sigma=sigma, start=start).force * FORCE
    scale = start * np.interp(sigma, TABLE.depth, FORCE)
    for k in (15, 20, 25):
        closure = sigma * np.log1p(FORCE[k] / scale)
        there = np.exp(
            np.interp(np.log(TABLE.depth[k] + closure), np.log(TABLE.depth), np.log(rough))
        )
        assert there == pytest.approx(FORCE[k], rel=0.03)


def test_a_vanishing_layer_changes_nothing():
    thin = layer(sigma=1e-12)
    deep = TABLE.depth > 1e-8
    assert np.allclose(thin.force[deep], 1.0, atol=2e-3)
    assert np.allclose(thin.recovery[deep], 1.0, atol=2e-3)


def test_asperities_that_stay_flattened_give_back_less_and_leave_more():
    elastic, flat = layer(kept=0.0), layer(kept=1.0)
    assert np.all(flat.recovery <= elastic.recovery + 1e-12)
    left = {
        name: one.dent * (TABLE.depth - one.recovery * np.exp(TABLE.stated.recovery))
        for name, one in (("elastic", elastic), ("flat", flat))
    }
    middle = slice(12, 30)
    assert np.all(left["flat"][middle] > left["elastic"][middle])
