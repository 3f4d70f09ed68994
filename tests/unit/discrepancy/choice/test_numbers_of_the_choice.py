"""Tuned numbers of the choice where they act, worked out by hand."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
from dentscope.discrepancy.choice.decide import decide
from dentscope.discrepancy.choice.odds import Odds
from dentscope.discrepancy.choice.own_sets import fit_test


def test_four_hundred_places_of_a_grid_stand_for_all(toy) -> None:
    """Only every second of 1000 places may be the best of a set: the odd one is not seen."""
    places = np.zeros((1000, 1))
    places[1::2] = 5.0
    base = toy.fit_of([5.0])
    effect = toy.Effect("m", (0.0,))
    fitted = replace(
        base, mechanisms=(effect,), residual=np.zeros(1), residuals=-places, chi2=1.0
    )  # fmt: skip
    nulls = toy.nulls_of([[5.0]] * 9)
    # sets of 5 have chi2 of 25 where their effect is passed over
    assert fit_test(fitted, nulls).p_value == 1.0


def test_six_readings_of_two_conditions_say_something(toy) -> None:
    def told(*conditions):
        given = SimpleNamespace(
            cells=SimpleNamespace(condition=np.array(conditions), count=np.ones(len(conditions))),
            followed=(), scatters=(), drifts=(),
        )  # fmt: skip
        odds = Odds({"baseline": (), "outside-library": ()},
                    {"baseline": 0.9, "outside-library": 0.1})  # fmt: skip
        ranking = toy.ranking_of(given, toy.fit_of([0.0]))
        return decide(ranking, odds).verdict

    assert told(0, 0, 0, 1, 1, 1) == "adequate"
    assert told(0, 0, 0, 1, 1) == "undetermined"
    assert told(0, 0, 0, 0, 0, 0) == "undetermined"
