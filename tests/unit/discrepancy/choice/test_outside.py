"""Something outside as an explanation of its own: what it takes up, and what repeats say."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.choice.gauge import scaled_observables
from dentscope.discrepancy.choice.judge import Judge
from dentscope.discrepancy.choice.outside import AMPLITUDES, odd_repeats, outside_of
from dentscope.discrepancy.comparison.cells import Scatter
from dentscope.discrepancy.unknowns.drift import Drift

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
    assert np.sqrt(found.parts[-1].noise[0, 0] - 1.0) == pytest.approx(AMPLITUDES[-1] * 200.0)
    # of a logarithm the departure is the part itself
    force = toy.problem([5.0] * CELLS, observable="peak_force_N")
    parts = outside_of(force, toy.fit_of([0.0] * CELLS)).parts
    assert np.sqrt(parts[-1].noise[0, 0] - 1.0) == pytest.approx(AMPLITUDES[-1])


def test_noise_alone_speaks_against_it(toy) -> None:
    assert gained(toy, np.random.default_rng(1).standard_normal(CELLS).tolist()) < 0.0


def test_what_no_law_explains_is_taken_up(toy) -> None:
    assert gained(toy, [40.0 * (-1) ** k for k in range(CELLS)]) > 100.0


def test_a_drift_is_worth_what_its_p_value_can_be(toy) -> None:
    p = 1e-4
    given = toy.problem([0.0], drifts=(Drift("restitution", 0.1, 3.8906),))
    assert odd_repeats(given) == pytest.approx(-math.log(-math.e * p * math.log(p)), abs=1e-3)
    assert odd_repeats(SimpleNamespace(drifts=(), scatters=(), followed=())) == -math.inf


def test_scatter_may_be_a_noise_misjudged_up_to_a_few_times(toy) -> None:
    def odds(ratio: float) -> float:
        return odd_repeats(toy.problem([0.0], scatters=(Scatter("restitution", ratio, 30),)))

    assert odds(1.5) < 0.0
    assert odds(78.0) > 20.0
    assert odds(2.0) < odds(4.0) < odds(8.0)


def depths_and_restitutions(toy, depths):
    """Four depths (logarithms, 2 %) and four restitutions that fit, with their baseline's fit."""
    given = toy.problem([0.02 * x for x in depths] + [0.5] * 4)
    names = ("permanent_depth_m",) * 4 + ("restitution",) * 4
    given = replace(given, cells=replace(given.cells, observable=names))
    base = toy.fit_of([0.02 * x for x in depths] + [0.0] * 4)
    linear = replace(base.linear, noise=0.02**2 * np.eye(8))
    mixture = replace(base.mixture, parts=(linear,))
    return given, replace(base, linear=linear, mixture=mixture)


def test_depths_that_are_all_as_many_times_too_large_are_a_calibration(toy) -> None:
    """Not roughness, which adds a depth and is no factor."""
    given, base = depths_and_restitutions(toy, [math.log(1.4) / 0.02] * 4)
    depth, restitution = scaled_observables(given, base)
    assert (depth.observable, restitution.observable) == ("permanent_depth_m", "restitution")
    assert depth.factor == pytest.approx(1.4, rel=0.005)
    assert restitution.factor == pytest.approx(1.0)
    # n (ln 1.4)^2/(2 s^2) less what the factor's prior costs
    whole = 4.0 * math.log(1.4) ** 2
    wide = 0.02**2 + 4.0 * 0.3**2
    gain = 0.5 * whole * (1.0 / 0.02**2 - 1.0 / wide) - 0.5 * math.log(wide / 0.02**2)
    assert depth.gain == pytest.approx(gain, rel=1e-6)
    assert restitution.gain < 0.0
    assert "all readings of crater depth are 1.4 times" in depth.told


def test_depths_off_by_more_at_every_speed_are_none(toy) -> None:
    given, base = depths_and_restitutions(toy, [-20.0, 20.0, -20.0, 20.0])
    assert all(s.gain < 0.0 for s in scaled_observables(given, base))


def test_one_observable_alone_has_no_factor(toy) -> None:
    given = toy.problem([200.0] * CELLS)
    assert scaled_observables(given, toy.fit_of([40.0] * CELLS)) == ()


def test_a_factor_is_told_where_it_explains_as_much_as_what_leads(toy) -> None:
    given, base = depths_and_restitutions(toy, [math.log(1.4) / 0.02] * 4)
    scaled = scaled_observables(given, base)
    judge = Judge(0.0, {}, toy.nulls_of(np.zeros((3, 8))), scaled)
    little = replace(base, log_evidence=base.log_evidence + scaled[0].gain - 1.0)
    much = replace(base, log_evidence=base.log_evidence + scaled[0].gain + 1.0)
    for single, told in ((little, 1), (much, 0)):
        ranking = toy.ranking_of(given, base, singles=[single])
        assert len(judge.factors_told(ranking)) == told
