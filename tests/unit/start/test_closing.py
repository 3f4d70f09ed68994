"""A named flow of the metal, taken back to the finite elements."""

import numpy as np
import pytest
from dentscope.core import Material, Pair
from dentscope.start.metal_press import _clock, _flowing

STEEL = Material(E=200e9, nu=0.3, Sy=300e6)
HARD = Material(E=200e9, nu=0.3, Sy=2e9)


def test_the_inferred_constants_are_those_of_ludwik_and_of_cowper_and_symonds():
    constants = {
        "work-hardening": {"hardening_ratio": 0.8, "hardening_exponent": 0.4},
        "strain-rate-hardening": {
            "rise_at_1000_per_s": 1.5, "rate_exponent": 0.2, "strength_kept": 0.5,
        },
    }  # fmt: skip
    pair = _flowing(Pair(HARD, STEEL, 5e-3), constants)
    assert pair.sphere is HARD
    # Tabor's strain of a contact of a/R = 0.1
    assert pair.flat.flow.curve(0.02) == pytest.approx(300e6 * (1.0 + 0.8 * 0.02**0.4), rel=1e-4)
    rate = pair.flat.flow.rate
    assert rate.law == "cowper-symonds"
    assert (1000.0 / rate.reference) ** (1.0 / rate.number) == pytest.approx(1.5)


def test_the_clock_stops_where_the_striker_does():
    depth, speed = np.array(_clock(0.02, 3.0)).T
    assert depth[0] == 0.0
    assert depth[-1] == 0.02
    assert speed[0] == 3.0
    assert np.all(np.diff(speed) <= 0.0)
    # a linear force: half the energy is left at 1/sqrt(2) of the depth
    assert np.interp(0.02 / np.sqrt(2.0), depth, speed) == pytest.approx(
        3.0 / np.sqrt(2.0), rel=0.02
    )
