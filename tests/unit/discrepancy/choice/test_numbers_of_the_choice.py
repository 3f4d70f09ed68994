"""Tuned numbers of the choice where they act, worked out by hand."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.discrepancy.choice.decide import _cheapest, _named, decide
from dentscope.discrepancy.choice.gauge import scaled_observables
from dentscope.discrepancy.choice.judge import Judge
from dentscope.discrepancy.choice.odds import Odds, odds_of, pooled
from dentscope.discrepancy.choice.own_sets import FitTest, fit_test


def test_at_most_three_explanations_are_named_together() -> None:
    p = {f"m{k}": 0.24 for k in range(4)} | {"baseline": 0.0, "outside-library": 0.04}
    odds = Odds({k: (k,) if k.startswith("m") else () for k in p}, p)
    assert len(_named(tuple(f"m{k}" for k in range(4)), odds)) == 3


def test_something_may_act_beside_what_has_a_hundredth(toy) -> None:
    """Gains whose odds leave a mechanism with a little more or less than 0.01."""

    def asked(p):
        base = toy.fit_of([0.0])
        effect = toy.Effect("m", (0.0,))
        one = toy.fit_of([0.0], effect)
        # 0.34 exp(gain - 1.5) of it, against 0.5 and nothing outside
        gain = math.log(p / (1.0 - p) * 0.5 / 0.34) + 1.5
        one = replace(one, log_evidence=base.log_evidence + gain)
        screened = [toy.screened_of(effect, np.zeros((5, 1)))]
        ranking = toy.ranking_of(None, base, singles=[one], screened=screened)
        seen = []
        odds_of(ranking, -1e6, beside=lambda f: seen.append(f.name) or -1e6)
        return "m" in seen

    assert [asked(0.0098), asked(0.0102)] == [False, True]


def test_outside_resembles_what_has_half_of_it(toy) -> None:
    base = toy.fit_of([0.0])
    effect = toy.Effect("m", (0.0,))
    one = toy.fit_of([0.0], effect)
    ranking = toy.ranking_of(
        SimpleNamespace(
            drifts=(), scatters=(), followed=(),
            cells=SimpleNamespace(condition=np.arange(8), count=np.ones(8)),
        ),
        base, singles=[one], screened=[toy.screened_of(effect, np.zeros((5, 1)))],
    )  # fmt: skip

    def told(part):
        odds = Odds(
            {"baseline": (), "outside-library": (), "m": ("m",)},
            {"outside-library": 0.98, "baseline": 0.01, "m": 0.01}, {"m": part * 0.98},
        )  # fmt: skip

        class Known(Judge):
            def odds(self, ranking, sampled=None):
                return odds

            def test(self, fitted):
                return FitTest(0.1, 0.0)

        return any("comes nearest" in r for r in Known(0.0, {}, None).decided(ranking, {}).reasons)

    assert [told(0.49), told(0.51)] == [False, True]


def test_a_factor_of_its_own_has_a_deviation_of_three_tenths_and_needs_three_numbers(toy) -> None:
    """Three logarithms all x too large, of unit noise 0.01: the gain by the determinant lemma."""
    names = ("permanent_depth_m",) * 3 + ("restitution",) * 3

    def found(n):
        given = toy.problem([0.2] * n + [0.0] * (6 - n))
        cells = replace(given.cells, observable=names[3 - n + 3 - 3 : 3] + names[3:] if n == 3
                        else (*names[:2], *("restitution",) * 4))  # fmt: skip
        return scaled_observables(replace(given, cells=cells), toy.fit_of(given.cells.value))

    [depth, *_] = [s for s in found(3) if s.observable == "permanent_depth_m"]
    v = 3.0 * 0.3**2
    gain = 0.5 * 0.2**2 * 3.0 * v / (1.0 + v) - 0.5 * math.log1p(v)
    assert depth.gain == pytest.approx(gain, rel=1e-9)
    assert not [s for s in found(2) if s.observable == "permanent_depth_m"]


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


def test_pairs_are_tried_where_one_in_twenty_of_its_own_sets_fits_no_better(toy) -> None:
    ranking = toy.ranking_of(None, toy.fit_of([0.0]), singles=[toy.fit_of([0.0])])

    def wanted(p):
        class Known(Judge):
            def test(self, fitted):
                return FitTest(p, 0.0)

        return Known(0.0, {}, None).wants_second(ranking)

    assert [wanted(0.049), wanted(0.051)] == [True, False]


def test_no_probability_is_surer_than_one_of_five_hundred_and_adequate_is_said_from_seven_in_ten(
    toy,
) -> None:
    names = {"baseline": (), "outside-library": (), "a": ("a",)}
    sure = Odds(names, {"baseline": 1.0 - 1e-9, "a": 5e-10, "outside-library": 5e-10})
    assert pooled(sure, sure).baseline == pytest.approx(0.998)

    def verdict(p):
        odds = Odds(
            names, {"baseline": p, "a": 0.5 * (1.0 - p), "outside-library": 0.5 * (1.0 - p)}
        )
        return _cheapest((), odds).verdict

    assert [verdict(0.69), verdict(0.71)] == ["undetermined", "adequate"]


def test_six_readings_of_two_conditions_say_something(toy) -> None:
    def told(*conditions):
        given = SimpleNamespace(
            cells=SimpleNamespace(condition=np.array(conditions), count=np.ones(len(conditions))),
            followed=(), scatters=(),
        )  # fmt: skip
        odds = Odds({"baseline": (), "outside-library": ()},
                    {"baseline": 0.9, "outside-library": 0.1})  # fmt: skip
        ranking = toy.ranking_of(given, toy.fit_of([0.0]))
        return decide(ranking, odds).verdict

    assert told(0, 0, 0, 1, 1, 1) == "adequate"
    assert told(0, 0, 0, 1, 1) == "undetermined"
    assert told(0, 0, 0, 0, 0, 0) == "undetermined"
