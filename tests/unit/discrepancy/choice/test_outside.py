"""Something outside as an explanation of its own: what it takes up, and what repeats say."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.choice.outside import odd_repeats, outside_of
from dentscope.discrepancy.rules import RULES
from dentscope.discrepancy.unknowns.repeats import Drift, Followed

CELLS = 8


def gained(toy, departure) -> float:
    """Ln odds of something outside for numbers of about 200 that are known to 1."""
    base = toy.fit_of(departure)
    found = outside_of(toy.problem([200.0 + x for x in departure]), base)
    return float(found.log_likelihood(base.residual)) - base.log_evidence


def test_its_weights_are_a_prior_and_its_departures_are_parts_of_the_value(toy) -> None:
    given = toy.problem([200.0] * CELLS)
    found = outside_of(given, toy.fit_of([0.0] * CELLS))
    assert np.exp(found.log_weight).sum() == pytest.approx(1.0)
    assert np.sqrt(found.parts[-1].noise[0, 0] - 1.0) == pytest.approx(RULES.amplitudes[-1] * 200.0)
    # of a logarithm the departure is the part itself
    force = toy.problem([5.0] * CELLS, observable="peak_force_N")
    parts = outside_of(force, toy.fit_of([0.0] * CELLS)).parts
    assert np.sqrt(parts[-1].noise[0, 0] - 1.0) == pytest.approx(RULES.amplitudes[-1])


def test_noise_alone_speaks_against_it(toy) -> None:
    assert gained(toy, np.random.default_rng(1).standard_normal(CELLS).tolist()) < 0.0


def test_what_no_law_explains_is_taken_up(toy) -> None:
    assert gained(toy, [40.0 * (-1) ** k for k in range(CELLS)]) > 100.0


@pytest.mark.parametrize("p", [1e-4, 1e-8])
def test_a_drift_or_a_column_is_worth_what_its_p_value_can_be(toy, p) -> None:
    """At most 1/(-e p ln p) (Sellke, Bayarri and Berger 2001)."""
    drifts = (Drift("restitution", 0.1, 3.9, math.log(p)),)
    followed = (Followed("x_oil", "restitution", 0.1, math.log(p)),)
    for given in ({"drifts": drifts}, {"followed": followed}):
        found = odd_repeats(toy.problem([0.0], **given))
        assert found == pytest.approx(-math.log(-math.e * p * math.log(p)))
    # what is not seen may act all the same, with its prior
    assert odd_repeats(SimpleNamespace(drifts=(), scatters=(), followed=())) == 0.0
