"""Values that leave a number unstated are equal to their like, on every Python."""

import pickle
from functools import lru_cache

import pytest
from dentscope.core import Material, Pair
from dentscope.dynamics.mechanisms.base import Surroundings
from dentscope.dynamics.scene import Friction, Striker


@pytest.mark.parametrize(
    "make",
    [
        lambda: Material(E=200e9, nu=0.3, density=float("nan")),
        lambda: Pair(Material(E=200e9, nu=0.3, density=float("nan")), Material(70e9, 0.3), 0.01),
        lambda: Striker(0.1, 0.01, radius=float("nan")),
        lambda: Friction(0.2, mu_static=float("nan")),
        lambda: Surroundings(thickness=float("nan"), temperature=310.0),
    ],
)
def test_what_was_stored_is_what_is_read(make):
    one, other = make(), pickle.loads(pickle.dumps(make()))
    assert one == other
    assert hash(one) == hash(other)
    asked = []
    kept = lru_cache(lambda value: asked.append(value))
    kept(one), kept(other)
    assert len(asked) == 1


def test_a_number_that_is_stated_tells_values_apart():
    steel = Material(E=200e9, nu=0.3)
    assert steel != steel.with_(density=7800.0)
    assert steel != steel.with_(nu=0.29)
    assert steel != "steel"
    assert steel.with_(density=7800.0) == steel.with_(density=7800.0)
