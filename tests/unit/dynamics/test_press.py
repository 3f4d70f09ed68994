"""Quasi-static presses: Hertz's depth, the law's own residuals, a peak of an impact come again."""

import numpy as np
import pytest
from dentscope.core import Material
from dentscope.core.errors import InputError
from dentscope.core.material import Pair
from dentscope.dynamics import (
    CREEP,
    Approach,
    Press,
    Striker,
    dent_radius,
    pressed,
    scene_of,
    strike,
)
from dentscope.models import LAWS

PLATE = Material(E=200e9, nu=0.3, Sy=350e6)
BALL = Material(E=210e9, nu=0.3, Sy=2e9)
LOADS = np.array([100.0, 400.0, 3000.0])


def scene(law="fitted", *, plate=PLATE, **given):
    return scene_of(
        LAWS[law], sphere=BALL, flat=plate, striker=Striker(mass=4e-3, tip_radius=5e-3),
        **{"approach": CREEP, **given},
    )  # fmt: skip


def test_elastic_press_is_hertz():
    found = pressed([scene("hertz", press=Press(load)) for load in LOADS])
    pair = scene("hertz").pair
    expected = (0.75 * LOADS / pair.E_reduced) ** (2.0 / 3.0) / pair.R ** (1.0 / 3.0)
    assert found.depth == pytest.approx(expected, rel=1e-9)
    assert found.recovered == pytest.approx(expected, rel=1e-9)
    assert found.radius == pytest.approx(np.sqrt(pair.R * expected), rel=1e-9)


def test_load_depth_and_what_stays_are_the_laws():
    found = pressed([scene(press=Press(load)) for load in LOADS])
    law, pair = LAWS["fitted"], Pair(BALL, PLATE, 5e-3)
    assert law.loading(pair, found.depth) == pytest.approx(LOADS, rel=1e-9)
    assert found.flat == pytest.approx(law.residual(pair, found.depth)[1], rel=1e-9)
    assert found.depth == pytest.approx(found.recovered + found.sphere + found.flat, rel=1e-12)


def test_press_to_the_peak_of_an_impact_leaves_its_dent():
    struck = scene(approach=Approach(2.0))
    impact = strike(struck)
    found = pressed([scene(press=Press(impact.peak_force_N))])
    assert found.depth[0] == pytest.approx(impact.peak_depth_m, rel=1e-6)
    assert found.flat[0] == pytest.approx(impact.residual_flat_m, rel=1e-6)
    wide = dent_radius([struck], np.array([impact.peak_depth_m]))
    assert found.radius == pytest.approx(wide, rel=1e-6)


def test_load_is_a_number_above_nothing():
    with pytest.raises(InputError, match="load_N: -1"):
        Press(-1.0)
