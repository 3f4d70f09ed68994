"""Simple rules on numbers small enough to follow, and their score."""

from __future__ import annotations

import math

import pytest
from dentscope.studies.peers import RULES, Row, Said, Tried, scored

CELLS = 20
BIC = RULES["BIC, 3 % floor"]


def tried(**chi2: float) -> list[Tried]:
    """Explanations of two parameters with these chi2; `baseline` first, with none."""
    return [
        Tried(name, 0 if name == "baseline" else 2, (10.0 * x, 0.0), (x, 0.0))
        for name, x in chi2.items()
    ]


@pytest.mark.parametrize(
    ("chi2", "said"),
    [
        ({"baseline": 20.0, "a": 15.0}, Said("adequate")),
        # a name costs two parameters and the margin: 2 ln 20 + 10 = 16.0
        ({"baseline": 31.5, "a": 15.0}, Said("missing-physics", "a")),
        ({"baseline": 30.9, "a": 15.0}, Said("adequate")),
        ({"baseline": 90.0, "a": 40.0, "b": 15.0}, Said("missing-physics", "b")),
        # chi2 of 60 on 18 degrees
        ({"baseline": 900.0, "a": 60.0}, Said("outside-library")),
        ({"baseline": 60.0, "a": 59.0}, Said("outside-library")),
    ],
)
def test_the_rule_that_was_declared(chi2, said) -> None:
    assert BIC.says(tried(**chi2), CELLS) == said


def test_what_a_parameter_costs_and_which_noise_counts() -> None:
    noise = RULES["AIC on noise"]
    assert noise.per_parameter(CELLS) == 2.0
    assert BIC.per_parameter(CELLS) == pytest.approx(math.log(20.0))
    # ten times the chi2 without the floor: nothing fits
    assert noise.says(tried(baseline=20.0, a=15.0), CELLS) == Said("outside-library")


def test_rows_are_counted_by_what_they_say_of_their_truth() -> None:
    def row(truth, verdict, *names) -> Row:
        return Row("set", truth, {"x": (verdict, names)}, {})

    rows = [
        row((), "adequate"), row((), "missing-physics", "a"), row(("a",), "missing-physics", "a"),
        row(("a",), "indistinguishable", "b", "a"), row(("a", "b"), "missing-physics", "b+a"),
        row(("outside-library",), "missing-physics", "a"),
        row(("outside-library",), "outside-library"),
    ]  # fmt: skip
    assert scored(rows, "x") == (4, 5, 1, 1)
